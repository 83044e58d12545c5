"""Displacement of a half-space under a uniform pressure: Love 1929; Johnson 1985, sections 3.3 and 3.4."""

from __future__ import annotations

from ..quantities import Floats, Quantities
from ._evaluate import one


def rectangle(
    contact_modulus: Quantities,
    pressure: Quantities,
    x: Quantities,
    y: Quantities,
    half_side_x: Quantities,
    half_side_y: Quantities,
) -> Floats:
    """Displacement under a pressure on a rectangle, m, positive into the solid.

    Parameters
    ----------
    contact_modulus : number, text or array
        E* of the solid, Pa.
    pressure : number, text or array
        Pressure on the rectangle, Pa.
    x, y : numbers, texts or arrays
        Place from the middle of the rectangle, m.
    half_side_x, half_side_y : numbers, texts or arrays
        Half its sides, m.

    Examples
    --------
    >>> from tabor import theory
    >>> theory.love.rectangle("1 GPa", "1 MPa", ["0 um", "1 um"], 0.0, "0.5 um", "0.5 um")
    array([1.12219970e-09, 3.30421493e-10])
    """
    return one("love.rectangle", locals())


def disc(contact_modulus: Quantities, pressure: Quantities, r: Quantities, radius: Quantities) -> Floats:
    """Displacement under a pressure on a disc, m, positive into the solid.

    Parameters
    ----------
    contact_modulus : number, text or array
        E* of the solid, Pa.
    pressure : number, text or array
        Pressure on the disc, Pa.
    r : number, text or array
        Distance from its middle, m.
    radius : number, text or array
        Radius of the disc, m.
    """
    return one("love.disc", locals())
