"""Numbers in SI units, or texts with units."""

from __future__ import annotations

from typing import Any, TypeAlias, Union

import numpy as np
import numpy.typing as npt

from . import _tabor
from .errors import QuantityError, SceneError, TaborError

#: A number in SI units, or a text with a unit such as "50 mJ/m^2".
Quantity: TypeAlias = Union[float, str]
#: The same, or an array of them.
Quantities: TypeAlias = Union[Quantity, npt.ArrayLike]
#: A float for scalars, else an array.
Floats: TypeAlias = Any


def si(value: Any, dimension: str, argument: str, error: type[TaborError] = SceneError) -> float:
    """The SI value of a number or of a text with a unit.

    Parameters
    ----------
    value : number or text
    dimension : str
        What it is, such as "length".
    argument : str
        Its name, for messages.
    error : type
        What is raised of a number that is not finite.
    """
    if isinstance(value, str):
        return _quantity(value, dimension, argument, error)
    refuse_unit(value, dimension, argument, error)
    try:
        # Python reads b"1" as a number, and NumPy drops an imaginary part.
        if isinstance(value, (bool, np.bool_, bytes, bytearray, complex, np.complexfloating)):
            raise TypeError
        number = float(value)
    except (TypeError, ValueError, OverflowError):
        raise error(f"{argument}: {value!r} is no number and no text with a unit") from None
    if not np.isfinite(number):
        raise error(f"{argument}: {number} is no finite number")
    return number


def _quantity(text: str, dimension: str, argument: str, error: type[TaborError]) -> float:
    try:
        return _tabor.quantity(text, dimension, argument)
    except UnicodeEncodeError as broken:
        raise error(f"{argument}: this is no text ({broken})") from None


def refuse_masked(values: Any, argument: str, error: type[TaborError] = SceneError) -> None:
    """Refuses an array with masked values: what lies under a mask is no number of anybody's."""
    if isinstance(values, np.ma.MaskedArray) and np.any(values.mask):
        raise error(f"{argument}: {np.count_nonzero(values.mask)} of {values.size} values are masked; fill them first")


def unit_of(values: Any) -> str:
    """The unit that a value or an array carries, as of astropy, pint, unyt and xarray; empty for none."""
    # Others have it of their class: a data frame has an attribute for each of its columns.
    bearer = values if isinstance(values, np.ndarray) else type(values)
    name = next((name for name in ("unit", "units") if hasattr(bearer, name)), None)
    unit = getattr(values, name) if name is not None else getattr(values, "attrs", {}).get("units")
    return "" if unit is None or str(unit) in ("1", "dimensionless") else str(unit)


def refuse_unit(values: Any, dimension: str, argument: str, error: type[TaborError] = SceneError) -> None:
    """Refuses what carries a unit other than that of SI: NumPy drops it."""
    unit = unit_of(values)
    if not unit:
        return
    try:
        is_si = _tabor.quantity(f"1 {unit}", dimension, argument) == 1.0
    except QuantityError:
        is_si = False
    if not is_si:
        raise error(f"{argument}: it has the unit {unit}; plain numbers in SI units are expected")


def refuse_truths(values: npt.NDArray[Any], argument: str, error: type[TaborError] = SceneError) -> None:
    """Refuses truth values: a mask given in place of numbers."""
    if values.dtype.kind == "b":
        raise error(f"{argument}: real numbers are expected, not truth values")


def si_array(values: Any, dimension: str, argument: str, error: type[TaborError] = SceneError) -> npt.NDArray[np.float64]:
    """SI values of a number, a text, or an array or sequence of them."""
    if isinstance(values, str):
        return np.float64(_quantity(values, dimension, argument, error)) * np.ones(())
    refuse_masked(values, argument, error)
    refuse_unit(values, dimension, argument, error)
    array = np.asarray(values)
    if array.dtype.kind in "US" and not isinstance(values, np.ndarray):
        # NumPy makes texts of the numbers beside a text, which then lack a unit.
        array = np.asarray(values, dtype=object)
    if array.dtype.kind in "OUS":
        flat = [si(each, dimension, argument, error) for each in array.ravel().tolist()]
        return np.array(flat, dtype=np.float64).reshape(array.shape)
    refuse_truths(array, argument, error)
    if array.dtype.kind not in "fiu":
        raise error(f"{argument}: real numbers are expected, not {array.dtype}")
    numbers = array.astype(np.float64, copy=False)
    # What may be infinite, such as the modulus of a rigid body, each theory knows.
    if np.isnan(numbers).any():
        raise error(f"{argument}: {np.count_nonzero(np.isnan(numbers))} of {numbers.size} values are NaN")
    return numbers


#: Prefixes of units, largest first.
PREFIXES = ((1e9, "G"), (1e6, "M"), (1e3, "k"), (1.0, ""), (1e-3, "m"), (1e-6, "\N{MICRO SIGN}"), (1e-9, "n"), (1e-12, "p"), (1e-15, "f"))


def prefix(values: npt.ArrayLike) -> tuple[float, str]:
    """The prefix that makes the largest of the values a short number."""
    numbers = np.asarray(values, dtype=float)
    finite = np.abs(numbers[np.isfinite(numbers)])
    largest = finite.max() if finite.size else 0.0
    return next(((factor, name) for factor, name in PREFIXES if largest >= factor), (1.0, ""))


def words(value: float, unit: str, digits: int = 4) -> str:
    """A number with its unit and prefix, such as "70.67 nm"."""
    factor, letter = prefix(value)
    return f"{value / factor:.{digits}g} {letter}{unit}"
