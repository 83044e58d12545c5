"""What a step gives: pictures, datasets, pickles, words."""

import concurrent.futures
import multiprocessing
import pickle
import warnings
from pathlib import Path

import numpy as np
import pytest

import tabor


def contact():
    heights = tabor.self_affine((32, 24), ("4 um", "3 um"), rms_slope=0.1, shortest="1 um")
    return tabor.Contact(heights, ("4 um", "3 um"), contact_modulus="100 MPa", law=tabor.Exponential("20 mJ/m^2", range="10 nm"))


@pytest.fixture(scope="module")
def step():
    return contact().solve(pressure="1 MPa")


def test_fields_and_numbers(step):
    for name in ("pressure", "gap", "displacement", "heights", "contact"):
        assert getattr(step, name).shape == (24, 32)
    assert step.contact.mean() == pytest.approx(step.contact_area_fraction, abs=0.02)
    np.testing.assert_allclose(step.pressure.mean(), step.mean_pressure, rtol=1e-6)
    assert step.force == pytest.approx(1e6 * 4e-6 * 3e-6, rel=1e-6)
    with pytest.raises(AttributeError, match="preasure"):
        step.preasure  # noqa: B018


def test_numbers_make_a_table():
    pandas = pytest.importorskip("pandas")
    table = pandas.DataFrame(each.numbers for each in contact().path(pressure=["1 MPa", "2 MPa"]))
    np.testing.assert_allclose(table["mean_pressure"], [1e6, 2e6], rtol=1e-6)
    assert table["contact_area_fraction"].is_monotonic_increasing and table["converged"].all()
    assert "gap" not in table


def test_datasets(step):
    dataset = step.to_dataset()
    assert dataset["pressure"].attrs["units"] == "Pa"
    assert dataset.sizes == {"y": 24, "x": 32}
    assert float(dataset["x"][-1]) == pytest.approx(4e-6 * 31 / 32)


def test_steps_pickle(step):
    again = pickle.loads(pickle.dumps(step))
    np.testing.assert_array_equal(again.gap, step.gap)
    assert again.residual == step.residual


def test_heights_of_a_solid_that_keeps_its_shape_are_one_array():
    first, second = contact().path(pressure=["1 MPa", "2 MPa"])
    assert first.heights is second.heights and not first.heights.flags.writeable
    assert first.gap.flags.writeable and first.gap.flags.owndata is False
    heights = tabor.self_affine(32, "4 um", rms_slope=0.1, shortest="1 um")
    soft = tabor.Contact(heights, "4 um", contact_modulus="100 MPa", hardness="5 MPa")
    first, second = soft.path(pressure=["1 MPa", "3 MPa"])
    assert (second.heights < first.heights).any()


def test_words(step):
    assert "in contact" in repr(step) and "converged" not in repr(step)
    assert "<table>" in step._repr_html_() and "12 µN" in step._repr_html_() and "mean pressure 1 MPa" in repr(step)
    assert "exponential" in repr(contact()) and "exponential" in contact()._repr_html_()


def solve(pressure):
    return contact().solve(pressure=pressure).contact_area_fraction


def test_processes_share_contacts():
    pressures = [1e5, 1e6, 2e6]
    with concurrent.futures.ProcessPoolExecutor(2, multiprocessing.get_context("spawn")) as pool:
        assert list(pool.map(solve, pressures)) == [solve(pressure) for pressure in pressures]


def test_threads_share_a_contact():
    one = contact()
    with concurrent.futures.ThreadPoolExecutor(3) as pool:
        steps = list(pool.map(lambda pressure: one.solve(pressure=pressure), [1e6] * 3))
    for each in steps[1:]:
        np.testing.assert_array_equal(each.gap, steps[0].gap)


def test_a_step_that_does_not_converge_says_so():
    heights = tabor.self_affine((32, 32), 4e-6, rms_slope=0.1, shortest=1e-6)
    rough = tabor.Contact(heights, 4e-6, contact_modulus=1e8, max_iterations=2)
    with pytest.warns(tabor.NotConvergedWarning, match="residual"):
        assert not rough.solve(pressure=1e6).converged


def test_progress_hears_iterations():
    heard = []
    heights = tabor.self_affine((512, 512), 4e-6, rms_slope=0.1, shortest=4e-8)
    rough = tabor.Contact(heights, 4e-6, contact_modulus=1e8, tolerance=1e-8)
    rough.solve(pressure=1e6, progress=lambda finished, iteration, residual: heard.append((iteration, residual)))
    assert heard and all(iteration > 0 and residual >= 0 for iteration, residual in heard)


def test_progress_hears_of_every_load_and_its_end():
    # Each of these takes less time than passes between two looks.
    heard = []
    steps = list(contact().path(pressure=["1 MPa", "2 MPa"], progress=lambda *numbers: heard.append(numbers)))
    assert [finished for finished, _, _ in heard] == [0, 1]
    assert [iteration for _, iteration, _ in heard] == [step.iterations for step in steps]


def test_a_bar_counts_loads(capsys):
    pytest.importorskip("tqdm")
    path = contact().path(pressure=["1 MPa", "2 MPa", "3 MPa"], progress=True)
    assert [step.converged for step in path] == [True] * 3
    shown = capsys.readouterr().err
    assert "2/3" in shown and "residual" in shown and shown.count("0/3") >= 1
    contact().solve(pressure="1 MPa", progress=True)
    assert "0/1" in capsys.readouterr().err


def test_what_progress_raises_ends_the_solve():
    def raising(finished, iteration, residual):
        raise RuntimeError("enough")

    heights = tabor.self_affine((512, 512), 4e-6, rms_slope=0.1, shortest=1.6e-8)
    rough = tabor.Contact(heights, 4e-6, contact_modulus=1e8, tolerance=1e-13, max_iterations=100_000)
    with pytest.raises(RuntimeError, match="enough"):
        rough.solve(pressure=1e6, progress=raising)


def test_pictures(step, tmp_path):
    matplotlib = pytest.importorskip("matplotlib")
    matplotlib.use("Agg")
    import matplotlib.pyplot as pyplot

    figure, axes = pyplot.subplots()
    assert step.plot("pressure", axes) is axes
    assert axes.get_images()[0].get_cmap().name == "tabor_signed"
    assert step.plot("gap").get_images()[0].get_cmap().name == "tabor_rising"
    with pytest.raises(ValueError, match="no field"):
        step.plot("force")
    pyplot.close("all")


def test_topographies():
    topography = pytest.importorskip("SurfaceTopography")
    values = np.random.default_rng(1).normal(size=(6, 4))
    mapped = topography.Topography(values, (3.0, 2.0), unit="nm", periodic=True)
    rough = tabor.Contact(mapped, contact_modulus="1 GPa")
    assert rough.resolved["grid"]["points"] == [6, 4]
    assert rough.resolved["grid"]["size"] == pytest.approx([3e-9, 2e-9])
    np.testing.assert_allclose(rough.heights(), values.T * 1e-9, rtol=1e-15)
    back = rough.solve(pressure="1 MPa").to_topography("heights")
    np.testing.assert_allclose(back.heights(), values * 1e-9, rtol=1e-12)
    assert back.physical_sizes == pytest.approx((3e-9, 2e-9)) and back.is_periodic and back.unit == "m"


FILES = Path(__file__).parents[2] / "tests" / "files"


# Files of instruments, and of other programs; those of them whose rows the other reader turns are compared by their values.
@pytest.mark.parametrize(
    ("name", "turned"),
    [
        ("asylum.ibw", True),
        ("bruker_5.spm", True),
        ("nanosurf.nid", True),
        ("mountains.x3p", False),
        ("description.vk4", False),
        ("gwyddion.gwy", False),
        ("surfacetopography.txt", False),
    ],
)
def test_topographies_of_files(name, turned):
    topography = pytest.importorskip("SurfaceTopography")
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        theirs = topography.read_topography(FILES / name)
        loaded = tabor.Contact(theirs, contact_modulus="1 GPa")
        ours = tabor.read_heights(FILES / name)
    assert loaded.surface()[1] == pytest.approx(ours.size, rel=1e-6)
    assert loaded.resolved["grid"]["boundary"] == "free"
    both = loaded.heights(), ours.heights
    if turned:
        both = tuple(np.sort(heights, axis=None) for heights in both)
    np.testing.assert_allclose(*both, atol=1e-9 * np.ptp(ours.heights))


def test_what_is_refused_ends_a_path():
    path = contact().path(mean_gap=[1e-7, -1, 1e-7])
    assert next(path).number == 1
    with pytest.raises(tabor.SceneError, match="mean_gap: -1"):
        next(path)
    assert list(path) == [] and "ended" in repr(path)


def test_a_dataset_goes_into_a_file(tmp_path):
    pytest.importorskip("netCDF4")
    xarray = pytest.importorskip("xarray")
    rubbing = tabor.Contact(contact().heights(), ("4 um", "3 um"), contact_modulus="100 MPa", friction={"shear_strength": "1 MPa"})
    solved = rubbing.solve(pressure="1 MPa")
    solved.to_dataset().to_netcdf(tmp_path / "step.nc")
    with xarray.open_dataset(tmp_path / "step.nc") as data:
        np.testing.assert_array_equal(data["pressure"], solved.pressure)
        assert data.attrs["converged"] == 1 and data.attrs["state"] == "contact"
        # What effects add is there too.
        assert data.attrs["friction_force"] == solved.friction_force
