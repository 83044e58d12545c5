"""Summits of Gaussian heights, each a JKR contact: Fuller & Tabor 1975. `direction` is "apart" or "together"."""

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
    direction: str = "apart",
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
    direction : str, optional
        Which way the surfaces move: "apart" or "together".
    """
    return one("fuller_tabor.pressure", locals())


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
    return one("fuller_tabor.pull_off", locals())
