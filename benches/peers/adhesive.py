"""tabor beside Tamaas 2.9 on rough contact with adhesion at a prescribed mean gap: CPU seconds and one measure of error.

    cargo build --release
    pip install numpy tamaas==2.9.0
    python benches/peers/adhesive.py [--points 512] [--tabor target/release/tabor]

The surface is made by tabor (Hurst exponent 0.8, roll-off at a quarter of the side, 16 pixels across the shortest wave, seed
1, rms slope 0.1) and handed to both. Unit cell, E* = 1, range 4e-4, mean gap one rms height, one thread each. Both gaps are
judged by the same function.
"""

import argparse
import pathlib
import platform
import tempfile
import time

import numpy as np
import tamaas as tm

from adhesive_run import RANGE, run_tabor

#: Law, its name in a scene, work of adhesion over E* and side.
CASES = [
    ("exponential", "exponential", 2e-5),
    ("exponential", "exponential", 4e-6),
    ("sharp Maugis-Dugdale", "maugis-dugdale", 2e-5),
]


def judge(gap, heights, law, work):
    """The imbalance outside of the contact over the pressure in it, rms, and the energy an area over the work of adhesion.

    Equilibrium asks that elastic pressure and attraction sum to the same number, the mean pressure, wherever the gap is open,
    and to no less than it in contact.
    """
    n = len(heights)
    q = np.hypot(2 * np.pi * np.fft.fftfreq(n, 1 / n)[:, None], 2 * np.pi * np.fft.rfftfreq(n, 1 / n)[None, :])
    elastic = np.fft.irfft2(0.5 * q * np.fft.rfft2(gap + heights), s=(n, n))
    if law == "exponential":
        attraction = work / RANGE * np.exp(-gap / RANGE)
    else:
        attraction = np.where(gap < RANGE, work / RANGE, 0.0)
    net = elastic + attraction
    # A pixel in the open at the end of a constant tension may carry any part of it.
    open_points = gap > 1e-9 * heights.std()
    if law != "exponential":
        open_points &= np.abs(gap - RANGE) > 1e-3 * RANGE
    net -= np.mean(net[open_points])
    wrong = np.where(open_points, net, np.minimum(net, 0.0))[open_points | (net < 0.0)]
    imbalance = np.sqrt((wrong**2).sum() / (net[~open_points] ** 2).sum())
    # Several states are in equilibrium with strong adhesion; which of them is found, its energy tells.
    potential = -work * (np.exp(-gap / RANGE) if law == "exponential" else np.maximum(1.0 - gap / RANGE, 0.0))
    energy = np.mean(0.5 * elastic * (gap + heights) + potential)
    return float(imbalance), float(energy / work)


def run_tamaas(case, heights, mean_gap, tolerance):
    """Polonsky & Keer's conjugate gradients in the gap with a law's energy, at one thread; CPU seconds of the solve."""
    _, law, work = case
    n = len(heights)
    tm.initialize(1)
    tm.set_log_level(tm.LogLevel.error)
    model = tm.ModelFactory.createModel(tm.model_type.basic_2d, [1.0, 1.0], [n, n])
    model.E, model.nu = 1.0, 0.0
    kind = tm.ExponentialAdhesionFunctional if law == "exponential" else tm.MaugisAdhesionFunctional
    functional = kind(heights)
    functional.parameters = {"rho": RANGE, "surface_energy": work}
    solver = tm.PolonskyKeerRey(model, heights, tolerance, tm.PolonskyKeerRey.gap, tm.PolonskyKeerRey.gap)
    solver.max_iter = 20000
    solver.addFunctionalTerm(functional)
    cpu = time.process_time()
    solver.solve(mean_gap)
    cpu = time.process_time() - cpu
    gap = np.array(model["gap"])
    return {"cpu": cpu, "gap": gap}


def main():
    """Runs both on every case and prints the table."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--points", type=int, default=512)
    parser.add_argument("--tabor", default="target/release/tabor")
    parser.add_argument("--tolerance", type=float, default=1e-6, help="tabor's residual")
    parser.add_argument("--peer-tolerance", type=float, default=1e-4, help="Tamaas' error")
    options = parser.parse_args()
    print(f"{options.points} x {options.points} points, {platform.machine()}, one thread each\n")
    print("| law | w/(E* L) | | CPU seconds | ratio | imbalance | energy | contact area |")
    print("|---|---|---|---|---|---|---|---|")
    with tempfile.TemporaryDirectory() as folder:
        folder = pathlib.Path(folder)
        first = run_tabor(options.tabor, CASES[1], options.points, 1.0, 1e-1, folder)
        heights = np.ascontiguousarray(first["heights"])
        mean_gap = float(heights.std())
        for case in CASES:
            name, law, work = case
            ours = run_tabor(options.tabor, case, options.points, mean_gap, options.tolerance, folder, heights)
            theirs = run_tamaas(case, heights, mean_gap, options.peer_tolerance)
            for who, run in (("tabor", ours), (f"Tamaas {tm.__version__}", theirs)):
                # A gap of rounding is contact in both.
                gap = np.maximum(run["gap"], 0.0)
                imbalance, energy = judge(gap, heights, law, work)
                area = 100 * (gap <= 1e-9 * heights.std()).mean()
                print(
                    f"| {name} | {work:g} | {who} | {run['cpu']:.2f} | {run['cpu'] / ours['cpu']:.1f} "
                    f"| {imbalance:.1e} | {energy:.5f} | {area:.3f} % |",
                    flush=True,
                )
    print("\nCPU seconds: tabor's of the whole process, files included; Tamaas' of its solve.")


if __name__ == "__main__":
    main()
