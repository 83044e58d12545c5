"""tabor beside Tamaas 2.9 on one rough contact: CPU seconds, transforms, and one measure of error.

    cargo build --release
    pip install numpy tamaas==2.9.0
    python benches/peers/compare.py [--points 1024] [--tabor target/release/tabor]

The surface is made by tabor (Hurst exponent 0.8, roll-off at a quarter of the side, 8 pixels across the
shortest wave, seed 1, rms slope 1) and handed to both. Unit cell, E* = 1, mean pressure 0.05 of E*
times the rms slope, no adhesion, one thread each. Both pressures are judged by the same function.
"""

import argparse
import json
import pathlib
import platform
import resource
import subprocess
import tempfile
import time

import numpy as np
import tamaas as tm

LOAD = 0.05

SCENE = """
[grid]
points = {points}
size = 1.0
[solid]
contact_modulus = 1.0
[[surface]]
kind = "self-affine"
hurst = 0.8
rms_slope = 1.0
longest = 1.0
rolloff = 0.25
shortest = {shortest!r}
seed = 1
[loading]
control = "pressure"
path = [{load!r}]
[solver]
tolerance = {tolerance!r}
[output]
images = []
fields = ["pressure", "heights"]
"""


def common_error(pressure, heights):
    """sum p (g - min g) / (std(h) sum p): p cut at 0 and scaled to the load, g = u(p) - h afresh."""
    n = len(heights)
    p = np.maximum(pressure, 0.0)
    p *= LOAD / p.mean()
    qx = 2 * np.pi * np.fft.rfftfreq(n, 1 / n)
    qy = 2 * np.pi * np.fft.fftfreq(n, 1 / n)
    q = np.hypot(qx[None, :], qy[:, None])
    q[0, 0] = np.inf
    gap = np.fft.irfft2(2.0 * np.fft.rfft2(p) / q, s=(n, n)) - heights
    return float((p * (gap - gap.min())).sum() / (heights.std() * p.sum()))


def run_tabor(binary, points, tolerance, folder):
    """One run at one thread; the solve's seconds, the process's CPU seconds, transforms, fields."""
    scene = folder / "peers.toml"
    scene.write_text(
        SCENE.format(
            points=points, shortest=8.0 / points, load=LOAD, tolerance=tolerance
        )
    )
    out = folder / "peers"
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    subprocess.run(
        [binary, "run", scene, "--out", out, "--threads", "1", "--backend", "cpu", "--quiet"],
        check=True,
    )
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    summary = json.loads((out / "summary.json").read_text())
    iterations = (out / "curve.csv").read_text().splitlines()[1].split(",")[10]
    return {
        "wall": summary["seconds"]["solve"],
        "cpu": after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime,
        "iterations": int(iterations),
        "transforms": summary["transforms"],
        "pressure": np.load(out / "fields" / "step_0001_pressure.npy"),
        "heights": np.load(out / "fields" / "step_0001_heights.npy"),
    }


def run_tamaas(heights, tolerance):
    """Polonsky & Keer's conjugate gradients at one thread; CPU seconds of the solve."""
    n = len(heights)
    tm.initialize(1)
    tm.set_log_level(tm.LogLevel.error)
    model = tm.ModelFactory.createModel(tm.model_type.basic_2d, [1.0, 1.0], [n, n])
    model.E = 1.0
    model.nu = 0.0
    heights = np.ascontiguousarray(heights, dtype=np.float64)
    pressure = tm.PolonskyKeerRey.pressure
    solver = tm.PolonskyKeerRey(model, heights, tolerance, pressure, pressure)
    solver.max_iter = 20000

    class Count(tm.Functional):
        """Adds nothing to the energy; is asked for its gradient as often as Tamaas' own."""

        gradients = 0

        def computeF(self, *_):
            return 0.0

        def computeGradF(self, *_):
            self.gradients += 1

    count = Count()  # kept by name: Tamaas does not keep it alive
    solver.addFunctionalTerm(count)
    clock, cpu = time.perf_counter(), time.process_time()
    solver.solve(LOAD)
    cpu, wall = time.process_time() - cpu, time.perf_counter() - clock
    return {
        "cpu": cpu,
        "wall": wall,
        # A convolution for each gradient and one for each step between two of them, two transforms
        # each: 95 forward and 95 inverse ones were counted with a debugger at 48 gradients.
        "transforms": 4 * count.gradients - 2,
        "iterations": count.gradients - 1,
        "pressure": np.array(model.traction),
    }


def main():
    """Runs both and prints the table."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--points", type=int, default=1024)
    parser.add_argument("--tabor", default="target/release/tabor")
    parser.add_argument("--tolerance", type=float, default=5e-9, help="tabor's residual")
    parser.add_argument("--peer-tolerance", type=float, default=1e-8, help="Tamaas' error")
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        folder = pathlib.Path(folder)
        tabor = run_tabor(options.tabor, options.points, options.tolerance, folder)
    heights = tabor["heights"]
    tamaas = run_tamaas(heights, options.peer_tolerance)
    print(f"{options.points} x {options.points} points, {platform.machine()}, one thread each\n")
    print("| | CPU seconds | seconds of the solve | iterations | transforms | error | contact area |")
    print("|---|---|---|---|---|---|---|")
    for name, run in [("tabor", tabor), (f"Tamaas {tm.__version__}", tamaas)]:
        error = common_error(run["pressure"], heights)
        area = 100 * (run["pressure"] > 0).mean()
        print(
            f"| {name} | {run['cpu']:.2f} | {run['wall']:.2f} | {run['iterations']} "
            f"| {run['transforms']:.1f} | {error:.1e} | {area:.4f} % |"
        )
    print("\nCPU seconds: tabor's of the whole process, surface and files included; Tamaas' of its solve.")


if __name__ == "__main__":
    main()
