"""Scenes as files for the time of a call: the command line reads no arrays."""

from __future__ import annotations

import json
import os
import re
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np

from . import _tabor
from .scene import Scene
from .values import override_words, toml_text


#: Where a parser stopped in a text.
SYNTAX = re.compile(r"TOML parse error at line \d+, column \d+\n(?:.*\|.*\n)+ *")


#: A message of the command line in the words of who called from Python.
Tell = Callable[[str], str]


def set_words(overrides: Mapping[str, Any] | None) -> list[str]:
    """Values in place of a scene's as words of the command line."""
    return [word for key, text in override_words(overrides) for word in ("--set", f"{key}={text}")]


def operand(path: str | os.PathLike[str]) -> str:
    """A path as an operand of the command line: one that begins with a hyphen is no option."""
    text = str(os.fspath(path))
    return os.path.join(os.curdir, text) if text.startswith("-") else text


def out_word(folder: str | os.PathLike[str]) -> str:
    """The folder of a study as a word of the command line."""
    return f"--out={os.fspath(folder)}"


@contextmanager
def scene_on_disk(scene: Any) -> Iterator[tuple[str, list[str], Tell]]:
    """The path of the file of a scene, words for the values in place of the file's, and who tells messages.

    A scene of arrays or of tables is written into a folder that goes with the call.
    """
    if isinstance(scene, (str, os.PathLike)):
        yield operand(scene), [], str
        return
    scene = Scene(scene) if isinstance(scene, Mapping) else scene
    if not isinstance(scene, Scene):
        raise TypeError(f"scene: a file, a Scene, a Contact or tables are expected, not {type(scene).__name__}")
    words = set_words(dict(scene._overrides))
    if scene.path_of_file is not None and not scene.has_arrays:
        yield operand(scene.path_of_file), words, str
        return
    import tempfile

    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "scene.toml"
        path.write_text(toml_text(_with_files(scene, folder)), encoding="utf-8")
        yield os.fspath(path), words, told_without(path, scene._told_of)


def told_without(path: Path, tell: Callable[[str, str], str]) -> Tell:
    """Tells messages about a file that its author has never seen, by key and words, without its path and lines."""
    place = re.compile(rf"^{re.escape(os.fspath(path))}(?::\d+)?(, from --set)?: (?:([\w.]+): )?(.*)$")

    def told(line: str) -> str:
        found = place.match(line)
        if found is None:
            return tell("", line)
        from_set, key, words = found.groups()
        return f'overrides["{key}"]: {words}' if from_set else tell(key or "", words)

    return lambda text: "\n".join(told(line) for line in SYNTAX.sub("", text).splitlines())


def _with_files(scene: Scene, folder: str) -> dict[str, Any]:
    """The tables of a scene, its arrays saved in `folder`, its paths from the root."""
    tables: dict[str, Any] = json.loads(_tabor.json_from_toml(scene.to_toml()))
    parts = tables["surface"]
    for part in parts:
        if "path" in part:
            part["path"] = os.path.abspath(os.path.join(scene._folder, part["path"]))
    adhesion = tables.get("adhesion") or {}
    if isinstance(adhesion.get("map"), str):
        adhesion["map"] = os.path.abspath(os.path.join(scene._folder, adhesion["map"]))
    heights, factors = scene._arrays
    if heights is not None:
        np.save(Path(folder) / "heights.npy", heights)
        part = {"kind": "file", "path": os.path.join(folder, "heights.npy"), "unit": "m"}
        tables["surface"] = [part] if parts == [{"kind": "flat"}] else [part, *parts]
    if factors is not None:
        np.save(Path(folder) / "factors.npy", factors)
        adhesion["map"] = os.path.join(folder, "factors.npy")
    return tables
