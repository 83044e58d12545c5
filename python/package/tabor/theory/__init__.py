"""Closed forms and asperity models, over NumPy arrays.

Every argument is a number in SI units, a text with a unit, or an array; arrays are broadcast against each other, and
the loop over their elements runs in Rust. An element for which a theory has no state, such as a force beyond pull-off in
`maugis_dugdale.at_force`, is NaN. Arguments out of the range of a closed form, such as a force beyond pull-off in
`jkr.contact_radius`, raise a `TheoryError`, which says the range and the element.

>>> from tabor import theory
>>> theory.jkr.pull_off_force("1 um", ["10 mJ/m^2", "50 mJ/m^2"])
array([-4.71238898e-08, -2.35619449e-07])

`table` gives whole curves, as ``tabor theory`` prints them.
"""

from . import (
    bam,
    bradley,
    cohesive_wave,
    cone,
    derjaguin,
    dmt,
    effects,
    flat_punch,
    fuller_tabor,
    gw,
    gw_m,
    hertz,
    icha,
    jkr,
    laws,
    layer,
    lennard_jones_sphere,
    love,
    maugis_dugdale,
    pastewka_robbins,
    persson,
    spectrum,
    westergaard,
)
from .pair import contact_modulus, maugis_parameter, regime, tabor_parameter, work_of_adhesion
from .tables import Table, table

__all__ = [
    "Table",
    "bam",
    "bradley",
    "cohesive_wave",
    "cone",
    "contact_modulus",
    "derjaguin",
    "dmt",
    "effects",
    "flat_punch",
    "fuller_tabor",
    "gw",
    "gw_m",
    "hertz",
    "icha",
    "jkr",
    "laws",
    "layer",
    "lennard_jones_sphere",
    "love",
    "maugis_dugdale",
    "maugis_parameter",
    "pastewka_robbins",
    "persson",
    "regime",
    "spectrum",
    "table",
    "tabor_parameter",
    "westergaard",
    "work_of_adhesion",
]
