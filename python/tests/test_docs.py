"""The examples in the documentation."""

import doctest
import importlib
import pkgutil

import pytest

import tabor

MODULES = ["tabor", *(module.name for module in pkgutil.walk_packages(tabor.__path__, "tabor.") if not module.name.endswith("__main__"))]


@pytest.mark.parametrize("name", MODULES)
def test_examples_of_the_documentation(name):
    assert doctest.testmod(importlib.import_module(name)).failed == 0
