"""Rigid flat circular punch on an elastic half-space: Sneddon 1965."""

from __future__ import annotations

from ..quantities import Floats, Quantities
from ._evaluate import one


def force(radius: Quantities, contact_modulus: Quantities, approach: Quantities) -> Floats:
    """Force at an approach, N.

    Parameters
    ----------
    radius : number, text or array
        Radius of the punch, m.
    contact_modulus : number, text or array
        E* of the pair, Pa.
    approach : number, text or array
        Approach, m.
    """
    return one("flat_punch.force", locals())
