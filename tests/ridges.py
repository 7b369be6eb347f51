"""Measured maps of surfaces with a lay, drawn from a known spectrum."""

from collections.abc import Callable

import numpy as np
import scipy

from lube.surfaces.lay import unstretched
from lube.surfaces.topography import Topography
from lube.types import Array

LENGTH, ROLL_OFF, RMS = 1e-3, 1e-4, 0.2e-6
"""Measured length, wavelength of the roll-off and rms height, m."""


def stretched_map(
    ratio: float, angle: float, seed: int, points: int = 512, hurst: float = 0.7
) -> tuple[Topography, Callable[[Array], Array]]:
    """Draw a map of ridges, cut from a larger periodic one.

    Parameters
    ----------
    ratio : float
        Length of the ridges over their width.
    angle : float
        Angle between ridges and rolling, degrees.
    seed : int
        Seed of the heights.
    points : int
        Points along either side.
    hurst : float
        Hurst exponent.

    Returns
    -------
    surface : Topography
        The map.
    density : callable
        Density of the line of its isotropic surface, m^3, at wave vectors, rad/m.
    """
    number, spacing = 2 * points, LENGTH / points
    along = 2 * np.pi * np.fft.fftfreq(number, spacing)[:, None]
    across = 2 * np.pi * np.fft.rfftfreq(number, spacing)
    own = unstretched(along, across, ratio, angle)

    def shape(q):
        return np.maximum(q * ROLL_OFF / (2 * np.pi), 1.0) ** (-2 * hurst - 2)

    # All waves that the spectrum may have, and some shorter ones.
    power = np.where(np.hypot(along, across) < 0.8 * np.pi / spacing, shape(own), 0.0)
    power[0, 0] = 0.0
    noise = np.random.default_rng(seed).normal(size=(number, number))
    heights = scipy.fft.irfft2(np.fft.rfft2(noise) * np.sqrt(power), noise.shape)
    weights = np.where(across > 0.0, 2.0, 1.0)
    # White noise of variance 1 has this mean square after the filter.
    mean_square = np.sum(weights * power) / number**2
    heights *= RMS / np.sqrt(mean_square)
    cell = (2 * np.pi / (number * spacing)) ** 2
    level = RMS**2 / np.sum(weights * power) / cell
    surface = Topography("ridges.x3p", heights[:points, :points], (spacing,) * 2)
    return surface, lambda q: 2 * np.pi * q * shape(q) * level / ratio
