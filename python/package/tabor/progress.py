"""How far a solve is: a bar by tqdm, or what the caller gives."""

from __future__ import annotations

import warnings
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any

Report = Callable[[int, int, float], None]


@contextmanager
def reporter(progress: Any) -> Iterator[Report | None]:
    """What is called with finished steps, iteration and residual; None for nobody."""
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
    with tqdm(unit=" iterations", leave=False) as bar:

        def tell(finished: int, iteration: int, residual: float) -> None:
            bar.set_description(f"{finished} steps")
            bar.set_postfix_str(f"residual {residual:.1e}")
            bar.n = iteration
            bar.refresh()

        yield tell
