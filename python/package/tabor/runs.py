"""Folders of runs, read back."""

from __future__ import annotations

import json
import os
import re
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

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
        """The content of ``summary.json``: pull-off, jumps, energies, seconds."""
        found: dict[str, Any] = json.loads((self.folder / "summary.json").read_text(encoding="utf-8"))
        return found

    @property
    def curve(self) -> npt.NDArray[np.void]:
        """The rows of ``curve.csv`` as a structured array; an empty cell is NaN."""
        return tables.read(self.folder / "curve.csv")

    def to_frame(self) -> Any:
        """The curve as a `pandas.DataFrame`."""
        import pandas

        return pandas.DataFrame(self.curve)

    @property
    def fields(self) -> list[tuple[int, str]]:
        """Step and name of each field in the folder."""
        found = (re.fullmatch(r"step_(\d+)_(\w+)", path.stem) for path in (self.folder / "fields").glob("step_*.npy"))
        return sorted((int(each[1]), each[2]) for each in found if each)

    def field(self, name: str, step: int | None = None) -> npt.NDArray[Any]:
        """A field of shape (ny, nx), SI, mapped from its file, not read.

        Parameters
        ----------
        name : str
            Such as "pressure"; the scene's ``[output] fields`` names those that are written.
        step : int, optional
            The step; the last one that has the field unless told.
        """
        steps = [number for number, field in self.fields if field == name and step in (None, number)]
        if not steps:
            held = ", ".join(sorted({field for _, field in self.fields})) or "no field"
            raise OutputError(f'{self.folder}: {name} is not there; it holds {held}; [output] fields = ["{name}"] writes it')
        mapped: npt.NDArray[Any] = np.load(self.folder / "fields" / f"step_{steps[-1]:04}_{name}.npy", mmap_mode="r")
        return mapped

    @property
    def images(self) -> list[Path]:
        """Its pictures."""
        return sorted((self.folder / "images").glob("*.png"))

    @property
    def report(self) -> Path:
        """The page with everything, to be opened in a browser."""
        return self.folder / "report.html"

    def plot(self, x: str = "approach", y: str = "force", axes: Any = None) -> Any:
        """Draws one column of the curve over another and returns the axis."""
        from .plots import plot_curve

        return plot_curve(self, x, y, axes)

    def _repr_html_(self) -> str:
        import html

        summary = self.summary
        kept = {name: value for name, value in summary.items() if isinstance(value, (int, float, str)) and not isinstance(value, bool)}
        rows = "".join(f"<tr><th style='text-align:left'>{name.replace('_', ' ')}</th><td>{value}</td></tr>" for name, value in kept.items())
        return f"<table><caption>{html.escape(str(self.folder))}: {len(self.curve)} steps</caption>{rows}</table>"

    def __repr__(self) -> str:
        return f"<Run {self.folder}: {len(self.curve)} steps>"
