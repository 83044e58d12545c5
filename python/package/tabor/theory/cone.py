"""Cone on an elastic half-space without adhesion: Sneddon 1965. `half_angle` lies between axis and flank, rad or "85 deg"."""

from __future__ import annotations

from ..quantities import Floats, Quantities
from ._evaluate import one


def contact_radius(half_angle: Quantities, contact_modulus: Quantities, force: Quantities) -> Floats:
    """Contact radius under a force, m.

    Parameters
    ----------
    half_angle : number, text or array
        Angle between axis and flank, rad.
    contact_modulus : number, text or array
        E* of the pair, Pa.
    force : number, text or array
        Force, N, positive in compression.
    """
    return one("cone.contact_radius", locals())


def approach(half_angle: Quantities, contact_modulus: Quantities, contact_radius: Quantities) -> Floats:
    """Approach at a contact radius, m.

    Parameters
    ----------
    half_angle : number, text or array
        Angle between axis and flank, rad.
    contact_modulus : number, text or array
        E* of the pair, Pa.
    contact_radius : number, text or array
        Contact radius, m.
    """
    return one("cone.approach", locals())


def force(half_angle: Quantities, contact_modulus: Quantities, contact_radius: Quantities) -> Floats:
    """Force at a contact radius, N.

    Parameters
    ----------
    half_angle : number, text or array
        Angle between axis and flank, rad.
    contact_modulus : number, text or array
        E* of the pair, Pa.
    contact_radius : number, text or array
        Contact radius, m.
    """
    return one("cone.force", locals())


def pressure(half_angle: Quantities, contact_modulus: Quantities, contact_radius: Quantities, r: Quantities) -> Floats:
    """Pressure at a distance `r` from the axis, Pa; infinite at the apex.

    Parameters
    ----------
    half_angle : number, text or array
        Angle between axis and flank, rad.
    contact_modulus : number, text or array
        E* of the pair, Pa.
    contact_radius : number, text or array
        Contact radius, m.
    r : number, text or array
        Distance from the axis, m.
    """
    return one("cone.pressure", locals())


def mean_pressure(
    half_angle: Quantities,
    contact_modulus: Quantities,
) -> Floats:
    """Mean pressure of the contact, Pa, at every load.

    Parameters
    ----------
    half_angle : number, text or array
        Angle between axis and flank, rad.
    contact_modulus : number, text or array
        E* of the pair, Pa.
    """
    return one("cone.mean_pressure", locals())
