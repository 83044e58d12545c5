"""Folders of runs, read back."""

from __future__ import annotations

import json
import os
from pathlib import Path
from typing import Any

import numpy as np

from . import tables
from .errors import OutputError


class Run:
    """A folder that a run wrote: ``Run("rough").curve["force"]``.

    The fields are mapped from their files, not read.
    """

    def __init__(self, folder: str | os.PathLike[str]) -> None:
        self.folder = Path(folder)
        if not (self.folder / "curve.csv").is_file():
            raise OutputError(f"{self.folder}: no folder of a run; it has no curve.csv")

    @property
    def summary(self) -> dict[str, Any]:
        """The content of ``summary.json``."""
        found: dict[str, Any] = json.loads((self.folder / "summary.json").read_text(encoding="utf-8"))
        return found

    @property
    def curve(self) -> np.ndarray:
        """The rows of ``curve.csv`` as a structured array; an empty cell is NaN."""
        return tables.read(self.folder / "curve.csv")

    def to_frame(self) -> Any:
        """The curve as a `pandas.DataFrame`."""
        import pandas

        return pandas.DataFrame(self.curve)

    def fields(self) -> list[Path]:
        """Files of fields, in their order."""
        return sorted(self.folder.rglob("*.npy"))

    def field(self, name: str, step: int | None = None) -> np.ndarray:
        """A field of a step, of the last one that has it unless told, mapped from its file."""
        for path in reversed(self.fields()):
            if name in path.stem and (step is None or f"{step:04}" in path.stem):
                mapped: np.ndarray = np.load(path, mmap_mode="r")
                return mapped
        raise OutputError(f"{self.folder}: holds no {name}; ask for it by [output] fields = [\"{name}\"]")

    def plot(self, x: str = "approach", y: str = "force", axes: Any = None) -> Any:
        """Draws one column of the curve over another and returns the axis."""
        from .plots import plot_curve

        return plot_curve(self, x, y, axes)

    def __repr__(self) -> str:
        return f"<Run {self.folder}: {len(self.curve)} steps>"
