"""Surfaces as arrays."""

from __future__ import annotations

from typing import Any

import numpy as np

from . import _tabor
from .quantities import si
from .scene import Scene, field


def self_affine(
    points: tuple[int, int],
    size: Any,
    *,
    hurst: float = 0.8,
    rms_slope: float | None = None,
    rms_height: float | str | None = None,
    longest: float | str | None = None,
    rolloff: float | str | None = None,
    shortest: float | str,
    seed: int = 1,
) -> np.ndarray:
    """Heights of self-affine roughness, m, of shape (ny, nx).

    Parameters
    ----------
    points : (nx, ny)
        Points along x and y.
    size : number or text, or two of them
        Lengths of the cell.
    hurst : float
        Hurst exponent.
    rms_slope, rms_height : optional
        One of them fixes the amplitude.
    longest, rolloff, shortest : numbers or texts
        Wavelengths: the longest (by default the shorter side), that below which the spectrum falls (by default the
        longest), and the shortest.
    seed : int
        Seed of the phases.
    """
    sides = list(size) if isinstance(size, (list, tuple, np.ndarray)) else [size, size]
    side = min(si(each, "length", "size") for each in sides)
    longest = side if longest is None else longest
    part = {
        "kind": "self-affine",
        "hurst": hurst,
        "rms_slope": rms_slope,
        "rms_height": rms_height,
        "longest": longest,
        "rolloff": longest if rolloff is None else rolloff,
        "shortest": shortest,
        "seed": seed,
    }
    return Scene(
        {
            "grid": {"points": list(points), "size": sides},
            "solid": {"contact_modulus": 1.0},
            "surface": [part],
            "loading": {"control": "pressure", "path": [0.0]},
        }
    ).heights()


def statistics(heights: Any, size: Any, *, boundary: str = "periodic") -> dict[str, float]:
    """Rms height, slope and curvature and more of heights of shape (ny, nx), m."""
    sides = list(size) if isinstance(size, (list, tuple, np.ndarray)) else [size, size]
    lengths = [si(each, "length", "size") for each in sides]
    values = field(heights, "heights").astype(np.float64, copy=False)
    found: dict[str, float] = _tabor.statistics(np.ascontiguousarray(values), lengths, boundary == "periodic")
    return found
