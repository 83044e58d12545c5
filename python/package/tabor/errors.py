"""Exceptions and warnings of tabor: what is wrong, where, and how to mend it.

Where is an argument, of a contact and of loads; a key of a scene that was given as tables; a line of a file.
"""


class TaborError(Exception):
    """Anything that tabor refuses or that fails."""


class SceneError(TaborError, ValueError):
    """Values of a scene or of a contact that are out of range or cannot stand together, one a line."""


class QuantityError(TaborError, ValueError):
    """A text that is no number with the unit that is asked for."""


class SurfaceError(TaborError, ValueError):
    """Heights, or a map of adhesion, that cannot be used."""


class TheoryError(TaborError, ValueError):
    """Arguments outside of the range of a theory."""


class FitError(TaborError, ValueError):
    """A force curve that cannot be read or fitted."""


class NotEnoughMemoryError(TaborError, MemoryError):
    """The memory of this machine does not hold what is asked for."""


class DeviceError(TaborError, RuntimeError):
    """The device that is asked for cannot be used, or fails."""


class OutputError(TaborError, OSError):
    """A folder that is not this run's, or files that cannot be written."""


class MissingPackageError(TaborError, ImportError):
    """A package that is installed beside tabor for this, and is not there."""


class TaborWarning(UserWarning):
    """Something of a scene or a solution that its user should know."""


class NotConvergedWarning(TaborWarning):
    """A load whose residual did not reach the tolerance: its fields are those of the last iteration."""
