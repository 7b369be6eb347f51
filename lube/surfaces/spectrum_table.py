"""The spectrum of a line as a table, with a power law between its values, and its power."""

from dataclasses import dataclass

import numpy as np
import scipy

from lube.errors import DataError
from lube.types import Array, Pair

TABLE_VALUES = 100
"""Number of values in a spectrum's table."""

_LAST = 5
"""Number of last densities whose slope continues a spectrum to its limit."""


@dataclass(frozen=True, eq=False)
class LineSpectrum:
    """Density of the line that stands for a measured surface.

    Attributes
    ----------
    name : str
        File or other name, for messages.
    wave_vector : numpy.ndarray
        Shape (n,), rising, rad/m.
    density : numpy.ndarray
        Shape (n,), m^3, one-sided.
    estimates : numpy.ndarray
        Shape (n,): number of independent estimates of which each density is the mean; the
        relative standard error is one over its square root.
    transfer : numpy.ndarray
        Shape (n,): fraction of the power that the Gaussian filters have left.
    isotropic : bool
        Whether the surface is isotropic, apart from its lay.
    limits : tuple of float, optional
        Smallest and largest wave vector that the densities are means over, rad/m; by default
        those of the first and the last density.
    lay_ratio, lay_angle : float
        Length of the ridges over their width, and their angle to rolling, degrees. With a lay,
        wave vectors and densities are those of the isotropic surface that is stretched.
    """

    name: str
    wave_vector: Array
    density: Array
    estimates: Array
    transfer: Array
    isotropic: bool
    limits: tuple[float, float] | None = None
    lay_ratio: float = 1.0
    lay_angle: float = 90.0


def band_table(spectrum: LineSpectrum, q_min: float, q_max: float) -> Pair:
    """Tabulate a spectrum within a band, for drawing lines.

    Parameters
    ----------
    spectrum : LineSpectrum
        The spectrum.
    q_min, q_max : float
        Smallest and largest wave vector, rad/m.

    Returns
    -------
    wave_vector, density : numpy.ndarray
        Shape (`TABLE_VALUES`,), equally spaced in the logarithm, rad/m and m^3; between them the
        density is a power law.

    Raises
    ------
    DataError
        If the spectrum does not cover the band, or is not positive in it.
    """
    begin, end = spectrum.limits or spectrum.wave_vector[[0, -1]]
    if q_min < begin * (1.0 - 1e-9):
        raise DataError(
            f"{spectrum.name}: got waves up to {2e3 * np.pi / begin:.3g} mm, half the measured "
            f"length, need waves up to {2e3 * np.pi / q_min:.3g} mm, the longest wavelength of the "
            "study"
        )
    if q_max > end * (1.0 + 1e-9):
        raise DataError(
            f"{spectrum.name}: got waves down to {2e6 * np.pi / end:.3g} µm, need waves down to "
            f"{2e6 * np.pi / q_max:.3g} µm, the shortest wavelength of the study"
        )
    if not np.all(spectrum.density > 0.0):
        raise DataError(f"{spectrum.name}: got a density of zero or less, need a positive spectrum")
    places, levels = np.log(spectrum.wave_vector), np.log(spectrum.density)
    # Up to half a bin beyond the last density the spectrum continues with the slope before it.
    away = places[-_LAST:] - np.mean(places[-_LAST:])
    slope = np.sum(away * levels[-_LAST:]) / np.sum(away**2)
    places = np.append(places, max(np.log(q_max), places[-1]) + 1e-9)
    levels = np.append(levels, levels[-1] + slope * (places[-1] - places[-2]))
    wave_vector = np.geomspace(q_min, q_max, TABLE_VALUES)
    return wave_vector, np.exp(np.interp(np.log(wave_vector), places, levels))


def power_law_integral(wave_vector: Array, density: Array) -> float:
    """Integrate a density that is a power law between the given values.

    Parameters
    ----------
    wave_vector, density : numpy.ndarray
        Shape (n,), rad/m and m^3.

    Returns
    -------
    float
        The integral, m^2.

    Examples
    --------
    >>> q = np.array([1.0, 2.0, 10.0])
    >>> f"{power_law_integral(q, q**-2.0):.6f}"
    '0.900000'
    """
    # The integrand over ln q is exponential: its mean is the logarithmic mean of both ends.
    power = wave_vector * density
    steps, ratio = np.diff(np.log(wave_vector)), np.diff(np.log(power))
    flat = np.abs(ratio) < 1e-9
    means = np.where(flat, power[:-1], np.diff(power) / np.where(flat, 1.0, ratio))
    return float(np.sum(means * steps))


def with_power(wave_vector: Array, density: Array, estimates: Array, power: float) -> Array:
    r"""Change a spectrum to a given mean square height, most where it is least certain.

    The densities are multiplied by :math:`\exp(\mu\, q\, C / n)`, where :math:`n` is the number of
    estimates. To first order this is the smallest change in units of the standard errors.

    Parameters
    ----------
    wave_vector, density, estimates : numpy.ndarray
        Shape (n,), rad/m, m^3 and numbers.
    power : float
        Mean square height wanted, m^2; that of the spectrum is at most doubled or halved.

    Returns
    -------
    numpy.ndarray
        Shape (n,), m^3.

    Examples
    --------
    >>> q = np.geomspace(1.0, 100.0, 20)
    >>> f"{power_law_integral(q, with_power(q, q**-2.0, q, 1.2)):.6f}"
    '1.200000'
    """
    before = power_law_integral(wave_vector, density)
    target = min(max(power, 0.5 * before), 2.0 * before)
    share = wave_vector * density / estimates
    share /= share.max()

    def missing(factor):
        return power_law_integral(wave_vector, density * np.exp(factor * share)) / target - 1.0

    return density * np.exp(scipy.optimize.brentq(missing, -60.0, 60.0, xtol=1e-12) * share)
