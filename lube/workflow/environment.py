"""The environment of all jobs: the package of this folder, and the same digits everywhere."""

import os
from pathlib import Path

AVX512 = "X86_V4 AVX512F AVX512CD AVX512_SKX AVX512_CLX AVX512_CNL AVX512_ICL AVX512_SPR"
"""NumPy's names for its AVX-512 functions, in version 2.4 and before."""


def prepare_environment(root: str | Path) -> None:
    """Set environment variables for all processes started from this one.

    Jobs and notebooks import the package from `root`, even if another clone is installed. NumPy
    does without its functions for AVX-512, because they round the last digits differently from
    those for other processors; a value set by the user is kept.

    Parameters
    ----------
    root : str or Path
        Folder of the Snakefile.
    """
    paths = [str(root), os.environ.get("PYTHONPATH")]
    os.environ["PYTHONPATH"] = os.pathsep.join(filter(None, paths))
    os.environ.setdefault("NPY_DISABLE_CPU_FEATURES", AVX512)
