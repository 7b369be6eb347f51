"""Steps before and after a line's Fourier transform: random phases, translated, rounded heights."""

import math

import numpy as np

from lube.kernels.compiler import kernel
from lube.types import Array

PHASES = 2**16
"""Number of equally spaced phases from which the phasors are drawn."""

_ANGLES = 2.0 * math.pi * np.arange(PHASES) / PHASES
# Rounded to single precision, this table is the same on every machine. Sines and cosines computed
# for each line would not be.
_PHASORS = (np.cos(_ANGLES) + 1j * np.sin(_ANGLES)).astype(np.complex64)


def random_phasors(generator: np.random.Generator, count: int) -> Array:
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


def gaussian_phasors(generator: np.random.Generator, count: int) -> Array:
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
def power_series(values: Array, coefficients: Array) -> Array:
    r"""Sum a power series without a constant term, :math:`\sum_{n \ge 1} c_n x^n`.

    Parameters
    ----------
    values : numpy.ndarray
        Shape (N,), x.
    coefficients : numpy.ndarray
        Shape (orders,), :math:`c_1, c_2, \ldots`

    Returns
    -------
    numpy.ndarray
        Shape (N,).

    Examples
    --------
    >>> power_series(np.array([1.0, 2.0]), np.array([3.0, 5.0]))
    array([ 8., 26.])
    """
    total = np.zeros(values.size)
    for first in range(0, values.size, 1024):  # stays in the processor's cache
        x, part = values[first : first + 1024], total[first : first + 1024]
        for n in range(coefficients.size - 1, -1, -1):
            for i in range(x.size):
                part[i] = (part[i] + coefficients[n]) * x[i]
    return total


@kernel
def translated_steps(heights: Array, curve: Array, reach: float, rms: float) -> Array:
    """Translate heights by a curve, and scale them to an rms height in whole height steps.

    Parameters
    ----------
    heights : numpy.ndarray
        Shape (N,), float32, of rms one.
    curve : numpy.ndarray
        Shape (nodes,), translated heights at equally spaced heights from -reach to reach; straight
        lines between them.
    reach : float
        Height at which the curve ends; heights beyond it are translated as this one.
    rms : float
        Rms height of the result, height steps.

    Returns
    -------
    numpy.ndarray
        Shape (N,), int32, of mean zero up to rounding.

    Examples
    --------
    >>> translated_steps(np.array([-1, 0, 1], np.float32), np.array([-9.0, 0.0, 3.0]), 3.0, 1e3)
    array([-1373,   392,   981], dtype=int32)
    """
    translated = np.empty(heights.size)
    last = curve.size - 1
    total, squares = 0.0, 0.0
    for i in range(heights.size):
        place = min(max((heights[i] / reach + 1.0) * 0.5 * last, 0.0), float(last))
        node = min(int(place), last - 1)
        height = curve[node] + (place - node) * (curve[node + 1] - curve[node])
        translated[i] = height
        total += height
        squares += height * height
    mean = total / heights.size
    scale = rms / math.sqrt(squares / heights.size - mean * mean)
    steps = np.empty(heights.size, np.int32)
    for i in range(heights.size):
        steps[i] = np.int32(np.rint((translated[i] - mean) * scale))
    return steps


@kernel
def mean_powers(line: Array) -> tuple[float, float, float]:
    """Mean square, cube and fourth power of a line's heights.

    Parameters
    ----------
    line : numpy.ndarray
        Shape (N,), height steps.

    Returns
    -------
    tuple of float
        The means.

    Examples
    --------
    >>> mean_powers(np.array([-1, 0, 4], np.int32))
    (5.666666666666667, 21.0, 85.66666666666667)
    """
    second = third = fourth = 0.0
    for i in range(line.size):
        height = float(line[i])
        square = height * height
        second += square
        third += square * height
        fourth += square * square
    return second / line.size, third / line.size, fourth / line.size
