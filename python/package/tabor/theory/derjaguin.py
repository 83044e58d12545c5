"""Hertz contact with the energy of its area: Derjaguin 1934. Kept for comparison."""

from __future__ import annotations

from ..quantities import Floats, Quantities
from ._evaluate import one


def force(
    radius: Quantities,
    contact_modulus: Quantities,
    work_of_adhesion: Quantities,
    contact_radius: Quantities,
) -> Floats:
    """Force at a contact radius, N.

    Parameters
    ----------
    radius : number, text or array
        Radius of the sphere, m.
    contact_modulus : number, text or array
        E* of the pair, Pa.
    work_of_adhesion : number, text or array
        Work of adhesion, J/m^2.
    contact_radius : number, text or array
        Contact radius, m.
    """
    return one("derjaguin.force", locals())
