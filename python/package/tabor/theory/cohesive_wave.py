"""Line wave with a constant tension over a range: Johnson's adhesive wave at a finite range.

The undeformed gap is amplitude (1 - cos(2 pi x/wavelength)). NaN where there is no such contact; too much adhesion, which
closes the wave without load, is refused.
"""

from __future__ import annotations

from typing import NamedTuple

from ..quantities import Floats, Quantities
from ._evaluate import several


class State(NamedTuple):
    """A contact of the wave."""

    #: Pa, positive in compression.
    mean_pressure: Floats
    #: Of the contact, m.
    half_width: Floats
    #: Of contact and cohesive zone, m; half the wavelength where the tension acts everywhere.
    cohesive_half_width: Floats


def at_half_width(
    contact_modulus: Quantities,
    amplitude: Quantities,
    wavelength: Quantities,
    work_of_adhesion: Quantities,
    range: Quantities,
    half_width: Quantities,
) -> State:
    """The contact of a half width.

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
    range : number, text or array
        Gap up to which the tension acts, m.
    half_width : number, text or array
        Half width of contact, m, below half the wavelength.

    Examples
    --------
    >>> from tabor import theory
    >>> state = theory.cohesive_wave.at_half_width("1 GPa", "10 nm", "1 um", "5 mJ/m^2", "1 nm", ["0.1 um", "0.2 um"])
    >>> state.mean_pressure.round(-3)
    array([2049000., 9494000.])
    """
    return State(*several("cohesive_wave.at_half_width", locals()))


def pull_off(
    contact_modulus: Quantities,
    amplitude: Quantities,
    wavelength: Quantities,
    work_of_adhesion: Quantities,
    range: Quantities,
) -> State:
    """The contact of the greatest mean tension.

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
    range : number, text or array
        Gap up to which the tension acts, m.
    """
    return State(*several("cohesive_wave.pull_off", locals()))


def closing(
    contact_modulus: Quantities,
    amplitude: Quantities,
    wavelength: Quantities,
    work_of_adhesion: Quantities,
    range: Quantities,
) -> State:
    """The contact of the greatest pressure before it snaps into full contact; NaN where it closes without a snap.

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
    range : number, text or array
        Gap up to which the tension acts, m.
    """
    return State(*several("cohesive_wave.closing", locals()))
