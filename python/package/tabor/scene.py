"""Scenes: what a scene file says, with arrays where it names files."""

from __future__ import annotations

import contextlib
import functools
import itertools
import json
import os
import sys
import warnings
from collections.abc import Callable, Iterable, Iterator, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any, ParamSpec, TypeAlias, TypeVar, Union

import numpy as np
import numpy.typing as npt

from . import _tabor
from .errors import NotConvergedWarning, OutputError, SceneError, TaborWarning
from .path import Load, Path as LoadPath
from .quantities import Quantity, refuse_unit, si, words
from .step import Step
from .values import Array, field, override_words, thread_count, toml_text
from .wording import Wording

if TYPE_CHECKING:
    from .runs import Run

Arguments = ParamSpec("Arguments")
Result = TypeVar("Result")

#: What a path may prescribe: the argument, the word of a scene, the dimension.
CONTROLS = {
    "pressure": ("pressure", "pressure"),
    "force": ("force", "force"),
    "approach": ("approach", "length"),
    "mean_gap": ("mean-gap", "length"),
}

#: Where the modules of this package lie.
PACKAGE = os.path.dirname(__file__)

#: What `Scene.new` writes.
KINDS = ("sphere", "rough", "afm", "pillars", "seal", "mems")

#: Loads of a path, or seconds: one, or many.
Loads: TypeAlias = Union[Quantity, Iterable[Quantity], npt.NDArray[Any]]


def control_at(boundary: Any) -> str:
    """What a load prescribes that nobody asks for: paths bring their own."""
    return "force" if isinstance(boundary, str) and boundary == "free" else "pressure"


def by_name(call: Callable[Arguments, Result]) -> Callable[Arguments, Result]:
    """A method that takes loads by the names of their controls, and says so where one comes without."""

    @functools.wraps(call)
    def called(*unnamed: Arguments.args, **named: Arguments.kwargs) -> Result:
        if len(unnamed) > 1:
            name = call.__name__
            example = f'{name}(force="10 nN")' if name == "solve" else f'{name}(force=["10 nN", "20 nN"])'
            words = f"{name} takes loads by the name of their control: pressure, force, approach or mean_gap"
            raise TypeError(f"{words}, as in {example}, not {unnamed[1]!r} alone")
        return call(*unnamed, **named)

    return called


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
        The file that the scene was read from. The scene stays as it was read where the file changes later.
    """

    def __init__(
        self,
        tables: Mapping[str, Any],
        *,
        heights: Any = None,
        adhesion_map: Any = None,
        threads: int | None = None,
    ) -> None:
        adhesion = tables.get("adhesion") if isinstance(tables, Mapping) else None
        if adhesion_map is not None and isinstance(adhesion, Mapping) and adhesion.get("map") is not None:
            raise SceneError("adhesion_map: given as an argument and as map in adhesion; give one")
        self._of_tables(tables, Wording({}, in_python=False), heights, adhesion_map, threads)

    def _of_tables(
        self, tables: Mapping[str, Any], wording: Wording, heights: Any = None, adhesion_map: Any = None, threads: int | None = None
    ) -> None:
        self._begin((toml_text(tables, wording), "scene", _here(), []), heights, adhesion_map, threads, None, wording)

    def _begin(
        self,
        source: tuple[str, str, str, list[tuple[str, str]]],
        heights: Any,
        adhesion_map: Any,
        threads: int | None,
        path_of_file: Path | None,
        wording: Wording | None,
    ) -> None:
        self._heights = None if heights is None else field(heights, "heights", "length")
        self._adhesion_map = None if adhesion_map is None else field(adhesion_map, "adhesion_map", "number")
        self._source = source
        self.path_of_file = path_of_file
        self.threads = None if threads is None else thread_count(threads, "threads")
        # Nobody tells messages of a file: they name its lines.
        self._wording = wording
        self._loaded = _tabor.LoadedScene(*source, self._heights, self._adhesion_map, wording)
        if self._adhesion_map is not None and self.resolved.get("adhesion") is None:
            raise SceneError("adhesion_map: it changes the tension of a law, and there is none; give a law")

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
            Values in place of the file's, by dotted keys: ``{"grid.points": 128}``, as in tables: a number in SI units is
            a number, and a text has its unit, ``{"solid.contact_modulus": "5 GPa"}``. A mapping stands in place of the
            whole table: ``{"adhesion": {"law": "exponential", ...}}``.
        threads : int, optional
            Threads of the processor.
        """
        path = Path(path)
        try:
            text = path.read_text(encoding="utf-8")
        except (OSError, ValueError) as error:
            raise SceneError(f"{path}: cannot be read: {error}") from error
        scene = cls.__new__(cls)
        chosen = override_words(overrides)
        # Files are read when they are asked for, perhaps from another working directory.
        there = Path(_here()) / path
        scene._begin((text, str(path), str(there.parent), chosen), None, None, threads, there, None)
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

    @property
    def _overrides(self) -> list[tuple[str, str]]:
        """Values in place of its file's, by dotted keys, as TOML writes them."""
        return list(self._source[3])

    @property
    def _folder(self) -> str:
        """Where its relative paths begin."""
        return self._source[2]

    @property
    def _arrays(self) -> tuple[Array | None, Array | None]:
        """Its heights and its map of adhesion, where they are arrays; refused once they have been written to."""
        self._loaded.check_arrays()
        return self._heights, self._adhesion_map

    def to_toml(self) -> str:
        """The text of the scene. Arrays and overrides are not in it."""
        return self._source[0]

    def write(self, path: str | os.PathLike[str]) -> None:
        """Writes the scene to a file, which the command line reads."""
        if self.has_arrays:
            raise SceneError("a file holds no arrays: save the heights by numpy.save and name them as a surface of kind file")
        if self.is_overridden:
            raise SceneError("the values given in place of the file's are not in its text")
        try:
            Path(path).write_text(self.to_toml(), encoding="utf-8")
        except (OSError, ValueError) as error:
            raise OutputError(f"{path}: cannot be written: {error}") from error

    def check(self, *, verbose: bool = False) -> str:
        """What ``tabor check`` says: the physics, how well the grid resolves it, memory and cost. It warns by `TaborWarning`.

        Parameters
        ----------
        verbose : bool
            Whether to name the fields and kernels of the solver too, and the effects that are off.
        """
        from .disk import scene_on_disk
        from .program import call

        with scene_on_disk(self) as (path, words, tell):
            return call(["check", path, *words, *(["--verbose"] if verbose else [])], True, tell)

    @classmethod
    def new(cls, kind: str, folder: str | os.PathLike[str]) -> Scene:
        """Writes a commented scene to begin with into a folder, as ``tabor new``, and reads it.

        Parameters
        ----------
        kind : {"sphere", "rough", "afm", "pillars", "seal", "mems"}
            What touches.
        folder : path
            Where ``scene.toml`` is written; one that is there already is kept, and refused.
        """
        from .disk import operand
        from .program import call

        if kind not in KINDS:
            from difflib import get_close_matches

            near = "".join(f"; did you mean {name!r}?" for name in get_close_matches(str(kind), KINDS, 1))
            raise SceneError(f"kind: one of {', '.join(KINDS)}, not {kind!r}{near}")
        call(["new", kind, operand(folder)], True)
        return cls.read(Path(folder) / "scene.toml")

    def surface(self) -> tuple[Array, tuple[float, float]]:
        """The heights of all parts, m, of shape (ny, nx), and the cell's (lx, ly), m."""
        heights, size, said = self._loaded.heights(self.threads)
        _warn(self._told_of("", words) for words in said)
        return heights, size

    def heights(self) -> Array:
        """The heights of all parts, m, of shape (ny, nx)."""
        return self.surface()[0]

    @by_name
    def path(
        self,
        *,
        pressure: Loads | None = None,
        force: Loads | None = None,
        approach: Loads | None = None,
        mean_gap: Loads | None = None,
        seconds: Loads | None = None,
        progress: Any = False,
    ) -> LoadPath:
        """Solves loads one after another, each from the state of the one before, as the iterator is asked for them.

        Parameters
        ----------
        pressure, force, approach, mean_gap : iterable of numbers or texts
            One of them: the loads, Pa, N, m and m, or with units. Without one, those of the scene, and with
            ``until = "apart"`` further ones behind them, in steps that become finer, until the surfaces are apart.
        seconds : number or text, or iterable of them, optional
            The time that each load but the first takes, s, for effects that depend on time: one for all, or one a load.
        progress : bool or callable, optional
            A bar (by tqdm, if installed), or what is called with finished loads, iteration and residual.

        Returns
        -------
        iterator of Step
            A path ends after a load that did not converge, of which a `NotConvergedWarning` tells.
        """
        control = _control(pressure=pressure, force=force, approach=approach, mean_gap=mean_gap)
        pulls = control is None and self.resolved["loading"].get("until") is not None
        loads = self._loads(control, seconds)
        given = self._loaded.loads() if control is None else control[1]
        total = 1 if _is_one(given) else len(given) if hasattr(given, "__len__") and not pulls else None
        return LoadPath(self, loads, self._wording_of(control), pulls, progress, total)

    def _wording_of(self, control: tuple[str, Any] | None) -> Wording | None:
        """Who tells messages of a path: loads that were given have the name of their control."""
        if control is None:
            return self._wording
        return (self._wording or Wording({}, in_python=False)).of_loads(control[0])

    def _told_of(self, key: str, words: str) -> str:
        """A message about a key, perhaps empty, in the words of the scene's author."""
        if self._wording is not None:
            return self._wording(key, words)
        return f"{key}: {words}" if key else words

    def _loads(self, control: tuple[str, Any] | None, seconds: Any) -> Iterator[Load]:
        if control is None:
            if seconds is not None:
                raise SceneError("seconds: the loads of a scene have their own durations; give pressure, force, approach or mean_gap too")
            return iter(self._loaded.loads())
        name, values = control
        word, dimension = CONTROLS[name]
        refuse_unit(values, dimension, name)
        values = [values] if _is_one(values) else values
        if seconds is None:
            return ((word, si(value, dimension, name), None) for value in values)
        if _is_one(seconds):
            seconds = itertools.repeat(si(seconds, "time", "seconds"))
        elif hasattr(seconds, "__len__") and hasattr(values, "__len__") and len(seconds) != len(values) - 1:
            raise SceneError(f"seconds: one for each load but the first is expected, {len(values) - 1} of them, not {len(seconds)}")
        times = iter(seconds)

        def timed() -> Iterator[Load]:
            for index, value in enumerate(values):
                try:
                    duration = 0.0 if index == 0 else si(next(times), "time", "seconds")
                except StopIteration:
                    raise SceneError("seconds: one for each load but the first is expected") from None
                yield word, si(value, dimension, name), duration

        return timed()

    @by_name
    def solve(
        self,
        *,
        pressure: Quantity | None = None,
        force: Quantity | None = None,
        approach: Quantity | None = None,
        mean_gap: Quantity | None = None,
        progress: Any = False,
    ) -> Step:
        """Solves one load from the undeformed surfaces: ``contact.solve(force="10 nN")``.

        It takes no time, as the first load of a path; what follows in time is asked for by `path`.

        Parameters
        ----------
        pressure, force, approach, mean_gap : number or text
            One of them: the load, Pa, N, m and m, or with a unit.
        progress : bool or callable, optional
            As in `path`.
        """
        control = _control(pressure=pressure, force=force, approach=approach, mean_gap=mean_gap)
        if control is None:
            raise TypeError('solve takes one load by the name of its control: pressure, force, approach or mean_gap, as in solve(force="10 nN")')
        name, value = control
        if not _is_one(value):
            raise TypeError(f"{name}: solve takes one load, not {type(value).__name__}; path takes many")
        # What depends on time needs one of each load.
        seconds = 0.0 if any(time is not None for _, _, time in self._loaded.loads()) else None
        return LoadPath(self, self._loads(control, seconds), self._wording_of(control), False, progress, 1)._next(4)

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

        Ctrl-C ends it as it ends the command line: after the current iteration, with summary and pictures of the finished
        steps, from which ``resume=True`` goes on. Only then `KeyboardInterrupt` is raised; a second Ctrl-C raises it at
        once, while the run still ends by itself.

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
        from .progress import reporter
        from .runs import Run

        total = None if self.resolved["loading"].get("until") else len(self._loaded.loads())
        said: list[str] = []
        with reporter(progress, total) as report:
            try:
                trouble = _tabor.run(self._loaded, os.fspath(folder), said, resume, overwrite, images, self.threads, report)
            except BaseException:
                for words in said:
                    # A warning that a filter makes an error does not stand in place of what ended the run.
                    with contextlib.suppress(Exception):
                        _warn([self._told_of("", words)])
                raise
        _warn(self._told_of("", words) for words in said)
        if trouble is not None:
            warnings.warn(trouble, NotConvergedWarning, stacklevel=2)
        return Run(folder)

    def __reduce__(self) -> Any:
        return _restore, (type(self), self._source, *self._arrays, self.threads, self.path_of_file, self._wording)

    def _described(self) -> dict[str, str]:
        """What the scene is, in words."""
        resolved = self.resolved
        grid, solid, adhesion = resolved["grid"], resolved["solid"], resolved.get("adhesion")
        points = grid.get("points")
        described = {
            "grid": "of its file" if points is None else f"{points[0]} x {points[1]} points, {grid['boundary']}",
            "contact modulus": words(solid["contact_modulus"], "Pa") if "contact_modulus" in solid else "of a layer",
            "adhesion": "none" if adhesion is None else str(adhesion["law"]),
        }
        if grid.get("size") is not None:
            described["size"] = " x ".join(words(side, "m") for side in grid["size"])
        if adhesion is not None and adhesion.get("work_of_adhesion") is not None:
            described["work of adhesion"] = words(adhesion["work_of_adhesion"], "J/m^2")
        return described

    def __repr__(self) -> str:
        return f"<{type(self).__name__}: {', '.join(f'{name} {each}' for name, each in self._described().items())}>"

    def _repr_html_(self) -> str:
        rows = "".join(f"<tr><th style='text-align:left'>{name}</th><td>{each}</td></tr>" for name, each in self._described().items())
        return f"<table><caption>{type(self).__name__}</caption>{rows}</table>"


def _restore(
    cls: type[Scene],
    source: Any,
    heights: Any,
    adhesion_map: Any,
    threads: int | None,
    path: Path | None,
    wording: Wording | None,
) -> Scene:
    scene = cls.__new__(cls)
    scene._begin(source, heights, adhesion_map, threads, path, wording)
    return scene


def _here() -> str:
    """The working directory, where relative paths of files begin."""
    try:
        return os.getcwd()
    except OSError:
        return os.curdir


def _is_one(values: Any) -> bool:
    """Whether this is one load, not many."""
    return isinstance(values, (str, bytes, bytearray)) or not hasattr(values, "__iter__") or (isinstance(values, np.ndarray) and values.ndim == 0)


def _control(**loads: Any) -> tuple[str, Any] | None:
    """The one of the loads that is given, with its name."""
    given = [(name, values) for name, values in loads.items() if values is not None]
    if len(given) > 1:
        raise TypeError(f"give one of {', '.join(loads)}, not {' and '.join(name for name, _ in given)}")
    return given[0] if given else None


def _warn(said: Iterable[str]) -> None:
    """Warns of the line that called this package, however deep in it the warning arises."""
    level, frame = 1, sys._getframe()
    while frame.f_back is not None and os.path.dirname(frame.f_code.co_filename) == PACKAGE:
        level, frame = level + 1, frame.f_back
    for each in said:
        warnings.warn(each, TaborWarning, stacklevel=level)
