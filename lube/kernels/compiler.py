"""The one place where compiler flags live, and where compiled kernels are kept."""

import hashlib
import os
from pathlib import Path

import numba


def _keep_apart_by_source(folder):
    """Keep the machine code of every version of the kernels in a place of its own.

    Numba compiles a kernel anew when the kernel's own file has changed, but not when a helper
    compiled into it, in another file, has: a new criterion in `layer.py` would silently go on
    giving the old results. Where the files cannot be written they cannot be changed either.
    """
    if not os.access(folder, os.W_OK):
        return
    sources = b"".join(path.read_bytes() for path in sorted(folder.glob("*.py")))
    root = Path(numba.config.CACHE_DIR or folder / "__pycache__")
    numba.config.CACHE_DIR = str(root / hashlib.sha256(sources).hexdigest()[:16])


_keep_apart_by_source(Path(__file__).parent)

kernel = numba.njit(cache=True, nogil=True, error_model="numpy")
"""Compile a kernel: cached on disk, strict IEEE arithmetic (no fast-math)."""

inlined = numba.njit(cache=True, nogil=True, error_model="numpy", inline="always")
"""Compile a small helper into each kernel that calls it."""
