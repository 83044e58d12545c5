"""Whether a rough surface sticks: Pastewka & Robbins 2014."""

from __future__ import annotations

from ..quantities import Floats, Quantities
from ._evaluate import one


def stickiness_ratio(
    rms_slope: Quantities,
    rms_curvature: Quantities,
    work_of_adhesion: Quantities,
    contact_modulus: Quantities,
    range: Quantities,
    area_coefficient: Quantities = 2.0,
) -> Floats:
    """Repulsion over attraction at the edges of contacts; the surface sticks below 1.

    Parameters
    ----------
    rms_slope : number, text or array
        Root mean square slope.
    rms_curvature : number, text or array
        Root mean square curvature, 1/m.
    work_of_adhesion : number, text or array
        Work of adhesion, J/m^2.
    contact_modulus : number, text or array
        E* of the pair, Pa.
    range : number, text or array
        Range of the attraction, m.
    area_coefficient : number, text or array, optional
        Contact area over load/(E* rms slope).
    """
    return one("pastewka_robbins.stickiness_ratio", locals())
