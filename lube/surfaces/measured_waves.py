"""Waves of measured heights: their powers through a Hann window, by bins, and by direction.

A Hann window of mean square one keeps the jump between opposite edges out of the spectrum. It
blurs the two or three longest waves, so bins begin at `LEAST_WAVES` on the measured length.
"""

import math
from collections.abc import Callable

import numpy as np
import scipy

from lube.surfaces.spectra import power_spectrum
from lube.types import Array, Pair

LEAST_WAVES = 2
"""A wave that fits fewer times into the measured length is left out."""

BINS_PER_DECADE = 20
"""Densities are means over bins of this width, or of one wave where waves are fewer."""

LEAST_WAVES_OF_RING = 50
"""Fewest waves of a ring that counts for the `anisotropy`."""


def profile_density(heights: Array, spacing: float) -> Pair:
    """One-sided density of a profile, through a Hann window.

    Parameters
    ----------
    heights : numpy.ndarray
        Shape (n,), m, of mean zero.
    spacing : float
        Distance of neighbouring points, m.

    Returns
    -------
    wave_vector, density : numpy.ndarray
        Shape (n // 2,), rad/m and m^3.

    Examples
    --------
    >>> wave = np.sin(2 * np.pi * np.arange(1000) / 50)
    >>> wave_vector, density = profile_density(wave, 1.0)
    >>> f"{np.sum(density) * wave_vector[0]:.4f}"
    '0.5000'
    """
    return power_spectrum(hann(heights.size) * heights, spacing)


def map_power(heights: Array) -> Array:
    """Mean square height of every wave of a map, through a Hann window in both directions.

    Parameters
    ----------
    heights : numpy.ndarray
        Shape (nx, ny), m, of mean zero.

    Returns
    -------
    numpy.ndarray
        Shape (nx, ny // 2 + 1), m^2, in the order of ``numpy.fft.rfft2``; each value of the half
        plane stands for both waves of opposite wave vectors, and their sum is the mean square
        height seen through the window.

    Examples
    --------
    >>> wave = np.add.outer(np.zeros(60), np.sin(2 * np.pi * np.arange(80) / 10))
    >>> f"{map_power(wave).sum():.4f}"
    '0.5000'
    """
    rows, columns = heights.shape
    spectrum = scipy.fft.rfft2(
        heights * hann(rows)[:, None] * hann(columns), overwrite_x=True, norm="forward"
    )
    power = spectrum.real**2
    power += spectrum.imag**2
    power[:, 1 : (columns + 1) // 2] *= 2.0
    power[0, 0] = 0.0
    return power


def hann(points: int) -> Array:
    """Hann window of mean square one, shape (points,).

    Examples
    --------
    >>> f"{np.mean(hann(100) ** 2):.12f}"
    '1.000000000000'
    """
    return math.sqrt(8.0 / 3.0) * np.sin(np.pi * np.arange(points) / points) ** 2


def wave_vectors(power: Array, lengths: Pair) -> Pair:
    """Wave vectors along both axes of a map.

    Parameters
    ----------
    power : numpy.ndarray
        From `map_power`, shape (nx, ny // 2 + 1).
    lengths : tuple of float
        Measured length in both directions, m.

    Returns
    -------
    along, across : numpy.ndarray
        Shapes (nx, 1) and (ny // 2 + 1,), rad/m.
    """
    rows, columns = power.shape
    along = 2.0 * np.pi / lengths[0] * scipy.fft.fftfreq(rows, 1.0 / rows)
    return along[:, None], 2.0 * np.pi / lengths[1] * np.arange(columns)


def sums_by_bin(wave_vector: Array, length: float, q_max: float) -> Callable[..., Array]:
    """Return a function that sums values, or counts them, in bins of the wave vector.

    At least one multiple of 2 pi / length lies in each bin. Values outside all bins are left out.

    Parameters
    ----------
    wave_vector : numpy.ndarray
        Of each value, rad/m.
    length : float
        Measured length, m.
    q_max : float
        Largest wave vector, rad/m.

    Returns
    -------
    callable
        Takes values in the shape of `wave_vector`, or none to count them; returns an array of the
        number of bins.
    """
    step, growth = 2.0 * np.pi / length, 10.0 ** (1.0 / BINS_PER_DECADE)
    edges = [(LEAST_WAVES - 0.5) * step]
    while (following := max(edges[-1] + step, edges[-1] * growth)) <= q_max * (1.0 + 1e-9):
        edges.append(following)
    inside = np.digitize(wave_vector, edges).ravel()

    def sums(values=None):
        values = None if values is None else values.ravel()
        return np.bincount(inside, values, len(edges) + 1)[1:-1]

    return sums


def anisotropy(power: Array, lengths: Pair, q_max: float) -> tuple[float, float]:
    r"""Measure how far the spectrum of a map depends on the direction.

    .. math:: A\, e^{2 i \theta_0} = \left\langle \frac{\sum P e^{2 i \theta}}{\sum P}
        \right\rangle

    The sums are over the waves of directions :math:`\theta` in a ring of wave vectors, and the
    mean is over rings of equal logarithmic width.

    Parameters
    ----------
    power, lengths
        As in `wave_vectors`.
    q_max : float
        Largest wave vector, rad/m, at most pi over the wider spacing.

    Returns
    -------
    measure : float
        0 if isotropic, 1 if all waves have one direction.
    direction : float
        Direction of the strongest waves from the first axis, rad, between -pi/2 and pi/2; the
        lay is perpendicular to it.

    Examples
    --------
    >>> rows = np.random.default_rng(1).normal(size=128)
    >>> power = map_power(np.outer(rows, np.ones(128)))
    >>> "{:.2f} {:.2f}".format(*anisotropy(power, (128.0, 128.0), 1.5))
    '1.00 0.00'
    """
    along, across = wave_vectors(power, lengths)
    sums = sums_by_bin(np.hypot(along, across), min(lengths), q_max)
    total, cosine, sine = map(sums, _double_angle(power, along, across))
    # Rings of few waves are left out: their scatter alone looks like a direction.
    many = (sums() >= LEAST_WAVES_OF_RING) & (total > 0)
    if not many.any():
        return 0.0, 0.0
    cosine, sine = (np.mean(part[many] / total[many]) for part in (cosine, sine))
    return float(np.hypot(cosine, sine)), 0.5 * float(np.arctan2(sine, cosine))


def _double_angle(power, along, across):
    """Yield power, and power times the cosine and the sine of twice the direction."""
    yield power
    square = along**2 + across**2
    square[0, 0] = 1.0
    weighted = power / square
    yield weighted * (along**2 - across**2)
    yield weighted * (2.0 * along * across)
