"""The program ``tabor``: ``python -m tabor run scene.toml``."""

from __future__ import annotations

import sys

from ._tabor import command_line


def main() -> int:
    """Runs the command line of this process and returns its exit code."""
    return command_line(["tabor", *sys.argv[1:]])


if __name__ == "__main__":
    sys.exit(main())
