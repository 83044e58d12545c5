"""Stiff adhesive sphere: Derjaguin, Muller & Toporov 1975; Muller, Yushchenko & Derjaguin 1983; Maugis 1992.

`method` is "thermodynamic" (DMT-T), "force" (DMT-F) or "constant" (DMT-M).
"""

from __future__ import annotations

from ..quantities import Floats, Quantities
from ._evaluate import one, several


def force(
    radius: Quantities,
    contact_modulus: Quantities,
    work_of_adhesion: Quantities,
    range: Quantities,
    approach: Quantities,
    law: str = "lennard-jones",
    method: str = "thermodynamic",
) -> Floats:
    """Force at an approach, N; at a negative one that of the rigid sphere.

    Parameters
    ----------
    radius : number, text or array
        Radius of the sphere, m.
    contact_modulus : number, text or array
        E* of the pair, Pa.
    work_of_adhesion : number, text or array
        Work of adhesion, J/m^2.
    range : number, text or array
        Range of the attraction, m.
    approach : number, text or array
        Approach, m.
    law : str, optional
        "lennard-jones", "cubic", "exponential" or "maugis-dugdale".
    method : str, optional
        "thermodynamic" (DMT-T), "force" (DMT-F) or "constant" (DMT-M).
    """
    return one("dmt.force", locals())


def pull_off(
    radius: Quantities,
    contact_modulus: Quantities,
    work_of_adhesion: Quantities,
    range: Quantities,
    law: str = "lennard-jones",
    method: str = "thermodynamic",
) -> tuple[Floats, Floats]:
    """The greatest tension.

    Parameters
    ----------
    radius : number, text or array
        Radius of the sphere, m.
    contact_modulus : number, text or array
        E* of the pair, Pa.
    work_of_adhesion : number, text or array
        Work of adhesion, J/m^2.
    range : number, text or array
        Range of the attraction, m.
    law : str, optional
        "lennard-jones", "cubic", "exponential" or "maugis-dugdale".
    method : str, optional
        "thermodynamic" (DMT-T), "force" (DMT-F) or "constant" (DMT-M).

    Returns
    -------
    force : float or array
        Force, N, negative.
    contact_radius : float or array
        Contact radius, m.
    """
    force, contact_radius = several("dmt.pull_off", locals())
    return force, contact_radius
