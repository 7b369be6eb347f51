"""Run independent pieces of work on several threads."""

import os
from collections.abc import Callable, Iterable
from concurrent.futures import ThreadPoolExecutor
from typing import Any


def on_threads(function: Callable, items: Iterable, threads: int | None = None) -> list[Any]:
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

    Returns
    -------
    list
        The results in the order of the items.
    """
    with ThreadPoolExecutor(threads or os.cpu_count()) as pool:
        return list(pool.map(function, items))
