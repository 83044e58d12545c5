"""Elastic sphere with Lennard-Jones attraction and repulsion: Muller, Yushchenko & Derjaguin 1980; Greenwood 1997; Feng 2001.

Solved numerically, for Tabor parameters from 0.01 to 5. The curve of a sphere takes a fraction of a second at 1, about ten
seconds at 3 and minutes at 5; elements that follow each other with the same Tabor parameter share it, and Ctrl-C ends it.
"""

from __future__ import annotations

from typing import NamedTuple

from ..quantities import Floats, Quantities
from ._evaluate import several


class State(NamedTuple):
    """An equilibrium of the sphere."""

    #: N, positive in compression.
    force: Floats
    #: m, positive closer; at 0 the undeformed apex is where the traction vanishes.
    approach: Floats
    #: Radius at which the traction vanishes, m; 0 where all of it attracts.
    contact_radius: Floats
    #: On the axis, from where the traction vanishes, m; negative under pressure.
    central_gap: Floats


def at_approach(
    radius: Quantities,
    contact_modulus: Quantities,
    work_of_adhesion: Quantities,
    range: Quantities,
    approach: Quantities,
    direction: str = "apart",
) -> State:
    """The equilibrium at an approach.

    Parameters
    ----------
    radius : number, text or array
        Radius of the sphere, m.
    contact_modulus : number, text or array
        E* of the pair, Pa.
    work_of_adhesion : number, text or array
        Work of adhesion, J/m^2.
    range : number, text or array
        Equilibrium distance of the law, m.
    approach : number, text or array
        Approach, m, up to 20 ranges.
    direction : str, optional
        Which way the surfaces move, where that matters: "apart" or "together".

    Examples
    --------
    >>> from tabor import theory
    >>> state = theory.lennard_jones_sphere.at_approach("1 um", "50 GPa", "50 mJ/m^2", "0.3 nm", ["-1 nm", "0 nm"])
    >>> state.contact_radius[0], state.contact_radius[1] > 0
    (np.float64(0.0), np.True_)
    """
    return State(*several("lennard_jones_sphere.at_approach", locals()))


def pull_off(
    radius: Quantities,
    contact_modulus: Quantities,
    work_of_adhesion: Quantities,
    range: Quantities,
) -> State:
    """The equilibrium of the greatest tension.

    Parameters
    ----------
    radius : number, text or array
        Radius of the sphere, m.
    contact_modulus : number, text or array
        E* of the pair, Pa.
    work_of_adhesion : number, text or array
        Work of adhesion, J/m^2.
    range : number, text or array
        Equilibrium distance of the law, m.
    """
    return State(*several("lennard_jones_sphere.pull_off", locals()))
