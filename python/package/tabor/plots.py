"""Pictures of steps, runs and fits by matplotlib, in the colours of the command line."""

from __future__ import annotations

import warnings
from typing import Any

import numpy as np
import numpy.typing as npt

from . import _tabor
from .optional import package
from .quantities import prefix
from .step import FIELDS

#: Our colour maps in matplotlib: its name and ours.
COLOURS = {"tabor_signed": "signed", "tabor_compression": "compression", "tabor_tension": "tension", "tabor_rising": "rising"}

#: Tension below this share of the largest pressure is rounding.
NEGLIGIBLE = 1e-9

#: Units that take a prefix.
PREFIXED = ("m", "N", "Pa", "s", "J")

#: Share of the picture's width that a scale bar takes at most.
BAR = 0.3


def register_colours() -> None:
    """Makes our colour maps known to matplotlib: ``tabor_signed``, ``tabor_compression``, ``tabor_tension``, ``tabor_rising``."""
    import matplotlib
    from matplotlib.colors import ListedColormap

    for name, ours in COLOURS.items():
        if name not in matplotlib.colormaps:
            colours = np.array(_tabor.colours(ours)) / 255.0
            matplotlib.colormaps.register(ListedColormap(colours, name=name))


def _axes(axes: Any) -> Any:
    pyplot = package("matplotlib.pyplot", "a picture")
    register_colours()
    return pyplot.subplots(constrained_layout=True)[1] if axes is None else axes


def _scale(name: str, values: npt.NDArray[np.float64]) -> tuple[str, Any]:
    """Colour map and norm of a field: zero pressure is always neutral, and each sign has half of the colours."""
    from matplotlib.colors import Normalize, TwoSlopeNorm

    least, greatest = float(values.min()), float(values.max())
    if name != "pressure":
        return "tabor_rising", Normalize(least, greatest)
    tense, compressed = -least > NEGLIGIBLE * greatest, greatest > NEGLIGIBLE * -least
    if tense and compressed:
        return "tabor_signed", TwoSlopeNorm(0.0, least, greatest)
    if tense:
        return "tabor_tension", Normalize(least, 0.0)
    return "tabor_compression", Normalize(0.0, max(greatest, 0.0))


def _bar(axes: Any, side: float) -> None:
    """A scale bar of a round length for a picture that is `side` m wide."""
    from mpl_toolkits.axes_grid1.anchored_artists import AnchoredSizeBar

    longest = BAR * side
    power = 10.0 ** np.floor(np.log10(longest))
    length = max(round_length * power for round_length in (1.0, 2.0, 5.0) if round_length * power <= longest)
    factor, letter = prefix(length)
    bar = AnchoredSizeBar(axes.transData, length, f"{length / factor:.4g} {letter}m", "lower right", pad=0.3, sep=3, frameon=True)
    axes.add_artist(bar)


def plot_field(step: Any, name: str, axes: Any) -> Any:
    """Draws a field of a step on an axis, with its unit and a scale bar."""
    if name not in FIELDS:
        raise ValueError(f"{name} is no field; a step has {', '.join(FIELDS)}")
    axes = _axes(axes)
    values = getattr(step, name)
    factor, letter = prefix(values)
    width, height = step.size
    colours, norm = _scale(name, values / factor)
    picture = axes.imshow(values / factor, origin="lower", extent=(0.0, width, 0.0, height), cmap=colours, norm=norm)
    axes.figure.colorbar(picture, ax=axes, label=f"{name} [{letter}{FIELDS[name]}]")
    _bar(axes, width)
    axes.set_xticks([])
    axes.set_yticks([])
    return axes


def _scaled(values: npt.NDArray[Any], name: str, unit: str) -> tuple[npt.NDArray[Any], str]:
    words = name.replace("_", " ")
    # Powers of compound units have no prefixes.
    if unit not in PREFIXED:
        return values, f"{words} [{unit}]" if unit not in ("", "1") else words
    factor, letter = prefix(values)
    return values / factor, f"{words} [{letter}{unit}]"


def plot_curve(run: Any, x: str, y: str, axes: Any, style: dict[str, Any]) -> Any:
    """Draws one column of a curve over another."""
    curve, units = run.curve, run.units
    for name in (x, y):
        if name not in units:
            raise ValueError(f"{name} is no column of numbers; the curve has {', '.join(units)}")
    axes = _axes(axes)
    before = getattr(axes, "_tabor_curve", None)
    drawn = []
    for place, name in enumerate((x, y)):
        values, label = _scaled(curve[name], name, units[name])
        if before is not None and before[place][0] == name:
            # Beside other curves in their unit.
            _, factor, label = before[place]
            values = curve[name] / factor
        else:
            factor = prefix(curve[name])[0] if units[name] in PREFIXED else 1.0
        drawn.append((name, factor, label, values))
    axes.plot(drawn[0][3], drawn[1][3], **{"marker": ".", **style})
    axes.set_xlabel(drawn[0][2])
    axes.set_ylabel(drawn[1][2])
    axes._tabor_curve = [each[:3] for each in drawn]
    return axes


def plot_fit(fit: Any, axes: Any) -> Any:
    """Draws a force curve and the model that fits it."""
    axes = _axes(axes)
    across, label_x = _scaled(fit.curve["approach"], "approach", "m")
    force, letter = prefix(fit.curve["force"])
    axes.plot(across, fit.curve["force"] / force, ".", markersize=3, label="measured")
    with warnings.catch_warnings():
        # Where the model has no contact its force is NaN.
        warnings.simplefilter("ignore", RuntimeWarning)
        for number, segment in enumerate(dict.fromkeys(fit.curve["segment"])):
            part = fit.curve["segment"] == segment
            label = str(fit.model) if number == 0 else None
            axes.plot(across[part], fit.curve["model_force"][part] / force, "k-", linewidth=1, label=label)
    axes.set_xlabel(label_x)
    axes.set_ylabel(f"force [{letter}N]")
    axes.legend()
    return axes
