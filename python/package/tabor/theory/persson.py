"""Rough contact from its spectrum: Persson 2001, corrected 2008; gaps by Yang & Persson 2008, Almqvist et al. 2011, adhesion by Persson & Scaraggi 2014.

The spectrum is self-affine: a Hurst exponent and the longest, roll-off and shortest wavelengths. `gamma` is the
elastic energy of partial contact relative to that of full contact.
"""

from __future__ import annotations

from ..quantities import Floats, Quantities
from ._evaluate import one, several


def contact_area_fraction(
    mean_pressure: Quantities,
    contact_modulus: Quantities,
    rms_slope: Quantities,
    gamma: Quantities = 0.5,
) -> Floats:
    """Contact area over nominal area under a mean pressure.

    Parameters
    ----------
    mean_pressure : number, text or array
        Mean pressure, Pa.
    contact_modulus : number, text or array
        E* of the pair, Pa.
    rms_slope : number, text or array
        Root mean square slope.
    gamma : number, text or array, optional
        Elastic energy of partial contact relative to that of full contact.
    """
    return one("persson.contact_area_fraction", locals())


def mean_gap(
    hurst: Quantities,
    longest: Quantities,
    rolloff: Quantities,
    shortest: Quantities,
    rms_height: Quantities,
    contact_modulus: Quantities,
    mean_pressure: Quantities,
    gamma: Quantities = 0.5,
) -> Floats:
    """Mean gap under a mean pressure, m.

    Parameters
    ----------
    hurst : number, text or array
        Hurst exponent.
    longest : number, text or array
        Longest wavelength, m.
    rolloff : number, text or array
        Wavelength at which the spectrum starts to fall, m.
    shortest : number, text or array
        Shortest wavelength, m.
    rms_height : number, text or array
        Root mean square height, m.
    contact_modulus : number, text or array
        E* of the pair, Pa.
    mean_pressure : number, text or array
        Mean pressure, Pa.
    gamma : number, text or array, optional
        Elastic energy of partial contact relative to that of full contact.
    """
    return one("persson.mean_gap", locals())


def pull_off(
    hurst: Quantities,
    longest: Quantities,
    rolloff: Quantities,
    shortest: Quantities,
    rms_height: Quantities,
    contact_modulus: Quantities,
    work_of_adhesion: Quantities,
    range: Quantities,
    gamma: Quantities = 0.5,
    law: str = "lennard-jones",
) -> tuple[Floats, Floats]:
    """Greatest mean tension; NaN where repulsion exceeds the attraction at every load.

    Parameters
    ----------
    hurst : number, text or array
        Hurst exponent.
    longest : number, text or array
        Longest wavelength, m.
    rolloff : number, text or array
        Wavelength at which the spectrum starts to fall, m.
    shortest : number, text or array
        Shortest wavelength, m.
    rms_height : number, text or array
        Root mean square height, m.
    contact_modulus : number, text or array
        E* of the pair, Pa.
    work_of_adhesion : number, text or array
        Work of adhesion, J/m^2.
    range : number, text or array
        Range of the attraction, m.
    gamma : number, text or array, optional
        Elastic energy of partial contact relative to that of full contact.
    law : str, optional
        "lennard-jones", "cubic", "exponential" or "maugis-dugdale".

    Returns
    -------
    tension : float or array
        Greatest mean tension, Pa, positive.
    repulsion : float or array
        Repulsive part of the mean pressure there, Pa.
    """
    tension, repulsion = several("persson.pull_off", locals())
    return tension, repulsion


def attraction(
    hurst: Quantities,
    longest: Quantities,
    rolloff: Quantities,
    shortest: Quantities,
    rms_height: Quantities,
    contact_modulus: Quantities,
    work_of_adhesion: Quantities,
    range: Quantities,
    pressure: Quantities,
    gamma: Quantities = 0.5,
    law: str = "lennard-jones",
) -> Floats:
    """Mean attraction over the gaps under a repulsive pressure, Pa, positive.

    Parameters
    ----------
    hurst : number, text or array
        Hurst exponent.
    longest : number, text or array
        Longest wavelength, m.
    rolloff : number, text or array
        Wavelength at which the spectrum starts to fall, m.
    shortest : number, text or array
        Shortest wavelength, m.
    rms_height : number, text or array
        Root mean square height, m.
    contact_modulus : number, text or array
        E* of the pair, Pa.
    work_of_adhesion : number, text or array
        Work of adhesion, J/m^2.
    range : number, text or array
        Range of the attraction, m.
    pressure : number, text or array
        Repulsive part of the mean pressure, Pa.
    gamma : number, text or array, optional
        Elastic energy of partial contact relative to that of full contact.
    law : str, optional
        "lennard-jones", "cubic", "exponential" or "maugis-dugdale".
    """
    return one("persson.attraction", locals())


def repulsive_pressure(
    hurst: Quantities,
    longest: Quantities,
    rolloff: Quantities,
    shortest: Quantities,
    rms_height: Quantities,
    contact_modulus: Quantities,
    work_of_adhesion: Quantities,
    range: Quantities,
    mean_pressure: Quantities,
    gamma: Quantities = 0.5,
    law: str = "lennard-jones",
) -> Floats:
    """Repulsive part of a net mean pressure, on the compressive side of pull-off, Pa.

    Parameters
    ----------
    hurst : number, text or array
        Hurst exponent.
    longest : number, text or array
        Longest wavelength, m.
    rolloff : number, text or array
        Wavelength at which the spectrum starts to fall, m.
    shortest : number, text or array
        Shortest wavelength, m.
    rms_height : number, text or array
        Root mean square height, m.
    contact_modulus : number, text or array
        E* of the pair, Pa.
    work_of_adhesion : number, text or array
        Work of adhesion, J/m^2.
    range : number, text or array
        Range of the attraction, m.
    mean_pressure : number, text or array
        Net mean pressure, Pa.
    gamma : number, text or array, optional
        Elastic energy of partial contact relative to that of full contact.
    law : str, optional
        "lennard-jones", "cubic", "exponential" or "maugis-dugdale".
    """
    return one("persson.repulsive_pressure", locals())
