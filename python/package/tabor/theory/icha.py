"""Interacting asperities of a height map, which merge as their contacts meet: Afferrante, Carbone & Demelio 2012.

Each summit of a periodic map is a Hertz contact that the others push down. Valid up to about 30 % of contact.
"""

from __future__ import annotations

import warnings
from typing import Any, NamedTuple

import numpy as np

from .. import _tabor
from ..errors import NotConvergedWarning, TheoryError
from ..quantities import Floats, Quantities, si_array
from ..surfaces import Size, sides
from ..values import field


class Pressed(NamedTuple):
    """Contacts of a surface under a mean pressure."""

    #: Contact area over the cell's.
    contact_area_fraction: Floats
    #: m.
    mean_gap: Floats
    #: How many contacts there are.
    contacts: Floats


def under_pressure(heights: Any, size: Size, contact_modulus: Quantities, mean_pressure: Quantities) -> Pressed:
    """The contacts under a mean pressure, without adhesion.

    Parameters
    ----------
    heights : array of shape (ny, nx)
        Heights of a periodic cell, m, positive towards the solid.
    size : number or text, or two of them
        Lengths of the cell, m.
    contact_modulus : number, text or array
        E* of the pair, Pa.
    mean_pressure : number, text or array
        Mean pressure, Pa, in any order; NaN is returned for those that the model does not reach.

    Examples
    --------
    >>> import tabor
    >>> rough = tabor.self_affine((64, 64), "20 um", rms_slope=0.1, shortest="2.5 um")
    >>> found = tabor.theory.icha.under_pressure(rough, "20 um", "1 GPa", ["1 MPa", "5 MPa"])
    >>> bool(found.contact_area_fraction[0] < found.contact_area_fraction[1] < 0.2)
    True
    """
    area, gap, contacts, _ = _loaded(heights, size, contact_modulus, mean_pressure, 0.0, 1.0, "lennard-jones")
    return Pressed(area, gap, contacts)


def attraction(
    heights: Any,
    size: Size,
    contact_modulus: Quantities,
    mean_pressure: Quantities,
    work_of_adhesion: Quantities,
    range: Quantities,
    law: str = "lennard-jones",
) -> Floats:
    """Mean tension of a law over the gap around these contacts, Pa: the force that DMT add to them.

    Parameters
    ----------
    heights : array of shape (ny, nx)
        Heights of a periodic cell, m, positive towards the solid.
    size : number or text, or two of them
        Lengths of the cell, m.
    contact_modulus : number, text or array
        E* of the pair, Pa.
    mean_pressure : number, text or array
        Mean pressure of the contacts alone, Pa; with the attraction the surfaces carry that much less.
    work_of_adhesion : number, text or array
        Work of adhesion, J/m^2.
    range : number, text or array
        Range of the attraction, m.
    law : str, optional
        "lennard-jones", "cubic", "exponential" or "maugis-dugdale".
    """
    return _loaded(heights, size, contact_modulus, mean_pressure, work_of_adhesion, range, law)[3]


def _loaded(heights: Any, size: Size, modulus: Any, pressure: Any, work: Any, reach: Any, law: str) -> list[Floats]:
    arguments = {
        "contact_modulus": (modulus, "pressure"),
        "mean_pressure": (pressure, "pressure"),
        "work_of_adhesion": (work, "energy per area"),
        "range": (reach, "length"),
    }
    values = {name: si_array(value, dimension, name, TheoryError) for name, (value, dimension) in arguments.items()}
    for name, array in values.items():
        if not (np.isfinite(array) & ((array > 0) | ((array == 0) & (name == "work_of_adhesion")))).all():
            raise TheoryError(f"icha: {name}: must be above zero and finite")
    try:
        moduli, pressures, works, ranges = np.broadcast_arrays(*values.values())
    except ValueError:
        shapes = ", ".join(f"{name} {array.shape}" for name, array in values.items() if array.shape)
        raise TheoryError(f"icha: these shapes do not go together: {shapes}") from None
    loads = [np.ascontiguousarray(column, dtype=np.float64).ravel() for column in (pressures / moduli, works / ranges, ranges)]
    found, missing = _tabor.icha(field(heights, "heights", "length"), sides(size), law, loads)
    if missing:
        warnings.warn(f"icha: {missing} of {loads[0].size} loads are beyond this model and NaN", NotConvergedWarning, stacklevel=4)
    return [column.reshape(pressures.shape)[()] for column in found]
