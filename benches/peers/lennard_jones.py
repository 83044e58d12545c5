"""tabor beside Adhesion on rough contact by a Lennard-Jones law: CPU seconds and one measure of error.

    cargo build --release
    pip install numpy scipy Adhesion==0.93 ContactMechanics==1.8.3 SurfaceTopography==1.27.1 NuMPI==0.18.1 muFFT==0.95 muGrid==1.4.1
    python benches/peers/lennard_jones.py [--points 256] [--tabor target/release/tabor]

The surface is made by tabor (as in adhesive.py) and handed to both. Unit cell, E* = 1, range 4e-4, one thread each. Adhesion holds a
rigid offset of one rms height between the mean planes; tabor is given the mean gap to which that leads. Both gaps are judged
by the same function.
"""

import os

# One thread for the vectors of the peer's minimiser unless the caller says otherwise, before NumPy looks.
for threads in ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS"):
    os.environ.setdefault(threads, "1")

import argparse
import pathlib
import platform
import tempfile
import time

import numpy as np
import scipy.optimize
from Adhesion.Interactions import VDW82
from Adhesion.System import SmoothContactSystem
from ContactMechanics import PeriodicFFTElasticHalfSpace
from SurfaceTopography import Topography

from adhesive_run import RANGE, run_tabor

#: Works of adhesion over E* and side.
WORKS = [4e-6, 2e-5]


def judge(gap, heights, work):
    """The imbalance over the traction, rms, and the energy an area over the work of adhesion.

    Equilibrium asks that elastic pressure and traction sum to the same number everywhere, the mean pressure.
    """
    n = len(heights)
    q = np.hypot(2 * np.pi * np.fft.fftfreq(n, 1 / n)[:, None], 2 * np.pi * np.fft.rfftfreq(n, 1 / n)[None, :])
    elastic = np.fft.irfft2(0.5 * q * np.fft.rfft2(gap + heights), s=(n, n))
    ratio = RANGE / (gap + RANGE)
    traction = 8 * work / (3 * RANGE) * (ratio**3 - ratio**9)
    imbalance = np.std(elastic + traction) / np.sqrt(np.mean(traction**2))
    potential = -work / 3 * (4 * ratio**2 - ratio**8)
    energy = np.mean(0.5 * elastic * (gap + heights) + potential)
    return float(imbalance), float(energy / work)


def run_adhesion(heights, work, tolerance, pairs):
    """Adhesion's objective with its default minimiser at one thread; CPU seconds of the minimisation, and the gap."""
    n = len(heights)
    substrate = PeriodicFFTElasticHalfSpace((n, n), 1.0, (1.0, 1.0))
    # The energy -w (4/3 (eps/r)^2 - 1/3 (eps/r)^8) at the distance r = gap + eps.
    law = VDW82(work / 3 * RANGE**8, 16 * np.pi * work * RANGE**2)
    system = SmoothContactSystem(substrate, law, Topography(heights, (1.0, 1.0), periodic=True))
    offset = -heights.std()
    rigid = heights + offset
    objective = system.objective(offset, gradient=True)
    start = np.maximum(0.0, rigid + 1.05 * RANGE)
    # No state lies deeper; it keeps the line search out of the core.
    bounds = scipy.optimize.Bounds((rigid + 0.5 * RANGE).ravel(), np.inf)
    options = {"maxiter": 20000, "maxfun": 40000, "ftol": 0.0, "gtol": tolerance / n**2, "maxcor": pairs}
    cpu = time.process_time()
    found = scipy.optimize.minimize(objective, start.ravel(), jac=True, method="L-BFGS-B", bounds=bounds, options=options)
    cpu = time.process_time() - cpu
    return {"cpu": cpu, "gap": found.x.reshape(n, n) - rigid - RANGE}


def main():
    """Runs both on each work of adhesion and prints the table."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--points", type=int, default=256)
    parser.add_argument("--tabor", default="target/release/tabor")
    parser.add_argument("--tolerance", type=float, default=1e-6, help="tabor's residual")
    parser.add_argument("--peer-tolerance", type=float, default=6e-7, help="largest imbalance of a point in Adhesion, E*")
    parser.add_argument("--pairs", type=int, default=10, help="pairs of vectors that Adhesion's minimiser keeps")
    options = parser.parse_args()
    print(f"{options.points} x {options.points} points, {platform.machine()}, one thread each\n")
    print("| w/(E* L) | | CPU seconds | ratio | imbalance | energy | repelling area |")
    print("|---|---|---|---|---|---|---|")
    with tempfile.TemporaryDirectory() as folder:
        folder = pathlib.Path(folder)
        case = ("exponential", "exponential", WORKS[0])
        heights = np.ascontiguousarray(run_tabor(options.tabor, case, options.points, 1.0, 1e-1, folder)["heights"])
        for work in WORKS:
            theirs = run_adhesion(heights, work, options.peer_tolerance, options.pairs)
            case = ("Lennard-Jones", "lennard-jones", work)
            mean_gap = float(theirs["gap"].mean())
            ours = run_tabor(options.tabor, case, options.points, mean_gap, options.tolerance, folder, heights)
            for who, run in (("tabor", ours), ("Adhesion 0.93", theirs)):
                imbalance, energy = judge(run["gap"], heights, work)
                area = 100 * (run["gap"] < 0.0).mean()
                print(
                    f"| {work:g} | {who} | {run['cpu']:.2f} | {run['cpu'] / ours['cpu']:.1f} "
                    f"| {imbalance:.1e} | {energy:.5f} | {area:.3f} % |",
                    flush=True,
                )
    print("\nCPU seconds: tabor's of the whole process, files included; Adhesion's of its minimisation.")


if __name__ == "__main__":
    main()
