"""Soft adhesive sphere: Johnson, Kendall & Roberts 1971. Where a force or an approach is given, of two states the stable one."""

from __future__ import annotations

from ..quantities import Floats, Quantities
from ._evaluate import one, several


def contact_radius(
    radius: Quantities,
    contact_modulus: Quantities,
    work_of_adhesion: Quantities,
    force: Quantities,
) -> Floats:
    """Contact radius under a force, m.

    Parameters
    ----------
    radius : number, text or array
        Radius of the sphere, m.
    contact_modulus : number, text or array
        E* of the pair, Pa.
    work_of_adhesion : number, text or array
        Work of adhesion, J/m^2.
    force : number, text or array
        Force, N, positive in compression.
    """
    return one("jkr.contact_radius", locals())


def contact_radius_at_approach(
    radius: Quantities,
    contact_modulus: Quantities,
    work_of_adhesion: Quantities,
    approach: Quantities,
) -> Floats:
    """Contact radius at an approach, m.

    Parameters
    ----------
    radius : number, text or array
        Radius of the sphere, m.
    contact_modulus : number, text or array
        E* of the pair, Pa.
    work_of_adhesion : number, text or array
        Work of adhesion, J/m^2.
    approach : number, text or array
        Approach, m.
    """
    return one("jkr.contact_radius_at_approach", locals())


def approach(
    radius: Quantities,
    contact_modulus: Quantities,
    work_of_adhesion: Quantities,
    contact_radius: Quantities,
) -> Floats:
    """Approach at a contact radius, m.

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
    return one("jkr.approach", locals())


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
    return one("jkr.force", locals())


def stiffness(
    radius: Quantities,
    contact_modulus: Quantities,
    work_of_adhesion: Quantities,
    contact_radius: Quantities,
) -> Floats:
    """Slope of the force against the approach, N/m.

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
    return one("jkr.stiffness", locals())


def pressure(
    radius: Quantities,
    contact_modulus: Quantities,
    work_of_adhesion: Quantities,
    contact_radius: Quantities,
    r: Quantities,
) -> Floats:
    """Pressure at a distance `r` from the axis, Pa; minus infinity at the edge.

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
    r : number, text or array
        Distance from the axis, m.
    """
    return one("jkr.pressure", locals())


def gap(
    radius: Quantities,
    contact_modulus: Quantities,
    work_of_adhesion: Quantities,
    contact_radius: Quantities,
    r: Quantities,
) -> Floats:
    """Gap at a distance `r` from the axis, m; 0 in the contact.

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
    r : number, text or array
        Distance from the axis, m.
    """
    return one("jkr.gap", locals())


def pull_off_force(radius: Quantities, work_of_adhesion: Quantities) -> Floats:
    """Force at pull-off under a prescribed force, N, negative.

    Parameters
    ----------
    radius : number, text or array
        Radius of the sphere, m.
    work_of_adhesion : number, text or array
        Work of adhesion, J/m^2.
    """
    return one("jkr.pull_off_force", locals())


def from_measurement(
    radius: Quantities,
    pull_off: Quantities,
    force: Quantities,
    stiffness: Quantities,
) -> tuple[Floats, Floats]:
    """Work of adhesion and contact modulus from a pull-off force and the stiffness at a force.

    Parameters
    ----------
    radius : number, text or array
        Radius of the sphere, m.
    pull_off : number, text or array
        Magnitude of the pull-off force, N.
    force : number, text or array
        Force, N, positive in compression.
    stiffness : number, text or array
        Slope of force against approach, N/m.

    Returns
    -------
    work_of_adhesion : float or array
        Work of adhesion, J/m^2.
    contact_modulus : float or array
        Contact modulus, Pa.
    """
    work_of_adhesion, contact_modulus = several("jkr.from_measurement", locals())
    return work_of_adhesion, contact_modulus
