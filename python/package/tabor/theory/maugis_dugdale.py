"""Adhesive sphere with a constant tension over a range: Maugis 1992. NaN beyond pull-off, where there is no contact."""

from __future__ import annotations

from typing import NamedTuple

from ..quantities import Floats, Quantities
from ._evaluate import one, several


class State(NamedTuple):
    """A contact of the sphere."""

    #: N, positive in compression.
    force: Floats
    #: m, positive closer.
    approach: Floats
    #: m.
    contact_radius: Floats
    #: Outer radius of the cohesive zone, m.
    cohesive_radius: Floats


def at_force(
    radius: Quantities,
    contact_modulus: Quantities,
    work_of_adhesion: Quantities,
    peak_tension: Quantities,
    force: Quantities,
) -> State:
    """The stable contact under a force.

    Parameters
    ----------
    radius : number, text or array
        Radius of the sphere, m.
    contact_modulus : number, text or array
        E* of the pair, Pa.
    work_of_adhesion : number, text or array
        Work of adhesion, J/m^2.
    peak_tension : number, text or array
        Tension of the law, Pa.
    force : number, text or array
        Force, N, positive in compression.
    """
    return State(*several("maugis_dugdale.at_force", locals()))


def at_approach(
    radius: Quantities,
    contact_modulus: Quantities,
    work_of_adhesion: Quantities,
    peak_tension: Quantities,
    approach: Quantities,
) -> State:
    """The stable contact at an approach.

    Parameters
    ----------
    radius : number, text or array
        Radius of the sphere, m.
    contact_modulus : number, text or array
        E* of the pair, Pa.
    work_of_adhesion : number, text or array
        Work of adhesion, J/m^2.
    peak_tension : number, text or array
        Tension of the law, Pa.
    approach : number, text or array
        Approach, m.
    """
    return State(*several("maugis_dugdale.at_approach", locals()))


def pull_off(
    radius: Quantities,
    contact_modulus: Quantities,
    work_of_adhesion: Quantities,
    peak_tension: Quantities,
) -> State:
    """The contact of the greatest tension.

    Parameters
    ----------
    radius : number, text or array
        Radius of the sphere, m.
    contact_modulus : number, text or array
        E* of the pair, Pa.
    work_of_adhesion : number, text or array
        Work of adhesion, J/m^2.
    peak_tension : number, text or array
        Tension of the law, Pa.
    """
    return State(*several("maugis_dugdale.pull_off", locals()))


def pressure(
    radius: Quantities,
    contact_modulus: Quantities,
    work_of_adhesion: Quantities,
    peak_tension: Quantities,
    contact_radius: Quantities,
    r: Quantities,
) -> Floats:
    """Net pressure at a distance `r` from the axis, Pa; minus the tension in the cohesive zone.

    Parameters
    ----------
    radius : number, text or array
        Radius of the sphere, m.
    contact_modulus : number, text or array
        E* of the pair, Pa.
    work_of_adhesion : number, text or array
        Work of adhesion, J/m^2.
    peak_tension : number, text or array
        Tension of the law, Pa.
    contact_radius : number, text or array
        Contact radius, m.
    r : number, text or array
        Distance from the axis, m.
    """
    return one("maugis_dugdale.pressure", locals())


def jump_in(
    radius: Quantities,
    contact_modulus: Quantities,
    work_of_adhesion: Quantities,
    peak_tension: Quantities,
) -> State:
    """The state that an approaching sphere jumps to as it first feels the attraction, at an approach of minus the range.

    Parameters
    ----------
    radius : number, text or array
        Radius of the sphere, m.
    contact_modulus : number, text or array
        E* of the pair, Pa.
    work_of_adhesion : number, text or array
        Work of adhesion, J/m^2.
    peak_tension : number, text or array
        Largest tension, Pa.
    """
    return State(*several("maugis_dugdale.jump_in", locals()))
