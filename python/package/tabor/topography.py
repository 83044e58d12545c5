"""Surfaces of the package SurfaceTopography, in and out.

Its arrays have x first and its lengths a unit; ours have y first and are in metres.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

from .errors import SurfaceError
from .optional import package

#: Metres per unit.
UNITS = {"Gm": 1e9, "Mm": 1e6, "km": 1e3, "m": 1.0, "mm": 1e-3, "µm": 1e-6, "μm": 1e-6, "um": 1e-6, "nm": 1e-9, "Å": 1e-10, "pm": 1e-12, "fm": 1e-15}


def is_topography(surface: Any) -> bool:
    """Whether this is a map of SurfaceTopography."""
    return callable(getattr(surface, "heights", None)) and hasattr(surface, "physical_sizes") and hasattr(surface, "is_periodic")


def from_topography(topography: Any) -> tuple[npt.NDArray[np.float64], tuple[float, float], str]:
    """Heights, m, of shape (ny, nx), sizes (lx, ly), m, and boundary of a `SurfaceTopography.Topography`."""
    if getattr(topography, "dim", 2) != 2:
        raise SurfaceError("heights: a line scan of SurfaceTopography is no map")
    if topography.physical_sizes is None:
        raise SurfaceError("heights: this topography has no physical sizes")
    unit = topography.unit
    if unit is not None and unit not in UNITS:
        raise SurfaceError(f"heights: the unit {unit} of this topography is unknown; to_unit('m') converts it")
    # Without a unit the numbers are taken as they are.
    metres = 1.0 if unit is None else UNITS[unit]
    values = topography.heights()
    if np.any(getattr(values, "mask", False)):
        raise SurfaceError("heights: this topography has undefined points; interpolate_undefined_data() fills them")
    lx, ly = (float(side) * metres for side in topography.physical_sizes)
    heights = np.ascontiguousarray(np.asarray(values, dtype=np.float64).T) * metres
    return heights, (lx, ly), "periodic" if topography.is_periodic else "free"


def to_topography(field: npt.NDArray[np.float64], size: tuple[float, float], periodic: bool) -> Any:
    """A `SurfaceTopography.Topography` of a field, m, of shape (ny, nx)."""
    return package("SurfaceTopography", "a topography").Topography(np.ascontiguousarray(field.T), tuple(size), unit="m", periodic=periodic)
