"""CPU seconds of the program and of Python on the same scenes, in turn: ``python benches/in_turn.py [TURNS]``.

Of both the start is taken off: of the program that of ``--version``, of Python that of the imports and of reading the scene.
"""

import copy
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

READ = "import sys, numpy, tabor, tabor.contact; scene = tabor.Scene.read(sys.argv[1], threads=1)"
SOLVE = f"{READ}\nfor step in scene.path(): pass"


def seconds(words):
    """CPU seconds of a process, user and system."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    subprocess.run(words, check=True, capture_output=True)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


def main():
    turns = int(sys.argv[1]) if len(sys.argv) > 1 else 5
    print("scene                 program: least median  Python: least median  ratio: least median")
    with tempfile.TemporaryDirectory() as folder:
        for name, tables in SCENES.items():
            path = Path(folder) / "scene.toml"
            tabor.Scene(tables).write(path)
            program, python = [], []
            for _ in range(turns):
                run = ["-m", "tabor", "run", str(path), "--out", f"{folder}/{name}", "--threads", "1", "--quiet"]
                program.append(seconds([sys.executable, *run]) - seconds([sys.executable, "-m", "tabor", "--version"]))
                python.append(seconds([sys.executable, "-c", SOLVE, str(path)]) - seconds([sys.executable, "-c", READ, str(path)]))
            numbers = [of(each) for each in (program, python) for of in (min, statistics.median)]
            ratios = numbers[2] / numbers[0], numbers[3] / numbers[1]
            print(f"{name:22}", "  ".join(f"{number:.3f}" for number in (*numbers, *ratios)))


if __name__ == "__main__":
    main()
