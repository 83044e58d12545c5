"""Summits of one radius and Gaussian heights: Greenwood & Williamson 1966. `separation` is in standard deviations above the mean summit."""

from __future__ import annotations

from ..quantities import Floats, Quantities
from ._evaluate import one


def pressure(
    radius: Quantities,
    contact_modulus: Quantities,
    density: Quantities,
    rms_height: Quantities,
    separation: Quantities,
) -> Floats:
    """Nominal pressure at a separation, Pa.

    Parameters
    ----------
    radius : number, text or array
        Radius of a summit, m.
    contact_modulus : number, text or array
        E* of the pair, Pa.
    density : number, text or array
        Summits per area, 1/m^2.
    rms_height : number, text or array
        Standard deviation of the summits' heights, m.
    separation : number, text or array
        Distance from the mean summit, in standard deviations.
    """
    return one("gw.pressure", locals())


def contact_area_fraction(
    radius: Quantities,
    contact_modulus: Quantities,
    density: Quantities,
    rms_height: Quantities,
    separation: Quantities,
) -> Floats:
    """Contact area over nominal area at a separation.

    Parameters
    ----------
    radius : number, text or array
        Radius of a summit, m.
    contact_modulus : number, text or array
        E* of the pair, Pa.
    density : number, text or array
        Summits per area, 1/m^2.
    rms_height : number, text or array
        Standard deviation of the summits' heights, m.
    separation : number, text or array
        Distance from the mean summit, in standard deviations.
    """
    return one("gw.contact_area_fraction", locals())


def contact_density(
    radius: Quantities,
    contact_modulus: Quantities,
    density: Quantities,
    rms_height: Quantities,
    separation: Quantities,
) -> Floats:
    """Contacts per area at a separation, 1/m^2.

    Parameters
    ----------
    radius : number, text or array
        Radius of a summit, m.
    contact_modulus : number, text or array
        E* of the pair, Pa.
    density : number, text or array
        Summits per area, 1/m^2.
    rms_height : number, text or array
        Standard deviation of the summits' heights, m.
    separation : number, text or array
        Distance from the mean summit, in standard deviations.
    """
    return one("gw.contact_density", locals())


def adhesion_parameter(
    radius: Quantities,
    contact_modulus: Quantities,
    work_of_adhesion: Quantities,
    density: Quantities,
    rms_height: Quantities,
) -> Floats:
    """Adhesion parameter of Fuller & Tabor 1975; large for rough surfaces.

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
    return one("gw.adhesion_parameter", locals())
