"""Bearing-area model: Ciavarella 2018, for a Maugis-Dugdale law."""

from __future__ import annotations

from ..quantities import Floats, Quantities
from ._evaluate import one, several


def mean_pressure(
    rms_height: Quantities,
    rolloff: Quantities,
    contact_modulus: Quantities,
    work_of_adhesion: Quantities,
    range: Quantities,
    mean_gap: Quantities,
) -> Floats:
    """Net mean pressure at a mean gap, Pa.

    Parameters
    ----------
    rms_height : number, text or array
        Root mean square height, m.
    rolloff : number, text or array
        Wavelength at which the spectrum starts to fall, m.
    contact_modulus : number, text or array
        E* of the pair, Pa.
    work_of_adhesion : number, text or array
        Work of adhesion, J/m^2.
    range : number, text or array
        Range of the attraction, m.
    mean_gap : number, text or array
        Mean gap, m.
    """
    return one("bam.mean_pressure", locals())


def pull_off(
    rms_height: Quantities,
    rolloff: Quantities,
    contact_modulus: Quantities,
    work_of_adhesion: Quantities,
    range: Quantities,
) -> tuple[Floats, Floats]:
    """Greatest mean tension; NaN where repulsion exceeds the attraction at every gap.

    Parameters
    ----------
    rms_height : number, text or array
        Root mean square height, m.
    rolloff : number, text or array
        Wavelength at which the spectrum starts to fall, m.
    contact_modulus : number, text or array
        E* of the pair, Pa.
    work_of_adhesion : number, text or array
        Work of adhesion, J/m^2.
    range : number, text or array
        Range of the attraction, m.

    Returns
    -------
    tension : float or array
        Greatest mean tension, Pa, positive.
    mean_gap : float or array
        Mean gap there, m.
    """
    tension, mean_gap = several("bam.pull_off", locals())
    return tension, mean_gap


def mean_gap(
    rms_height: Quantities,
    rolloff: Quantities,
    contact_modulus: Quantities,
    work_of_adhesion: Quantities,
    range: Quantities,
    mean_pressure: Quantities,
) -> Floats:
    """Mean gap under a net mean pressure, on the compressive side of pull-off, m.

    Parameters
    ----------
    rms_height : number, text or array
        Root mean square height, m.
    rolloff : number, text or array
        Wavelength at which the spectrum starts to fall, m.
    contact_modulus : number, text or array
        E* of the pair, Pa.
    work_of_adhesion : number, text or array
        Work of adhesion, J/m^2.
    range : number, text or array
        Range of the attraction, m.
    mean_pressure : number, text or array
        Net mean pressure, Pa.
    """
    return one("bam.mean_gap", locals())


def attraction(
    rms_height: Quantities,
    rolloff: Quantities,
    contact_modulus: Quantities,
    work_of_adhesion: Quantities,
    range: Quantities,
    mean_gap: Quantities,
) -> Floats:
    """Attraction at a mean gap, Pa, positive.

    Parameters
    ----------
    rms_height : number, text or array
        Root mean square height, m.
    rolloff : number, text or array
        Wavelength at which the spectrum starts to fall, m.
    contact_modulus : number, text or array
        E* of the pair, Pa.
    work_of_adhesion : number, text or array
        Work of adhesion, J/m^2.
    range : number, text or array
        Range of the attraction, m.
    mean_gap : number, text or array
        Mean gap, m.
    """
    return one("bam.attraction", locals())
