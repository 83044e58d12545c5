"""The program tabor in a process of its own."""

from __future__ import annotations

import contextlib
import os
import re
import sys
import warnings
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from .errors import OutputError, SceneError, TaborError, TaborWarning

if TYPE_CHECKING:
    import subprocess

#: Exit codes of the command line: 3 is a case that did not converge, which its table shows.
CLASSES: dict[int, type[TaborError]] = {1: OutputError, 2: SceneError}
NOT_CONVERGED = 3

#: The program of this very package, wherever it lies and wherever the process starts.
PROGRAM = "import sys; sys.path[0] = sys.argv.pop(1); from tabor.program import main_of_caller; sys.exit(main_of_caller())"
PACKAGE = os.fspath(Path(__file__).parents[1])


#: A message of the program, whose further lines are indented.
MESSAGE = re.compile(r"^(warning|error): (.*(?:\n  .*)*)", re.MULTILINE)


def call(words: Sequence[str], quiet: bool, tell: Callable[[str], str] = str) -> str:
    """Runs the command line in a process of its own and returns what it printed.

    Where it is quiet its warnings are those of who called the caller; messages are told by `tell`. Whatever ends the wait
    ends the process too: Ctrl-C as in a terminal, after which the process says what it has kept, anything else, and a
    second Ctrl-C, sooner.
    """
    # A pipe whose one end this process holds: however it ends, the other end tells the program.
    lifeline = os.pipe() if os.name == "posix" else ()
    try:
        # Its own signals: Ctrl-C reaches it through this process alone, whether a terminal or a notebook sent it.
        return _communicate(_start(words, quiet, lifeline[:1]), tell, words[0])
    finally:
        for end in lifeline:
            os.close(end)


def _start(words: Sequence[str], quiet: bool, lifeline: Sequence[int]) -> subprocess.Popen[str]:
    """The program on its words, which ends where the lifeline does."""
    # Where it is first called for: it takes longer to import than all of this package.
    import subprocess

    return subprocess.Popen(
        [sys.executable, "-c", PROGRAM, PACKAGE, ",".join(map(str, lifeline)), *words],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE if quiet else None,
        # Whatever the locale.
        encoding="utf-8",
        errors="replace",
        start_new_session=True,
        pass_fds=lifeline,
    )


def main_of_caller() -> int:
    """The program in the process that `call` starts, which ends with its caller, also where that is killed."""
    import threading

    from .__main__ import main

    lifeline = sys.argv.pop(1)
    if lifeline:
        threading.Thread(target=_end_behind, args=(int(lifeline),), daemon=True).start()
    return main()


def _end_behind(lifeline: int) -> None:
    """Ends this process where nobody holds the other end."""
    import signal

    os.read(lifeline, 1)
    os.kill(os.getpid(), signal.SIGTERM)


def _communicate(process: subprocess.Popen[str], tell: Callable[[str], str], command: str) -> str:
    """What a process prints, whose end is waited for."""
    import signal

    try:
        printed, said = process.communicate()
    except BaseException as error:
        # Nobody else ends it.
        try:
            if isinstance(error, KeyboardInterrupt) and os.name == "posix":
                process.send_signal(signal.SIGINT)
            else:
                process.terminate()
            _, said = process.communicate()
        except BaseException:
            process.kill()
            process.wait()
            for pipe in (process.stdout, process.stderr):
                if pipe is not None:
                    pipe.close()
            raise
        for kind, text in _messages(said, tell):
            # A warning that a filter makes an error does not stand in place of what ended the call.
            with contextlib.suppress(Exception):
                if kind == "warning":
                    warnings.warn(text, TaborWarning, stacklevel=4)
        raise
    messages = _messages(said, tell)
    for kind, text in messages:
        if kind == "warning":
            warnings.warn(text, TaborWarning, stacklevel=4)
    if process.returncode not in (0, NOT_CONVERGED):
        message = "\n".join(text for kind, text in messages if kind == "error") or (said or "").strip() or f"tabor {command} ended with {process.returncode}"
        raise CLASSES.get(process.returncode, TaborError)(message)
    return printed


def _messages(said: str | None, tell: Callable[[str], str]) -> list[tuple[str, str]]:
    """Kind and words of each message of the program; nobody called it by options."""
    return [(kind, tell(text.replace("\n  ", "\n").replace(" with --out", ""))) for kind, text in MESSAGE.findall(said or "")]


def devices() -> str:
    """What this machine can compute on, and which of it ``backend="auto"`` takes."""
    return call(["devices"], True).rstrip()
