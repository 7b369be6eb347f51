"""Random phases and rounded heights: the steps around a roughness line's Fourier transform."""

import math

import numpy as np

from lube.kernels.compiler import kernel

PHASES = 2**16
"""Number of equally spaced phases from which the phasors are drawn."""

_ANGLES = 2.0 * math.pi * np.arange(PHASES) / PHASES
# Rounded to single precision, this table is the same on every machine. Sines and cosines computed
# for each line would not be.
_PHASORS = (np.cos(_ANGLES) + 1j * np.sin(_ANGLES)).astype(np.complex64)


def random_phasors(generator: np.random.Generator, count: int) -> np.ndarray:
    r"""Draw unit phasors :math:`e^{i \varphi}` with uniformly distributed random phases.

    Parameters
    ----------
    generator : numpy.random.Generator
        Source of randomness.
    count : int
        Number of phasors.

    Returns
    -------
    numpy.ndarray
        Shape (count,), complex64.

    Examples
    --------
    >>> phasors = random_phasors(np.random.default_rng(1), 3)
    >>> np.allclose(np.abs(phasors), 1.0)
    True
    """
    return _PHASORS[generator.integers(0, PHASES, count, dtype=np.uint16)]


def gaussian_phasors(generator: np.random.Generator, count: int) -> np.ndarray:
    """Draw complex Gaussian numbers with a mean square of one.

    Parameters
    ----------
    generator, count
        As in `random_phasors`.

    Returns
    -------
    numpy.ndarray
        Shape (count,), complex64.

    Examples
    --------
    >>> phasors = gaussian_phasors(np.random.default_rng(1), 10_000)
    >>> f"{np.mean(np.abs(phasors) ** 2):.1f}"
    '1.0'
    """
    parts = generator.standard_normal((count, 2), dtype=np.float32)
    return np.float32(math.sqrt(0.5)) * parts.view(np.complex64)[:, 0]


@kernel
def whole_steps(heights: np.ndarray) -> np.ndarray:
    """Round heights in units of the height step to whole height steps.

    Parameters
    ----------
    heights : numpy.ndarray
        Shape (N,), float32, heights over the height step.

    Returns
    -------
    numpy.ndarray
        Shape (N,), int32; halves are rounded to even.

    Examples
    --------
    >>> whole_steps(np.array([-1.6, 0.5, 2.51], np.float32)).tolist()
    [-2, 0, 3]
    """
    steps = np.empty(heights.size, np.int32)
    for i in range(heights.size):
        steps[i] = np.int32(np.rint(heights[i]))
    return steps
