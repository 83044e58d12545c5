"""Heights and other arrays of any type: taken as they are, or refused with what is wrong."""

import numpy as np
import pytest

import tabor

ROUGH = tabor.self_affine(16, 1.0, rms_slope=0.1, shortest=0.25)
LAW = tabor.MaugisDugdale(1e-3, range=0.1)


def contact(heights=ROUGH, **more):
    return tabor.Contact(heights, 1.0, **{"contact_modulus": 1.0} | more)


class Unit(np.ndarray):
    """An array with a unit, as of astropy (``unit``)."""

    unit = "nm"


class Units(np.ndarray):
    """An array with a unit, as of unyt (``units``)."""

    units = "nm"


def with_unit(values, unit, kind=Unit):
    array = np.asarray(values, dtype=float).view(kind)
    if kind is Unit:
        array.unit = unit
    else:
        array.units = unit
    return array


@pytest.mark.parametrize(
    ("call", "words"),
    [
        (lambda: contact(ROUGH > 0), "heights: real numbers are expected, not truth values"),
        (lambda: contact(np.array([[True, 1.5]], object)), "heights: real numbers are expected, not True"),
        (lambda: contact(np.array([["1", 2.0]], object)), "heights: real numbers are expected, not '1'"),
        # 2^-24 is the least number of float16 above 0.
        (lambda: contact(ROUGH.astype(np.float16)), "heights: float16 has steps of 60 nm and more for lengths in metres; give float32"),
        (lambda: contact([[np.float16(1)] * 2] * 2), "heights: float16"),
        (lambda: contact(ROUGH.astype(complex)), "heights: real numbers are expected, not complex128"),
        (lambda: contact(np.array([[1j, 2]], object)), "heights: an array of numbers is expected"),
        (lambda: contact(np.array([[None, 2.0]], object)), "heights: 1 of 2 values are not finite"),
        (lambda: contact(np.zeros((2, 2), [("a", float)])), "heights: real numbers are expected"),
        (lambda: contact(np.array(1.0)), r"heights: an array of shape \(ny, nx\) is expected, not \(\)"),
        (lambda: contact(ROUGH[0]), r"heights: .* not \(16,\)"),
        (lambda: contact(ROUGH[None]), r"heights: .* not \(1, 16, 16\)"),
        (lambda: contact(np.zeros((0, 3))), r"heights: .* not \(0, 3\)"),
        (lambda: contact(np.ma.masked_less(ROUGH, 0)), "heights: .* values are masked"),
        (lambda: contact(with_unit(ROUGH, "nm")), "heights: it has the unit nm; plain numbers in SI units are expected"),
        (lambda: contact(with_unit(ROUGH, "nm", Units)), "heights: it has the unit nm"),
        (lambda: contact(contact_modulus=with_unit(1.0, "GPa")), "^contact_modulus: it has the unit GPa; a number in SI units"),
        (lambda: tabor.Contact(ROUGH, [with_unit(1.0, "um")] * 2, contact_modulus=1.0), r"^size\[0\]: it has the unit um"),
        (lambda: contact(law=LAW, adhesion_map=with_unit(ROUGH, "nm")), "adhesion_map: it has the unit nm"),
        (lambda: list(contact().path(pressure=with_unit([1.0, 2.0], "kPa"))), "pressure: it has the unit kPa"),
        (lambda: tabor.statistics(ROUGH > 0, 1.0), "heights: real numbers"),
        (lambda: tabor.theory.hertz.force(with_unit([1.0], "um"), 1.0, 1.0), "radius: it has the unit um"),
        (lambda: tabor.theory.hertz.force([True], 1.0, 1.0), "radius: real numbers are expected, not truth values"),
        (lambda: tabor.fit((with_unit(np.arange(20), "nm"), np.arange(20.0)), radius=1.0), "approach: it has the unit nm"),
        (lambda: contact({"radius": 1.0}, points=8), "heights: a mapping is a part of a surface and has a kind"),
        (lambda: tabor.heights([tabor.Flat(), {}], 8, 1.0), "parts: a mapping is a part of a surface and has a kind"),
    ],
)
def test_arrays_that_are_refused(call, words):
    with pytest.raises(tabor.TaborError, match=words):
        call()


def test_units_of_si_and_masks_of_adhesion():
    expected = contact().solve(pressure=0.01).pressure
    for same in (with_unit(ROUGH, "m"), with_unit(ROUGH, ""), with_unit(ROUGH, "m", Units)):
        np.testing.assert_array_equal(contact(same).solve(pressure=0.01).pressure, expected)
    acts = ROUGH > 0
    steps = [contact(law=LAW, adhesion_map=factors).solve(pressure=0.01) for factors in (acts, acts.astype(float), acts.astype(np.float16))]
    assert steps[0].force == steps[1].force == steps[2].force


def test_arrays_with_names_of_dimensions():
    xarray = pytest.importorskip("xarray")
    expected = contact().solve(pressure=0.01).pressure
    rows = xarray.DataArray(ROUGH, dims=("y", "x"), attrs={"units": "m"})
    np.testing.assert_array_equal(contact(rows).solve(pressure=0.01).pressure, expected)
    turned = rows.transpose("x", "y")
    with pytest.raises(tabor.SceneError, match=r'its dimensions are \(x, y\), .* heights.transpose\("y", "x"\)'):
        contact(turned)
    np.testing.assert_array_equal(contact(turned.transpose("y", "x")).solve(pressure=0.01).pressure, expected)
    with pytest.raises(tabor.SceneError, match="heights: it has the unit nm"):
        contact(rows.assign_attrs(units="nm"))
    with pytest.raises(tabor.SurfaceError, match="heights: a mapping is a part of a surface and has a kind, .*, not heights"):
        contact(xarray.Dataset({"heights": rows}), points=16)


def test_data_frames():
    pandas = pytest.importorskip("pandas")
    # A column of this name is no unit.
    frame = pandas.DataFrame(ROUGH).rename(columns={0: "unit"})
    np.testing.assert_array_equal(contact(frame).solve(pressure=0.01).pressure, contact().solve(pressure=0.01).pressure)
