"""Theories beside the tables that the library is tested with (tests/reference)."""

import csv
import json
from pathlib import Path

import numpy as np
import pytest

import tabor
from tabor import theory

REFERENCE = Path(__file__).parents[2] / "tests" / "reference"


def checks(function):
    """The entries of a function: their inputs, what is expected and its relative tolerance."""
    entries = json.loads((REFERENCE / "theory_checks.json").read_text())["checks"]
    found = [entry for name, entry in entries.items() if name.partition("#")[0] == function]
    assert found
    return found


def rows(file):
    lines = (REFERENCE / file).read_text().splitlines()
    return list(csv.DictReader(line for line in lines if not line.startswith("#")))


def test_love():
    entries = checks("love")
    inputs = {name: np.array([entry["inputs"][name] for entry in entries]) for name in ("x", "y", "a", "b")}
    found = theory.love.rectangle(1.0, 1.0, inputs["x"], inputs["y"], inputs["a"], inputs["b"])
    np.testing.assert_allclose(found, [entry["expected"] for entry in entries], rtol=1e-10)
    discs = checks("disc_load")
    places = [entry["inputs"]["r_over_c"] for entry in discs]
    tolerance = max(entry["rtol"] for entry in discs)
    np.testing.assert_allclose(theory.love.disc(2.0, 6.0, places, 1.0) / 3.0, [entry["expected"] for entry in discs], rtol=tolerance)


def test_layers():
    entries = checks("layer_M")
    q, nu = (np.array([entry["inputs"][name] for entry in entries]) for name in ("k", "nu"))
    np.testing.assert_allclose(theory.layer.bonded(q, nu), [entry["expected"]["bonded"] for entry in entries], rtol=1e-11)
    np.testing.assert_allclose(theory.layer.sliding(q), [entry["expected"]["slip"] for entry in entries], rtol=1e-11)
    assert theory.layer.bonded(q[:, None], nu[None, :]).shape == (q.size, nu.size)


def test_a_lennard_jones_sphere_forgets_other_approaches():
    sphere = (1.0, 0.1**-1.5, 1.0, 1.0)
    force = theory.lennard_jones_sphere.at_approach(*sphere, 0.5).force
    # Its curve goes deeper, and has other points.
    theory.lennard_jones_sphere.at_approach(*sphere, 5.0)
    assert theory.lennard_jones_sphere.at_approach(*sphere, 0.5).force == force


@pytest.mark.parametrize("mu", [0.1, 0.5])
def test_lennard_jones_sphere(mu):
    # Range, radius and work of adhesion 1: the modulus that makes this Tabor parameter.
    sphere = (1.0, mu**-1.5, 1.0, 1.0)
    [expected] = [row for row in rows("lj_special_points.csv") if float(row["mu"]) == mu]
    off = theory.lennard_jones_sphere.pull_off(*sphere)
    # Two solvers of that table agree to 1e-6 in what is stationary; its place is known to the root of that.
    assert off.force / (2 * np.pi) == pytest.approx(-float(expected["pull_F_over_2piwR"]), rel=1e-6)
    assert off.approach == pytest.approx(float(expected["pull_A"]), abs=1e-3)
    curve = [row for row in rows(f"lj_curve_mu{mu}.csv")[::10] if float(row["A"]) < 2]
    assert len(curve) > 5
    approach, force, gap, radius = (np.array([float(row[name]) for row in curve]) for name in ("A", "F_over_2piwR", "u0", "r_eq"))
    found = theory.lennard_jones_sphere.at_approach(*sphere, approach)
    # Gaps of that table count from the bodies, these from where the traction vanishes.
    np.testing.assert_allclose(found.force / (2 * np.pi), force, atol=1e-5)
    np.testing.assert_allclose(found.central_gap + 1, gap, atol=1e-5)
    np.testing.assert_allclose(found.contact_radius, radius, atol=1e-4)


def test_cohesive_wave():
    wave = (1e9, 1e-8, 1e-6, 5e-3)
    a = np.linspace(0.05, 0.4, 5) * 1e-6
    # A range of 1e-4 amplitudes is Johnson's wave to 1e-3 of the full pressure (the library's own test), ...
    sharp = theory.cohesive_wave.at_half_width(*wave, 1e-12, a)
    whole = theory.westergaard.full_contact_pressure(*wave[:3])
    johnson = theory.westergaard.adhesive_mean_pressure(*wave, a)
    np.testing.assert_allclose(sharp.mean_pressure, johnson, atol=1e-3 * whole)
    assert theory.cohesive_wave.pull_off(*wave, 1e-12).mean_pressure == pytest.approx(-theory.westergaard.pull_off(*wave)[0], rel=1e-3)
    # ... and of 10 amplitudes adds its tension to Westergaard's pressure.
    wide = theory.cohesive_wave.at_half_width(*wave, 1e-7, a)
    hard = theory.westergaard.mean_pressure(*wave[:3], a)
    np.testing.assert_allclose(wide.mean_pressure, hard - 5e-3 / 1e-7, rtol=1e-12)
    np.testing.assert_allclose(wide.cohesive_half_width, 0.5e-6, rtol=1e-12)
    np.testing.assert_allclose(wide.half_width, a, rtol=1e-12)
    assert np.isnan(theory.cohesive_wave.closing(*wave, 1e-7).mean_pressure)
    with pytest.raises(ValueError, match="half_width"):
        theory.cohesive_wave.at_half_width(*wave, 1e-9, 0.6e-6)


def test_interacting_asperities():
    [entry] = [entry for entry in checks("icha_det_surface") if entry["inputs"]["rule"] == "vol"][:1]
    inputs, expected = entry["inputs"], entry["expected"]
    modulus, side = 1.33e12, 2 * np.pi / 2.5e5
    heights = tabor.self_affine(
        (inputs["n"],) * 2,
        side,
        hurst=inputs["H"],
        rms_height=0.52e-9,
        rolloff=side / 4,
        shortest=side / (4 * inputs["N"]),
        seed=inputs["seed"],
    )
    unit = modulus * tabor.statistics(heights, side)["rms_slope"]
    # In any order.
    loads = np.array([0.02, 0.005])
    found = theory.icha.under_pressure(heights, side, modulus, loads * unit)
    for load, area in zip(loads, found.contact_area_fraction):
        # Which contacts merge depends on the loads on the way: 5 %, as the table says.
        assert area / load == pytest.approx(expected[f"kappa_at_{load}"], rel=entry["rtol"])
    tension = theory.icha.attraction(heights, side, modulus, 0.005 * unit, 0.2, 1e-9)
    assert tension / unit == pytest.approx(expected["pad_at_0.005"], rel=entry["rtol"])
    assert found.mean_gap[0] < found.mean_gap[1]


def test_asperities_refuse():
    heights = tabor.self_affine((32, 32), 1e-6, rms_slope=0.1, shortest=2e-7)
    icha = theory.icha.under_pressure
    for call, words in [
        (lambda: icha(heights, 1e-6, 1e9, 0.0), "mean_pressure"),
        (lambda: icha(heights, 1e-6, -1e9, 1e6), "contact_modulus"),
        (lambda: icha(np.zeros((8, 8)), 1e-6, 1e9, 1e6), "summit"),
        (lambda: icha(heights, 1e-6, [1e9, 1e9], [1e6] * 3), "shapes"),
        (lambda: icha(heights[0], 1e-6, 1e9, 1e6), "heights"),
        (lambda: theory.icha.attraction(heights, 1e-6, 1e9, 1e6, 0.1, 1e-9, law="yukawa"), "law"),
    ]:
        with pytest.raises(ValueError, match=words):
            call()
    with pytest.warns(tabor.NotConvergedWarning, match="beyond this model"):
        found = icha(heights, 1e-6, 1e9, [1e6, 1e9])
    assert np.isfinite(found.mean_gap[0]) and np.isnan(found.mean_gap[1])
