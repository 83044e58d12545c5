"""Seconds: `pytest benches`. What Python costs beside the command line, and other codes on the same surface."""

import subprocess
import sys

import numpy as np
import pytest

import tabor

POINTS, SIDE, PRESSURE = 512, 1.0, 0.005
SCENE = {
    "grid": {"points": POINTS, "size": SIDE},
    "solid": {"contact_modulus": 1.0},
    "surface": [
        {"kind": "self-affine", "hurst": 0.8, "rms_slope": 0.1, "longest": 1.0, "rolloff": 0.25, "shortest": 1 / 64, "seed": 1}
    ],
    "loading": {"control": "pressure", "path": [PRESSURE]},
    "solver": {"tolerance": 1e-7, "backend": "cpu"},
    "output": {"images": []},
}


@pytest.fixture(scope="module")
def heights():
    return tabor.Scene(SCENE).heights()


@pytest.mark.benchmark(group="import")
def test_import(benchmark):
    # NumPy's own import is most of it.
    benchmark.pedantic(lambda: subprocess.run([sys.executable, "-c", "import tabor"], check=True), rounds=5)


@pytest.mark.benchmark(group="import")
def test_import_of_numpy(benchmark):
    benchmark.pedantic(lambda: subprocess.run([sys.executable, "-c", "import numpy"], check=True), rounds=5)


@pytest.mark.benchmark(group="512 points")
def test_python(benchmark, heights):
    contact = tabor.Contact(heights, SIDE, contact_modulus=1.0, tolerance=1e-7, backend="cpu", threads=1)
    benchmark.pedantic(lambda: contact.solve(pressure=PRESSURE), rounds=8, warmup_rounds=1)


@pytest.mark.benchmark(group="512 points")
def test_command_line(benchmark, heights, tmp_path):
    # Seconds of the step itself, as its row says: without start-up, surface and files.
    np.save(tmp_path / "map.npy", heights)
    scene = {**SCENE, "surface": [{"kind": "file", "path": str(tmp_path / "map.npy"), "unit": "m"}], "grid": {"size": SIDE}}
    (tmp_path / "scene.toml").write_text(tabor.Scene(scene).to_toml())
    words = ["run", str(tmp_path / "scene.toml"), "--out", str(tmp_path / "out"), "--threads", "1", "--quiet"]

    def run():
        subprocess.run([sys.executable, "-m", "tabor", *words], check=True)

    benchmark.pedantic(run, rounds=8, warmup_rounds=1)
    benchmark.extra_info["seconds of the step"] = float(tabor.Run(tmp_path / "out").curve["seconds"][0])


@pytest.mark.benchmark(group="512 points")
def test_tamaas(benchmark, heights):
    tamaas = pytest.importorskip("tamaas")
    tamaas.set_log_level(tamaas.LogLevel.error)

    def solve():
        model = tamaas.Model(tamaas.model_type.basic_2d, [SIDE, SIDE], [POINTS, POINTS])
        model.E, model.nu = 1.0, 0.0
        tamaas.PolonskyKeerRey(model, heights, 1e-9).solve(PRESSURE)

    benchmark.pedantic(solve, rounds=2)


@pytest.mark.benchmark(group="512 points")
def test_contactmechanics(benchmark, heights):
    mechanics = pytest.importorskip("ContactMechanics")
    topography = pytest.importorskip("SurfaceTopography")
    surface = topography.Topography(heights.T, (SIDE, SIDE), periodic=True)
    substrate = mechanics.PeriodicFFTElasticHalfSpace((POINTS, POINTS), 1.0, (SIDE, SIDE))
    system = mechanics.Systems.NonSmoothContactSystem(substrate, surface)
    benchmark.pedantic(lambda: system.minimize_proxy(external_force=PRESSURE * SIDE**2, pentol=1e-7), rounds=2)


@pytest.mark.benchmark(group="theory")
def test_ten_thousand_radii(benchmark):
    force = np.linspace(-1.4, 10, 10_000) * np.pi * 0.05 * 1e-6
    benchmark(lambda: tabor.theory.jkr.contact_radius(1e-6, 1e9, 0.05, force))
