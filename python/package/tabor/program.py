"""The program tabor in a process of its own."""

from __future__ import annotations

import contextlib
import os
import re
import sys
import warnings
from collections.abc import Callable, Sequence
from pathlib import Path

from .errors import OutputError, SceneError, TaborError, TaborWarning

#: Exit codes of the command line: 3 is a case that did not converge, which its table shows.
CLASSES: dict[int, type[TaborError]] = {1: OutputError, 2: SceneError}
NOT_CONVERGED = 3

#: The program of this very package, wherever it lies and wherever the process starts.
PROGRAM = "import sys; sys.path[0] = sys.argv.pop(1); from tabor.__main__ import main; sys.exit(main())"
PACKAGE = os.fspath(Path(__file__).parents[1])


#: A message of the program, whose further lines are indented.
MESSAGE = re.compile(r"^(warning|error): (.*(?:\n  .*)*)", re.MULTILINE)


def call(words: Sequence[str], quiet: bool, tell: Callable[[str], str] = str) -> str:
    """Runs the command line in a process of its own and returns what it printed.

    Where it is quiet its warnings are those of who called the caller; messages are told by `tell`. Whatever ends the wait
    ends the process too: Ctrl-C as in a terminal, after which the process says what it has kept, anything else, and a
    second Ctrl-C, sooner.
    """
    # Where it is first called for: these take longer to import than all of this package.
    import signal
    import subprocess

    output = subprocess.PIPE if quiet else None
    # Its own signals: Ctrl-C reaches it through this process alone, whether a terminal or a notebook sent it.
    process = subprocess.Popen(
        [sys.executable, "-c", PROGRAM, PACKAGE, *words],
        stdout=subprocess.PIPE,
        stderr=output,
        # Whatever the locale.
        encoding="utf-8",
        errors="replace",
        start_new_session=True,
    )
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
                    warnings.warn(text, TaborWarning, stacklevel=3)
        raise
    messages = _messages(said, tell)
    for kind, text in messages:
        if kind == "warning":
            warnings.warn(text, TaborWarning, stacklevel=3)
    if process.returncode not in (0, NOT_CONVERGED):
        message = "\n".join(text for kind, text in messages if kind == "error") or (said or "").strip() or f"tabor {words[0]} ended with {process.returncode}"
        raise CLASSES.get(process.returncode, TaborError)(message)
    return printed


def _messages(said: str | None, tell: Callable[[str], str]) -> list[tuple[str, str]]:
    """Kind and words of each message of the program; nobody called it by options."""
    return [(kind, tell(text.replace("\n  ", "\n").replace(" with --out", ""))) for kind, text in MESSAGE.findall(said or "")]


def devices() -> str:
    """What this machine can compute on, and which of it ``backend="auto"`` takes."""
    return call(["devices"], True).rstrip()
