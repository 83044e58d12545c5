"""Any layout gives the same numbers, and no input ends in a panic."""

import warnings

import numpy as np
import pytest

import tabor

pytest.importorskip("hypothesis")
from hypothesis import given, settings  # noqa: E402
from hypothesis import strategies as st  # noqa: E402
from hypothesis.extra import numpy as arrays  # noqa: E402

SMOOTH = tabor.self_affine((16, 12), (4.0, 3.0), rms_slope=0.1, shortest=1.0)
REFERENCE = tabor.Contact(SMOOTH, (4.0, 3.0), contact_modulus=1.0, threads=1).solve(pressure=0.02)

anything = st.one_of(
    st.none(), st.booleans(), st.integers(), st.floats(), st.text(max_size=8), st.lists(st.floats(), max_size=3), st.complex_numbers(),
    st.binary(max_size=3), st.dictionaries(st.text(max_size=3), st.floats(), max_size=2), st.sets(st.integers(), max_size=2),
)


@settings(max_examples=20, deadline=None)
@given(st.sampled_from(["C", "F", "reversed", "strided", "swapped", "read-only", "list"]))
def test_layouts(layout):
    same = {
        "C": SMOOTH,
        "F": np.asfortranarray(SMOOTH),
        "reversed": np.ascontiguousarray(SMOOTH[::-1, ::-1])[::-1, ::-1],
        "strided": np.repeat(SMOOTH, 2, axis=1)[:, ::2],
        "swapped": SMOOTH.astype(">f8"),
        "read-only": np.require(SMOOTH.copy(), requirements="C"),
        "list": SMOOTH.tolist(),
    }[layout]
    if layout == "read-only":
        same.flags.writeable = False
    step = tabor.Contact(same, (4.0, 3.0), contact_modulus=1.0, threads=1).solve(pressure=0.02)
    np.testing.assert_array_equal(step.pressure, REFERENCE.pressure)


def only_errors_of_its_own(call):
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        try:
            call()
        except (tabor.TaborError, TypeError) as error:
            assert "failed within itself" not in str(error)


@settings(max_examples=60, deadline=None)
@given(arrays.arrays(st.sampled_from([np.float64, np.float32, np.int32, np.complex128, bool]), arrays.array_shapes(max_dims=3, max_side=4)))
def test_any_heights(values):
    only_errors_of_its_own(
        lambda: tabor.Contact(values, 1.0, contact_modulus=1.0, max_iterations=20, threads=1).solve(pressure=0.1)
    )


ARGUMENTS = [
    "size", "contact_modulus", "hardness", "tolerance", "threads", "boundary", "precision", "max_iterations", "points", "young_modulus",
    "poisson_ratio", "thickness", "base", "relaxation", "spring", "adhesion_map", "solid", "loading", "friction", "output", "title",
]  # fmt: skip


@settings(max_examples=200, deadline=None)
@given(st.sampled_from(ARGUMENTS), anything)
def test_any_argument(name, value):
    arguments = {"size": 1.0, "contact_modulus": 1.0, "max_iterations": 20, "backend": "cpu", name: value}
    only_errors_of_its_own(lambda: tabor.Contact(SMOOTH, **arguments))


@settings(max_examples=100, deadline=None)
@given(st.sampled_from(["work_of_adhesion", "range", "peak_tension", "taper"]), anything)
def test_any_law(name, value):
    law = tabor.MaugisDugdale(**{"work_of_adhesion": 0.01, "range": 0.1, name: value})
    only_errors_of_its_own(lambda: tabor.Contact(SMOOTH, (4.0, 3.0), contact_modulus=1.0, law=law, max_iterations=20))


@settings(max_examples=60, deadline=None)
@given(st.sampled_from(["pressure", "force", "approach", "mean_gap"]), anything)
def test_any_load(control, value):
    contact = tabor.Contact(SMOOTH, (4.0, 3.0), contact_modulus=1.0, max_iterations=20, threads=1)
    only_errors_of_its_own(lambda: contact.solve(**{control: value}))


@settings(max_examples=60, deadline=None)
@given(st.sampled_from(["sphere", "cone", "wavy", "rough", "file", "points", "parts"]), anything)
def test_any_surface(kind, value):
    calls = {
        "sphere": lambda: tabor.heights(tabor.Sphere(value), 8, 1.0),
        "cone": lambda: tabor.heights(tabor.Cone(value), 8, 1.0),
        "wavy": lambda: tabor.heights(tabor.Wavy(0.1, value), 8, 1.0),
        "rough": lambda: tabor.self_affine(8, 1.0, rms_slope=value, shortest=0.5),
        "file": lambda: tabor.read_heights(value, 1.0),
        "points": lambda: tabor.Contact(tabor.Flat(), 1.0, points=value, contact_modulus=1.0),
        "parts": lambda: tabor.Contact(value, 1.0, points=8, contact_modulus=1.0),
    }
    only_errors_of_its_own(calls[kind])


@settings(max_examples=100, deadline=None)
@given(anything, anything, anything)
def test_any_theory(radius, modulus, force):
    only_errors_of_its_own(lambda: tabor.theory.hertz.contact_radius(radius, modulus, force))
