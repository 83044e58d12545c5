"""Packages that need not be installed."""

from __future__ import annotations

from importlib import import_module
from typing import Any

from .errors import MissingPackageError


def package(name: str, use: str) -> Any:
    """The module of a package, which `use` needs."""
    try:
        return import_module(name)
    except ImportError:
        raise MissingPackageError(f"{use} needs {name.partition('.')[0]}: pip install {name.partition('.')[0]}") from None
