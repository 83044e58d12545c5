"""Theories over arrays: broadcast here, one loop in Rust."""

from __future__ import annotations

import warnings
from collections.abc import Mapping
from typing import Any

import numpy as np

from .. import _tabor
from ..errors import NotConvergedWarning, TheoryError
from ..quantities import si_array

#: What each argument is, for texts with units.
DIMENSIONS = {
    "amplitude": "length",
    "approach": "length",
    "area_coefficient": "number",
    "branch_modulus": "pressure",
    "conductivity": "conductivity",
    "contact_angle": "angle",
    "contact_modulus": "pressure",
    "contact_radius": "length",
    "counter_conductivity": "conductivity",
    "density": "per area",
    "exponent": "number",
    "force": "force",
    "gamma": "number",
    "gap": "length",
    "half_angle": "angle",
    "half_side_x": "length",
    "half_side_y": "length",
    "half_width": "length",
    "hurst": "number",
    "interface_energy": "energy per area",
    "longest": "length",
    "mean_gap": "length",
    "mean_pressure": "pressure",
    "molar_volume": "molar volume",
    "peak_tension": "pressure",
    "poisson_ratio": "number",
    "poisson_ratio_2": "number",
    "pressure": "pressure",
    "pull_off": "force",
    "r": "length",
    "radius": "length",
    "range": "length",
    "reference_speed": "speed",
    "relative_humidity": "number",
    "relaxation_time": "time",
    "relaxed_modulus": "pressure",
    "rms_curvature": "per length",
    "rms_height": "length",
    "rms_slope": "number",
    "rolloff": "length",
    "separation": "number",
    "shear_strength": "pressure",
    "shortest": "length",
    "slope": "energy per area",
    "speed": "speed",
    "stiffness": "force per length",
    "surface_energy": "energy per area",
    "surface_energy_2": "energy per area",
    "surface_tension": "energy per area",
    "tabor_parameter": "number",
    "temperature": "temperature",
    "time": "time",
    "wavelength": "length",
    "wavenumber": "per length",
    "work_of_adhesion": "energy per area",
    "wavenumber_times_thickness": "number",
    "x": "length",
    "y": "length",
    "young_modulus": "pressure",
    "young_modulus_2": "pressure",
}

#: Arguments that are words.
WORDS = ("direction", "law", "method")


def several(name: str, arguments: Mapping[str, Any]) -> list[Any]:
    """The results of a theory for its arguments, in their order, broadcast against each other."""
    words = [(key, str(value)) for key, value in arguments.items() if key in WORDS]
    values = {key: si_array(value, DIMENSIONS[key], key, TheoryError) for key, value in arguments.items() if key not in WORDS}
    try:
        broadcast = np.broadcast_arrays(*values.values())
    except ValueError:
        shapes = ", ".join(f"{key} {array.shape}" for key, array in values.items() if array.shape)
        raise TheoryError(f"{name}: these shapes do not go together: {shapes}") from None
    shape = broadcast[0].shape
    columns = [np.ascontiguousarray(array, dtype=np.float64).ravel() for array in broadcast]
    found, not_converged = _tabor.theory(name, words, columns)
    if not_converged:
        warnings.warn(f"{name}: {not_converged} of {columns[0].size} did not converge and are NaN", NotConvergedWarning, stacklevel=4)
    # A scalar for scalars, as NumPy's own functions.
    return [each.reshape(shape)[()] for each in found]


def one(name: str, arguments: Mapping[str, Any]) -> Any:
    """The only result of a theory."""
    return several(name, arguments)[0]


