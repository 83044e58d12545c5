"""Values of a scene checked before they go into its text: arrays, counts, tables."""

from __future__ import annotations

import json
import math
import os
from collections.abc import Mapping
from typing import Any

import numpy as np
import numpy.typing as npt

from . import _tabor
from .errors import SceneError
from .quantities import refuse_masked, refuse_truths, refuse_unit, unit_of
from .wording import Wording

#: As many as the command line takes.
MOST_THREADS = 1024

#: The greatest whole number that TOML holds.
MOST_WHOLE = 2**63 - 1

Array = npt.NDArray[np.float64]


def field(array: Any, argument: str, dimension: str) -> Array:
    """A two-dimensional array of float64 in C order, every number finite; the array itself where it is one.

    Parameters
    ----------
    array : array of shape (ny, nx)
    argument : str
        Its name, for messages.
    dimension : str
        "length", or "number", of which truth values may be two.
    """
    refuse_masked(array, argument)
    refuse_unit(array, dimension, argument)
    dims = getattr(array, "dims", ())
    if isinstance(dims, tuple) and [str(each).lower() for each in dims] == ["x", "y"]:
        raise SceneError(f'{argument}: its dimensions are (x, y), and rows lie along y; give {argument}.transpose("y", "x")')
    try:
        values = np.asarray(array)
    except ValueError as error:
        raise SceneError(f"{argument}: an array of shape (ny, nx) is expected ({error})") from None
    if values.dtype.kind not in "fiubO":
        raise SceneError(f"{argument}: real numbers are expected, not {values.dtype}")
    if dimension == "length":
        refuse_truths(values, argument)
        # Near 0 its numbers are multiples of 2^-24.
        if values.dtype == np.float16:
            raise SceneError(f"{argument}: float16 has steps of 60 nm and more for lengths in metres; give float32 or float64")
    if values.ndim == 0 and values.dtype.kind == "O":
        raise SceneError(f"{argument}: an array of shape (ny, nx) is expected, not {type(array).__name__}")
    if values.dtype.kind == "O":
        odd = next((each for each in values.flat if isinstance(each, (bool, np.bool_, str, bytes))), None)
        if odd is not None:
            raise SceneError(f"{argument}: real numbers are expected, not {odd!r}")
    try:
        values = np.require(values, np.float64, ["C_CONTIGUOUS", "ALIGNED"])
    except (TypeError, ValueError, OverflowError) as error:
        raise SceneError(f"{argument}: an array of numbers is expected ({error})") from None
    if values.ndim != 2 or values.size == 0:
        raise SceneError(f"{argument}: an array of shape (ny, nx) is expected, not {values.shape}")
    if not np.isfinite(values).all():
        rows, columns = np.nonzero(~np.isfinite(values))
        raise SceneError(f"{argument}: {rows.size} of {values.size} values are not finite, the first at [{rows[0]}, {columns[0]}]; fill them first")
    return values


def thread_count(count: Any, argument: str) -> int:
    """A number of threads, or of what has threads of its own."""
    if isinstance(count, (bool, np.bool_)) or not isinstance(count, (int, np.integer)) or not 1 <= count <= MOST_THREADS:
        raise SceneError(f"{argument}: a count from 1 to {MOST_THREADS} is expected, not {count!r}")
    return int(count)


def plain(value: Any, place: str = "", wording: Wording | None = None) -> Any:
    """A value at a place of a scene as TOML can hold it; tables lose what is None. Messages are told by `wording`."""

    def refuse(words: str) -> SceneError:
        return SceneError(f"{place}: {words}" if wording is None else wording(place, words))

    if isinstance(value, Mapping):
        each = {str(key): below for key, below in value.items() if below is not None}
        return {key: plain(below, f"{place}.{key}" if place else key, wording) for key, below in each.items()}
    if unit := unit_of(value):
        raise refuse(f"it has the unit {unit}; a number in SI units, or a text with its unit, is expected")
    if isinstance(value, np.ndarray):
        value = value.tolist()
    if isinstance(value, (list, tuple)):
        return [plain(each, f"{place}.{index}", wording) for index, each in enumerate(value)]
    if isinstance(value, np.generic):
        value = value.item()
    if isinstance(value, os.PathLike):
        value = os.fspath(value)
    if isinstance(value, float) and not math.isfinite(value):
        raise refuse(f"{value} is no finite number")
    if isinstance(value, int) and not isinstance(value, bool) and not -MOST_WHOLE <= value <= MOST_WHOLE:
        raise refuse(f"{value} is out of range; a whole number is at most 2^63 - 1")
    if isinstance(value, str) and not value.isascii():
        try:
            value.encode()
        except UnicodeEncodeError as error:
            raise refuse(f"this is no text ({error})") from None
    if not isinstance(value, (bool, int, float, str)):
        raise refuse(f"a number, a text, a list or a table is expected, not {type(value).__name__}")
    return value


def toml_text(tables: Mapping[str, Any], wording: Wording | None = None) -> str:
    """Tables as the text of a TOML file; messages are told by `wording`."""
    if not isinstance(tables, Mapping):
        raise SceneError(f"a scene is a mapping of tables, not {type(tables).__name__}; Scene.read reads a file")
    try:
        return _tabor.toml_from_json(json.dumps(plain(tables, wording=wording)))
    except RecursionError as error:
        raise SceneError(f"a scene holds numbers, texts, lists and tables: {error}") from None


def checked_overrides(overrides: Any) -> Mapping[str, Any]:
    """Values by dotted keys."""
    if overrides is None:
        return {}
    if not isinstance(overrides, Mapping) or not all(isinstance(key, str) for key in overrides):
        raise SceneError(f'overrides: values by dotted keys are expected, such as {{"grid.points": 128}}, not {overrides!r}')
    for key, value in overrides.items():
        if "=" in key:
            raise SceneError(f'overrides["{key}"]: a key has no =; give its value behind it, as in {{"grid.points": 128}}')
        if value is None:
            raise SceneError(f'overrides["{key}"]: a value is expected, not None')
    return overrides


def override_words(overrides: Any) -> list[tuple[str, str]]:
    """Values by dotted keys as TOML writes them, so that a text stays a text."""
    return [(key, toml_value(value, f'overrides["{key}"]')) for key, value in checked_overrides(overrides).items()]


def toml_value(value: Any, place: str) -> str:
    """A value at a place of the arguments as TOML writes it behind a key, on one line."""
    try:
        return _tabor.toml_value_from_json(json.dumps(plain(value, place)))
    except RecursionError as error:
        raise SceneError(f"{place}: numbers, texts, lists and tables are expected: {error}") from None
