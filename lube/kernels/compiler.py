"""Compiler flags of all kernels, and the folder that keeps their machine code.

Numba compiles a cached function anew when the function's own file has changed, but not when a
helper compiled into it, from another file, has: a new criterion in `layer.py` would silently go on
giving the old results. So every version of the kernels' sources gets a cache folder of its own.
"""

import hashlib
import os
from collections.abc import Callable
from pathlib import Path

import numba


def _cache_folder(sources: Path) -> str:
    """Cache folder for the present version of the sources; Numba's own if they are read-only."""
    if not os.access(sources, os.W_OK):
        return numba.config.CACHE_DIR
    text = b"".join(path.read_bytes() for path in sorted(sources.glob("*.py")))
    root = Path(numba.config.CACHE_DIR or sources / "__pycache__")
    return str(root / hashlib.sha256(text).hexdigest()[:16])


_CACHE_FOLDER = _cache_folder(Path(__file__).parent)


def kernel(function: Callable, **options) -> Callable:
    """Compile a kernel.

    Parameters
    ----------
    function : callable
        Plain Python on numbers and NumPy arrays.
    **options
        Further options of `numba.njit`.

    Returns
    -------
    callable
        The compiled function. Its machine code is cached on disk; it releases Python's global
        lock; arithmetic is strict IEEE (no fast-math), and a division by zero gives infinity.
    """
    # Numba reads this setting while it decorates. Put back at once, it concerns no other function.
    users_folder = numba.config.CACHE_DIR
    numba.config.CACHE_DIR = _CACHE_FOLDER
    try:
        return numba.njit(cache=True, nogil=True, error_model="numpy", **options)(function)
    finally:
        numba.config.CACHE_DIR = users_folder


def inlined(function: Callable) -> Callable:
    """Compile a small helper into each kernel that calls it; else as `kernel`."""
    return kernel(function, inline="always")
