"""The one place where compiler flags live."""

import numba

kernel = numba.njit(cache=True, nogil=True, error_model="numpy")
"""Compile a kernel: cached on disk, strict IEEE arithmetic (no fast-math)."""

inlined = numba.njit(cache=True, nogil=True, error_model="numpy", inline="always")
"""Compile a small helper into each kernel that calls it."""
