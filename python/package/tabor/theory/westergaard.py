"""A wave on a half-space: Westergaard 1939, with adhesion Johnson 1995.

The undeformed gap is `amplitude (1 - cos(2 pi x/wavelength))`; contact is over a `half_width` around each crest.
"""

from __future__ import annotations

from ..quantities import Floats, Quantities
from ._evaluate import one, several


def full_contact_pressure(contact_modulus: Quantities, amplitude: Quantities, wavelength: Quantities) -> Floats:
    """Mean pressure of full contact, Pa.

    Parameters
    ----------
    contact_modulus : number, text or array
        E* of the pair, Pa.
    amplitude : number, text or array
        Amplitude of the wave, m.
    wavelength : number, text or array
        Wavelength, m.
    """
    return one("westergaard.full_contact_pressure", locals())


def adhesion_parameter(
    contact_modulus: Quantities,
    amplitude: Quantities,
    wavelength: Quantities,
    work_of_adhesion: Quantities,
) -> Floats:
    """Johnson's adhesion parameter alpha.

    Parameters
    ----------
    contact_modulus : number, text or array
        E* of the pair, Pa.
    amplitude : number, text or array
        Amplitude of the wave, m.
    wavelength : number, text or array
        Wavelength, m.
    work_of_adhesion : number, text or array
        Work of adhesion, J/m^2.
    """
    return one("westergaard.adhesion_parameter", locals())


def half_width(
    contact_modulus: Quantities,
    amplitude: Quantities,
    wavelength: Quantities,
    mean_pressure: Quantities,
) -> Floats:
    """Half width of contact under a mean pressure, m.

    Parameters
    ----------
    contact_modulus : number, text or array
        E* of the pair, Pa.
    amplitude : number, text or array
        Amplitude of the wave, m.
    wavelength : number, text or array
        Wavelength, m.
    mean_pressure : number, text or array
        Mean pressure, Pa.
    """
    return one("westergaard.half_width", locals())


def mean_pressure(
    contact_modulus: Quantities,
    amplitude: Quantities,
    wavelength: Quantities,
    half_width: Quantities,
) -> Floats:
    """Mean pressure at a half width, Pa.

    Parameters
    ----------
    contact_modulus : number, text or array
        E* of the pair, Pa.
    amplitude : number, text or array
        Amplitude of the wave, m.
    wavelength : number, text or array
        Wavelength, m.
    half_width : number, text or array
        Half width of contact, m.
    """
    return one("westergaard.mean_pressure", locals())


def adhesive_mean_pressure(
    contact_modulus: Quantities,
    amplitude: Quantities,
    wavelength: Quantities,
    work_of_adhesion: Quantities,
    half_width: Quantities,
) -> Floats:
    """Mean pressure with adhesion at a half width, Pa.

    Parameters
    ----------
    contact_modulus : number, text or array
        E* of the pair, Pa.
    amplitude : number, text or array
        Amplitude of the wave, m.
    wavelength : number, text or array
        Wavelength, m.
    work_of_adhesion : number, text or array
        Work of adhesion, J/m^2.
    half_width : number, text or array
        Half width of contact, m.
    """
    return one("westergaard.adhesive_mean_pressure", locals())


def pull_off(
    contact_modulus: Quantities,
    amplitude: Quantities,
    wavelength: Quantities,
    work_of_adhesion: Quantities,
) -> tuple[Floats, Floats]:
    """Greatest mean tension, and when the contact is complete.

    Parameters
    ----------
    contact_modulus : number, text or array
        E* of the pair, Pa.
    amplitude : number, text or array
        Amplitude of the wave, m.
    wavelength : number, text or array
        Wavelength, m.
    work_of_adhesion : number, text or array
        Work of adhesion, J/m^2.

    Returns
    -------
    tension : float or array
        Greatest mean tension, Pa, positive.
    closing_pressure : float or array
        Mean pressure beyond which the contact is complete, Pa.
    """
    tension, closing_pressure = several("westergaard.pull_off", locals())
    return tension, closing_pressure


def pressure(
    contact_modulus: Quantities,
    amplitude: Quantities,
    wavelength: Quantities,
    half_width: Quantities,
    x: Quantities,
) -> Floats:
    """Pressure at a distance `x` from a crest, Pa.

    Parameters
    ----------
    contact_modulus : number, text or array
        E* of the pair, Pa.
    amplitude : number, text or array
        Amplitude of the wave, m.
    wavelength : number, text or array
        Wavelength, m.
    half_width : number, text or array
        Half width of contact, m.
    x : number, text or array
        Distance from a crest, m.
    """
    return one("westergaard.pressure", locals())


def gap(
    contact_modulus: Quantities,
    amplitude: Quantities,
    wavelength: Quantities,
    half_width: Quantities,
    x: Quantities,
) -> Floats:
    """Gap at a distance `x` from a crest, m.

    Parameters
    ----------
    contact_modulus : number, text or array
        E* of the pair, Pa.
    amplitude : number, text or array
        Amplitude of the wave, m.
    wavelength : number, text or array
        Wavelength, m.
    half_width : number, text or array
        Half width of contact, m.
    x : number, text or array
        Distance from a crest, m.
    """
    return one("westergaard.gap", locals())


def mean_gap(
    contact_modulus: Quantities,
    amplitude: Quantities,
    wavelength: Quantities,
    mean_pressure: Quantities,
) -> Floats:
    """Mean gap under a mean pressure, m.

    Parameters
    ----------
    contact_modulus : number, text or array
        E* of the pair, Pa.
    amplitude : number, text or array
        Amplitude of the wave, m.
    wavelength : number, text or array
        Wavelength, m.
    mean_pressure : number, text or array
        Mean pressure, Pa.
    """
    return one("westergaard.mean_gap", locals())
