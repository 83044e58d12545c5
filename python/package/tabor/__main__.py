"""The program ``tabor``: ``python -m tabor run scene.toml``."""

from __future__ import annotations

import contextlib
import signal
import sys

from ._tabor import command_line


def main() -> int:
    """Runs the command line of this process and returns its exit code."""
    # Python's own handler of Ctrl-C waits until the program returns to its interpreter.
    if signal.getsignal(signal.SIGINT) is signal.default_int_handler:
        with contextlib.suppress(ValueError):  # only the main thread may
            signal.signal(signal.SIGINT, signal.SIG_DFL)
    return command_line(["tabor", *sys.argv[1:]])


if __name__ == "__main__":
    sys.exit(main())
