"""Adhesive contact of rough surfaces, solved as a full field.

Heights go in as an array, pressure and gap come out as arrays:

>>> import tabor
>>> heights = tabor.self_affine((64, 64), "20 um", rms_slope=0.12, shortest="2.5 um")
>>> contact = tabor.Contact(heights, "20 um", contact_modulus="100 MPa",
...                         law=tabor.MaugisDugdale("50 mJ/m^2", range="20 nm"))
>>> step = contact.solve(pressure="5 MPa")
>>> step.converged, step.pressure.shape
(True, (64, 64))

Every quantity is a number in SI units or a text with its unit.
"""

from . import theory
from ._tabor import __version__
from .contact import Contact, Exponential, LennardJones, MaugisDugdale
from .errors import (
    DeviceError,
    FitError,
    NotConvergedWarning,
    NotEnoughMemoryError,
    OutputError,
    QuantityError,
    SceneError,
    SurfaceError,
    TaborError,
    TaborWarning,
    TheoryError,
)
from .fits import Estimate, Fit, fit
from .program import devices
from .runs import Run
from .scene import Scene
from .step import Step
from .studies import Study, accuracy, compare, sweep
from .surfaces import (
    Cone,
    Flat,
    HeightFile,
    SelfAffine,
    Sphere,
    Surface,
    Wavy,
    heights,
    read_heights,
    scale_dependence,
    self_affine,
    spectrum,
    statistics,
)

__all__ = [
    "Cone",
    "Contact",
    "DeviceError",
    "Estimate",
    "Exponential",
    "Fit",
    "FitError",
    "Flat",
    "HeightFile",
    "LennardJones",
    "MaugisDugdale",
    "NotConvergedWarning",
    "NotEnoughMemoryError",
    "OutputError",
    "QuantityError",
    "Run",
    "Scene",
    "SceneError",
    "SelfAffine",
    "Sphere",
    "Step",
    "Study",
    "Surface",
    "SurfaceError",
    "TaborError",
    "TaborWarning",
    "TheoryError",
    "Wavy",
    "__version__",
    "accuracy",
    "compare",
    "devices",
    "fit",
    "heights",
    "read_heights",
    "scale_dependence",
    "self_affine",
    "spectrum",
    "statistics",
    "sweep",
    "theory",
]
