"""Scenes: what a scene file says, with arrays where it names files."""

from __future__ import annotations

import json
import os
import warnings
from collections.abc import Iterable, Iterator, Mapping
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from . import _tabor
from .errors import NotConvergedWarning, SceneError, TaborWarning
from .program import call
from .progress import reporter
from .quantities import si
from .runs import Run
from .step import Step

#: What a path may prescribe: the argument, the word of a scene, the dimension.
CONTROLS = {
    "pressure": ("pressure", "pressure"),
    "force": ("force", "force"),
    "approach": ("approach", "length"),
    "mean_gap": ("mean-gap", "length"),
}

Array = npt.NDArray[np.float64]
#: A load: the word of its control, its value, SI, and the seconds that it takes.
Load = tuple[str, float, "float | None"]


def field(array: Any, argument: str) -> Array:
    """A two-dimensional array of float64 in C order, every number finite; the array itself where it is one."""
    if isinstance(array, np.ma.MaskedArray) and np.any(array.mask):
        masked = np.count_nonzero(array.mask)
        raise SceneError(f"{argument}: {masked} of {array.size} values are masked; fill them first")
    values = np.asarray(array)
    if values.dtype.kind == "c":
        raise SceneError(f"{argument}: real numbers are expected, not {values.dtype}")
    try:
        values = np.require(values, np.float64, ["C_CONTIGUOUS", "ALIGNED"])
    except (TypeError, ValueError) as error:
        raise SceneError(f"{argument}: an array of numbers is expected ({error})") from None
    if values.ndim != 2 or values.size == 0:
        raise SceneError(f"{argument}: an array of shape (ny, nx) is expected, not {values.shape}")
    if not np.isfinite(values).all():
        rows, columns = np.nonzero(~np.isfinite(values))
        raise SceneError(f"{argument}: {rows.size} of {values.size} values are not finite, the first at [{rows[0]}, {columns[0]}]; fill them first")
    return values


def plain(value: Any) -> Any:
    """A value as TOML can hold it; tables lose what is None."""
    if isinstance(value, Mapping):
        return {str(key): plain(each) for key, each in value.items() if each is not None}
    if isinstance(value, (list, tuple)):
        return [plain(each) for each in value]
    if isinstance(value, np.ndarray):
        return value.tolist()
    if isinstance(value, np.generic):
        return value.item()
    if isinstance(value, os.PathLike):
        return os.fspath(value)
    return value


def toml_text(tables: Mapping[str, Any]) -> str:
    """Tables as the text of a TOML file."""
    try:
        # TOML knows inf and nan, JSON does not.
        text = json.dumps(plain(tables), allow_nan=False)
    except (TypeError, ValueError) as error:
        raise SceneError(f"a scene holds numbers, texts, lists and tables: {error}") from None
    return _tabor.toml_from_json(text)


class Scene:
    """A scene: tables of keys as a scene file has them, read and checked.

    Parameters
    ----------
    tables : mapping
        The tables of a scene file, such as ``{"grid": {"points": 256, "size": "20 um"}, ...}``.
    heights : array of shape (ny, nx), optional
        Heights in metres, positive towards the solid; the parts of ``[[surface]]`` are added to them. Shared, as in
        `Contact`.
    adhesion_map : array of shape (ny, nx), optional
        A factor on the tension of the law at each point; shared too.
    threads : int, optional
        Threads of the processor; one a core by default. Results do not depend on it.

    Attributes
    ----------
    path_of_file : Path or None
        The file that the scene was read from.
    """

    def __init__(
        self,
        tables: Mapping[str, Any],
        *,
        heights: Any = None,
        adhesion_map: Any = None,
        threads: int | None = None,
    ) -> None:
        self._begin((toml_text(tables), "scene", ".", []), heights, adhesion_map, threads)

    def _begin(
        self,
        source: tuple[str, str, str, list[tuple[str, str]]],
        heights: Any,
        adhesion_map: Any,
        threads: int | None,
        path_of_file: Path | None = None,
    ) -> None:
        if threads is not None and (not isinstance(threads, (int, np.integer)) or threads < 1):
            raise SceneError(f"threads: a count of 1 or more is expected, not {threads!r}")
        self._heights = None if heights is None else field(heights, "heights")
        self._adhesion_map = None if adhesion_map is None else field(adhesion_map, "adhesion_map")
        self._source = source
        self.path_of_file = path_of_file
        self.threads = None if threads is None else int(threads)
        self._loaded = _tabor.LoadedScene(*source, self._heights, self._adhesion_map)

    @classmethod
    def read(
        cls, path: str | os.PathLike[str], overrides: Mapping[str, Any] | None = None, *, threads: int | None = None
    ) -> Scene:
        """Reads a scene file.

        Parameters
        ----------
        path : path
            The TOML file.
        overrides : mapping, optional
            Values in place of the file's, by dotted keys: ``{"grid.points": 128}``.
        threads : int, optional
            Threads of the processor.
        """
        path = Path(path)
        try:
            text = path.read_text(encoding="utf-8")
        except (OSError, UnicodeDecodeError) as error:
            raise SceneError(f"{path}: cannot be read: {error}") from error
        scene = cls.__new__(cls)
        chosen = [
            (key, value if isinstance(value, str) else json.dumps(plain(value))) for key, value in (overrides or {}).items()
        ]
        scene._begin((text, str(path), str(path.parent), chosen), None, None, threads, path)
        return scene

    @property
    def resolved(self) -> dict[str, Any]:
        """The scene with every default filled in, in SI units."""
        resolved: dict[str, Any] = json.loads(self._loaded.resolved_json())
        return resolved

    @property
    def has_arrays(self) -> bool:
        """Whether the scene holds arrays, which no file of it can."""
        return self._heights is not None or self._adhesion_map is not None

    @property
    def is_overridden(self) -> bool:
        """Whether values were given in place of its file's."""
        return bool(self._source[3])

    def to_toml(self) -> str:
        """The text of the scene. Arrays and overrides are not in it."""
        return self._source[0]

    def write(self, path: str | os.PathLike[str]) -> None:
        """Writes the scene to a file, which the command line reads."""
        if self.has_arrays:
            raise SceneError("a file holds no arrays: save the heights by numpy.save and name them as a surface of kind file")
        if self.is_overridden:
            raise SceneError("the values given in place of the file's are not in its text")
        Path(path).write_text(self.to_toml(), encoding="utf-8")

    def check(self) -> str:
        """What ``tabor check`` says: the physics, how well the grid resolves it, memory and cost."""
        if self.has_arrays or self.is_overridden:
            raise SceneError("a check reads its scene from a file, which holds no arrays and no overrides")
        if self.path_of_file is not None:
            return call(["check", os.fspath(self.path_of_file)], quiet=True)
        import tempfile

        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "scene.toml"
            self.write(path)
            return call(["check", os.fspath(path)], quiet=True)

    def surface(self) -> tuple[Array, tuple[float, float]]:
        """The heights of all parts, m, of shape (ny, nx), and the cell's (lx, ly), m."""
        heights, size, said = self._loaded.heights(self.threads)
        _warn(said)
        return heights, size

    def heights(self) -> Array:
        """The heights of all parts, m, of shape (ny, nx)."""
        return self.surface()[0]

    def path(
        self, *, seconds: Iterable[float | str] | None = None, progress: Any = False, **control: Any
    ) -> Iterator[Step]:
        """Solves loads one after another, each from the state of the one before, as the iterator is asked for them.

        Parameters
        ----------
        pressure, force, approach, mean_gap : iterable of numbers or texts
            One of them: the loads, SI or with units. Without one, those of the scene, and with ``until = "apart"``
            further ones behind them, in steps that become finer, until the surfaces are apart.
        seconds : iterable, optional
            The time that each load but the first takes, for effects that depend on time.
        progress : bool or callable, optional
            A bar (by tqdm, if installed), or what is called with finished loads, iteration and residual.

        Yields
        ------
        Step
            A solved load. A path ends after one that did not converge, of which a `NotConvergedWarning` tells.
        """
        loads = self._loads(control, seconds)
        periodic = self.resolved["grid"]["boundary"] == "periodic"
        pulls = not control and self.resolved["loading"].get("until") is not None
        return self._solved(loads, pulls, periodic, progress)

    def _solved(self, loads: Iterator[Load], pulls: bool, periodic: bool, progress: Any) -> Iterator[Step]:
        solver = self._loaded.path(self.threads, pulls)
        while True:
            load = next(loads, None)
            if load is None and not pulls:
                return
            with reporter(progress) as report:
                solved = solver.pull(report) if load is None else solver.solve(*load, report)
            if solved is None:
                return
            found, said = solved
            _warn(said)
            step = Step(found, periodic)
            if not step.converged:
                words = f"a load did not converge: residual {step.residual:.1e} after {step.iterations} iterations"
                warnings.warn(words, NotConvergedWarning, stacklevel=3)
            yield step
            if not step.converged:
                return

    def _loads(self, control: dict[str, Any], seconds: Iterable[float | str] | None) -> Iterator[Load]:
        unknown = [name for name in control if name not in CONTROLS]
        if unknown or len(control) > 1:
            raise TypeError(f"give one of {', '.join(CONTROLS)}, not {', '.join(control)}")
        if not control:
            return iter(self._loaded.loads())
        [(name, values)] = control.items()
        word, dimension = CONTROLS[name]
        if isinstance(values, str) or np.ndim(values) == 0:
            values = [values]
        if seconds is None:
            return ((word, si(value, dimension, name), None) for value in values)
        times: Iterator[float | str] = iter(seconds)

        def timed() -> Iterator[Load]:
            for index, value in enumerate(values):
                try:
                    duration = 0.0 if index == 0 else si(next(times), "time", "seconds")
                except StopIteration:
                    raise SceneError("seconds: one for each load but the first is expected") from None
                yield word, si(value, dimension, name), duration

        return timed()

    def solve(self, *, progress: Any = False, **control: Any) -> Step:
        """Solves one load from the undeformed surfaces: ``contact.solve(force="10 nN")``.

        Parameters
        ----------
        pressure, force, approach, mean_gap : number or text
            One of them: the load, SI or with a unit.
        progress : bool or callable, optional
            As in `path`.
        """
        if not control:
            raise TypeError(f"give one of {', '.join(CONTROLS)}")
        for value in control.values():
            if not isinstance(value, str) and np.ndim(value) != 0:
                raise TypeError("solve takes one load; path takes many")
        return next(iter(self.path(progress=progress, **control)))

    def run(
        self,
        folder: str | os.PathLike[str],
        *,
        resume: bool = False,
        overwrite: bool = True,
        images: bool = True,
        progress: Any = False,
    ) -> Run:
        """Solves every step of the scene into a folder, as the command line does, and opens it.

        Ctrl-C keeps the finished steps, from which ``resume=True`` goes on.

        Parameters
        ----------
        folder : path
            Where the run is written.
        resume : bool
            Whether to go on from the finished steps in the folder.
        overwrite : bool
            Whether an older run in the folder is replaced.
        images : bool
            Whether pictures and the report are written.
        progress : bool or callable, optional
            As in `path`.
        """
        with reporter(progress) as report:
            trouble, said = _tabor.run(self._loaded, os.fspath(folder), resume, overwrite, images, self.threads, report)
        _warn([words for is_warning, words in said if is_warning])
        if trouble is not None:
            warnings.warn(trouble, NotConvergedWarning, stacklevel=2)
        return Run(folder)

    def __reduce__(self) -> Any:
        return _restore, (type(self), self._source, self._heights, self._adhesion_map, self.threads, self.path_of_file)

    def _described(self) -> dict[str, str]:
        """What the scene is, in words."""
        resolved = self.resolved
        grid, solid, adhesion = resolved["grid"], resolved["solid"], resolved.get("adhesion")
        points = grid.get("points")
        words = {
            "grid": "of its file" if points is None else f"{points[0]} x {points[1]} points, {grid['boundary']}",
            "contact modulus": f"{solid['contact_modulus']:.4g} Pa" if "contact_modulus" in solid else "of a layer",
            "adhesion": "none" if adhesion is None else str(adhesion["law"]),
        }
        if grid.get("size") is not None:
            words["size"] = " x ".join(f"{side:.4g} m" for side in grid["size"])
        if adhesion is not None and adhesion.get("work_of_adhesion") is not None:
            words["work of adhesion"] = f"{adhesion['work_of_adhesion']:.4g} J/m^2"
        return words

    def __repr__(self) -> str:
        return f"<{type(self).__name__}: {', '.join(f'{name} {words}' for name, words in self._described().items())}>"

    def _repr_html_(self) -> str:
        rows = "".join(f"<tr><th style='text-align:left'>{name}</th><td>{words}</td></tr>" for name, words in self._described().items())
        return f"<table><caption>{type(self).__name__}</caption>{rows}</table>"


def _restore(cls: type[Scene], source: Any, heights: Any, adhesion_map: Any, threads: int | None, path: Path | None) -> Scene:
    scene = cls.__new__(cls)
    scene._begin(source, heights, adhesion_map, threads, path)
    return scene


def _warn(said: Iterable[str]) -> None:
    for words in said:
        warnings.warn(words, TaborWarning, stacklevel=4)
