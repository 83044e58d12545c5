"""Sphere on an elastic half-space without adhesion: Hertz 1882; Johnson 1985."""

from __future__ import annotations

from ..quantities import Floats, Quantities
from ._evaluate import one


def contact_radius(radius: Quantities, contact_modulus: Quantities, force: Quantities) -> Floats:
    """Contact radius under a force, m.

    Parameters
    ----------
    radius : number, text or array
        Radius of the sphere, m.
    contact_modulus : number, text or array
        E* of the pair, Pa.
    force : number, text or array
        Force, N, positive in compression.
    """
    return one("hertz.contact_radius", locals())


def contact_radius_at_approach(radius: Quantities, contact_modulus: Quantities, approach: Quantities) -> Floats:
    """Contact radius at an approach, m.

    Parameters
    ----------
    radius : number, text or array
        Radius of the sphere, m.
    contact_modulus : number, text or array
        E* of the pair, Pa.
    approach : number, text or array
        Approach, m.
    """
    return one("hertz.contact_radius_at_approach", locals())


def approach(radius: Quantities, contact_modulus: Quantities, contact_radius: Quantities) -> Floats:
    """Approach at a contact radius, m.

    Parameters
    ----------
    radius : number, text or array
        Radius of the sphere, m.
    contact_modulus : number, text or array
        E* of the pair, Pa.
    contact_radius : number, text or array
        Contact radius, m.
    """
    return one("hertz.approach", locals())


def force(radius: Quantities, contact_modulus: Quantities, contact_radius: Quantities) -> Floats:
    """Force at a contact radius, N.

    Parameters
    ----------
    radius : number, text or array
        Radius of the sphere, m.
    contact_modulus : number, text or array
        E* of the pair, Pa.
    contact_radius : number, text or array
        Contact radius, m.
    """
    return one("hertz.force", locals())


def stiffness(radius: Quantities, contact_modulus: Quantities, contact_radius: Quantities) -> Floats:
    """Slope of the force against the approach, N/m.

    Parameters
    ----------
    radius : number, text or array
        Radius of the sphere, m.
    contact_modulus : number, text or array
        E* of the pair, Pa.
    contact_radius : number, text or array
        Contact radius, m.
    """
    return one("hertz.stiffness", locals())


def pressure(radius: Quantities, contact_modulus: Quantities, contact_radius: Quantities, r: Quantities) -> Floats:
    """Pressure at a distance `r` from the axis, Pa; 0 outside the contact.

    Parameters
    ----------
    radius : number, text or array
        Radius of the sphere, m.
    contact_modulus : number, text or array
        E* of the pair, Pa.
    contact_radius : number, text or array
        Contact radius, m.
    r : number, text or array
        Distance from the axis, m.
    """
    return one("hertz.pressure", locals())


def displacement(radius: Quantities, contact_modulus: Quantities, contact_radius: Quantities, r: Quantities) -> Floats:
    """Displacement of the surface at a distance `r` from the axis, m.

    Parameters
    ----------
    radius : number, text or array
        Radius of the sphere, m.
    contact_modulus : number, text or array
        E* of the pair, Pa.
    contact_radius : number, text or array
        Contact radius, m.
    r : number, text or array
        Distance from the axis, m.
    """
    return one("hertz.displacement", locals())


def gap(radius: Quantities, contact_modulus: Quantities, contact_radius: Quantities, r: Quantities) -> Floats:
    """Gap at a distance `r` from the axis, m; 0 in the contact.

    Parameters
    ----------
    radius : number, text or array
        Radius of the sphere, m.
    contact_modulus : number, text or array
        E* of the pair, Pa.
    contact_radius : number, text or array
        Contact radius, m.
    r : number, text or array
        Distance from the axis, m.
    """
    return one("hertz.gap", locals())
