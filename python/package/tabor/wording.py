"""Messages about scenes, told to who writes Python.

A contact is a scene to the solver, whose messages name the keys of a scene file and lines to write there. Its author gave
arguments: they hear of these.
"""

from __future__ import annotations

import difflib
import inspect
import re
from collections.abc import Mapping

#: Keys whose argument is called the same.
SAME = {
    "solid": (
        "contact_modulus",
        "young_modulus",
        "poisson_ratio",
        "counter_young_modulus",
        "counter_poisson_ratio",
        "thickness",
        "base",
        "hardness",
        "relaxation",
    ),
    "adhesion": ("law", "treatment", "rate"),
    "loading": ("spring",),
    "solver": ("tolerance", "max_iterations", "precision", "backend"),
    "grid": ("points", "size", "boundary"),
}

#: The arguments of a contact by the keys that they set. One that ends with a dot is an object with attributes.
CONTACT = {f"{table}.{key}": key for table, keys in SAME.items() for key in keys} | {
    "grid": "size",
    "surface": "heights",
    "adhesion": "law.",
    "adhesion.map": "adhesion_map",
}

#: How long each load takes, of a path whose loads are given.
SECONDS = "give seconds, the time that each load but the first takes"

#: Phrases of scene files, and what they are where the loads of a path are given.
OF_LOADS = (
    ('give start and [[loading.ramp]] with duration = "1 s" (or hold = "1 s")', SECONDS),
    ('give start and [[loading.ramp]] with a duration above 0, such as duration = "1 s"', SECONDS),
)

#: Phrases of scene files and what they are in Python; longer ones stand before those that they hold.
PHRASES = (
    ('law = "maugis-dugdale" or "exponential"', "MaugisDugdale or Exponential"),
    ('law = "maugis-dugdale"', "MaugisDugdale"),
    ('law = "lennard-jones"', "LennardJones"),
    ('law = "exponential"', "Exponential"),
    ('control = "pressure" or "force"', "pressure or force"),
    ('control = "approach"', "approach"),
    ('control = "mean-gap"', "mean_gap"),
    ('take "force" or "approach"', "take force or approach"),
    ("`[[loading.ramp]]` with `to` and `steps`", '`"ramp": [{"to": "10 MPa", "steps": 10}]`'),
    ("`[[solid.relaxation]]`", '`relaxation=[{"modulus": "1 MPa", "time": "10 ms"}]`'),
    ('[[surface]] with kind = "sphere" and radius = "1 um"', 'Sphere("1 um")'),
    ("an array of tables", "a list of mappings"),
    ("a list of tables", "a list of mappings"),
    ("a table", "a mapping"),
    ("a text in quotes", "a text"),
    ("a word in quotes", "a text"),
    ("true or false is expected", "True or False is expected"),
    ("the truth value true", "True"),
    ("the truth value false", "False"),
    ("[[solid.relaxation]]", "relaxation"),
    ("[grid] ", ""),
    ("; a key of this name belongs in the scene itself", ""),
    ("take it out of the scene", "leave it out"),
    ("--backend cpu", 'backend="cpu"'),
    ("[[loading.ramp]]", "ramp"),
    ("[adhesion] rate", "rate"),
    ("[adhesion] map :", "adhesion_map:"),
    ("[adhesion] map ", "adhesion_map "),
    ("[adhesion] is given too", "a law is given too"),
    ("leave [adhesion] out", "leave the law out"),
    ("of adhesion.map", "of adhesion_map"),
    ("solver.tolerance", "tolerance"),
    ("grid.size", "size"),
    ("grid.points: ", ""),
    ("; a path in a scene is relative to the folder of the scene file", ""),
    (", relative to the scene file", ""),
)

#: A table of a kind of part.
KIND = re.compile(r"\ba (self-affine|sphere|cone|wavy|flat|file) \[\[surface\]\]")
#: A table by its head.
HEAD = re.compile(r"\[\[?([a-z]\w*)\]?\]")
#: A table as the example of itself, which says nothing without its head.
ITSELF = re.compile(r"; write for example `\[+(?!solid)[\w.]+\]+`")
#: The part of a surface that a message begins with.
PART = re.compile(r"\[\[surface\]\] (\d+)")
#: A table in a line.
INLINE = re.compile(r"\{ (\w+ = [^{}]*) \}")
#: A key with its value, but no statement of a length in m.
LINE = re.compile(r"\b([a-z]\w*) = (?=[\"\[{]|(?:[\d.e+-]+|true|false)(?:[^-+\w\s.]|\.?$))")
#: The words of a key that nothing knows, at the top of a scene.
UNKNOWN = "unknown key in the scene itself"


class Wording:
    """Tells messages about a scene whose values were given as arguments.

    Parameters
    ----------
    names : mapping
        The arguments by the keys of a scene, dotted, that they set; a key without one is its own name.
    in_python : bool
        Whether the author wrote Python alone, and no keys of a scene.
    load : str, optional
        The argument of the loads of a path.
    """

    def __init__(self, names: Mapping[str, str], in_python: bool = True, load: str | None = None) -> None:
        self.names = dict(names)
        self.in_python = in_python
        self.load = load

    def of_loads(self, load: str) -> Wording:
        """The same of a path whose loads are given as this argument."""
        return Wording(self.names, self.in_python, load)

    def argument(self, key: str) -> str:
        """What set a key: an argument, and the place in it as Python writes it."""
        segments = key.split(".")
        if self.load is not None and segments[0] == "loading" and key != "loading.spring":
            return "seconds" if segments[-1] in ("duration", "hold") else self.load
        if not self.in_python:
            return key
        known = (count for count in range(len(segments), 0, -1) if ".".join(segments[:count]) in self.names)
        count = next(known, 0)
        name = self.names[".".join(segments[:count])] if count else segments[0]
        within = segments[max(count, 1) :]
        if name.endswith("."):
            name = name + within.pop(0) if within else name[:-1]
        return name + "".join(f"[{each}]" if each.isdecimal() else f'["{each}"]' for each in within)

    def words(self, text: str) -> str:
        """A message in Python's words."""
        if self.load is not None:
            for scene, python in OF_LOADS:
                text = text.replace(scene, python)
        if not self.in_python:
            return text
        text = ITSELF.sub("", text)
        text = KIND.sub(r"a part of kind \1", text)
        text = PART.sub(lambda part: self._part(int(part[1]) - 1), text)
        for scene, python in PHRASES:
            text = text.replace(scene, python)
        text = INLINE.sub(lambda table: "{" + re.sub(r"(\w+) = ", r'"\1": ', table[1]) + "}", text)
        text = HEAD.sub(lambda head: self.names.get(head[1], head[1]).rstrip("."), text)
        return LINE.sub(r"\1=", text)

    def __call__(self, key: str, text: str) -> str:
        """A message about a key, or about none where that is empty."""
        if not key:
            return self.words(text)
        if self.in_python and UNKNOWN in text:
            return f"{key}: {self._unknown(key, text)}"
        name = self.argument(key)
        if self.load is not None and "needs durations" in text:
            name = "seconds"
        return f"{name}: {self.words(text)}"

    def _part(self, index: int) -> str:
        """The part of a surface, by its number from 0."""
        return self.argument(f"surface.{index}")

    def _unknown(self, name: str, text: str) -> str:
        """That a contact has no such argument; `text` lists the tables of a scene."""
        from .contact import Contact

        arguments = [each for each in inspect.signature(Contact).parameters if each != "tables"]
        tables = [each for each in text.rpartition("takes ")[2].partition(";")[0].split(", ") if each not in (*SAME, "surface")]
        near = difflib.get_close_matches(name, [*arguments, *tables], 1)
        meant = f"; did you mean {near[0]}? It" if near else "; it"
        return f"unknown argument of a contact{meant} takes those of help(tabor.Contact), and {', '.join(tables)}"
