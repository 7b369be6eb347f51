"""The same last digits on all processors."""

import os

AVX512 = "X86_V4 AVX512F AVX512CD AVX512_SKX AVX512_CLX AVX512_CNL AVX512_ICL AVX512_SPR"
"""What NumPy calls its functions for AVX-512: names of version 2.4, and those before."""


def compute_alike():
    """Keep NumPy from its functions for AVX-512, here and in all processes begun from here.

    They round otherwise than those for other processors, in the last digits. It takes effect
    where NumPy has not been imported yet, and leaves a choice of the user's as it is.
    """
    os.environ.setdefault("NPY_DISABLE_CPU_FEATURES", AVX512)
