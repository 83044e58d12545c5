"""Surfaces as arrays: made, read, added up, and their statistics."""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, ClassVar, NamedTuple, Union

import numpy as np
import numpy.typing as npt

from . import _tabor
from .errors import SurfaceError, TaborError
from .quantities import Quantity, si
from .scene import Scene, control_at
from .values import field
from .wording import CONTACT, Wording

#: One side of a square, or two sides (x, y).
Size = Union[Quantity, Sequence[Quantity]]
Array = npt.NDArray[np.float64]


class _Part:
    """What every part of a surface that is no file has."""

    #: Its word in a scene.
    kind: ClassVar[str]

    def table(self, side: float | None) -> dict[str, Any]:
        """The keys of ``[[surface]]`` on a cell whose shorter side is `side`, m, if that is known."""
        return {"kind": self.kind, **vars(self)}


@dataclass(frozen=True)
class SelfAffine(_Part):
    """Random roughness with a self-affine spectrum.

    Parameters
    ----------
    hurst : float
        Hurst exponent.
    rms_slope : float, optional
    rms_height : number or text, optional
        One of the two fixes the amplitude.
    longest, rolloff, shortest : numbers or texts
        Wavelengths: the longest, that below which the spectrum falls, and the shortest, m.
    seed : int
        Seed of the phases: the same surface on every grid and machine.
    """

    hurst: float = 0.8
    rms_slope: float | None = None
    rms_height: Quantity | None = None
    longest: Quantity | None = None
    rolloff: Quantity | None = None
    shortest: Quantity | None = None
    seed: int = 1

    kind: ClassVar[str] = "self-affine"

    def table(self, side: float | None) -> dict[str, Any]:
        """The keys of ``[[surface]]`` on a cell whose shorter side is `side`, m, if that is known."""
        longest = side if self.longest is None else self.longest
        rolloff = longest if self.rolloff is None else self.rolloff
        return {**super().table(side), "longest": longest, "rolloff": rolloff}


@dataclass(frozen=True)
class Sphere(_Part):
    """The paraboloid -r^2/(2 radius).

    Parameters
    ----------
    radius : number or text
        Radius of curvature, m.
    centre : (x, y), optional
        Its apex, m; the middle of the cell unless told.
    """

    radius: Quantity
    centre: Sequence[Quantity] | None = None

    kind: ClassVar[str] = "sphere"


@dataclass(frozen=True)
class Cone(_Part):
    """A cone.

    Parameters
    ----------
    half_angle : number or text
        Angle between axis and flank, rad, or with a unit such as "70 deg".
    centre : (x, y), optional
        Its apex, m; the middle of the cell unless told.
    """

    half_angle: Quantity
    centre: Sequence[Quantity] | None = None

    kind: ClassVar[str] = "cone"

    def table(self, side: float | None) -> dict[str, Any]:
        """The keys of ``[[surface]]``, in which numbers of an angle are degrees."""
        angle = si(self.half_angle, "angle", "half_angle", SurfaceError)
        if not 0 < angle < np.pi / 2:
            raise SurfaceError(f'half_angle: {self.half_angle!r} is not between 0 and pi/2 rad; a text has its unit, such as "70 deg"')
        return {**super().table(side), "half_angle": f"{angle!r} rad"}


@dataclass(frozen=True)
class Wavy(_Part):
    """The wave amplitude cos(2 pi x/wavelength_x) cos(2 pi y/wavelength_y).

    Parameters
    ----------
    amplitude : number or text
        m.
    wavelength : number or text, or two of them
        Along x and y, m; ``"inf"`` along an axis for none. One alone is that along x.
    """

    amplitude: Quantity
    wavelength: Quantity | Sequence[Quantity]

    kind: ClassVar[str] = "wavy"


@dataclass(frozen=True)
class Flat(_Part):
    """A flat surface."""

    kind: ClassVar[str] = "flat"


class HeightFile:
    """A height map from a file.

    Parameters
    ----------
    path : path
        The file: NumPy, text, grey images, and the formats of instruments that ``docs/surfaces.md`` lists.
    **keys
        Further keys of a ``[[surface]]`` of kind ``"file"``: unit, scale, detrend, fill, crop, outliers, edges, resample,
        profile, black, white.
    """

    def __init__(self, path: str | os.PathLike[str], **keys: Any) -> None:
        self.path = os.fspath(path)
        self.keys = keys

    def table(self, side: float | None) -> dict[str, Any]:
        """The keys of ``[[surface]]``."""
        return {"kind": "file", "path": os.path.abspath(self.path), **self.keys}

    def __repr__(self) -> str:
        return f"HeightFile({self.path!r})"


Part = Union[SelfAffine, Sphere, Cone, Wavy, Flat, HeightFile, Mapping[str, Any]]


class Surface(NamedTuple):
    """Heights and the cell that they lie on."""

    #: m, of shape (ny, nx).
    heights: Array
    #: (lx, ly), m.
    size: tuple[float, float]


def sides(size: Any, argument: str = "size", error: type[TaborError] = SurfaceError) -> list[float]:
    """The sides (lx, ly), m, of a size."""
    each = list(size) if isinstance(size, (list, tuple, np.ndarray)) and np.ndim(size) else [size, size]
    if len(each) != 2:
        raise error(f"{argument}: one length or two are expected, not {len(each)}")
    lengths = [si(side, "length", argument, error) for side in each]
    if min(lengths) <= 0:
        raise error(f"{argument}: must be more than zero")
    return lengths


def counts(points: Any) -> list[int]:
    """The points (nx, ny) of a grid, of one number those of both sides."""
    each = list(points) if isinstance(points, (list, tuple, np.ndarray)) and np.ndim(points) else [points, points]
    if len(each) != 2 or not all(isinstance(side, (int, np.integer)) and not isinstance(side, bool) and side > 0 for side in each):
        raise SurfaceError(f"points: one count or two (nx, ny) are expected, not {points!r}")
    return [int(side) for side in each]


def is_part(parts: Any) -> bool:
    """Whether this is a part of a surface, or a list of parts."""
    if isinstance(parts, (list, tuple)) and parts:
        return all(is_part(part) and not isinstance(part, (list, tuple)) for part in parts)
    return isinstance(parts, (_Part, HeightFile, Mapping))


def tables_of(parts: Any, side: float | None, argument: str) -> list[dict[str, Any]]:
    """The tables ``[[surface]]`` of a part or a list of parts that was given as `argument`."""
    each = parts if isinstance(parts, (list, tuple)) else [parts]
    for part in each:
        if not isinstance(part, (_Part, HeightFile, Mapping)):
            raise SurfaceError(f"{argument}: parts of a surface are expected, such as Sphere(\"1 um\"), not {part!r}")
        if isinstance(part, Mapping) and "kind" not in part:
            words = 'a mapping is a part of a surface and has a kind, such as {"kind": "sphere", "radius": "1 um"}'
            raise SurfaceError(f"{argument}: {words}, not {', '.join(map(str, part)) or 'nothing'}")
    return [dict(part) if isinstance(part, Mapping) else part.table(side) for part in each]


def names_of(parts: Any, argument: str) -> dict[str, str]:
    """What messages call the tables of a part or a list of parts that was given as `argument`."""
    names = {"surface": argument}
    if isinstance(parts, (list, tuple)):
        return names | {f"surface.{index}": f"{argument}[{index}]{'' if isinstance(part, Mapping) else '.'}" for index, part in enumerate(parts)}
    return names | {"surface.0": argument if isinstance(parts, Mapping) else f"{type(parts).__name__}."}


def _scene(parts: Any, grid: dict[str, Any], side: float | None, threads: int | None, names: Mapping[str, str]) -> Scene:
    scene = Scene.__new__(Scene)
    # What is no surface is not read: the modulus and the load stand for any.
    tables = {
        "grid": grid,
        "solid": {"contact_modulus": 1.0},
        "surface": tables_of(parts, side, "parts"),
        "loading": {"control": control_at(grid.get("boundary")), "path": [0.0]},
    }
    scene._of_tables(tables, Wording({**CONTACT, **names}), threads=threads)
    return scene


def heights(
    parts: Part | Sequence[Part],
    points: int | tuple[int, int],
    size: Size,
    *,
    boundary: str = "periodic",
    threads: int | None = None,
) -> Array:
    """The sum of the heights of parts, m, of shape (ny, nx).

    Parameters
    ----------
    parts : SelfAffine, Sphere, Cone, Wavy, Flat, HeightFile or mapping, or a list of them
        A mapping has the keys of ``[[surface]]``.
    points : int or (nx, ny)
        Points along x and y, or of each side.
    size : number or text, or two of them
        Lengths of the cell, m.
    boundary : {"periodic", "free"}
        Whether what leaves the cell on one side enters it on the other.

    Examples
    --------
    >>> import tabor
    >>> bumpy = tabor.heights([tabor.Sphere("50 um"), tabor.Wavy("1 nm", "1 um")], (64, 32), ("10 um", "5 um"))
    >>> bumpy.shape
    (32, 64)
    """
    return _heights(parts, points, size, boundary, threads, names_of(parts, "parts"))


def _heights(parts: Any, points: Any, size: Size, boundary: str, threads: int | None, names: Mapping[str, str]) -> Array:
    lengths = sides(size)
    grid = {"points": counts(points), "size": lengths, "boundary": boundary}
    return _scene(parts, grid, min(lengths), threads, names).heights()


def read_heights(path: str | os.PathLike[str], size: Size | None = None, **keys: Any) -> Surface:
    """Heights of a file and the size of its cell.

    Parameters
    ----------
    path : path
        The file.
    size : number or text, or two of them, optional
        Lengths of the cell, where the file does not say them.
    **keys
        As in `HeightFile`.
    """
    grid = {} if size is None else {"size": sides(size)}
    names = {"surface.0": "path", **{f"surface.0.{key}": key for key in ("path", *keys)}}
    found, lengths = _scene(HeightFile(path, **keys), grid, None, None, names).surface()
    return Surface(found, (lengths[0], lengths[1]))


def self_affine(
    points: int | tuple[int, int],
    size: Size,
    *,
    hurst: float = 0.8,
    rms_slope: float | None = None,
    rms_height: Quantity | None = None,
    longest: Quantity | None = None,
    rolloff: Quantity | None = None,
    shortest: Quantity,
    seed: int = 1,
) -> Array:
    """Heights of self-affine roughness, m, of shape (ny, nx).

    Parameters
    ----------
    points : int or (nx, ny)
        Points along x and y, or of each side.
    size : number or text, or two of them
        Lengths of the cell, m.
    hurst : float
        Hurst exponent.
    rms_slope, rms_height : optional
        One of them fixes the amplitude.
    longest, rolloff, shortest : numbers or texts
        Wavelengths, m: the longest (by default the shorter side), that below which the spectrum falls (by default the
        longest), and the shortest.
    seed : int
        Seed of the phases.
    """
    part = SelfAffine(hurst, rms_slope, rms_height, longest, rolloff, shortest, seed)
    names = {"surface.0": "self_affine", **{f"surface.0.{key}": key for key in vars(part)}}
    return _heights(part, points, size, "periodic", None, names)


def _map(array: Any, size: Size | None) -> tuple[Array, list[float]]:
    if isinstance(array, Surface):
        size = array.size if size is None else size
        array = array.heights
    if size is None:
        raise SurfaceError("size: the lengths of the cell are expected")
    return field(array, "heights", "length"), sides(size)


def statistics(heights: Any, size: Size | None = None, *, boundary: str = "periodic") -> dict[str, float]:
    """Statistics of a height map.

    Parameters
    ----------
    heights : array of shape (ny, nx), or a Surface
        m.
    size : number or text, or two of them, optional
        Lengths of the cell, m; a Surface brings its own.
    boundary : {"periodic", "free"}
        Whether the map repeats.

    Returns
    -------
    dict
        mean, lowest, highest, rms_height, mean_deviation, correlation_length, mean_summit_height, mean_summit_radius (m),
        skewness, kurtosis, rms_slope, rms_curvature (1/m), nayak_parameter, summit_density (1/m^2); None for what a flat
        map does not have. The numbers of the summits are those of a Gaussian surface with the spectral moments of the map,
        their radius 1 over their mean curvature.
    """
    values, lengths = _map(heights, size)
    found: dict[str, float] = _tabor.statistics(values, lengths, _periodic(boundary))
    return found


def spectrum(heights: Any, size: Size | None = None, *, boundary: str = "periodic") -> npt.NDArray[np.void]:
    """The power spectral density averaged over rings, long waves first.

    Parameters
    ----------
    heights : array of shape (ny, nx), or a Surface
        m.
    size : number or text, or two of them, optional
        Lengths of the cell, m; a Surface brings its own.
    boundary : {"periodic", "free"}
        Whether the map repeats; if not, its edges are windowed.

    Returns
    -------
    structured array
        wavenumber, 1/m; density, m^4, whose integral over wavevectors is the mean square height; modes, their number.
    """
    values, lengths = _map(heights, size)
    return _table(("wavenumber", "density", "modes"), _tabor.spectrum(values, lengths, _periodic(boundary)))


def scale_dependence(heights: Any, size: Size | None = None, *, boundary: str = "periodic") -> npt.NDArray[np.void]:
    """Slope and curvature of profiles along x over a distance: Sanner et al. 2022.

    Parameters
    ----------
    heights : array of shape (ny, nx), or a Surface
        m.
    size : number or text, or two of them, optional
        Lengths of the cell, m; a Surface brings its own.
    boundary : {"periodic", "free"}
        Whether the map repeats.

    Returns
    -------
    structured array
        distance, m; slope; curvature, 1/m.
    """
    values, lengths = _map(heights, size)
    return _table(("distance", "slope", "curvature"), _tabor.scales(values, lengths, _periodic(boundary)))


def self_affine_like(heights: Any, size: Size | None = None, *, boundary: str = "periodic", seed: int = 1) -> SelfAffine:
    """The self-affine roughness whose spectrum is like that of a height map, as ``tabor surface`` fits it.

    Parameters
    ----------
    heights : array of shape (ny, nx), or a Surface
        m.
    size : number or text, or two of them, optional
        Lengths of the cell, m; a Surface brings its own.
    boundary : {"periodic", "free"}
        Whether the map repeats; if not, its edges are windowed.
    seed : int
        Seed of the phases.

    Returns
    -------
    SelfAffine
        With the rms height of the map; ``dataclasses.replace`` changes a value.

    Examples
    --------
    >>> import tabor
    >>> rough = tabor.self_affine(128, "4 um", hurst=0.7, rms_height="5 nm", rolloff="1 um", shortest="0.2 um")
    >>> like = tabor.self_affine_like(rough, "4 um")
    >>> round(like.hurst, 1), round(like.rms_height * 1e9, 3)
    (0.7, 5.0)
    """
    values, lengths = _map(heights, size)
    found = _tabor.self_affine_like(values, lengths, _periodic(boundary))
    return SelfAffine(found["hurst"], None, found["rms_height"], found["longest"], found["rolloff"], found["shortest"], seed)


def _periodic(boundary: str) -> bool:
    if not isinstance(boundary, str) or boundary not in ("periodic", "free"):
        raise SurfaceError(f"boundary: {boundary!r} is not one of periodic, free")
    return boundary == "periodic"


def _table(names: tuple[str, ...], columns: Sequence[Array]) -> npt.NDArray[np.void]:
    table = np.empty(len(columns[0]), dtype=[(name, np.float64) for name in names])
    for name, column in zip(names, columns):
        table[name] = column
    return table
