"""Studies: many solves that write a folder of tables and pictures, as the command line does."""

from __future__ import annotations

import os
from collections.abc import Mapping
from contextlib import AbstractContextManager
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from . import tables
from .errors import OutputError, SceneError
from .program import call
from .scene import Scene, plain, toml_text

class Study:
    """The folder of a study.

    Attributes
    ----------
    folder : Path
        Where it lies.
    """

    def __init__(self, folder: str | os.PathLike[str]) -> None:
        self.folder = Path(folder)
        if not any(self.folder.glob("*.csv")):
            raise OutputError(f"{self.folder}: no folder of a study; it has no table")

    @property
    def tables(self) -> list[str]:
        """Names of its tables."""
        return sorted(path.stem for path in self.folder.glob("*.csv"))

    def __getitem__(self, name: str) -> npt.NDArray[np.void]:
        path = self.folder / f"{name}.csv"
        if not path.is_file():
            raise KeyError(f"{name}; the study has {', '.join(self.tables)}")
        return tables.read(path)

    def to_frame(self, name: str) -> Any:
        """A table as a `pandas.DataFrame`."""
        import pandas

        return pandas.DataFrame(self[name])

    @property
    def pictures(self) -> list[Path]:
        """Its pictures."""
        return sorted([*self.folder.glob("*.png"), *self.folder.glob("*.svg")])

    def __repr__(self) -> str:
        return f"<Study {self.folder}: {', '.join(self.tables)}>"


def _scene_file(scene: Any, folder: str) -> str:
    """The path of a scene: its own, or a file written for the time of a call."""
    if isinstance(scene, Scene):
        if scene.has_arrays:
            raise SceneError("a study reads its scene from a file: save the heights by numpy.save and name them as a surface of kind file")
        if scene.is_overridden:
            raise SceneError("give the file of the scene and the overrides to the study")
        if scene.path_of_file is not None:
            return os.fspath(scene.path_of_file)
        path = Path(folder) / "scene.toml"
        path.write_text(scene.to_toml(), encoding="utf-8")
        return os.fspath(path)
    if isinstance(scene, Mapping):
        path = Path(folder) / "scene.toml"
        path.write_text(toml_text(scene), encoding="utf-8")
        return os.fspath(path)
    return str(os.fspath(scene))


def _folder() -> AbstractContextManager[str]:
    """A folder for the time of a call."""
    import tempfile

    return tempfile.TemporaryDirectory()


def _overrides(overrides: Mapping[str, Any] | None) -> list[str]:
    words = []
    for key, value in (overrides or {}).items():
        words += ["--set", f"{key}={value if isinstance(value, str) else plain(value)}"]
    return words


def compare(scene: Any, folder: str | os.PathLike[str], *, overrides: Mapping[str, Any] | None = None, quiet: bool = True) -> Study:
    """The same surface through the full field, DMT, ICHA, Persson, GW-M and BAM, as ``tabor compare``.

    Parameters
    ----------
    scene : path, Scene or mapping
        The scene.
    folder : path
        Where ``compare.csv`` and ``compare.png`` are written.
    overrides : mapping, optional
        Values in place of the scene's, by dotted keys.
    quiet : bool
        Whether what the command line says is held back.
    """
    with _folder() as written:
        call(["compare", _scene_file(scene, written), "--out", os.fspath(folder), *_overrides(overrides)], quiet)
    return Study(folder)


def accuracy(
    scene: Any,
    folder: str | os.PathLike[str],
    *,
    budget: str = "5 min",
    overrides: Mapping[str, Any] | None = None,
    quiet: bool = True,
) -> Study:
    """What accuracy costs: a scene over grids, tolerances, precisions and models, as ``tabor accuracy``.

    Parameters
    ----------
    scene : path, Scene or mapping
        The scene.
    folder : path
        Where ``accuracy.csv`` and ``accuracy.png`` are written.
    budget : text
        How long it may take, such as "90 s".
    overrides : mapping, optional
        Values in place of the scene's, by dotted keys.
    quiet : bool
        Whether what the command line says is held back.
    """
    with _folder() as written:
        words = ["accuracy", _scene_file(scene, written), "--out", os.fspath(folder), "--budget", budget]
        call([*words, *_overrides(overrides)], quiet)
    return Study(folder)


def sweep(
    study: str | os.PathLike[str] | Mapping[str, Any],
    folder: str | os.PathLike[str],
    *,
    jobs: int | None = None,
    overrides: Mapping[str, Any] | None = None,
    quiet: bool = True,
) -> Study:
    """A scene over values of its keys, as ``tabor sweep``; what is finished in the folder is not repeated.

    Parameters
    ----------
    study : path or mapping
        The study, a TOML file or its tables.
    folder : path
        Where ``sweep.csv``, ``runs.csv`` and ``means.csv`` are written.
    jobs : int, optional
        Cases at a time.
    overrides : mapping, optional
        Values in place of the scene's, by dotted keys.
    quiet : bool
        Whether what the command line says is held back.
    """
    with _folder() as written:
        if isinstance(study, Mapping):
            path = Path(written) / "study.toml"
            path.write_text(toml_text(study), encoding="utf-8")
        else:
            path = Path(study)
        words = ["sweep", os.fspath(path), "--out", os.fspath(folder)]
        if jobs is not None:
            words += ["--jobs", str(jobs)]
        call([*words, *_overrides(overrides)], quiet)
    return Study(folder)
