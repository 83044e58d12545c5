"""A run as one netCDF file, by a program that was built with the feature: TABOR_NETCDF is its path."""

import json
import os
import subprocess

import numpy as np
import pytest

import tabor

PROGRAM = os.environ.get("TABOR_NETCDF")
pytestmark = pytest.mark.skipif(
    PROGRAM is None, reason="set TABOR_NETCDF to a program built by cargo build --release --features netcdf"
)

SCENE = """
title = "A wave"
[grid]
points = [32, 16]
size = ["2 um", "0.5 um"]
[solid]
contact_modulus = "1 GPa"
[[surface]]
kind = "wavy"
amplitude = "20 nm"
wavelength = "2 um"
[adhesion]
law = "exponential"
work_of_adhesion = "50 mJ/m^2"
range = "10 nm"
[loading]
control = "pressure"
path = ["1 MPa", "2 MPa", "-900 MPa"]
[solver]
precision = "PRECISION"
[output]
fields = ["pressure", "gap"]
steps = [1, 3]
"""


def tabor_program(*words, folder):
    return subprocess.run([PROGRAM, *words], cwd=folder, capture_output=True, text=True)


@pytest.mark.parametrize("precision", ["double", "single"])
def test_xarray_opens_a_run_with_units_and_scene(tmp_path, precision):
    xarray = pytest.importorskip("xarray")
    pytest.importorskip("netCDF4")
    (tmp_path / "scene.toml").write_text(SCENE.replace("PRECISION", precision))
    ran = tabor_program("run", "scene.toml", "--out", "wave", "--quiet", folder=tmp_path)
    # The last load carries nothing: the step has no fields.
    assert ran.returncode == 0, ran.stderr
    written = tabor_program("netcdf", "wave", folder=tmp_path)
    assert written.returncode == 0, written.stderr
    # A folder without a name of its own is called by the one that it has elsewhere.
    written = (tmp_path / "wave.nc").read_bytes()
    (tmp_path / "wave.nc").unlink()
    here = tabor_program("netcdf", ".", folder=tmp_path / "wave")
    assert here.returncode == 0, here.stderr
    assert (tmp_path / "wave.nc").stat().st_size == len(written)
    run = tabor.Run(tmp_path / "wave")
    with xarray.open_dataset(tmp_path / "wave.nc", decode_times=False) as data:
        for name in run.curve.dtype.names:
            if name == "state":
                assert list(data[name].values) == list(run.curve[name])
            else:
                np.testing.assert_array_equal(data[name].values, run.curve[name].astype(data[name].dtype))
        assert data["force"].attrs["units"] == "N"
        assert data["contact_area_fraction"].attrs["units"] == "1"
        assert data["pressure"].dims == ("field_step", "y", "x")
        assert data["field_step"].attrs["axis"] == "T", "along which ParaView plays"
        assert data["pressure"].shape == (1, 16, 32)
        assert data["pressure"].attrs["units"] == "Pa"
        assert data["pressure"].dtype == ("float32" if precision == "single" else "float64")
        for name in ["pressure", "gap"]:
            saved = np.load(tmp_path / "wave" / "fields" / f"step_0001_{name}.npy")
            np.testing.assert_array_equal(data[name].sel(field_step=1).values, saved)
        np.testing.assert_allclose(data["x"].values, np.arange(32) * 2e-6 / 32, rtol=1e-15)
        np.testing.assert_allclose(data["y"].values, np.arange(16) * 0.5e-6 / 16, rtol=1e-15)
        assert json.loads(data.attrs["scene"])["title"] == "A wave"
        assert data.attrs["pull_off_step"] == 2


def test_what_is_no_run_is_refused(tmp_path):
    (tmp_path / "empty").mkdir()
    said = tabor_program("netcdf", "empty", folder=tmp_path)
    assert said.returncode == 2
    assert "curve.csv: is not there; name the folder of a run" in said.stderr
    assert list(tmp_path.iterdir()) == [tmp_path / "empty"]
