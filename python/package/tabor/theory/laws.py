"""The laws of attraction of two facing surfaces, over the gap between them."""

from __future__ import annotations

from ..quantities import Floats, Quantities
from ._evaluate import one


def energy(
    work_of_adhesion: Quantities,
    range: Quantities,
    gap: Quantities,
    law: str = "lennard-jones",
) -> Floats:
    """Energy per area at a gap, J/m^2: minus the work of adhesion at 0, and 0 far away.

    Parameters
    ----------
    work_of_adhesion : number, text or array
        Work of adhesion, J/m^2.
    range : number, text or array
        Range of the attraction, m.
    gap : number, text or array
        Gap, m, from 0 on; of Lennard-Jones from the distance of no force, and above minus the range.
    law : str, optional
        "lennard-jones", "cubic", "exponential" or "maugis-dugdale".
    """
    return one("laws.energy", locals())


def traction(
    work_of_adhesion: Quantities,
    range: Quantities,
    gap: Quantities,
    law: str = "lennard-jones",
) -> Floats:
    """Traction at a gap, Pa; positive attracts.

    Parameters
    ----------
    work_of_adhesion : number, text or array
        Work of adhesion, J/m^2.
    range : number, text or array
        Range of the attraction, m.
    gap : number, text or array
        Gap, m, from 0 on; of Lennard-Jones from the distance of no force, and above minus the range.
    law : str, optional
        "lennard-jones", "cubic", "exponential" or "maugis-dugdale".
    """
    return one("laws.traction", locals())


def slope(
    work_of_adhesion: Quantities,
    range: Quantities,
    gap: Quantities,
    law: str = "lennard-jones",
) -> Floats:
    """Slope of the traction over the gap, Pa/m; 0 on either side of Maugis-Dugdale's end.

    Parameters
    ----------
    work_of_adhesion : number, text or array
        Work of adhesion, J/m^2.
    range : number, text or array
        Range of the attraction, m.
    gap : number, text or array
        Gap, m, from 0 on; of Lennard-Jones from the distance of no force, and above minus the range.
    law : str, optional
        "lennard-jones", "cubic", "exponential" or "maugis-dugdale".
    """
    return one("laws.slope", locals())


def peak_tension(
    work_of_adhesion: Quantities,
    range: Quantities,
    law: str = "lennard-jones",
) -> Floats:
    """Largest tension of a law, Pa.

    Parameters
    ----------
    work_of_adhesion : number, text or array
        Work of adhesion, J/m^2.
    range : number, text or array
        Range of the attraction, m.
    law : str, optional
        "lennard-jones", "cubic", "exponential" or "maugis-dugdale".
    """
    return one("laws.peak_tension", locals())
