"""Scenes as files for the time of a call: the command line reads no arrays."""

from __future__ import annotations

import json
import os
import re
from collections.abc import Callable, Iterable, Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np

from . import _tabor
from .scene import Scene
from .values import override_words, toml_text, toml_value


#: Where a parser stopped in a text.
SYNTAX = re.compile(r"TOML parse error at line \d+, column \d+\n(?:.*\|.*\n)+ *")


#: A message of the command line in the words of who called from Python.
Tell = Callable[[str], str]


def set_words(overrides: Mapping[str, Any] | None) -> list[str]:
    """Values in place of a scene's as words of the command line."""
    return _as_words(override_words(overrides))


def _as_words(chosen: Iterable[tuple[str, str]]) -> list[str]:
    return [word for key, text in chosen for word in ("--set", f"{key}={text}")]


def operand(path: str | os.PathLike[str]) -> str:
    """A path as an operand of the command line: one that begins with a hyphen is no option."""
    text = str(os.fspath(path))
    return os.path.join(os.curdir, text) if text.startswith("-") else text


def out_word(folder: str | os.PathLike[str]) -> str:
    """The folder of a study as a word of the command line."""
    return f"--out={os.fspath(folder)}"


@contextmanager
def scene_on_disk(scene: Any, overrides: Mapping[str, Any] | None = None) -> Iterator[tuple[str, list[str], Tell]]:
    """The path of the file of a scene, words for the values in place of the file's, and who tells messages.

    A scene of arrays or of tables is written into a folder that goes with the call, and so is one whose file is not what it
    was when it was read.
    """
    if isinstance(scene, (str, os.PathLike)):
        yield operand(scene), set_words(overrides), str
        return
    scene = Scene(scene) if isinstance(scene, Mapping) else scene
    if not isinstance(scene, Scene):
        raise TypeError(f"scene: a file, a Scene, a Contact or tables are expected, not {type(scene).__name__}")
    chosen = [*scene._overrides, *override_words(overrides)]
    if scene.path_of_file is not None and not scene.has_arrays and _holds(scene.path_of_file, scene.to_toml()):
        yield operand(scene.path_of_file), _as_words(chosen), str
        return
    import tempfile

    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "scene.toml"
        path.write_text(toml_text(_with_files(scene, folder)), encoding="utf-8")
        words = _as_words([(key, _from_root(key, text, scene._folder)) for key, text in chosen])
        yield os.fspath(path), words, told_without(path, scene._told_of)


def _holds(path: Path, text: str) -> bool:
    """Whether a file holds this text."""
    try:
        return path.read_text(encoding="utf-8") == text
    except (OSError, ValueError):
        return False


def _from_root(key: str, text: str, folder: str) -> str:
    """A value in place of a scene's, as TOML writes it, its paths from the root."""
    names = [name.strip() for name in key.split(".")]
    tables: Any = json.loads(_tabor.json_from_toml(f"value = {text}"))["value"]
    for name in reversed(names):
        tables = {name: tables}
    # A single part is {"0": {"path": ...}} here.
    parts = tables.get("surface")
    for part in parts.values() if isinstance(parts, dict) else parts if isinstance(parts, list) else []:
        _file_from_root(part, "path", folder)
    _file_from_root(tables.get("adhesion"), "map", folder)
    for name in names:
        tables = tables[name]
    return toml_value(tables, f'overrides["{key}"]')


def _file_from_root(table: Any, key: str, folder: str) -> None:
    """A path in a table, relative to `folder`, from the root."""
    if isinstance(table, dict) and isinstance(table.get(key), str):
        table[key] = os.path.abspath(os.path.join(folder, table[key]))


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
        _file_from_root(part, "path", scene._folder)
    adhesion = tables.get("adhesion") or {}
    _file_from_root(adhesion, "map", scene._folder)
    heights, factors = scene._arrays
    if heights is not None:
        np.save(Path(folder) / "heights.npy", heights)
        part = {"kind": "file", "path": os.path.join(folder, "heights.npy"), "unit": "m"}
        tables["surface"] = [part] if parts == [{"kind": "flat"}] else [part, *parts]
    if factors is not None:
        np.save(Path(folder) / "factors.npy", factors)
        adhesion["map"] = os.path.join(folder, "factors.npy")
    return tables
