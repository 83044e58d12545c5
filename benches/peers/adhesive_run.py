"""One run of tabor with adhesion at a prescribed mean gap, as the comparisons with other programs time it."""

import resource
import subprocess

import numpy as np

RANGE = 4e-4

SCENE = """
[grid]
points = {points}
size = 1.0
[solid]
contact_modulus = 1.0
[[surface]]
kind = "{surface}"
{keys}
[adhesion]
law = "{law}"
work_of_adhesion = {work!r}
range = {range!r}
{taper}
[loading]
control = "mean-gap"
path = [{mean_gap!r}]
[solver]
tolerance = {tolerance!r}
max_iterations = 20000
backend = "cpu"
[output]
images = []
fields = ["gap", "heights"]
"""

SELF_AFFINE = "hurst = 0.8\nrms_slope = 0.1\nlongest = 1.0\nrolloff = 0.25\nshortest = {shortest!r}\nseed = 1"


def run_tabor(binary, case, points, mean_gap, tolerance, folder, heights=None):
    """One run at one thread: CPU seconds of the process, gap and heights."""
    _, law, work = case
    if heights is None:
        surface, keys = "self-affine", SELF_AFFINE.format(shortest=16.0 / points)
    else:
        np.save(folder / "heights.npy", heights)
        surface, keys = "file", 'path = "heights.npy"\nunit = "m"'
    scene = folder / "adhesive.toml"
    taper = "taper = 0.0" if law == "maugis-dugdale" else ""
    text = SCENE.format(
        points=points, surface=surface, keys=keys, law=law, work=work, range=RANGE, taper=taper, mean_gap=mean_gap, tolerance=tolerance
    )
    scene.write_text(text)
    out = folder / f"{law}_{work}_{surface}"
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    done = subprocess.run([binary, "run", scene, "--out", out, "--threads", "1", "--quiet"])
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    if done.returncode not in (0, 3):
        raise SystemExit(done.returncode)
    return {
        "cpu": after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime,
        "gap": np.load(out / "fields" / "step_0001_gap.npy"),
        "heights": np.load(out / "fields" / "step_0001_heights.npy"),
    }
