"""Greenwood & Williamson's summits with the constant attraction of DMT: Maugis 1996."""

from __future__ import annotations

from ..quantities import Floats, Quantities
from ._evaluate import one


def pressure(
    radius: Quantities,
    contact_modulus: Quantities,
    work_of_adhesion: Quantities,
    density: Quantities,
    rms_height: Quantities,
    separation: Quantities,
) -> Floats:
    """Net nominal pressure at a separation, Pa.

    Parameters
    ----------
    radius : number, text or array
        Radius of a summit, m.
    contact_modulus : number, text or array
        E* of the pair, Pa.
    work_of_adhesion : number, text or array
        Work of adhesion, J/m^2.
    density : number, text or array
        Summits per area, 1/m^2.
    rms_height : number, text or array
        Standard deviation of the summits' heights, m.
    separation : number, text or array
        Distance from the mean summit, in standard deviations.
    """
    return one("gw_m.pressure", locals())


def separation(
    radius: Quantities,
    contact_modulus: Quantities,
    work_of_adhesion: Quantities,
    density: Quantities,
    rms_height: Quantities,
    pressure: Quantities,
) -> Floats:
    """Separation at a net nominal pressure, in standard deviations.

    Parameters
    ----------
    radius : number, text or array
        Radius of a summit, m.
    contact_modulus : number, text or array
        E* of the pair, Pa.
    work_of_adhesion : number, text or array
        Work of adhesion, J/m^2.
    density : number, text or array
        Summits per area, 1/m^2.
    rms_height : number, text or array
        Standard deviation of the summits' heights, m.
    pressure : number, text or array
        Net nominal pressure, Pa.
    """
    return one("gw_m.separation", locals())


def pull_off(
    radius: Quantities,
    contact_modulus: Quantities,
    work_of_adhesion: Quantities,
    density: Quantities,
    rms_height: Quantities,
) -> Floats:
    """Greatest nominal tension, Pa.

    Parameters
    ----------
    radius : number, text or array
        Radius of a summit, m.
    contact_modulus : number, text or array
        E* of the pair, Pa.
    work_of_adhesion : number, text or array
        Work of adhesion, J/m^2.
    density : number, text or array
        Summits per area, 1/m^2.
    rms_height : number, text or array
        Standard deviation of the summits' heights, m.
    """
    return one("gw_m.pull_off", locals())
