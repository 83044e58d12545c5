"""The study of `examples/sweep` by Snakemake, as a SLURM array, and by Dask."""

import csv
import os
import shutil
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

EXAMPLE = Path(__file__).parents[2] / "examples" / "sweep"
# The programs of this environment.
PROGRAMS = Path(sys.executable).parent


@pytest.fixture
def study(tmp_path):
    shutil.copytree(EXAMPLE, tmp_path / "sweep")
    return tmp_path / "sweep"


def environment(**more):
    return {**os.environ, "PATH": f"{PROGRAMS}{os.pathsep}{os.environ['PATH']}", **more}


def rows(path):
    with path.open(newline="") as file:
        return list(csv.DictReader(file))


def finished(folder):
    lines = [line for path in sorted(folder.glob("*/*.jsonl")) for line in path.read_text().splitlines()]
    # A case that did not converge is solved again by the next call.
    return [line for line in lines if '"status":"finished"' in line]


def snakemake(folder, *words):
    return [str(PROGRAMS / "snakemake"), "-c2", "--nolock", "--rerun-incomplete", "--quiet", "all", *words]


def test_snakemake_goes_on_after_a_kill(study):
    pytest.importorskip("snakemake")
    # More cases than end before the kill, one of which cannot converge.
    text = (study / "study.toml").read_text().replace("to = 4\ncount = 4", "to = 12\ncount = 12")
    limits = '[[axis]]\nkey = "solver.max_iterations"\nvalues = [5000, 3]\n'
    (study / "study.toml").write_text(text.replace("values = [0.05, 0.1, 0.2]", "values = [0.05, 0.1]") + "\n" + limits)
    job = subprocess.Popen(snakemake(study), cwd=study, env=environment(), start_new_session=True)
    for _ in range(600):
        time.sleep(0.05)
        if len(finished(study / "shares")) > 3:
            break
    os.killpg(job.pid, signal.SIGKILL)
    job.wait()
    before = finished(study / "shares")
    assert 3 < len(before) < 24, "killed amid the work"
    done = subprocess.run(snakemake(study), cwd=study, env=environment(), capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    after = finished(study / "shares")
    # What was finished stands as it was, seconds included; the last line of each job the kill may have cut.
    assert len(set(before) - set(after)) <= 2
    found = rows(study / "swept" / "runs.csv")
    assert len(found) == 48
    for row in found:
        expected = "finished" if row["solver.max_iterations"] == "5000" else "not-converged"
        assert row["status"] == expected, row
    assert (study / "swept" / "means.png").stat().st_size > 0


def test_a_slurm_array(study):
    script = [str(study / "slurm.sh"), "study.toml"]
    for number in ("1", "2", "3"):
        task = {"SLURM_ARRAY_TASK_ID": number, "SLURM_ARRAY_TASK_COUNT": "3", "SLURM_CPUS_PER_TASK": "1"}
        subprocess.run(script, cwd=study, env=environment(**task), check=True)
    subprocess.run([*script, "merge"], cwd=study, env=environment(), check=True)
    found = rows(study / "study" / "runs.csv")
    assert len(found) == 12
    assert {row["status"] for row in found} == {"finished"}


def test_dask(study, monkeypatch):
    pytest.importorskip("distributed")
    pytest.importorskip("pandas")
    from dask.distributed import Client, LocalCluster

    monkeypatch.chdir(study)
    monkeypatch.syspath_prepend(str(study))
    import with_dask

    paths = environment(PYTHONPATH=str(study))
    monkeypatch.setenv("PYTHONPATH", paths["PYTHONPATH"])
    with LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=None) as cluster, Client(cluster) as client:
        table = with_dask.study(client, [0.1, -1.0], [1, 2])
    assert len(table) == 4
    good = table[table["rms_slope"] == 0.1]
    assert (good["pull_off_force"] > 0).all()
    # A case that fails says why, and the others are done.
    bad = table[table["rms_slope"] == -1.0]
    assert bad["message"].str.contains("rms_slope").all()
