"""Random phases and exact heights: what a roughness line needs around its Fourier transform."""

import math

import numpy as np

from lube.kernels.compiler import kernel

PHASES = 2**16
_ANGLES = 2.0 * math.pi * np.arange(PHASES) / PHASES
# Rounded to single precision, the directions are the same on every machine, which sines and
# cosines computed line by line would not be. So fine a wheel cannot be told from a circle.
_WHEEL = (np.cos(_ANGLES) + 1j * np.sin(_ANGLES)).astype(np.complex64)


def random_directions(generator, count):
    """Draw unit phasors with random phases.

    Parameters
    ----------
    generator : numpy.random.Generator
        Source of randomness.
    count : int
        How many.

    Returns
    -------
    numpy.ndarray
        Shape (count,), complex64, of modulus one.
    """
    return _WHEEL[generator.integers(0, PHASES, count, dtype=np.uint16)]


@kernel
def whole_steps(heights):
    """Round heights, already in units of the step, to whole steps.

    Parameters
    ----------
    heights : numpy.ndarray
        Shape (N,), float32, heights over the height step.

    Returns
    -------
    numpy.ndarray
        Shape (N,), int32.
    """
    steps = np.empty(heights.size, np.int32)
    for i in range(heights.size):
        steps[i] = np.int32(np.rint(heights[i]))
    return steps
