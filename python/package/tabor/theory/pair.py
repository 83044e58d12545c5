"""Moduli and work of adhesion of a pair of bodies, and the numbers that tell which theory of a sphere holds."""

from __future__ import annotations

from typing import Any

import numpy as np

from ..quantities import Floats, Quantities
from ._evaluate import one

#: The theories by the codes of the compiled part.
REGIMES = np.array(["dmt", "intermediate", "jkr"])


def contact_modulus(
    young_modulus: Quantities,
    poisson_ratio: Quantities,
    young_modulus_2: Quantities = float("inf"),
    poisson_ratio_2: Quantities = 0.0,
) -> Floats:
    """Contact modulus E* of two bodies, Pa: 1/E* = (1 - nu1^2)/E1 + (1 - nu2^2)/E2. Johnson 1985.

    Parameters
    ----------
    young_modulus, young_modulus_2 : number, text or array
        Young's moduli, Pa; the second body is rigid unless told.
    poisson_ratio, poisson_ratio_2 : number or array
        Poisson's ratios.
    """
    return one("contact_modulus", locals())


def work_of_adhesion(surface_energy: Quantities, surface_energy_2: Quantities, interface_energy: Quantities) -> Floats:
    """Dupre's work of adhesion, J/m^2: the surface energies less that of the interface.

    Parameters
    ----------
    surface_energy, surface_energy_2, interface_energy : number, text or array
        J/m^2.
    """
    return one("work_of_adhesion", locals())


def tabor_parameter(
    radius: Quantities, contact_modulus: Quantities, work_of_adhesion: Quantities, range: Quantities
) -> Floats:
    """Tabor's number of a sphere, (R w^2/(E*^2 range^3))^(1/3). Tabor 1977.

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
    """
    return one("tabor_parameter", locals())


def maugis_parameter(
    radius: Quantities, contact_modulus: Quantities, work_of_adhesion: Quantities, peak_tension: Quantities
) -> Floats:
    """Maugis' lambda of a sphere with a constant tension. Maugis 1992.

    Parameters
    ----------
    radius : number, text or array
        Radius of the sphere, m.
    contact_modulus : number, text or array
        E* of the pair, Pa.
    work_of_adhesion : number, text or array
        Work of adhesion, J/m^2.
    peak_tension : number, text or array
        Tension of the law, Pa.
    """
    return one("maugis_parameter", locals())


def regime(tabor_parameter: Quantities) -> Any:
    """Which theory of a sphere holds: "dmt", "intermediate" or "jkr". Johnson & Greenwood 1997.

    Parameters
    ----------
    tabor_parameter : number or array
        Tabor's number.
    """
    codes = np.asarray(one("regime", locals()))
    return np.take(REGIMES, codes.astype(int))
