"""Work of adhesion and modulus from force curves."""

from __future__ import annotations

import csv
import io
import json
import os
import warnings
from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from . import _tabor
from .errors import FitError, TaborWarning
from .quantities import Quantity, refuse_unit, si, words
from .tables import structured


#: Fitted numbers with their units.
UNITS = {"work_of_adhesion": "J/m^2", "contact_modulus": "Pa", "range": "m", "peak_tension": "Pa"}


#: Columns of a curve whose numbers are in SI units.
DIMENSIONS = {"approach": "length", "force": "force", "time": "time"}


class Estimate(NamedTuple):
    """A fitted number."""

    #: SI.
    value: float
    #: Standard deviation; None where the curve does not determine it.
    uncertainty: float | None


class Fit:
    """A fitted force curve.

    Attributes
    ----------
    model : str
        The model that was chosen: "hertz", "dmt", "jkr" or "maugis-dugdale".
    work_of_adhesion, contact_modulus, range, peak_tension : Estimate
        J/m^2, Pa, m, Pa.
    tabor_parameter : float
        Tabor's number that follows.
    report : dict
        Everything, as in the command line's ``fit.json``, whose keys are attributes too.
    curve : structured ndarray
        The measured points beside the model: approach, force, model_force, segment, interacting.
    """

    def __init__(self, report: dict[str, Any], curve: npt.NDArray[np.void], headline: str) -> None:
        self.report = report
        self.curve = curve
        self.headline = headline

    def __getattr__(self, name: str) -> Any:
        if name.startswith("_") or "report" not in self.__dict__:
            raise AttributeError(name)
        if name not in self.report:
            raise AttributeError(f"a fit has no {name}; it has {', '.join(sorted(self.report))}")
        value = self.report[name]
        if isinstance(value, dict) and set(value) == {"value", "uncertainty"}:
            return Estimate(**value)
        return value

    def __dir__(self) -> list[str]:
        return sorted({*super().__dir__(), *self.report})

    def plot(self, axes: Any = None) -> Any:
        """Draws the curve and the model on a matplotlib axis and returns the axis."""
        from .plots import plot_fit

        return plot_fit(self, axes)

    def __repr__(self) -> str:
        return f"<Fit: {self.headline}>"

    def _repr_html_(self) -> str:
        import html

        described = {"model": str(self.report["model"])}
        for name, unit in UNITS.items():
            found = self.report.get(name)
            if found is not None:
                doubt = found["uncertainty"]
                share = "" if doubt is None else f" ± {abs(doubt / found['value']):.1%}" if found["value"] else ""
                described[name.replace("_", " ")] = words(found["value"], unit) + share
        if self.report.get("tabor_parameter") is not None:
            described["Tabor parameter"] = f"{self.report['tabor_parameter']:.3g}"
        for number, warning in enumerate(self.report.get("warnings", [])):
            described["warning" if number == 0 else f"warning {number + 1}"] = warning
        rows = "".join(
            f"<tr><th style='text-align:left'>{name}</th><td style='text-align:left'>{html.escape(each)}</td></tr>" for name, each in described.items()
        )
        return f"<table><caption>Fit</caption>{rows}</table>"


def fit(
    curve: Any,
    *,
    radius: Quantity | None = None,
    cone: Quantity | None = None,
    pyramid: Quantity | None = None,
    contact_at_zero: bool = False,
    baseline: bool = False,
    baseline_slope: bool = False,
    columns: Sequence[str] = (),
    sensitivity: Quantity | None = None,
    spring: Quantity | None = None,
    spring_error: Quantity = 0.0,
    radius_error: Quantity = 0.0,
    relaxation: bool = False,
    advise: bool = False,
    range: Quantity | None = None,
) -> Fit:
    """Fits Hertz, DMT, JKR and Maugis-Dugdale to a force curve and chooses one.

    Parameters
    ----------
    curve : path, mapping, DataFrame or structured array, or a tuple or list of two or three arrays
        A file (CSV, or one of an instrument); columns ``approach`` (m, positive closer), ``force`` (N, positive in
        compression) and perhaps ``time`` (s), or what `columns` chooses; or (approach, force) or (approach, force, time).
    radius : number or text, optional
        Radius of the sphere, m.
    cone, pyramid : number or text, optional
        In place of a sphere the angle between axis and flank or face, rad, or with a unit.
    contact_at_zero : bool
        The undeformed surfaces touch at approach 0; else that place is fitted.
    baseline, baseline_slope : bool
        Fit the force where nothing acts, and its slope.
    columns : sequence of texts
        Columns of an instrument, such as ``"position=Z [um]"``.
    sensitivity : number or text, optional
        Deflection per volt, m/V.
    spring : number or text, optional
        Spring constant of the cantilever, N/m.
    spring_error, radius_error : number or text
        Relative standard deviations, such as 0.1 or "10%".
    relaxation : bool
        Fit one relaxation time beside; the curve needs a time.
    advise : bool
        Say in `advice` which model suits, with probabilities learned from full fields; of spheres only.
    range : number or text, optional
        Range of the attraction, m, where it is known.

    Returns
    -------
    Fit

    Examples
    --------
    >>> import numpy as np, tabor
    >>> sphere = tabor.theory.maugis_dugdale.at_force("10 um", "1 GPa", "50 mJ/m^2", "5 MPa", np.linspace(-2.6e-6, 1e-5, 200))
    >>> found = tabor.fit((sphere.approach, sphere.force), radius="10 um", contact_at_zero=True)
    >>> found.model, round(found.work_of_adhesion.value, 4)
    ('maugis-dugdale', 0.05)
    """
    given = [(name, size) for name, size in (("sphere", radius), ("cone", cone), ("pyramid", pyramid)) if size is not None]
    if len(given) != 1:
        raise FitError("give one of radius, cone and pyramid")
    [(tip, size)] = given
    if tip != "sphere" and not 0 < si(size, "angle", tip, FitError) < np.pi / 2:
        raise FitError(f'{tip}: {size!r} is not between 0 and pi/2 rad; a text has its unit, such as "70 deg"')
    if tip != "sphere":
        for name, given_too in (("advise", advise), ("range", range is not None), ("radius_error", radius_error != 0.0)):
            if given_too:
                raise FitError(f"{name}: of spheres only")
    if isinstance(columns, str) or not all(isinstance(each, str) for each in columns):
        raise FitError(f'columns: a list of texts such as ["position=Z [um]"] is expected, not {columns!r}')
    path, text = _curve(curve, relaxation is not False or any(each.strip().startswith("time") for each in columns))
    how = {
        "tip": tip,
        "tip_size": _positive(size, "length" if tip == "sphere" else "angle", "radius" if tip == "sphere" else tip),
        "contact_at_zero": _truth(contact_at_zero, "contact_at_zero"),
        "baseline": _truth(baseline, "baseline"),
        "baseline_slope": _truth(baseline_slope, "baseline_slope"),
        "columns": list(columns),
        "sensitivity": None if sensitivity is None else _positive(sensitivity, "length per voltage", "sensitivity"),
        "spring": None if spring is None else _positive(spring, "force per length", "spring"),
        "spring_error": _share(spring_error, "spring_error"),
        "radius_error": _share(radius_error, "radius_error"),
        "relaxation": _truth(relaxation, "relaxation"),
        "advise": _truth(advise, "advise"),
        "range": None if range is None else _positive(range, "length", "range"),
    }
    report, table, headline, said = _tabor.fit(path, text, how)
    for warning in said:
        warnings.warn(warning, TaborWarning, stacklevel=2)
    found = {**json.loads(report), "warnings": said}
    return Fit(found, structured(list(csv.reader(io.StringIO(table)))), headline)


def _positive(value: Quantity, dimension: str, argument: str) -> float:
    number = si(value, dimension, argument, FitError)
    if number <= 0:
        raise FitError(f"{argument}: {value!r} is not above zero")
    return number


def _truth(value: Any, argument: str) -> bool:
    # A text such as "no" would count as true.
    if not isinstance(value, (bool, np.bool_)):
        raise FitError(f"{argument}: True or False is expected, not {value!r}")
    return bool(value)


def _share(value: Quantity, argument: str) -> float:
    """A share from 0 to 1, as a number or in per cent."""
    return _tabor.share(value if isinstance(value, str) else repr(si(value, "number", argument, FitError)), argument)


def _column(name: str, values: Any) -> npt.NDArray[Any]:
    """The values of a column; what is masked is missing, as NaN."""
    refuse_unit(values, DIMENSIONS.get(name, "number"), name, FitError)
    if isinstance(values, np.ma.MaskedArray) and np.any(values.mask):
        return np.where(values.mask, np.nan, np.asarray(values, dtype=np.float64))
    array = np.asarray(values)
    if name in DIMENSIONS:
        if array.dtype.kind not in "fiuO":
            raise FitError(f"{name}: real numbers are expected, not {array.dtype}")
        if array.dtype.kind == "f" and np.isinf(array).any():
            raise FitError(f"{name}: {np.count_nonzero(np.isinf(array))} of {array.size} values are infinite; what is missing is NaN")
    return array


def _is_no_number(values: Any) -> bool:
    """Whether values are dates, spans of time or texts."""
    dtype = values.dtype if hasattr(values, "dtype") else np.asarray(values).dtype
    return dtype.kind in "mMSU"


def _curve(curve: Any, needs_time: bool) -> tuple[str, str | None]:
    """The path of a curve, or the text of one in memory."""
    if isinstance(curve, (str, os.PathLike)):
        return os.fspath(curve), None
    if isinstance(curve, (tuple, list)):
        if len(curve) not in (2, 3):
            raise FitError(f"curve: (approach, force) or (approach, force, time) is expected, not {len(curve)} arrays")
        table: Mapping[str, Any] = dict(zip(("approach", "force", "time"), curve))
    elif isinstance(curve, np.ndarray) and curve.dtype.names:
        table = {name: curve[name] for name in curve.dtype.names}
    elif isinstance(curve, Mapping):
        table = curve
    elif hasattr(curve, "columns") and hasattr(curve, "__getitem__"):
        table = {str(name): curve[name] for name in curve.columns}
    else:
        raise FitError(f"curve: a file, columns or (approach, force) are expected, not {type(curve).__name__}")
    # Dates in a column that happens to be named so are not asked for; it stays, since columns may be chosen by their numbers.
    arrays = {name: _column("" if name == "time" and not needs_time and _is_no_number(values) else name, values) for name, values in table.items()}
    if len({array.shape for array in arrays.values()}) > 1 or any(array.ndim != 1 for array in arrays.values()):
        shapes = ", ".join(f"{name} {array.shape}" for name, array in arrays.items())
        raise FitError(f"curve: columns of one length are expected, not {shapes}")
    text = io.StringIO()
    # Texts in quotes may hold what separates columns, and begin as comments do.
    writer = csv.writer(text, lineterminator="\n", quoting=csv.QUOTE_NONNUMERIC)
    writer.writerow(_lines(list(arrays)))
    # Python's shortest text of a float reads back as the same number.
    writer.writerows(zip(*(_lines(array.tolist()) if array.dtype.kind in "OU" else array.tolist() for array in arrays.values())))
    return "curve", text.getvalue()


def _lines(cells: list[Any]) -> list[Any]:
    """Cells, each text of them in one line."""
    return [" ".join(each.splitlines()) if isinstance(each, str) else each for each in cells]
