"""The README's table of validation, through Python."""

import numpy as np
import pytest

import tabor
from tabor import theory


def test_hertz_on_three_grids():
    # Contact radius 1/5 of the side, as in the table: force to 5.7e-4, 1e-4, 3.6e-5.
    radius, modulus, side = 1e-5, 1e9, 1e-6
    approach = (side / 5) ** 2 / radius
    for points, error in ((64, 5.7e-4), (128, 1e-4), (256, 3.6e-5)):
        sphere = {
            "grid": {"points": points, "size": side, "boundary": "free"},
            "solid": {"contact_modulus": modulus},
            "surface": [{"kind": "sphere", "radius": radius}],
            "loading": {"control": "approach", "path": [approach]},
            "solver": {"tolerance": 1e-9},
        }
        [step] = tabor.Scene(sphere).path()
        assert step.force == pytest.approx(theory.hertz.force(radius, modulus, side / 5), rel=error)


def test_westergaard():
    # A wave along x; mean gap to 2e-4 of the amplitude, contact to the two pixels at its edges.
    modulus, amplitude, wavelength, points = 1e9, 1e-9, 1e-6, 512
    heights = tabor.heights(tabor.Wavy(amplitude, wavelength), (points, 4), (wavelength, wavelength / 128))
    contact = tabor.Contact(heights, (wavelength, wavelength / 128), contact_modulus=modulus, tolerance=1e-8)
    wave = (modulus, amplitude, wavelength)
    pressures = theory.westergaard.full_contact_pressure(*wave) * np.array([0.05, 0.3, 0.8])
    for pressure, step in zip(pressures, contact.path(pressure=pressures)):
        assert step.mean_gap == pytest.approx(theory.westergaard.mean_gap(*wave, pressure), abs=2e-4 * amplitude)
        half = theory.westergaard.half_width(*wave, pressure)
        assert step.contact_area_fraction * points == pytest.approx(2 * half / wavelength * points, abs=2)


def test_full_contact():
    # The rms pressure of full contact is E* h'/2.
    heights = tabor.self_affine((128, 128), 1e-6, rms_slope=0.1, shortest=8e-8)
    step = tabor.Contact(heights, 1e-6, contact_modulus=1e9, tolerance=1e-10).solve(pressure=1e9)
    assert step.contact_area_fraction == 1.0
    slope = tabor.statistics(heights, 1e-6)["rms_slope"]
    assert step.pressure.std() == pytest.approx(1e9 * slope / 2, rel=1e-8)


@pytest.mark.parametrize("maugis_parameter", [0.3, 1.0])
def test_maugis_dugdale_spheres(maugis_parameter):
    # On 64 points and a chi up to 0.4, pull-off to 1.7 % and force to 2.8 % of 2 pi w R, as in the table.
    modulus, work, radius = 0.75, 1 / np.pi, 1.0  # Maugis' units: force, contact radius and approach of order 1
    tension = maugis_parameter / 2
    reach = work / tension
    side, points = 7.0 if maugis_parameter < 0.5 else 5.0, 64
    assert work * side / points / (modulus * reach**2) < 0.4
    apex = tabor.Sphere(radius, centre=(side / 2, side / 2))
    heights = tabor.heights(apex, (points, points), side, boundary="free")
    law = tabor.MaugisDugdale(work, range=reach)
    contact = tabor.Contact(heights, side, contact_modulus=modulus, law=law, boundary="free")
    sphere = (radius, modulus, work, tension)
    turn = theory.maugis_dugdale.pull_off(*sphere)
    assert theory.maugis_parameter(*sphere) == pytest.approx(maugis_parameter, rel=1e-12)
    approaches = np.linspace(1.0, turn.approach - 0.1, 45)
    forces = np.array([step.force for step in contact.path(approach=approaches)])
    unit = 2 * np.pi * work * radius
    assert forces.min() == pytest.approx(turn.force, rel=0.017)
    before = approaches > turn.approach + 0.1
    expected = theory.maugis_dugdale.at_approach(*sphere, approaches[before]).force
    np.testing.assert_allclose(forces[before], expected, atol=0.028 * unit)


@pytest.mark.parametrize("law", ["maugis-dugdale", "exponential", "lennard-jones"])
def test_stiff_spheres_before_contact(law):
    # Bradley's force at a gap: rigid bodies. Attraction acts over 0.3 of the radius, ten pixels; one of them at the rim of a
    # constant tension is 2 % of its area.
    work, reach, gap, side, points = 1e-6, 0.05, 0.005, 3.0, 96
    kinds = {"maugis-dugdale": tabor.MaugisDugdale, "exponential": tabor.Exponential, "lennard-jones": tabor.LennardJones}
    heights = tabor.heights(tabor.Sphere(1.0, centre=(1.5, 1.5)), (points, points), side, boundary="free")
    contact = tabor.Contact(heights, side, contact_modulus=1.0, law=kinds[law](work, range=reach), boundary="free")
    step = contact.solve(approach=-gap)
    assert step.converged and step.state == "attracted"
    assert step.force == pytest.approx(theory.bradley.force(1.0, work, reach, gap, law=law), rel=0.02)


def test_single_and_mixed_precision_agree():
    heights = tabor.self_affine((64, 64), 1e-6, rms_slope=0.1, shortest=1e-7)
    areas = {}
    for precision in ("double", "mixed", "single"):
        contact = tabor.Contact(heights, 1e-6, contact_modulus=1e9, precision=precision, tolerance=1e-4)
        areas[precision] = contact.solve(pressure=1e7).contact_area_fraction
    assert areas["mixed"] == pytest.approx(areas["double"], rel=2e-3)
    assert areas["single"] == pytest.approx(areas["double"], rel=2e-3)


def test_effects_have_their_columns():
    heights = tabor.self_affine((32, 32), 1e-6, rms_slope=0.1, shortest=2e-7)
    contact = tabor.Contact(heights, 1e-6, contact_modulus=1e9, friction={"shear_strength": "10 MPa"}, leakage={"viscosity": "1 mPa s"})
    step = contact.solve(pressure=2e7)
    assert step.friction_force == pytest.approx(1e7 * step.contact_area_fraction_corrected * 1e-12, rel=1e-9)
    assert set(step.columns) == {"friction_force", "flow_conductance", "critical_constriction"}
