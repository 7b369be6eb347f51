"""Compiler flags of all kernels, and the folder that keeps their machine code.

Numba compiles a cached function anew when the function's own file has changed, but not when a
helper from another file, compiled into it, has: after a change of the criterion in `layer.py` the
kernels would silently give the old results. So every version of the kernels' sources gets its own
cache folder. Each edit of the kernels leaves an old one of about 3 MB behind, which may be deleted
at any time.
"""

import hashlib
import os
from collections.abc import Callable
from pathlib import Path

import numba


def _cache_folder(sources: Path) -> str:
    """Cache folder for the present sources; Numba's default if their folder is read-only."""
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
        The compiled function. Its machine code is cached on disk. It releases Python's global
        interpreter lock. Arithmetic is strict IEEE (no fast-math), and a division by zero gives
        infinity.
    """
    # Numba reads this setting while it decorates. It is restored at once, for all other functions.
    users_folder = numba.config.CACHE_DIR
    numba.config.CACHE_DIR = _CACHE_FOLDER
    try:
        return numba.njit(cache=True, nogil=True, error_model="numpy", **options)(function)
    finally:
        numba.config.CACHE_DIR = users_folder


def inlined(function: Callable) -> Callable:
    """Compile a small helper into each kernel that calls it, with the options of `kernel`."""
    return kernel(function, inline="always")
