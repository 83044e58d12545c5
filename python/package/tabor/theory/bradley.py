"""Rigid adhesive sphere on a rigid flat: Bradley 1932, in Derjaguin's approximation of 1934."""

from __future__ import annotations

from ..quantities import Floats, Quantities
from ._evaluate import one


def force(
    radius: Quantities,
    work_of_adhesion: Quantities,
    range: Quantities,
    gap: Quantities,
    law: str = "lennard-jones",
) -> Floats:
    """Force at the least gap, N; negative attracts.

    Parameters
    ----------
    radius : number, text or array
        Radius of the sphere, m.
    work_of_adhesion : number, text or array
        Work of adhesion, J/m^2.
    range : number, text or array
        Range of the attraction, m.
    gap : number, text or array
        Least gap, m.
    law : str, optional
        "lennard-jones", "cubic", "exponential" or "maugis-dugdale".
    """
    return one("bradley.force", locals())
