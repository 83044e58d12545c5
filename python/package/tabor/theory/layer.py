"""Elastic layer on a rigid base: its compliance over that of a half-space of the same material, wave by wave."""

from __future__ import annotations

from ..quantities import Floats, Quantities
from ._evaluate import one


def bonded(wavenumber_times_thickness: Quantities, poisson_ratio: Quantities) -> Floats:
    """Compliance of a layer that is bonded to its base, over 2/(E* q).

    Parameters
    ----------
    wavenumber_times_thickness : number or array
        Wave number q of the pressure times the thickness.
    poisson_ratio : number or array
        Poisson's ratio, -1 to 1/2.

    Examples
    --------
    >>> from tabor import theory
    >>> theory.layer.bonded([0.5, 50.0], 0.3).round(6)
    array([0.206642, 1.      ])
    """
    return one("layer.bonded", locals())


def sliding(wavenumber_times_thickness: Quantities) -> Floats:
    """Compliance of a layer that slides on its base without friction, over 2/(E* q).

    Parameters
    ----------
    wavenumber_times_thickness : number or array
        Wave number q of the pressure times the thickness.
    """
    return one("layer.sliding", locals())
