"""Run independent pieces of work on several threads."""

import os
from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import ThreadPoolExecutor
from contextlib import contextmanager
from contextvars import ContextVar
from typing import Any

DELAY = 3.0
"""Seconds after which a progress bar appears; an answer that comes sooner needs none."""

_shows_progress = ContextVar("shows_progress", default=False)


@contextmanager
def progress_bars() -> Iterator[None]:
    """Show, in a terminal or a notebook, how far the work of `on_threads` has come."""
    token = _shows_progress.set(True)
    try:
        yield
    finally:
        _shows_progress.reset(token)


def on_threads(
    function: Callable, items: Iterable, threads: int | None = None, name: str = ""
) -> list[Any]:
    """Call a function for each of some items, such as the numbers of pairs.

    Kernels and linear algebra release Python's global lock, so the threads run in parallel.

    Parameters
    ----------
    function : callable
        A function of one item.
    items : iterable
        The items.
    threads : int, optional
        Number of threads, by default one for each core; it does not change the results.
    name : str, optional
        Name of the work, for a progress bar within `progress_bars`. Without it there is none.

    Returns
    -------
    list
        The results in the order of the items.
    """
    items = list(items)
    with ThreadPoolExecutor(threads or os.cpu_count()) as pool:
        found = pool.map(function, items)
        if name and _shows_progress.get():
            from tqdm.auto import tqdm  # slow to import

            bar = {"total": len(items), "delay": DELAY, "leave": False, "disable": None}
            return list(tqdm(found, name, **bar))
        return list(found)
