"""Theories over arrays, against their closed forms."""

import numpy as np
import pytest

import tabor
from tabor import theory

R, E, W = 1e-6, 1e9, 0.05
# Its name before NumPy 2.
trapezoid = getattr(np, "trapezoid", None) or np.trapz


def test_hertz_over_arrays():
    force = np.array([[1e-9], [1e-6]])
    radius = np.array([1e-6, 2e-6, 3e-6])
    a = theory.hertz.contact_radius(radius, "1 GPa", force)
    assert a.shape == (2, 3)
    np.testing.assert_allclose(a, np.cbrt(0.75 * radius * force / 1e9), rtol=1e-14)
    np.testing.assert_allclose(theory.hertz.force(radius, 1e9, a), np.broadcast_to(force, (2, 3)), rtol=1e-13)


def test_a_scalar_gives_a_scalar():
    force = theory.jkr.pull_off_force("1 um", "50 mJ/m^2")
    assert isinstance(force, float)
    assert force == pytest.approx(-1.5 * np.pi * W * R, rel=1e-15)


def test_texts_in_arrays():
    np.testing.assert_array_equal(
        theory.jkr.pull_off_force(["1 um", "2 um"], W), theory.jkr.pull_off_force(np.array([1e-6, 2e-6]), W)
    )


def test_no_state_is_nan():
    pull_off = theory.maugis_dugdale.pull_off(R, E, W, 1e6)
    state = theory.maugis_dugdale.at_force(R, E, W, 1e6, np.array([2.0, 0.5]) * pull_off.force)
    assert np.isnan(state.force[0])
    assert state.force[1] == pytest.approx(0.5 * pull_off.force, rel=1e-10)


def test_maugis_between_dmt_and_jkr():
    # Maugis 1992: -2 pi w R at a small lambda, -1.5 pi w R at a large one.
    modulus = 4 * E / 3
    tension = np.array([1e-3, 1e2]) / 2 * np.cbrt(np.pi * W * modulus**2 / R)
    np.testing.assert_allclose(theory.maugis_parameter(R, E, W, tension), [1e-3, 1e2], rtol=1e-12)
    pull_off = theory.maugis_dugdale.pull_off(R, E, W, tension)
    np.testing.assert_allclose(pull_off.force / (np.pi * W * R), [-2, -1.5], rtol=2e-3)


def test_dmt_at_contact():
    # Each version holds 2 pi w R at point contact.
    for method in ("thermodynamic", "force", "constant"):
        force = theory.dmt.force(R, E, W, 1e-9, 0.0, method=method)
        assert force == pytest.approx(-2 * np.pi * W * R, rel=1e-9)


def test_persson_area():
    # Full contact at large pressures, and A = kappa p/(E* h') with kappa = sqrt(8/pi) for gamma = 1 at small ones.
    small = theory.persson.contact_area_fraction(1e-4 * E * 0.1, E, 0.1, gamma=1.0)
    assert small == pytest.approx(np.sqrt(8 / np.pi) * 1e-4, rel=1e-3)
    assert theory.persson.contact_area_fraction(10 * E * 0.1, E, 0.1) == pytest.approx(1.0, abs=1e-6)


def test_ten_thousand_elements():
    force = np.linspace(-1.4, 10, 10_000) * np.pi * W * R
    a = theory.jkr.contact_radius(R, E, W, force)
    np.testing.assert_allclose(theory.jkr.force(R, E, W, a), force, rtol=1e-9, atol=1e-12 * np.pi * W * R)


@pytest.mark.parametrize(
    ("call", "words"),
    [
        (lambda: theory.hertz.force(-1.0, E, 1e-9), "radius"),
        (lambda: theory.hertz.force([R, -1.0], E, 1e-9), r"radius.*element 1"),
        (lambda: theory.hertz.force("1 Pa", E, 1e-9), "radius"),
        (lambda: theory.hertz.force(R, E, np.nan), "contact_radius"),
        (lambda: theory.hertz.pressure(R, E, [1e-9, -1e-9], 0.0), r"contact_radius.*element 1"),
        (lambda: theory.cone.force(1.2, E, -1e-9), "contact_radius"),
        (lambda: theory.derjaguin.force(R, E, W, -1e-9), "contact_radius"),
        (lambda: theory.jkr.force(R, E, W, -1e-9), "contact_radius"),
        (lambda: theory.hertz.force([R, R], E, [1e-9, 1e-9, 1e-9]), "shapes"),
        (lambda: theory.hertz.force(R, E, 1j), "contact_radius"),
        (lambda: theory.hertz.force(R, None, 1e-9), "contact_modulus"),
        (lambda: theory.dmt.force(R, E, W, 1e-9, 0.0, law="yukawa"), "law"),
        (lambda: theory.westergaard.half_width(E, 1e-8, 1e-6, "40 MPa"), "mean_pressure = 4e7 .* full contact"),
        (lambda: theory.westergaard.gap(E, 1e-8, 1e-6, "0.6 um", 0.0), "half_width = 6e-7"),
        (lambda: theory.persson.contact_area_fraction(-1e6, E, 0.1), "mean_pressure = -1e6"),
        (lambda: theory.persson.pull_off(0.8, 1e-5, 1e-5, 1e-6, 1e-8, E, W, -1e-9), "range"),
        (lambda: theory.bam.attraction(1e-8, 1e-5, E, W, -1e-9, 0.0), "range"),
        (lambda: theory.laws.energy(W, 1e-9, [0.0, -1e-9]), "gap.*element 1"),
        (lambda: theory.effects.relaxation(E, E, 1.0, -1.0), "time"),
        (lambda: theory.effects.creep(E, E, 1.0, -1.0), "time"),
        (lambda: theory.table("jkr", radius="1 um"), "contact_modulus"),
        (lambda: theory.table("kjr"), r"did you mean jkr\? models\(\) lists them"),
        (lambda: theory.table("jkr", radius="1 um", contact_modulus=1e9, work=1), r"(?s)no parameter work; did you mean work_of_adhesion.*work_of_adhesion=.50 mJ/m"),
    ],
)
def test_mistakes_name_the_argument(call, words):
    with pytest.raises(ValueError, match=words) as raised:
        call()
    assert isinstance(raised.value, tabor.TaborError)


def test_laws_of_attraction():
    # The traction is the slope of the energy, and integrates to the work of adhesion.
    gap = np.linspace(0, 60e-9, 600_001)
    for law in ("lennard-jones", "cubic", "exponential", "maugis-dugdale"):
        traction = theory.laws.traction(W, "1 nm", gap, law=law)
        assert trapezoid(traction, gap) == pytest.approx(W, rel=2e-3 if law != "cubic" else 5e-4)
        inner = gap[1:400]
        slope = (theory.laws.energy(W, 1e-9, inner + 1e-13, law=law) - theory.laws.energy(W, 1e-9, inner - 1e-13, law=law)) / 2e-13
        np.testing.assert_allclose(slope, theory.laws.traction(W, 1e-9, inner, law=law), rtol=1e-4, atol=1e3)
        assert traction.max() == pytest.approx(theory.laws.peak_tension(W, 1e-9, law=law), rel=1e-6)
        steepness = (theory.laws.traction(W, 1e-9, inner + 1e-13, law=law) - theory.laws.traction(W, 1e-9, inner - 1e-13, law=law)) / 2e-13
        np.testing.assert_allclose(theory.laws.slope(W, 1e-9, inner, law=law), steepness, rtol=1e-3, atol=1e-3 * W / 1e-18)


def test_inverses_of_rough_theories():
    bam = (1e-8, "5 um", E, 0.05, 1e-9)
    gap = theory.bam.mean_gap(*bam, [1e5, 1e6])
    np.testing.assert_allclose(theory.bam.mean_pressure(*bam, gap), [1e5, 1e6], rtol=1e-6)
    assert (theory.bam.attraction(*bam, gap) > 0).all()
    rough = (0.8, 1e-5, 5e-6, 1e-7, 1e-8, E, W, 1e-9)
    repulsion = theory.persson.repulsive_pressure(*rough, "2 MPa")
    assert repulsion - theory.persson.attraction(*rough, repulsion) == pytest.approx(2e6, rel=1e-4)
    band = rough[:5]
    wavenumbers = np.linspace(2 * np.pi / 1e-5, 2 * np.pi / 1e-7, 400_001)
    density = theory.spectrum.density(*band, wavenumbers)
    assert np.sqrt(trapezoid(2 * np.pi * wavenumbers * density, wavenumbers)) == pytest.approx(1e-8, rel=1e-3)
    assert theory.spectrum.density(*band, 1e9) == 0.0


def test_weak_attraction_has_no_pull_off():
    # Stiff surfaces: of the arrays the first element adheres, the second does not.
    work = ["200 mJ/m^2", "1 uJ/m^2"]
    tension, gap = theory.bam.pull_off(1e-8, "5 um", E, work, 1e-9)
    assert tension[0] > 0 and np.isnan([tension[1], gap[1]]).all()
    rough = (0.8, "10 um", "5 um", "0.1 um", 1e-8, E)
    tension, repulsion = theory.persson.pull_off(*rough, work, 1e-9)
    assert tension[0] > 0 and np.isnan([tension[1], repulsion[1]]).all()
    # The attraction is at most w/range, 1 kPa.
    repulsion = theory.persson.repulsive_pressure(*rough, work[1], 1e-9, "2 MPa")
    assert 0 < repulsion - 2e6 < 1e3
    assert repulsion - theory.persson.attraction(*rough, work[1], 1e-9, repulsion) == pytest.approx(2e6, rel=1e-6)


def test_single_contacts_of_effects():
    # E* cot(half angle)/2 under a cone; 2 k1 k2/(k1 + k2); 2 pi R times the work of a liquid at touch.
    assert theory.cone.mean_pressure("70 deg", E) == pytest.approx(E / 2 / np.tan(np.radians(70)), rel=1e-12)
    assert theory.effects.combined_conductivity(400.0, 1.4) == pytest.approx(2 * 400 * 1.4 / 401.4, rel=1e-12)
    water = ("72 mN/m", 18e-6, 298.15, 0.5, 0.0)
    work = theory.effects.meniscus(*water)[0]
    assert theory.effects.meniscus_force(*water, R, 0.0) == pytest.approx(-2 * np.pi * R * work, rel=1e-12)
    # Slowly pulled it is JKR's, and stronger the faster.
    at_speed = theory.effects.pull_off_at_speed(R, E, W, [1e-10, 1e-6], 1e-6, 1.0)
    assert at_speed[0] == pytest.approx(theory.jkr.pull_off_force(R, W), rel=0.05) and at_speed[1] < 1.2 * at_speed[0]
    late = theory.effects.creeping_pressure(E, E, 1.0, R, 1e-8, 1e3, 0.0)
    assert late == pytest.approx(theory.hertz.pressure(R, E, theory.hertz.contact_radius(R, E, 1e-8), 0.0), rel=1e-9)
    touching = theory.maugis_dugdale.jump_in(R, E, W, 5e7)
    assert touching.approach == pytest.approx(-W / 5e7, rel=1e-9) and touching.force < 0


def test_which_theory_holds():
    assert theory.regime([0.1, 1.0, 10.0]).tolist() == ["dmt", "intermediate", "jkr"]


def test_tables_are_those_of_the_command_line():
    table = theory.table("hertz", radius="1 mm", contact_modulus="1 GPa", to="100 nm", points=5)
    assert len(table) == 5
    assert table.units["force"] == "N"
    np.testing.assert_allclose(table["force"], 4 / 3 * E * np.sqrt(1e-3) * table["approach"] ** 1.5, rtol=1e-12)
    # Angles too are in SI.
    for half_angle in [1.2, np.float32(1.2), "1.2 rad"]:
        cone = theory.table("cone", half_angle=half_angle, contact_modulus=E, to="100 nm", points=5)
        sneddon = 2 / np.pi * E * np.tan(1.2) * cone["approach"] ** 2
        np.testing.assert_allclose(cone["force"], sneddon, rtol=1e-6)
    right = theory.table("cone", half_angle=1, contact_modulus=E, to="100 nm", points=2)["force"][-1]
    np.testing.assert_allclose(right, 2 / np.pi * E * np.tan(1) * 1e-14, rtol=1e-12)


def test_every_function_gives_finite_numbers_for_likely_arguments():
    likely = {
        "radius": R, "contact_modulus": E, "work_of_adhesion": W, "force": 1e-8, "approach": 1e-9, "contact_radius": 5e-8, "r": 2e-8,
        "range": 1e-9, "gap": 1e-10, "half_angle": "85 deg", "peak_tension": 5e7, "pull_off": 2e-7, "stiffness": 200.0,
        "amplitude": 1e-8, "wavelength": 1e-6, "half_width": 2e-7, "x": 3e-7, "mean_pressure": 1e6, "wavenumber": 1e7, "counter_conductivity": 1.0, "density": 1e12,
        "rms_height": 1e-8, "separation": 1.0, "pressure": 1e5, "hurst": 0.8, "longest": 1e-5, "rolloff": 5e-6, "shortest": 1e-7,
        "rms_slope": 0.1, "rms_curvature": 1e6, "mean_gap": 2e-8, "speed": 1e-6, "reference_speed": 1e-7, "exponent": 0.5,
        "slope": 0.01, "relaxed_modulus": E, "branch_modulus": E, "relaxation_time": 1.0, "time": 2.0, "shear_strength": 1e7,
        "conductivity": 100.0, "surface_tension": 0.072, "molar_volume": 18e-6, "temperature": 298.15, "relative_humidity": 0.5,
        "contact_angle": 0.3, "surface_energy": 0.03, "surface_energy_2": 0.03, "interface_energy": 0.01, "young_modulus": E,
        "poisson_ratio": 0.3, "tabor_parameter": 1.0, "wavenumber_times_thickness": 2.0, "y": 1e-7, "half_side_x": 1e-7, "half_side_y": 2e-7,
        "heights": tabor.self_affine((32, 32), 1e-6, rms_slope=0.1, shortest=2e-7), "size": 1e-6,
    }  # fmt: skip
    import inspect
    import types

    called = 0
    modules = [each for each in vars(theory).values() if isinstance(each, types.ModuleType) and not each.__name__.endswith(("tables", "_evaluate"))]
    for module in modules:
        for name, function in inspect.getmembers(module, inspect.isfunction):
            if function.__module__ != module.__name__ or name.startswith("_"):
                continue
            wanted = [key for key, parameter in inspect.signature(function).parameters.items() if parameter.default is inspect.Parameter.empty]
            found = function(**{key: likely[key] for key in wanted})
            called += 1
            if name != "regime":
                assert np.isfinite(np.asarray(found, dtype=float)).all(), f"{module.__name__}.{name}"
    assert called >= 88
