from collections.abc import Callable, Mapping, Sequence
from typing import Any, final

import numpy as np
import numpy.typing as npt

_Array = npt.NDArray[np.float64]
_Report = Callable[[int, int, float], object] | None
#: A message about a key of a scene, perhaps empty, in other words.
_Teller = Callable[[str, str], str] | None

__all__ = [
    "__version__",
    "LoadedScene",
    "SolvedPath",
    "colours",
    "command_line",
    "fit",
    "icha",
    "json_from_toml",
    "quantity",
    "run",
    "scales",
    "self_affine_like",
    "share",
    "spectrum",
    "statistics",
    "theory",
    "theory_table",
    "toml_from_json",
    "toml_value_from_json",
]

__version__: str

@final
class LoadedScene:
    def __new__(
        cls,
        text: str,
        name: str,
        folder: str,
        overrides: Sequence[tuple[str, str]],
        heights: _Array | None = None,
        factors: _Array | None = None,
        teller: _Teller = None,
    ) -> LoadedScene: ...
    def resolved_json(self) -> str: ...
    def check_arrays(self) -> None: ...
    def loads(self) -> list[tuple[str, float, float | None]]: ...
    def path(self, threads: int | None = None, until_apart: bool = False, teller: _Teller = None) -> SolvedPath: ...
    def heights(self, threads: int | None = None) -> tuple[_Array, tuple[float, float], list[str]]: ...

@final
class SolvedPath:
    def solve(
        self, word: str, value: float, seconds: float | None, said: list[str], progress: _Report = None
    ) -> dict[str, Any]: ...
    def pull(self, said: list[str], progress: _Report = None) -> dict[str, Any] | None: ...
    def conclude(self, said: list[str]) -> None: ...

def colours(name: str) -> list[tuple[int, int, int]]: ...
def command_line(words: Sequence[str]) -> int: ...
def fit(path: str, text: str | None, how: Mapping[str, Any]) -> tuple[str, str, str, list[str]]: ...
def json_from_toml(text: str) -> str: ...
def quantity(text: str, dimension: str, argument: str) -> float: ...
def run(
    scene: LoadedScene,
    folder: str,
    said: list[str],
    resume: bool = False,
    overwrite: bool = True,
    images: bool = True,
    threads: int | None = None,
    progress: _Report = None,
) -> str | None: ...
def icha(
    heights: _Array, size: Sequence[float], law: str, loads: Sequence[_Array]
) -> tuple[list[_Array], int]: ...
def scales(heights: _Array, size: Sequence[float], is_periodic: bool) -> list[_Array]: ...
def self_affine_like(heights: _Array, size: Sequence[float], is_periodic: bool) -> dict[str, Any]: ...
def share(text: str, argument: str) -> float: ...
def spectrum(heights: _Array, size: Sequence[float], is_periodic: bool) -> list[_Array]: ...
def statistics(heights: _Array, size: Sequence[float], is_periodic: bool) -> dict[str, Any]: ...
def theory(name: str, words: Sequence[tuple[str, str]], columns: Sequence[_Array]) -> tuple[list[_Array], int]: ...
def theory_table(words: Sequence[str]) -> str: ...
def toml_from_json(json: str) -> str: ...
def toml_value_from_json(json: str) -> str: ...
