"""A contact of arrays: heights, solid, law, boundary."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, ClassVar

from .errors import SceneError
from .scene import Scene, field
from .surfaces import Surface
from .topography import from_topography, is_topography


@dataclass(frozen=True)
class _Law:
    """What every law has."""

    work_of_adhesion: float | str | None = None
    range: float | str | None = None
    peak_tension: float | str | None = None

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

    taper: float | str | None = None

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
    heights : array of shape (ny, nx), a Surface, or a Topography of SurfaceTopography
        Heights in metres, positive towards the solid; any array of numbers. One of float64 in C order is shared, not
        copied; of another type, such as float32, or in another order one copy is made, of float64, in which the solver reads
        heights whatever its precision. A shared array must stay as it is: once it has been written to, the contact
        refuses to solve. Give ``heights.copy()`` where you will go on writing.
    size : number or text, or two of them
        Lengths of the cell along x and y, m; a Surface and a Topography bring their own, this one its boundary too.
    contact_modulus : number or text, optional
        E*, with the counter-face's share; or give `solid`.
    law : MaugisDugdale, LennardJones or Exponential, optional
        The attraction; without one a hard wall is all there is.
    boundary : {"periodic", "free"}, optional
        What lies beyond the edge: the surface again, or nothing. Periodic unless told.
    hardness : number or text, optional
        Largest pressure that the solid carries, Pa.
    treatment : {"full", "dmt"}, optional
        Whether attraction deforms the contact, or is summed over the gap of the contact without it.
    rate : mapping, optional
        How the work of adhesion grows with the speed of a receding edge: the keys of ``[adhesion.rate]``.
    adhesion_map : array of shape (ny, nx), optional
        A factor on the tension of the law at each point; shared as the heights are.
    spring : number or text, optional
        Stiffness of a spring between the prescribed approach and the body, N/m.
    tolerance, max_iterations : number, optional
        When a solve ends.
    precision : {"auto", "double", "mixed", "single"}, optional
    backend : {"auto", "cpu", "gpu"}, optional
    solid : mapping, optional
        Further keys of ``[solid]``, such as those of a layer.
    loading : mapping, optional
        The keys of ``[loading]``, for `run` and for `path` without loads.
    **tables
        Further tables of a scene, such as ``friction={"shear_strength": "10 MPa"}``.
    threads : int, optional
        Threads of the processor.
    """

    def __init__(
        self,
        heights: Any,
        size: Any = None,
        *,
        contact_modulus: float | str | None = None,
        law: MaugisDugdale | LennardJones | Exponential | None = None,
        boundary: str | None = None,
        hardness: float | str | None = None,
        treatment: str | None = None,
        rate: dict[str, Any] | None = None,
        adhesion_map: Any = None,
        spring: float | str | None = None,
        tolerance: float | None = None,
        max_iterations: int | None = None,
        precision: str | None = None,
        backend: str | None = None,
        threads: int | None = None,
        solid: dict[str, Any] | None = None,
        loading: dict[str, Any] | None = None,
        **tables: Any,
    ) -> None:
        if is_topography(heights):
            heights, own_size, own_boundary = from_topography(heights)
            size = own_size if size is None else size
            boundary = own_boundary if boundary is None else boundary
        if isinstance(heights, Surface):
            size = heights.size if size is None else size
            heights = heights.heights
        boundary = "periodic" if boundary is None else boundary
        if law is not None and not isinstance(law, _Law):
            raise SceneError(f'law: a law such as MaugisDugdale("50 mJ/m^2", range="5 nm") is expected, not {law!r}')
        if size is None:
            raise SceneError("size: the lengths of the cell are expected")
        values = field(heights, "heights")
        rows, columns = values.shape
        adhesion = None if law is None else law.table() | {"treatment": treatment, "rate": rate}
        # A load that nobody asks for: paths bring their own.
        loading = loading or {"control": "force" if boundary == "free" else "pressure", "path": [0.0]}
        if spring is not None:
            loading = {**loading, "control": "approach", "spring": spring}
        super().__init__(
            {
                "grid": {"points": [columns, rows], "size": size, "boundary": boundary},
                "solid": {"contact_modulus": contact_modulus, "hardness": hardness, **(solid or {})},
                "surface": [{"kind": "flat"}],
                "adhesion": adhesion,
                "loading": loading,
                "solver": {"tolerance": tolerance, "max_iterations": max_iterations, "precision": precision, "backend": backend},
                **tables,
            },
            heights=values,
            adhesion_map=adhesion_map,
            threads=threads,
        )
