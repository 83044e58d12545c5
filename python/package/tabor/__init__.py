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

from ._tabor import __version__

# As type checkers read it; whatever else is asked for by name is imported then.
TYPE_CHECKING = False
if TYPE_CHECKING:
    from . import theory
    from .contact import Contact, Exponential, LennardJones, MaugisDugdale
    from .errors import (
        DeviceError,
        FitError,
        MissingPackageError,
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
        self_affine_like,
        spectrum,
        statistics,
    )

#: Where each name comes from.
_HOMES = {
    "contact": ("Contact", "Exponential", "LennardJones", "MaugisDugdale"),
    "errors": (
        "DeviceError",
        "FitError",
        "MissingPackageError",
        "NotConvergedWarning",
        "NotEnoughMemoryError",
        "OutputError",
        "QuantityError",
        "SceneError",
        "SurfaceError",
        "TaborError",
        "TaborWarning",
        "TheoryError",
    ),
    "fits": ("Estimate", "Fit", "fit"),
    "program": ("devices",),
    "runs": ("Run",),
    "scene": ("Scene",),
    "step": ("Step",),
    "studies": ("Study", "accuracy", "compare", "sweep"),
    "surfaces": (
        "Cone",
        "Flat",
        "HeightFile",
        "SelfAffine",
        "Sphere",
        "Surface",
        "Wavy",
        "heights",
        "read_heights",
        "scale_dependence",
        "self_affine",
        "self_affine_like",
        "spectrum",
        "statistics",
    ),
}

#: Modules that are asked for by their own names.
_MODULES = ("errors", "plots", "theory")

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
    "MissingPackageError",
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
    "self_affine_like",
    "spectrum",
    "statistics",
    "sweep",
    "theory",
]

if not TYPE_CHECKING:

    def __getattr__(name):
        """Imports what is asked for: NumPy and the theories, for one, take longer than all of the rest."""
        from importlib import import_module

        if name in _MODULES:
            return import_module(f".{name}", __name__)
        home = next((home for home, names in _HOMES.items() if name in names), None)
        if home is None:
            raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
        value = globals()[name] = getattr(import_module(f".{home}", __name__), name)
        return value


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__})
