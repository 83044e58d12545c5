"""Loads that are solved one after another."""

from __future__ import annotations

import contextlib
import threading
import warnings
from collections.abc import Iterator
from typing import TYPE_CHECKING, Any

from .errors import NotConvergedWarning, TaborError, TaborWarning
from .progress import Report, reporter
from .step import Step

if TYPE_CHECKING:
    from .scene import Scene
    from .wording import Wording

#: A load: the word of its control, its value, SI, and the seconds that it takes.
Load = tuple[str, float, "float | None"]


class Path:
    """Solves a load each time it is asked for the next `Step`: the iterator that `Contact.path` gives.

    It ends after the last load, or after one that did not converge or was refused. It does not pickle, and once begun it does not go on
    in a fork; its contact and its steps do both.
    """

    def __init__(
        self, scene: Scene, loads: Iterator[Load], wording: Wording | None, until_apart: bool, progress: Any, total: int | None = None
    ) -> None:
        self._of = type(scene).__name__
        self._solver = scene._loaded.path(scene.threads, until_apart, wording)
        self._wording = wording
        self._loads = loads
        self._pulls = until_apart
        # One bar for all loads, from the first on.
        self._open = contextlib.ExitStack()
        self._bar = reporter(progress, total)
        self._report: Report | None = None
        self._periodic = scene.resolved["grid"]["boundary"] == "periodic"
        self._busy = threading.Lock()
        self._begun = self._ended = False
        self._solved = 0

    def __iter__(self) -> Path:
        return self

    def __next__(self) -> Step:
        return self._next(3)

    def _next(self, level: int) -> Step:
        """The next step; warnings are told of the frame `level` above."""
        if not self._busy.acquire(blocking=False):
            raise RuntimeError("this path solves a load already, for another thread or for this progress; begin another path")
        said: list[str] = []
        try:
            if self._ended:
                raise StopIteration
            load = next(self._loads, None)
            if load is None and not self._pulls:
                self._ended = True
                self._solver.conclude(said)
                raise StopIteration
            if not self._begun:
                self._begun = True
                self._report = self._open.enter_context(self._bar)
            found = self._solver.pull(said, self._report) if load is None else self._solver.solve(*load, said, self._report)
            if found is None:
                self._ended = True
                raise StopIteration
            step = Step(found, self._periodic)
            self._solved += 1
            self._ended = not step.converged
            if self._ended:
                self._solver.conclude(said)
        except StopIteration:
            self._open.close()
            self._tell(said, level + 1)
            raise
        except BaseException as error:
            # As of a generator: what is refused ends it.
            self._ended = self._ended or isinstance(error, TaborError)
            self._open.close()
            for words in said:
                # A warning that a filter makes an error does not stand in place of what ended the path.
                with contextlib.suppress(Exception):
                    self._tell([words], level + 1)
            raise
        finally:
            self._busy.release()
        if self._ended:
            self._open.close()
        self._tell(said, level + 1)
        if not step.converged:
            words = f"a load did not converge: {step.unreachable or f'residual {step.residual:.1e} after {step.iterations} iterations'}"
            warnings.warn(words, NotConvergedWarning, stacklevel=level)
        return step

    def _tell(self, said: list[str], level: int) -> None:
        """Warns in the words of the scene's author."""
        for words in said:
            told = words if self._wording is None else self._wording("", words)
            warnings.warn(told, TaborWarning, stacklevel=level)

    def __reduce__(self) -> Any:
        raise TypeError("a path that solves does not pickle; pickle its contact or scene, or the steps that it gave: list(path)")

    def __repr__(self) -> str:
        return f"<Path of a {self._of}: {self._solved} loads solved{', ended' if self._ended else ''}>"
