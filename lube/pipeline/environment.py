"""The environment of all jobs: the package of this folder, and the same digits everywhere."""

import os
from pathlib import Path

AVX512 = "X86_V4 AVX512F AVX512CD AVX512_SKX AVX512_CLX AVX512_CNL AVX512_ICL AVX512_SPR"
"""NumPy's names for its AVX-512 functions, in version 2.4 and before."""


def compute_alike() -> None:
    """Make NumPy do without its functions for AVX-512, here and in processes started from here.

    These functions round the last digits differently from NumPy's functions for other processors.
    The setting takes effect only before NumPy is imported, so this module and `lube.cli` import
    nothing that imports NumPy. A value set by the user is kept.
    """
    os.environ.setdefault("NPY_DISABLE_CPU_FEATURES", AVX512)


def use_package(root: str | Path) -> None:
    """Make processes started from here import the package of one folder, not an installed one.

    Parameters
    ----------
    root : str or Path
        Folder of the Snakefile.
    """
    paths = [str(root), os.environ.get("PYTHONPATH")]
    os.environ["PYTHONPATH"] = os.pathsep.join(filter(None, paths))
