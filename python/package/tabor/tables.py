"""CSV tables as structured arrays."""

from __future__ import annotations

import csv
import os
from collections.abc import Sequence
from pathlib import Path

import numpy as np
import numpy.typing as npt

from .errors import OutputError


def structured(rows: Sequence[Sequence[str]]) -> npt.NDArray[np.void]:
    """Rows of texts, the head first, as a structured array: counts, numbers, truth values or texts; an empty number is NaN."""
    head, *body = rows
    columns: list[tuple[str, npt.NDArray[np.generic]]] = []
    for index, name in enumerate(head):
        cells = [row[index] for row in body]
        if cells and set(cells) <= {"true", "false"}:
            columns.append((name, np.array([cell == "true" for cell in cells])))
            continue
        if cells and all(cell.isdecimal() for cell in cells):
            columns.append((name, np.array([int(cell) for cell in cells])))
            continue
        try:
            columns.append((name, np.array([float(cell) if cell else np.nan for cell in cells])))
        except ValueError:
            columns.append((name, np.array(cells)))
    table = np.empty(len(body), dtype=[(name, values.dtype) for name, values in columns])
    for name, values in columns:
        table[name] = values
    return table


def read(path: str | os.PathLike[str]) -> npt.NDArray[np.void]:
    """A CSV file with one head."""
    with Path(path).open(newline="", encoding="utf-8") as file:
        rows = [row for row in csv.reader(file) if row and not row[0].startswith("#")]
    if not rows:
        raise OutputError(f"{path}: is empty")
    return structured(rows)
