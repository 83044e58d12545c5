"""Scenes: what a scene file says, with arrays where it names files."""

from __future__ import annotations

import json
import os
import warnings
from collections.abc import Iterable, Iterator, Mapping
from pathlib import Path
from typing import Any

import numpy as np

from . import _tabor
from .errors import NotConvergedWarning, SceneError, TaborWarning
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


def field(array: Any, argument: str) -> np.ndarray:
    """A two-dimensional array of float64 or float32, every number finite."""
    values = np.asarray(array)
    if values.dtype != np.float32:
        try:
            values = values.astype(np.float64, copy=False)
        except (TypeError, ValueError) as error:
            raise SceneError(f"{argument}: an array of numbers is expected ({error})") from None
    if values.ndim != 2 or values.size == 0:
        raise SceneError(f"{argument}: an array of shape (ny, nx) is expected, not {values.shape}")
    if not np.isfinite(values).all():
        rows, columns = np.nonzero(~np.isfinite(values))
        raise SceneError(f"{argument}: {rows.size} of {values.size} values are not finite, the first at [{rows[0]}, {columns[0]}]")
    return values


def _plain(value: Any) -> Any:
    """A value as TOML can hold it; tables lose what is None."""
    if isinstance(value, Mapping):
        return {str(key): _plain(each) for key, each in value.items() if each is not None}
    if isinstance(value, (list, tuple)):
        return [_plain(each) for each in value]
    if isinstance(value, np.ndarray):
        return value.tolist()
    if isinstance(value, np.generic):
        return value.item()
    if isinstance(value, os.PathLike):
        return os.fspath(value)
    return value


class Scene:
    """A scene: tables of keys as a scene file has them, read and checked.

    Parameters
    ----------
    tables : mapping
        The tables of a scene file, such as ``{"grid": {"points": 256, "size": "20 um"}, ...}``.
    heights : array of shape (ny, nx), optional
        Heights in metres, positive towards the solid; the parts of ``[[surface]]`` are added to them.
    adhesion_map : array of shape (ny, nx), optional
        A factor on the tension of the law at each point.
    threads : int, optional
        Threads of the processor; one a core by default. Results do not depend on it.
    """

    def __init__(
        self,
        tables: Mapping[str, Any],
        *,
        heights: Any = None,
        adhesion_map: Any = None,
        threads: int | None = None,
    ) -> None:
        text = _tabor.toml_from_json(json.dumps(_plain(tables)))
        self._begin(text, "scene", ".", [], heights, adhesion_map, threads)

    def _begin(
        self,
        text: str,
        name: str,
        folder: str,
        overrides: list[tuple[str, str]],
        heights: Any = None,
        adhesion_map: Any = None,
        threads: int | None = None,
    ) -> None:
        self._heights = None if heights is None else field(heights, "heights")
        self._adhesion_map = None if adhesion_map is None else field(adhesion_map, "adhesion_map")
        self._source = (text, name, folder, overrides)
        self.threads = threads
        self._loaded = _tabor.LoadedScene(*self._source, self._heights, self._adhesion_map)

    @classmethod
    def read(cls, path: str | os.PathLike[str], overrides: Mapping[str, Any] | None = None, *, threads: int | None = None) -> Scene:
        """Reads a scene file.

        Parameters
        ----------
        path : path
            The TOML file.
        overrides : mapping, optional
            Values in place of the file's, by dotted keys: ``{"grid.points": 128}``.
        """
        path = Path(path)
        try:
            text = path.read_text(encoding="utf-8")
        except (OSError, UnicodeDecodeError) as error:
            raise SceneError(f"{path}: cannot be read: {error}") from error
        scene = cls.__new__(cls)
        chosen = [(key, value if isinstance(value, str) else json.dumps(_plain(value))) for key, value in (overrides or {}).items()]
        scene._begin(text, str(path), str(path.parent), chosen, threads=threads)
        return scene

    @property
    def resolved(self) -> dict[str, Any]:
        """The scene with every default filled in, in SI units."""
        resolved: dict[str, Any] = json.loads(self._loaded.resolved_json())
        return resolved

    def to_toml(self) -> str:
        """The text of the scene. Arrays are not in it."""
        return self._source[0]

    def heights(self) -> np.ndarray:
        """The heights of all parts, m, of shape (ny, nx)."""
        heights, said = self._loaded.heights(self.threads)
        _warn(said)
        return heights

    def path(self, *, seconds: Iterable[float | str] | None = None, progress: Any = False, **control: Any) -> Iterator[Step]:
        """Solves loads one after another, each from the state of the one before, as the iterator is asked for them.

        Parameters
        ----------
        pressure, force, approach, mean_gap : iterable of numbers or texts
            One of them: the loads, SI or with units. Without one, those of the scene.
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
        solver = self._loaded.path(self.threads)
        with reporter(progress) as report:
            for word, value, duration in loads:
                found, said = solver.solve(word, value, duration, report)
                _warn(said)
                step = Step(found)
                if not step.converged:
                    warnings.warn(f"a load did not converge: residual {step.residual:.1e} after {step.iterations} iterations", NotConvergedWarning, stacklevel=2)
                yield step
                if not step.converged:
                    return

    def _loads(self, control: dict[str, Any], seconds: Iterable[float | str] | None) -> Iterator[tuple[str, float, float | None]]:
        unknown = [name for name in control if name not in CONTROLS]
        if unknown or len(control) > 1:
            raise TypeError(f"give one of {', '.join(CONTROLS)}, not {', '.join(control)}")
        if not control:
            return iter(self._loaded.loads())
        [(name, values)] = control.items()
        word, dimension = CONTROLS[name]
        if isinstance(values, (str, float, int)):
            values = [values]
        if seconds is None:
            return ((word, si(value, dimension, name), None) for value in values)
        times: Iterator[float | str] = iter(seconds)

        def timed() -> Iterator[tuple[str, float, float | None]]:
            for index, value in enumerate(values):
                duration = 0.0 if index == 0 else si(next(times), "time", "seconds")
                yield word, si(value, dimension, name), duration

        return timed()

    def solve(self, *, progress: Any = False, **control: Any) -> Step:
        """Solves one load from the undeformed surfaces: ``contact.solve(force="10 nN")``."""
        for value in control.values():
            if not isinstance(value, str) and np.ndim(value) != 0:
                raise TypeError("solve takes one load; path takes many")
        return next(iter(self.path(progress=progress, **control)))

    def run(self, folder: str | os.PathLike[str], *, resume: bool = False, overwrite: bool = True, images: bool = True, progress: Any = True) -> Run:
        """Solves every step of the scene into a folder, as the command line does, and opens it.

        Ctrl-C keeps the finished steps, from which ``resume=True`` goes on.
        """
        with reporter(progress) as report:
            trouble, said = _tabor.run(self._loaded, os.fspath(folder), resume, overwrite, images, self.threads, report)
        _warn([words for is_warning, words in said if is_warning])
        if trouble is not None:
            warnings.warn(trouble, NotConvergedWarning, stacklevel=2)
        return Run(folder)

    def __reduce__(self) -> Any:
        return _restore, (type(self), self._source, self._heights, self._adhesion_map, self.threads)

    def __repr__(self) -> str:
        grid = self.resolved["grid"]
        points = grid.get("points")
        return f"<{type(self).__name__} of {'a file' if points is None else 'x'.join(map(str, points))} points>"


def _restore(cls: type[Scene], source: Any, heights: Any, adhesion_map: Any, threads: int | None) -> Scene:
    scene = cls.__new__(cls)
    scene._begin(*source, heights, adhesion_map, threads)
    return scene


def _warn(said: Iterable[str]) -> None:
    for words in said:
        warnings.warn(words, TaborWarning, stacklevel=3)
