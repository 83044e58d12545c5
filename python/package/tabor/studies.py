"""Studies: many solves that write a folder of tables and pictures, as the command line does."""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from . import tables
from .disk import Tell, operand, out_word, scene_on_disk, set_words, told_without
from .errors import OutputError, SceneError
from .optional import package
from .program import call
from .quantities import Quantity, si
from .scene import Scene
from .values import thread_count, toml_text


class Study:
    """The folder of a study.

    Attributes
    ----------
    folder : Path
        Where it lies.
    """

    def __init__(self, folder: str | os.PathLike[str]) -> None:
        self.folder = Path(folder)
        # A share of a sweep has none before it is merged.
        if not any(self.folder.glob("*.csv")) and not any(self.folder.glob("*.jsonl")):
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
        pandas = package("pandas", "a data frame")

        return pandas.DataFrame(self[name])

    @property
    def pictures(self) -> list[Path]:
        """Its pictures."""
        return sorted([*self.folder.glob("*.png"), *self.folder.glob("*.svg")])

    def __repr__(self) -> str:
        return f"<Study {self.folder}: {', '.join(self.tables)}>"


def compare(scene: Any, folder: str | os.PathLike[str], *, overrides: Mapping[str, Any] | None = None, quiet: bool = True) -> Study:
    """The same surface through the full field, DMT, ICHA, Persson, GW-M and BAM, as ``tabor compare``.

    Parameters
    ----------
    scene : path, Scene, Contact or mapping
        The scene.
    folder : path
        Where ``compare.csv`` and ``compare.png`` are written.
    overrides : mapping, optional
        Values in place of the scene's, by dotted keys, as `Scene.read` takes them.
    quiet : bool
        Whether what the command line says is held back; of it warnings are `TaborWarning`.
    """
    with scene_on_disk(scene, overrides) as (path, words, tell):
        call(["compare", path, out_word(folder), *words], quiet, tell)
    return Study(folder)


def accuracy(
    scene: Any,
    folder: str | os.PathLike[str],
    *,
    budget: Quantity = "5 min",
    overrides: Mapping[str, Any] | None = None,
    quiet: bool = True,
) -> Study:
    """What accuracy costs: a scene over grids, tolerances, precisions and models, as ``tabor accuracy``.

    Parameters
    ----------
    scene : path, Scene, Contact or mapping
        The scene.
    folder : path
        Where ``accuracy.csv`` and ``accuracy.png`` are written.
    budget : number or text
        How long it may take, s, or such as "5 min".
    overrides : mapping, optional
        Values in place of the scene's, by dotted keys, as `Scene.read` takes them.
    quiet : bool
        Whether what the command line says is held back; of it warnings are `TaborWarning`.
    """
    seconds = si(budget, "time", "budget")
    if seconds <= 0:
        raise SceneError("budget: must be more than zero")
    with scene_on_disk(scene, overrides) as (path, words, tell):
        call(["accuracy", path, out_word(folder), f"--budget={seconds!r} s", *words], quiet, tell)
    return Study(folder)


def sweep(
    study: str | os.PathLike[str] | Mapping[str, Any],
    folder: str | os.PathLike[str],
    *,
    jobs: int | None = None,
    threads: int | None = None,
    share: tuple[int, int] | None = None,
    merge: Sequence[str | os.PathLike[str]] | None = None,
    overrides: Mapping[str, Any] | None = None,
    quiet: bool = True,
) -> Study:
    """A scene over values of its keys, as ``tabor sweep``; what is finished in the folder is not repeated.

    Parameters
    ----------
    study : path or mapping
        The study, a TOML file or its tables, whose ``scene`` is a file, a Scene, a Contact without arrays, or tables.
    folder : path
        Where ``sweep.csv``, ``runs.csv`` and ``means.csv`` are written.
    jobs : int, optional
        Cases at a time; one a core unless told.
    threads : int, optional
        Threads of each case.
    share : (i, n), optional
        Solves share i of n alone, 1 to n, as one of n processes.
    merge : list of folders, optional
        Solves nothing, and joins what is finished in the folder and in these.
    overrides : mapping, optional
        Values in place of the scene's, by dotted keys, as `Scene.read` takes them.
    quiet : bool
        Whether what the command line says is held back; of it warnings are `TaborWarning`.
    """
    import contextlib
    import tempfile

    options = [f"--{name}={thread_count(count, name)}" for name, count in (("jobs", jobs), ("threads", threads)) if count is not None]
    if share is not None:
        options.append(f"--only={_share(share)}")
    if merge is not None:
        options += ["--merge", *(operand(each) for each in merge)]
    with contextlib.ExitStack() as until_done:
        words = set_words(overrides)
        tell: Tell = str
        if isinstance(study, Mapping):
            tables = dict(study)
            if "scene" in tables:
                if isinstance(tables["scene"], Scene) and tables["scene"].has_arrays:
                    words_of_files = "save the array by numpy.save and give the contact its path, by which the study is known again"
                    raise SceneError(f"study: its scene holds an array; {words_of_files}")
                scene, words, tell_of_scene = until_done.enter_context(scene_on_disk(tables["scene"], overrides))
                tables["scene"] = os.path.abspath(scene)
            path = Path(until_done.enter_context(tempfile.TemporaryDirectory())) / "study.toml"
            path.write_text(toml_text(tables), encoding="utf-8")
            tell_of_study = told_without(path, _of_study)

            def tell(text: str) -> str:
                return tell_of_scene(tell_of_study(text))

        else:
            path = Path(study)
        call(["sweep", operand(path), out_word(folder), *options, *words], quiet, tell)
    return Study(folder)


def _share(share: Any) -> str:
    """A share (i, n) in the words of the command line."""
    numbers = list(share) if isinstance(share, (tuple, list)) else []
    if len(numbers) != 2 or not all(isinstance(number, (int, np.integer)) and not isinstance(number, bool) for number in numbers) or not 1 <= numbers[0] <= numbers[1]:
        raise SceneError(f"share: (i, n) is expected, as in (2, 8) for the second of eight, not {share!r}")
    return f"{numbers[0]}/{numbers[1]}"


def _of_study(key: str, words: str) -> str:
    """A message about the tables of a study."""
    return f"study: {key}: {words}" if key else f"study: {words}"
