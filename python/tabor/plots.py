"""Pictures of steps and runs by matplotlib."""

from __future__ import annotations

from typing import Any

import numpy as np

from .errors import TaborError
from .step import FIELDS

#: Prefixes for axes, largest first.
PREFIXES = ((1e9, "G"), (1e6, "M"), (1e3, "k"), (1.0, ""), (1e-3, "m"), (1e-6, "u"), (1e-9, "n"), (1e-12, "p"), (1e-15, "f"))


def prefix(values: np.ndarray) -> tuple[float, str]:
    """The prefix that makes the largest of the values a short number."""
    finite = np.abs(values[np.isfinite(values)])
    largest = finite.max() if finite.size else 0.0
    return next(((factor, name) for factor, name in PREFIXES if largest >= factor), (1.0, ""))


def _axes(axes: Any) -> Any:
    if axes is not None:
        return axes
    try:
        import matplotlib.pyplot as pyplot
    except ImportError:
        raise TaborError("pictures need matplotlib: pip install 'tabor[plots]'") from None
    return pyplot.subplots()[1]


def plot_field(step: Any, name: str, axes: Any) -> Any:
    """Draws a field of a step on an axis."""
    if name not in FIELDS:
        raise ValueError(f"{name} is no field; a step has {', '.join(FIELDS)}")
    axes = _axes(axes)
    values = getattr(step, name)
    factor, letter = prefix(values)
    side = np.array(step.size)
    length, metres = prefix(side)
    extent = (0.0, side[0] / length, 0.0, side[1] / length)
    picture = axes.imshow(values / factor, origin="lower", extent=extent)
    axes.figure.colorbar(picture, ax=axes, label=f"{name} [{letter}{FIELDS[name]}]")
    axes.set_xlabel(f"x [{metres}m]")
    axes.set_ylabel(f"y [{metres}m]")
    return axes


#: Units of the columns of a curve.
UNITS = {"approach": "m", "mean_gap": "m", "force": "N", "mean_pressure": "Pa", "time": "s", "elastic_energy": "J", "adhesive_energy": "J"}


def plot_curve(run: Any, x: str, y: str, axes: Any) -> Any:
    """Draws one column of a curve over another."""
    curve = run.curve
    for name in (x, y):
        if name not in curve.dtype.names:
            raise ValueError(f"{name} is no column; the curve has {', '.join(curve.dtype.names)}")
    axes = _axes(axes)
    scaled = []
    for name in (x, y):
        unit = UNITS.get(name, "")
        factor, letter = prefix(curve[name]) if unit else (1.0, "")
        scaled.append((curve[name] / factor, f"{name.replace('_', ' ')} [{letter}{unit}]" if unit else name.replace("_", " ")))
    (across, label_x), (up, label_y) = scaled
    axes.plot(across, up, ".-")
    axes.set_xlabel(label_x)
    axes.set_ylabel(label_y)
    return axes
