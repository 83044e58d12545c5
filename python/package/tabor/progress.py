"""How far a solve is: a bar by tqdm, or what the caller gives."""

from __future__ import annotations

import warnings
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any

Report = Callable[[int, int, float], None]


@contextmanager
def reporter(progress: Any, total: int | None = None) -> Iterator[Report | None]:
    """What is called with finished steps, of this total if it is known, iteration and residual; None for nobody."""
    if callable(progress):
        yield progress
        return
    if not progress:
        yield None
        return
    try:
        with warnings.catch_warnings():
            # A notebook without widgets has a bar of text.
            warnings.simplefilter("ignore")
            from tqdm.auto import tqdm
    except ImportError:
        yield None
        return
    with tqdm(unit=" loads", total=total, leave=False) as bar:

        def tell(finished: int, iteration: int, residual: float) -> None:
            bar.n = finished
            bar.set_postfix_str(f"iteration {iteration}, residual {residual:.1e}")

        yield tell
