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
from .optional import package
from .step import FIELDS

#: Units of the columns of a curve that have one.
UNITS = {
    "time": "s",
    "position": "m",
    "approach": "m",
    "mean_gap": "m",
    "force": "N",
    "mean_pressure": "Pa",
    "elastic_energy": "J",
    "adhesive_energy": "J",
    "plastic_energy": "J",
    "attractive_force": "N",
    "friction_force": "N",
    "conductance": "W/K",
    "resistance": "ohm",
    "wear_rate": "m^3/m",
    "flow_conductance": "m^3/(s Pa)",
    "critical_constriction": "m",
    "seconds": "s",
}
#: Columns that are no numbers.
TEXTS = ("state", "converged")


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
        path = self.folder / "summary.json"
        try:
            found: dict[str, Any] = json.loads(path.read_text(encoding="utf-8"))
        except FileNotFoundError:
            raise OutputError(f"{path}: is not there; the run has not ended") from None
        return found

    @property
    def curve(self) -> npt.NDArray[np.void]:
        """The rows of ``curve.csv`` as a structured array; an empty cell is NaN."""
        return tables.read(self.folder / "curve.csv")

    @property
    def units(self) -> dict[str, str]:
        """The unit of each column of the curve; a share has the unit 1, a text none."""
        names = [name for name in self.curve.dtype.names or () if name not in TEXTS]
        # A current's conductance has its resistance beside it.
        units = {**UNITS, "conductance": "S"} if "resistance" in names else UNITS
        return {name: units.get(name, "1") for name in names}

    def to_frame(self) -> Any:
        """The curve as a `pandas.DataFrame`."""
        pandas = package("pandas", "a data frame")

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
        if name not in FIELDS:
            raise OutputError(f"{self.folder}: {name} is no field; a run has {', '.join(FIELDS)}")
        having = [number for number, field in self.fields if field == name]
        if not having:
            held = ", ".join(sorted({field for _, field in self.fields})) or "no field"
            raise OutputError(f'{self.folder}: {name} is not there; it holds {held}; [output] fields = ["{name}"] writes it')
        if step is not None and step not in having:
            some = ", ".join(map(str, having[:10])) + (", ..." if len(having) > 10 else "")
            raise OutputError(f"{self.folder}: step {step} has no {name}; steps that have it are {some}")
        number = having[-1] if step is None else int(step)
        mapped: npt.NDArray[Any] = np.load(self.folder / "fields" / f"step_{number:04}_{name}.npy", mmap_mode="r")
        return mapped

    def to_dataset(self) -> Any:
        """Curve and fields with coordinates and units, as an `xarray.Dataset` of the variables that ``tabor netcdf`` writes.

        Fields are over ``field_step``, the steps that have some; they are read, and a step without one of them is NaN.
        """
        xarray = package("xarray", "a dataset")

        curve, units = self.curve, self.units
        data: dict[str, Any] = {
            name: ("step", curve[name], {"units": units[name]} if name in units else {})
            for name in curve.dtype.names or ()
            if name != "step"
        }
        coordinates: dict[str, Any] = {"step": curve["step"]}
        numbers = sorted({number for number, _ in self.fields})
        if numbers:
            lx, ly = self.summary["scene"]["grid"]["size"]
            names = sorted({name for _, name in self.fields})
            ny, nx = self.field(names[0]).shape
            coordinates |= {
                "field_step": numbers,
                "y": ("y", np.arange(ny) * ly / ny, {"units": "m"}),
                "x": ("x", np.arange(nx) * lx / nx, {"units": "m"}),
            }
            for name in names:
                stack = np.full((len(numbers), ny, nx), np.nan, self.field(name).dtype)
                for place, number in enumerate(numbers):
                    if (number, name) in self.fields:
                        stack[place] = self.field(name, number)
                data[name] = (("field_step", "y", "x"), stack, {"units": FIELDS[name]})
        return xarray.Dataset(data, coordinates, {"title": self.summary["scene"].get("title") or ""})

    @property
    def images(self) -> list[Path]:
        """Its pictures."""
        return sorted((self.folder / "images").glob("*.png"))

    @property
    def report(self) -> Path:
        """The page with everything, to be opened in a browser."""
        return self.folder / "report.html"

    def plot(self, x: str = "approach", y: str = "force", axes: Any = None, **style: Any) -> Any:
        """Draws one column of the curve over another on a matplotlib axis and returns the axis.

        Several runs go onto one axis: ``rough.plot(axes=smooth.plot(label="smooth"), label="rough").legend()``.

        Parameters
        ----------
        x, y : str
            Columns of the curve.
        axes : matplotlib axis, optional
            Where it is drawn; a new one unless told. The prefixes of an axis that has curves stay.
        **style
            Further arguments of matplotlib's ``plot``, such as ``label``.
        """
        from .plots import plot_curve

        return plot_curve(self, x, y, axes, style)

    def _repr_html_(self) -> str:
        import html

        try:
            summary = self.summary
        except OutputError:
            summary = {}
        kept = {name: value for name, value in summary.items() if isinstance(value, (int, float, str)) and not isinstance(value, bool)}
        rows = "".join(f"<tr><th style='text-align:left'>{name.replace('_', ' ')}</th><td>{value}</td></tr>" for name, value in kept.items())
        return f"<table><caption>{html.escape(str(self.folder))}: {len(self.curve)} steps</caption>{rows}</table>"

    def __repr__(self) -> str:
        return f"<Run {self.folder}: {len(self.curve)} steps>"
