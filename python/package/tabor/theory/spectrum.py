"""Self-affine roughness in closed form."""

from __future__ import annotations

from typing import NamedTuple

from ..quantities import Floats, Quantities
from ._evaluate import one, several


class Statistics(NamedTuple):
    """Moments of a surface."""

    #: Root mean square slope.
    rms_slope: Floats
    #: Root mean square curvature, 1/m.
    rms_curvature: Floats
    #: Nayak's parameter alpha.
    nayak_parameter: Floats
    #: Summits per area, 1/m^2.
    summit_density: Floats
    #: Radius of curvature of a typical summit, m.
    typical_radius: Floats


def statistics(
    hurst: Quantities,
    longest: Quantities,
    rolloff: Quantities,
    shortest: Quantities,
    rms_height: Quantities,
) -> Statistics:
    """Moments of a self-affine surface.

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
    """
    return Statistics(*several("spectrum.statistics", locals()))


def density(
    hurst: Quantities,
    longest: Quantities,
    rolloff: Quantities,
    shortest: Quantities,
    rms_height: Quantities,
    wavenumber: Quantities,
) -> Floats:
    """Power spectral density at a wave number, m^4; 0 outside of the band.

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
    wavenumber : number, text or array
        Wave number, 1/m.
    """
    return one("spectrum.density", locals())
