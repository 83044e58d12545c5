"""Whole curves of theories, as the command line prints them."""

from __future__ import annotations

import re
from collections.abc import Mapping
from typing import Any

import numpy as np
import numpy.typing as npt

from .. import _tabor
from ..errors import TheoryError
from ..tables import structured


class Table:
    """A table of a theory: ``table("jkr", ...)["force"]`` is a column.

    Attributes
    ----------
    rows : structured ndarray
        The columns by their names, SI.
    units : dict
        The unit of each column.
    notes : dict
        Numbers beside the table, such as ``pull_off_force``.
    """

    def __init__(self, text: str) -> None:
        lines = text.splitlines()
        comments = [line[1:].strip() for line in lines if line.startswith("#")]
        columns = next((line for line in comments if line.startswith("columns: ")), "")
        units = re.findall(r"([a-z0-9_]+)(?: \[([^]]*)\])?", columns.removeprefix("columns: "))
        self.units: dict[str, str] = dict(units)
        self.rows: npt.NDArray[np.void] = structured([line.split(",") for line in lines if not line.startswith("#")])
        self.comments = comments
        self.notes: dict[str, float] = {}
        for line in comments:
            found = re.fullmatch(r"([a-z0-9_]+) = ([-+0-9.e]+)(?: .*)?", line)
            if found:
                self.notes[found[1]] = float(found[2])

    def __getitem__(self, name: str) -> npt.NDArray[Any]:
        column: npt.NDArray[Any] = self.rows[name]
        return column

    def __len__(self) -> int:
        return len(self.rows)

    def __repr__(self) -> str:
        return f"<Table of {len(self)} rows: {', '.join(self.units)}>"


#: Parameters that are angles.
ANGLES = frozenset({"half_angle"})


def table(model: str, parameters: Mapping[str, Any] | None = None, /, **more: Any) -> Table:
    """The curve of a model, as ``tabor theory MODEL`` prints it.

    Parameters
    ----------
    model : str
        Its name; ``print(models())`` lists them.
    parameters, **more
        The model's parameters by name, numbers in SI or texts with units; those of the name of a keyword of Python,
        such as ``from``, in the mapping.

    Examples
    --------
    >>> jkr = table("jkr", radius="1 um", contact_modulus="1 GPa", work_of_adhesion="50 mJ/m^2")
    >>> bool(jkr["force"].min() >= jkr.notes["pull_off_force"] * 1.0001)
    True
    """
    words = [model]
    for name, value in {**(parameters or {}), **more}.items():
        try:
            number = value if isinstance(value, (str, int, np.integer)) else repr(float(value))
            # The command line reads angles in degrees.
            unit = " rad" if name in ANGLES and not isinstance(value, str) else ""
            words.append(f"--{name}={number}{unit}")
        except (TypeError, ValueError):
            raise TheoryError(f"{name}: {value!r} is no number and no text with a unit") from None
    try:
        return Table(_tabor.theory_table(words))
    except TheoryError as error:
        raise TheoryError(_of_parameters(str(error))) from None


def _of_parameters(message: str) -> str:
    """A message about options of the command line as one about parameters."""
    message = re.sub(r'--([a-z_]+) ("[^"]*"|[-+0-9.]\S*)', r"\1=\2", message)
    message = re.sub(r'"?--([a-z_]+)"?', r"\1", message)
    return message.replace("tabor theory lists the models", "models() lists them")


def models() -> str:
    """The models and what they describe."""
    return _tabor.theory_table([])
