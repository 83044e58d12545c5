"""A contact of arrays: heights, solid, law, boundary."""

from __future__ import annotations

import os
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, ClassVar

from .errors import SceneError, SurfaceError
from .quantities import Quantity
from .scene import Scene, control_at
from .surfaces import HeightFile, Surface, counts, is_part, names_of, sides, tables_of
from .topography import from_topography, is_topography
from .values import field
from .wording import CONTACT, Wording

#: Tables of a scene that a contact has arguments for.
TABLES = {
    "grid": "size, points and boundary",
    "surface": "heights",
    "adhesion": 'law, such as law=MaugisDugdale("50 mJ/m^2", range="5 nm")',
    "solver": "tolerance, max_iterations, precision and backend",
}


@dataclass(frozen=True)
class _Law:
    """What every law has."""

    work_of_adhesion: Quantity | None = None
    range: Quantity | None = None
    peak_tension: Quantity | None = None

    #: Its word in a scene.
    word: ClassVar[str]

    def table(self) -> dict[str, Any]:
        """The keys of ``[adhesion]``."""
        return {"law": self.word, **vars(self)}


@dataclass(frozen=True)
class MaugisDugdale(_Law):
    """A constant tension over a range; give two of work of adhesion, range and peak tension.

    ``taper`` is the interval of the gap over which the tension falls to 0.
    """

    taper: Quantity | None = None

    word: ClassVar[str] = "maugis-dugdale"


@dataclass(frozen=True)
class LennardJones(_Law):
    """Attraction and repulsion from the 9-3 potential of surfaces; give two of the three."""

    word: ClassVar[str] = "lennard-jones"


@dataclass(frozen=True)
class Exponential(_Law):
    """A tension that decays exponentially with the gap; give two of the three."""

    word: ClassVar[str] = "exponential"


class Contact(Scene):
    """A rough, rigid counter-face over an elastic solid.

    Parameters
    ----------
    heights : array of shape (ny, nx), a Surface, a file, a part or list of parts, or a Topography of SurfaceTopography
        Heights in metres, positive towards the solid; any array of numbers. One of float64 in C order is shared, not
        copied; of another type, such as float32, or in another order one copy is made, of float64, in which the solver reads
        heights whatever its precision. Refused are float16, whose steps are 60 nm and more in metres, truth values, and
        arrays with a unit other than m (of astropy, pint, unyt or xarray), which NumPy would drop. A shared array must stay as it is: once it has been written to, the contact
        refuses to solve, and to be checked, studied, copied or pickled. Give ``heights.copy()`` where you will go on writing. A file (its path, or a `HeightFile`) and
        parts such as ``Sphere("1 um")`` are what they are in a scene.
    size : number or text, or two of them
        Lengths of the cell along x and y, m; a Surface, a Topography and most files of instruments bring their own, a
        Topography its boundary too.
    points : int or (nx, ny), optional
        Points along x and y, where `heights` are parts; arrays and files have theirs.
    contact_modulus : number or text, optional
        E*, Pa, with the counter-face's share; or give `young_modulus` and `poisson_ratio`, or `solid`.
    young_modulus, counter_young_modulus : number or text, optional
        Of the solid and of the counter-face, Pa.
    poisson_ratio, counter_poisson_ratio : number, optional
        Of the solid and of the counter-face.
    law : MaugisDugdale, LennardJones or Exponential, optional
        The attraction; without one a hard wall is all there is.
    boundary : {"periodic", "free"}, optional
        What lies beyond the edge: the surface again, or nothing. Periodic unless told.
    thickness : number or text, optional
        Of a layer on a rigid base, m; needs `poisson_ratio`.
    base : {"bonded", "frictionless"}, optional
        How the layer lies on its base.
    hardness : number or text, optional
        Largest pressure that the solid carries, Pa.
    relaxation : list of mappings, optional
        Branches of a viscoelastic solid: ``[{"modulus": "1 MPa", "time": "10 ms"}]``.
    treatment : {"full", "dmt"}, optional
        Whether attraction deforms the contact, or is summed over the gap of the contact without it.
    rate : mapping, optional
        How the work of adhesion grows with the speed of a receding edge: the keys of ``[adhesion.rate]``.
    adhesion_map : array of shape (ny, nx), file or mapping, optional
        A factor on the tension of the law at each point, or truth values: whether the law acts there. An array is shared as the
        heights are, and a mapping is a pattern:
        ``{"pattern": "checker", "period": "1 um", "low": 0, "high": 1}``.
    spring : number or text, optional
        Stiffness of a spring between the prescribed approach and the body, N/m. The control of `loading` is then
        "approach", and no other one.
    tolerance, max_iterations : number, optional
        When a solve ends.
    precision : {"auto", "double", "mixed", "single"}, optional
    backend : {"auto", "cpu", "gpu"}, optional
    threads : int, optional
        Threads of the processor.
    solid : mapping, optional
        Further keys of ``[solid]``. One that is given as an argument too is refused, as is `spring` in `loading`.
    loading : mapping, optional
        The keys of ``[loading]``, for `run` and for `path` without loads.
    **tables
        Further tables of a scene: ``friction={"shear_strength": "10 MPa"}``, ``capillary={"humidity": 0.5}``, ``wear``,
        ``conductance``, ``leakage``, ``output``, ``title``.
    """

    def __init__(
        self,
        heights: Any,
        size: Any = None,
        *,
        points: Any = None,
        contact_modulus: Quantity | None = None,
        young_modulus: Quantity | None = None,
        poisson_ratio: float | None = None,
        counter_young_modulus: Quantity | None = None,
        counter_poisson_ratio: float | None = None,
        law: MaugisDugdale | LennardJones | Exponential | None = None,
        boundary: str | None = None,
        thickness: Quantity | None = None,
        base: str | None = None,
        hardness: Quantity | None = None,
        relaxation: Any = None,
        treatment: str | None = None,
        rate: Mapping[str, Any] | None = None,
        adhesion_map: Any = None,
        spring: Quantity | None = None,
        tolerance: float | None = None,
        max_iterations: int | None = None,
        precision: str | None = None,
        backend: str | None = None,
        threads: int | None = None,
        solid: Mapping[str, Any] | None = None,
        loading: Mapping[str, Any] | None = None,
        **tables: Any,
    ) -> None:
        if is_topography(heights):
            heights, own_size, own_boundary = from_topography(heights)
            size = own_size if size is None else size
            boundary = own_boundary if boundary is None else boundary
        if isinstance(heights, Surface):
            size = heights.size if size is None else size
            heights = heights.heights
        names = {}
        if isinstance(heights, (str, os.PathLike)):
            names = {"surface.0": "heights"}
            _refuse_no_file(heights, "heights")
            heights = HeightFile(heights)
        boundary = "periodic" if boundary is None else boundary
        for name in TABLES.keys() & tables:
            raise SceneError(f"{name}: a contact takes {TABLES[name]}")
        for name, table in (("solid", solid), ("loading", loading)):
            if table is not None and not isinstance(table, Mapping):
                raise SceneError(f"{name}: a mapping of the keys of [{name}] is expected, not {table!r}")
        if law is not None and not isinstance(law, _Law):
            raise SceneError(f'law: a law such as MaugisDugdale("50 mJ/m^2", range="5 nm") is expected, not {law!r}')
        if law is None:
            for name, value in (("treatment", treatment), ("rate", rate), ("adhesion_map", adhesion_map)):
                if value is not None:
                    raise SceneError(f"{name}: it needs a law, such as law=MaugisDugdale(...)")
        if law is not None:
            names["adhesion"] = f"{type(law).__name__}."
        adhesion = None if law is None else law.table() | {"treatment": treatment, "rate": rate}
        if adhesion is not None and isinstance(adhesion_map, Mapping):
            adhesion["map"], adhesion_map = adhesion_map, None
        elif adhesion is not None and isinstance(adhesion_map, (str, os.PathLike)):
            _refuse_no_file(adhesion_map, "adhesion_map")
            adhesion["map"], adhesion_map = os.path.abspath(adhesion_map), None
        grid: dict[str, Any] = {"size": size, "boundary": boundary}
        if is_part(heights):
            grid["points"] = None if points is None else counts(points)
            surface = tables_of(heights, None if size is None else min(sides(size, error=SceneError)), "heights")
            values, names = None, names_of(heights, "heights") | names
        else:
            if points is not None:
                raise SceneError("points: an array has its own; they are for parts such as Sphere")
            if size is None:
                raise SceneError("size: the lengths of the cell are expected")
            values = field(heights, "heights", "length")
            names |= {"surface.0": "heights", "grid.points": "heights"}
            rows, columns = values.shape
            grid["points"] = [columns, rows]
            surface = [{"kind": "flat"}]
        times = rate is not None or relaxation is not None or (solid or {}).get("relaxation") is not None
        instant = {"start": 0.0, "ramp": [{"hold": 1.0, "steps": 1}]} if times else {"path": [0.0]}
        control = control_at(boundary) if spring is None else "approach"
        loading = loading or {"control": control, **instant}
        if spring is not None:
            # A control of the author's stays: a spring refuses all but one.
            loading = _joined("loading", {"control": control, **loading}, {"spring": spring})
        of_solid = {
            "contact_modulus": contact_modulus,
            "young_modulus": young_modulus,
            "poisson_ratio": poisson_ratio,
            "counter_young_modulus": counter_young_modulus,
            "counter_poisson_ratio": counter_poisson_ratio,
            "thickness": thickness,
            "base": base,
            "hardness": hardness,
            "relaxation": relaxation,
        }
        scene = {
            "grid": grid,
            "solid": _joined("solid", solid or {}, of_solid),
            "surface": surface,
            "adhesion": adhesion,
            "loading": loading,
            "solver": {"tolerance": tolerance, "max_iterations": max_iterations, "precision": precision, "backend": backend},
            **tables,
        }
        self._of_tables(scene, Wording(CONTACT | names), values, adhesion_map, threads)


def _joined(name: str, table: Mapping[str, Any], arguments: Mapping[str, Any]) -> dict[str, Any]:
    """A table that was given as `name` with the arguments that are keys of it too."""
    given = {key: value for key, value in arguments.items() if value is not None}
    for key in given:
        if table.get(key) is not None:
            raise SceneError(f"{key}: given as an argument and in {name}; give one")
    return {**table, **given}


def _refuse_no_file(path: str | os.PathLike[str], argument: str) -> None:
    if not os.path.isfile(path):
        words = "is a folder" if os.path.isdir(path) else "there is no such file"
        raise SurfaceError(f"{argument}: {os.fspath(path)}: {words}")
