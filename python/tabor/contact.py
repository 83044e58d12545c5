"""A contact of arrays: heights, solid, law, boundary."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from .scene import Scene, field


@dataclass(frozen=True)
class MaugisDugdale:
    """A constant tension over a range; give two of work of adhesion, range and peak tension.

    ``taper`` is the interval of the gap over which the tension falls to 0.
    """

    work_of_adhesion: float | str | None = None
    range: float | str | None = None
    peak_tension: float | str | None = None
    taper: float | str | None = None

    def table(self) -> dict[str, Any]:
        """The keys of ``[adhesion]``."""
        return {"law": "maugis-dugdale", **vars(self)}


@dataclass(frozen=True)
class LennardJones:
    """Attraction and repulsion from the 9-3 potential of surfaces; give two of the three."""

    work_of_adhesion: float | str | None = None
    range: float | str | None = None
    peak_tension: float | str | None = None

    def table(self) -> dict[str, Any]:
        """The keys of ``[adhesion]``."""
        return {"law": "lennard-jones", **vars(self)}


@dataclass(frozen=True)
class Exponential:
    """A tension that decays exponentially with the gap; give two of the three."""

    work_of_adhesion: float | str | None = None
    range: float | str | None = None
    peak_tension: float | str | None = None

    def table(self) -> dict[str, Any]:
        """The keys of ``[adhesion]``."""
        return {"law": "exponential", **vars(self)}


class Contact(Scene):
    """A rough, rigid counter-face over an elastic solid.

    Parameters
    ----------
    heights : array of shape (ny, nx)
        Heights in metres, positive towards the solid. The numbers are copied once.
    size : number or text, or two of them
        Lengths of the cell along x and y.
    contact_modulus : number or text, optional
        E*, with the counter-face's share; or give `solid`.
    law : MaugisDugdale, LennardJones or Exponential, optional
        The attraction; without one a hard wall is all there is.
    boundary : {"periodic", "free"}
        What lies beyond the edge.
    solid, solver, **tables : mappings, optional
        Further keys of ``[solid]``, ``[solver]`` and of any other table of a scene, such as
        ``friction={"shear_strength": "10 MPa"}``.
    treatment, rate, adhesion_map : optional
        Effects of the adhesion.
    spring : number or text, optional
        Stiffness of a spring between the prescribed approach and the body.
    tolerance, max_iterations, precision, backend : optional
        Keys of ``[solver]``.
    threads : int, optional
        Threads of the processor.
    """

    def __init__(
        self,
        heights: Any,
        size: Any,
        *,
        contact_modulus: float | str | None = None,
        law: MaugisDugdale | LennardJones | Exponential | None = None,
        boundary: str = "periodic",
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
