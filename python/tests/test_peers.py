"""Examples and tests of other codes with their numbers, solved here."""

import json
from contextlib import nullcontext
from pathlib import Path

import numpy as np
import pytest
import tamaas_numbers

import tabor
from tabor import theory


@pytest.mark.parametrize("points", [(512, 512), (512, 511)])
def test_contactmechanics_hertz(points):
    # ContactMechanics, test_hertz: a sphere of radius 20 on E* = 102 in a free cell of side 5, at a depth of 0.1 and under a
    # force of 15. Its tolerances: 1 % of depth, force and energy, 10 % of the area, 1e-3 E* of the pressure within 0.99 a.
    radius, modulus, side = 20.0, 102.0, 5.0
    heights = tabor.heights(tabor.Sphere(radius, centre=(side / 2, side / 2)), points, side, boundary="free")
    contact = tabor.Contact(heights, side, contact_modulus=modulus, boundary="free", tolerance=1e-8)
    depth = {"approach": 0.1}
    load = {"force": 15.0}
    for control in (depth, load):
        step = contact.solve(**control)
        a = theory.hertz.contact_radius_at_approach(radius, modulus, 0.1) if control is depth else theory.hertz.contact_radius(radius, modulus, 15.0)
        assert step.force == pytest.approx(theory.hertz.force(radius, modulus, a), rel=1e-2)
        assert step.approach == pytest.approx(a**2 / radius, rel=1e-2)
        assert step.contact_area_fraction * side**2 == pytest.approx(np.pi * a**2, rel=0.1)
        # The energy of a Hertz contact: (8/15) E* a^5/R^2.
        assert step.elastic_energy == pytest.approx(8 / 15 * modulus * a**5 / radius**2, rel=1e-2)
        x, y = ((np.arange(n) - n / 2) * side / n for n in points)
        r = np.hypot(x[None, :], y[:, None])
        expected = theory.hertz.pressure(radius, modulus, a, r)
        inside = r < 0.99 * a
        assert np.abs(step.pressure - expected)[inside].max() / modulus < 1e-3


def test_adhesion_wave_against_johnson():
    # Adhesion, example "sinewave": E* = 1/pi, wavelength 1, alpha = 0.2, on 256 points with the exponential law of a range
    # of the square root of the pixel. Its errors of the mean pressure on a loop fall from 0.1 to 0.01 between 64 and 4096
    # points; at equal contact widths ours lies below the law's own share of it, half of range times peak tension.
    modulus, alpha, points = 1 / np.pi, 0.2, 256
    work = alpha**2 / (2 * modulus)
    reach = np.sqrt(1 / points)
    cell = (1.0, 4 / points)
    heights = tabor.heights(tabor.Wavy(1.0, 1.0), (points, 4), cell)
    contact = tabor.Contact(heights, cell, contact_modulus=modulus, law=tabor.Exponential(work, range=reach))
    assert theory.westergaard.adhesion_parameter(modulus, 1.0, 1.0, work) == pytest.approx(alpha, rel=1e-12)
    assert theory.westergaard.full_contact_pressure(modulus, 1.0, 1.0) == pytest.approx(1.0, rel=1e-12)
    for step in contact.path(mean_gap=[0.7, 0.5, 0.3]):
        half = step.contact_area_fraction / 2
        johnson = theory.westergaard.adhesive_mean_pressure(modulus, 1.0, 1.0, work, half)
        assert step.converged
        assert step.mean_pressure == pytest.approx(johnson, abs=0.05)


def test_adhesion_sphere_against_jkr():
    # Adhesion, example "adhesive sphere": R = 1, w = 1/pi, E* = 3/4 (Maugis' units), 256 points over a side of 5, range 0.1.
    radius, work, modulus, reach, side, points = 1.0, 1 / np.pi, 0.75, 0.1, 5.0, 256
    heights = tabor.heights(tabor.Sphere(radius), (points, points), side, boundary="free")
    law = tabor.Exponential(work, range=reach)
    contact = tabor.Contact(heights, side, contact_modulus=modulus, law=law, boundary="free")
    sphere = (radius, modulus, work)
    approaches = np.array([0.0, 0.4, 0.8, 1.2])
    jkr = theory.jkr.force(*sphere, theory.jkr.contact_radius_at_approach(*sphere, approaches))
    for approach, expected, step in zip(approaches, jkr, contact.path(approach=approaches)):
        assert step.converged
        # A law of range 0.1 pulls from 0.1 further away: its own scale is the slope of the JKR force times a tenth.
        slope = theory.jkr.stiffness(*sphere, theory.jkr.contact_radius_at_approach(*sphere, approach))
        assert step.force == pytest.approx(expected, abs=0.1 * slope)


def test_tamaas_rough_contact():
    # Tamaas' example of rough contact (its self-affine surface, H = 0.8, wavelengths from 1/4 to 1/32 of the side) at one
    # load, on its own heights: area and pressure point by point.
    tamaas = pytest.importorskip("tamaas")
    points, side, pressure = 128, 1.0, 0.02
    tamaas.set_log_level(tamaas.LogLevel.error)
    spectrum = tamaas.Isopowerlaw2D()
    spectrum.q0, spectrum.q1, spectrum.q2, spectrum.hurst = 4, 4, 32, 0.8
    generator = tamaas.SurfaceGeneratorFilter2D([points, points])
    generator.spectrum = spectrum
    generator.random_seed = 1
    heights = generator.buildSurface().copy()
    heights *= 0.1 / tabor.statistics(heights, side)["rms_slope"]
    model = tamaas.Model(tamaas.model_type.basic_2d, [side, side], [points, points])
    model.E, model.nu = 1.0, 0.0
    tamaas.PolonskyKeerRey(model, heights, 1e-12).solve(pressure)
    step = tabor.Contact(heights, side, contact_modulus=1.0, tolerance=1e-9).solve(pressure=pressure)
    theirs = np.asarray(model.traction)
    np.testing.assert_array_equal(step.pressure > 0, theirs > 0)
    np.testing.assert_allclose(step.pressure, theirs, atol=1e-5 * theirs.max())


@pytest.mark.parametrize("example", tamaas_numbers.EXAMPLES)
def test_tamaas_examples(example):
    # Its examples of rough contact and of adhesion, with the numbers that it printed.
    expected = json.loads(Path(tamaas_numbers.__file__).with_suffix(".json").read_text())[example]
    # Its adhesive summits are attracted over a pixel: a pull-off would count pixels, and the contact under a load is the same.
    warned = pytest.warns(tabor.TaborWarning, match="a stiff summit is attracted") if example == "adhesion" else nullcontext()
    with warned:
        step = tamaas_numbers.solved_by_tabor(example)
    found = tamaas_numbers.numbers(step.pressure, step.contact)
    assert found.pop("points in contact") == expected.pop("points in contact")
    # Both are solved to about 1e-9 of the largest pressure.
    assert found == pytest.approx(expected, rel=1e-7, abs=1e-8 * expected["greatest"])


def test_tamaas_prints_these_numbers():
    pytest.importorskip("tamaas", reason="Tamaas is not installed; its numbers are compared as it printed them")
    pressure, gap = tamaas_numbers.solved_by_tamaas("rough contact")
    step = tamaas_numbers.solved_by_tabor("rough contact")
    np.testing.assert_allclose(step.pressure, pressure, atol=1e-8 * pressure.max())
    np.testing.assert_allclose(step.gap, gap, atol=1e-8 * gap.max())


def test_jkr_in_maugis_units():
    # Adhesion's reference solutions take Maugis' units: R = 1, E* = 3/4, w = 1/pi. There a^3 = P + 3 + sqrt(6 P + 9) and
    # the depth is a^2 - sqrt(8 a/3); a sphere lets go at -3/2 under a load, and at -5/6 where a^3 = 1/6 under a depth.
    sphere = (1.0, 0.75, 1 / np.pi)
    assert theory.jkr.pull_off_force(1.0, 1 / np.pi) == pytest.approx(-1.5, rel=1e-12)
    force = np.array([-1.5, 0.0, 4.5])
    a = theory.jkr.contact_radius(*sphere, force)
    np.testing.assert_allclose(a**3, [1.5, 6.0, 13.5], rtol=1e-9)
    np.testing.assert_allclose(theory.jkr.approach(*sphere, a), a**2 - np.sqrt(8 * a / 3), rtol=1e-12)
    edge = (1 / 6) ** (1 / 3)
    assert theory.jkr.force(*sphere, edge) == pytest.approx(-5 / 6, rel=1e-12)
    # There the curve of force over depth is vertical: between both points it falls.
    assert theory.jkr.stiffness(*sphere, 1.0001 * edge) < -1e3
