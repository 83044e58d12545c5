"""CPU seconds of the program and of Python on the same scenes, in turn: ``python benches/in_turn.py [TURNS]``.

``python benches/in_turn.py instructions`` counts 1e9 instructions in their place, by valgrind, which a busy machine does not disturb: a minute or more each.

Both solve a scene with the same tolerance on one thread, with its surface. Of both the start is taken off: of the program that of ``--version``, of
Python that of the imports and of reading the scene. The program writes its files too; so that the solves can be compared, Python also runs the scene into
a folder without pictures and report (``run``), which does what the program does but for these.
"""

import copy
import os
import re
import resource
import statistics
import subprocess
import sys
import tempfile
from pathlib import Path

import tabor

HARD = {
    "grid": {"points": 512, "size": 1.0},
    "solid": {"contact_modulus": 1.0},
    "surface": [{"kind": "self-affine", "hurst": 0.8, "rms_slope": 0.1, "longest": 1.0, "rolloff": 0.25, "shortest": 1 / 64, "seed": 1}],
    "loading": {"control": "pressure", "path": [0.005]},
    "solver": {"tolerance": 1e-7, "backend": "cpu"},
    "output": {"images": []},
}
ADHESIVE = {**copy.deepcopy(HARD), "adhesion": {"law": "exponential", "work_of_adhesion": 5e-5, "range": 0.004}}
PATH = {**copy.deepcopy(HARD), "loading": {"control": "pressure", "start": 0.002, "ramp": [{"to": 0.02, "steps": 29}]}}
SCENES = {"hard wall": HARD, "exponential": ADHESIVE, "hard wall, 30 loads": PATH}

READ = "import sys, numpy, tabor, tabor.contact, tabor.runs; scene = tabor.Scene.read(sys.argv[1], threads=1)"
SOLVE = f"{READ}\nfor step in scene.path(): pass"
RUN = f"{READ}\nscene.run(sys.argv[2], images=False)"

# The threads of NumPy's linear algebra, which nobody here asks for, wait busily when it is imported.
ALONE = {**os.environ, "OPENBLAS_NUM_THREADS": "1", "PYTHONHASHSEED": "0"}


def seconds(*words):
    """CPU seconds of a process of this interpreter, user and system."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    subprocess.run([sys.executable, *words], check=True, capture_output=True, env=ALONE)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


def instructions(*words):
    """1e9 instructions of such a process."""
    count = ["valgrind", "--tool=callgrind", "--callgrind-out-file=/dev/null", sys.executable, *words]
    said = subprocess.run(count, check=True, capture_output=True, env=ALONE, text=True).stderr
    return int(re.search(r"Collected *: *(\d+)", said)[1]) * 1e-9


def main():
    counts = sys.argv[1:] == ["instructions"]
    turns = 1 if counts else int(sys.argv[1]) if len(sys.argv) > 1 else 5
    cost = instructions if counts else seconds
    print("least and median            program        run           Python        Python/program  Python/run")
    with tempfile.TemporaryDirectory() as folder:
        for name, tables in SCENES.items():
            scene = str(Path(folder) / "scene.toml")
            tabor.Scene(tables).write(scene)
            spent = [[] for _ in range(5)]
            for _ in range(turns):
                processes = (
                    ("-m", "tabor", "--version"),
                    ("-m", "tabor", "run", scene, "--out", f"{folder}/{name}", "--threads", "1", "--quiet"),
                    ("-c", READ, scene),
                    ("-c", RUN, scene, f"{folder}/{name}, run"),
                    ("-c", SOLVE, scene),
                )
                for each, words in zip(spent, processes, strict=True):
                    each.append(cost(*words))
            # The least of a difference would be that of the slowest start: the least of each is taken.
            columns = []
            for of in (min, statistics.median):
                version, program, read, run, python = map(of, spent)
                columns.append((program - version, run - read, python - read))
            (program, run, python), medians = columns
            cells = [f"{least:.3f}, {median:.3f}" for least, median in zip(*columns, strict=True)]
            cells += [f"{python / program:.2f}, {medians[2] / medians[0]:.2f}", f"{python / run:.2f}, {medians[2] / medians[1]:.2f}"]
            print(f"{name:24}", "  ".join(f"{cell:>13}" for cell in cells), flush=True)


if __name__ == "__main__":
    main()
