"""The examples in the documentation."""

import doctest
import importlib
import pkgutil
import re
from pathlib import Path

import pytest

import tabor

# What a fit says of its doubts is no error here.
pytestmark = pytest.mark.filterwarnings("ignore::tabor.TaborWarning")

MODULES = ["tabor", *(module.name for module in pkgutil.walk_packages(tabor.__path__, "tabor.") if not module.name.endswith("__main__"))]


@pytest.mark.parametrize("name", MODULES)
def test_examples_of_the_documentation(name):
    assert doctest.testmod(importlib.import_module(name)).failed == 0


def test_the_program_of_the_readme(capsys):
    text = (Path(__file__).parents[2] / "README.md").read_text(encoding="utf-8")
    [program] = re.findall(r"```python\n(.*?)```", text, re.DOTALL)
    exec(compile(program, "README.md", "exec"), {})
    assert len(capsys.readouterr().out.splitlines()) == 3
