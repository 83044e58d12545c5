"""Types: mypy over the package, and the stub beside the compiled module."""

import subprocess
import sys
from pathlib import Path

import pytest

pytest.importorskip("mypy")
ROOT = Path(__file__).parents[1]


@pytest.mark.parametrize(
    "words",
    [
        pytest.param(["mypy", "--cache-dir", "{cache}"], id="mypy"),
        pytest.param(["mypy.stubtest", "tabor._tabor"], id="stubtest"),
    ],
)
def test_types(words, tmp_path):
    # The stub is compared with the installed module, which lies in no source folder.
    where = tmp_path if words[0].endswith("stubtest") else ROOT
    done = subprocess.run(
        [sys.executable, "-m", *(word.format(cache=tmp_path) for word in words)], cwd=where, capture_output=True, text=True
    )
    assert done.returncode == 0, done.stdout + done.stderr
