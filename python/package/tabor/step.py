"""A solved load."""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

from .optional import package
from .quantities import words

#: Fields with their units.
FIELDS = {"pressure": "Pa", "gap": "m", "displacement": "m", "heights": "m"}


class Step:
    """A solved load, in SI units. Fields are arrays of shape (ny, nx).

    Attributes
    ----------
    pressure, gap, displacement, heights : ndarray
        Net normal traction, Pa, positive in compression; distance of the surfaces, m; normal displacement of the
        solid, m, positive into it; heights, m, with the plastic depth subtracted. Without hardness the heights of all steps
        of a path are one array, which cannot be written to.
    contact_area_fraction, force, mean_pressure : float
        Of the whole cell; so are ``approach`` and ``mean_gap``, m, which are None where the surfaces are separated.
    residual, iterations, converged, unreachable
        How well it is solved; `unreachable` is why not, where the iterations are not the reason, and None otherwise. Of a value that no
        contact can have, as a position beyond full contact, the fields are NaN.
    state, jump : str
        "contact", "attracted" or "separated", and "unknown" where no contact has the prescribed value; "in", "off" or None.
    pull_off : (float, float) or None
        Tensions, N, between which the contact let go under a prescribed load or off a spring, if it did up to here on its path.
    columns : dict
        What effects add, by the names of ``curve.csv``.
    """

    def __init__(self, found: dict[str, Any], periodic: bool = True) -> None:
        self._found = found
        self._periodic = periodic

    def __getattr__(self, name: str) -> Any:
        # Asked for before there is anything, when a step is unpickled.
        if name.startswith("_"):
            raise AttributeError(name)
        found = self._found
        if name in found:
            return found[name]
        if name in found["columns"]:
            return found["columns"][name]
        raise AttributeError(f"a step has no {name}; it has {', '.join(sorted([*found, *found['columns']]))}")

    def __dir__(self) -> list[str]:
        return sorted({*super().__dir__(), *self._found, *self._found["columns"]})

    @property
    def contact(self) -> npt.NDArray[np.bool_]:
        """Where the surfaces touch: a gap of 0, or below."""
        touching: npt.NDArray[np.bool_] = self._found["gap"] <= 0.0
        return touching

    @property
    def numbers(self) -> dict[str, Any]:
        """All but the fields: a row of ``pandas.DataFrame(step.numbers for step in path)``."""
        plain = {key: value for key, value in self._found.items() if value is None or isinstance(value, (int, float, str, bool))}
        return {**plain, **self._found["columns"]}

    def to_dataset(self) -> Any:
        """The fields with coordinates and units, and the numbers as attributes, as an `xarray.Dataset`; ``converged`` is 1 or 0."""
        xarray = package("xarray", "a dataset")

        ny, nx = self._found["gap"].shape
        lx, ly = self._found["size"]
        metres = {"units": "m"}
        coordinates = {
            "y": ("y", np.arange(ny) * ly / ny, metres),
            "x": ("x", np.arange(nx) * lx / nx, metres),
        }
        fields = {name: (("y", "x"), self._found[name], {"units": unit}) for name, unit in FIELDS.items()}
        # A file of netCDF has no truth values.
        numbers = {key: int(value) if isinstance(value, bool) else value for key, value in self.numbers.items() if value is not None}
        return xarray.Dataset(fields, coordinates, numbers)

    def to_topography(self, field: str = "gap") -> Any:
        """A field with the unit of a length as a `SurfaceTopography.Topography`."""
        from .topography import to_topography

        if FIELDS.get(field) != "m":
            raise ValueError(f"{field} is no length; {', '.join(name for name, unit in FIELDS.items() if unit == 'm')} are")
        return to_topography(self._found[field], self._found["size"], self._periodic)

    def plot(self, field: str = "pressure", axes: Any = None) -> Any:
        """Draws a field on a matplotlib axis and returns the axis."""
        from .plots import plot_field

        return plot_field(self, field, axes)

    @property
    def _has_no_solution(self) -> bool:
        """Whether no contact has the value that was asked for."""
        return self._found.get("unreachable") is not None and self._found["approach"] is None

    def _described(self) -> dict[str, str]:
        """The main numbers, in words."""
        found = self._found
        described = {
            "state": found["state"],
            "force": words(found["force"], "N", 6),
            "mean pressure": words(found["mean_pressure"], "Pa", 6),
            "contact area": f"{100 * found['contact_area_fraction']:.4g} %",
        }
        for name in ("approach", "mean_gap"):
            if found[name] is not None:
                described[name.replace("_", " ")] = words(found[name], "m", 6)
        described["residual"] = f"{found['residual']:.1e} after {found['iterations']} iterations"
        if self._has_no_solution:
            described["state"] = f"no solution: {found['unreachable']}"
        elif not found["converged"]:
            described["residual"] += ", not converged"
        return described

    def _repr_html_(self) -> str:
        rows = "".join(f"<tr><th style='text-align:left'>{name}</th><td>{each}</td></tr>" for name, each in self._described().items())
        return f"<table><caption>Step {self._found['number']}</caption>{rows}</table>"

    def __repr__(self) -> str:
        found = self._found
        if self._has_no_solution:
            return f"<Step {found['number']}: no solution, {found['unreachable']}>"
        ending = "" if found["converged"] else f", not converged (residual {found['residual']:.1e})"
        return (
            f"<Step {found['number']}: {found['state']}, mean pressure {words(found['mean_pressure'], 'Pa')}, "
            f"{100 * found['contact_area_fraction']:.2f} % in contact{ending}>"
        )
