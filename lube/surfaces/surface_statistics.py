r"""Numbers that describe a measured surface, each with its 95 % confidence interval.

The Hurst exponent and the roll-off come from the spectrum by weighted least squares of its
logarithm, which allows for the scatter and the bias of the logarithm of a mean of :math:`n`
exponentially distributed powers, :math:`\psi'(n)` and :math:`\psi(n) - \ln n`. If the residuals
are larger than that, so are the intervals.

Moments of the heights have intervals by the jackknife over blocks of the surface, which are longer
than its waves and so nearly independent.
"""

from typing import NamedTuple

import numpy as np
import scipy.special

from lube.errors import DataError
from lube.surfaces.spectrum_table import LineSpectrum
from lube.types import Array

BLOCKS = 16
"""Blocks of a profile, or four times four of a map."""

LEAST_TRANSFER = 0.25
"""Waves of which the Gaussian filters leave less of the power, those beyond the cutoffs, take no
part in fits; the others are divided by what is left."""

LEAST_CHANGE = 2.0
"""A roll-off nearer than this factor to either end of the spectrum cannot be told from none."""


class Estimate(NamedTuple):
    """A value and the limits of its 95 % confidence interval."""

    value: float
    lower: float
    upper: float


def hurst_exponent(spectrum: LineSpectrum, longest: float, shortest: float) -> Estimate:
    r"""Fit the Hurst exponent, :math:`C \propto q^{-2H-1}`, to a range of wavelengths.

    Parameters
    ----------
    spectrum : LineSpectrum
        The spectrum of the line.
    longest, shortest : float
        Limits of the range, m.

    Returns
    -------
    Estimate
        The exponent.

    Raises
    ------
    DataError
        If fewer than three densities lie in the range.

    Examples
    --------
    >>> q = np.geomspace(1e4, 1e6, 40)
    >>> many = np.full(40, 1e4)
    >>> exact = LineSpectrum("a", q, q**-2.4, many, np.ones(40), True)
    >>> f"{hurst_exponent(exact, 1e-4, 1e-5).value:.4f}"
    '0.7000'
    """
    wave_vector, logarithm, error = _logarithms(spectrum)
    wavelength = 2.0 * np.pi / wave_vector
    used = (wavelength <= longest * (1 + 1e-9)) & (wavelength >= shortest * (1 - 1e-9))
    if np.count_nonzero(used) < 3:
        raise DataError(
            f"{spectrum.name}: got {np.count_nonzero(used)} densities between {shortest:.3g} and "
            f"{longest:.3g} m, need three or more for the Hurst exponent"
        )
    basis = np.stack([np.ones(used.sum()), np.log(wave_vector[used])], axis=1)
    fit, covariance = _least_squares(basis, logarithm[used], error[used])
    exponent, half = -0.5 * float(fit[1] + 1.0), 0.98 * float(np.sqrt(covariance[1, 1]))
    return Estimate(exponent, exponent - half, exponent + half)


def roll_off(spectrum: LineSpectrum) -> Estimate | None:
    r"""Fit the wavelength above which the spectrum rises no more.

    The model is a constant below the wave vector of the roll-off and a power law above, of the
    surface's density :math:`C/q` if it is isotropic and of the profile's density :math:`C` if not.

    Parameters
    ----------
    spectrum : LineSpectrum
        The spectrum of the line.

    Returns
    -------
    Estimate or None
        The wavelength, m; None if the best fit is too near to an end of the spectrum.

    Examples
    --------
    >>> q = np.geomspace(1e4, 1e6, 40)
    >>> density = q * np.where(q < 5e4, 1.0, (q / 5e4) ** -3.6)
    >>> exact = LineSpectrum("a", q, density, np.full(40, 1e4), np.ones(40), True)
    >>> f"{2 * np.pi / roll_off(exact).value:.3g}"
    '4.97e+04'
    """
    wave_vector, logarithm, error = _logarithms(spectrum)
    places = np.log(wave_vector)
    if spectrum.isotropic:
        logarithm = logarithm - places

    def fitted(place):
        basis = np.stack([np.ones(places.size), np.maximum(places - place, 0.0)], axis=1)
        fit, _ = _least_squares(basis, logarithm, error)
        return np.sum(((logarithm - basis @ fit) / error) ** 2)

    tried = np.linspace(places[0], places[-1], 400)
    misfit = np.array([fitted(place) for place in tried])
    best = int(np.argmin(misfit))
    margin = np.log(LEAST_CHANGE)
    if not places[0] + margin <= tried[best] <= places[-1] - margin:
        return None
    # Limits where the profile likelihood falls by 3.84 / 2, larger if the fit is poor.
    poor = max(misfit[best] / max(places.size - 3, 1), 1.0)
    inside = tried[misfit <= misfit[best] + 3.84 * poor]
    limits = (tried[best], inside[-1], inside[0])
    return Estimate(*(float(2.0 * np.pi / np.exp(place)) for place in limits))


def height_distribution(heights: Array) -> dict[str, Estimate]:
    """Moments of the heights with 95 % confidence intervals, by the jackknife over blocks.

    Parameters
    ----------
    heights : numpy.ndarray
        Shape (n,) or (nx, ny), m, without holes.

    Returns
    -------
    dict of str to Estimate
        ``rms_height`` and ``mean_deviation`` (Rq and Ra, or Sq and Sa, m), ``skewness`` and
        ``kurtosis`` (3 for Gaussian heights).

    References
    ----------
    H. R. Kuensch, The jackknife and the bootstrap for general stationary observations,
    Ann. Stat. 17 (1989) 1217-1241.

    Examples
    --------
    >>> heights = np.random.default_rng(1).normal(size=16000)
    >>> found = height_distribution(heights)
    >>> " ".join(f"{limit:.2f}" for limit in found["rms_height"])
    '1.00 0.99 1.01'
    """
    heights = heights - np.mean(heights)
    sums = np.array([_power_sums(block) for block in _blocks(heights)])
    whole = sums.sum(axis=0)
    values = _moments(whole)
    without = np.array([_moments(whole - part) for part in sums])
    count = len(sums)
    error = np.sqrt((count - 1) * np.var(without, axis=0))
    half = scipy.special.stdtrit(count - 1, 0.975) * error
    names = ("rms_height", "mean_deviation", "skewness", "kurtosis")
    limits = zip(values, values - half, values + half, strict=True)
    return {name: Estimate(*map(float, each)) for name, each in zip(names, limits, strict=True)}


def _blocks(heights):
    """Yield the blocks of a profile or a map."""
    if heights.ndim == 1:
        yield from np.array_split(heights, BLOCKS)
    else:
        side = round(BLOCKS**0.5)
        for rows in np.array_split(heights, side):
            yield from np.array_split(rows, side, axis=1)


def _power_sums(block):
    """Return the number of points and the sums of z, |z|, z^2, z^3 and z^4."""
    square = block * block
    return np.array(
        [
            block.size,
            block.sum(),
            np.abs(block).sum(),
            square.sum(),
            np.vdot(square, block),
            np.vdot(square, square),
        ]
    )


def _moments(sums):
    """Rms height, mean deviation, skewness and kurtosis; the mean is nearly zero."""
    mean, deviation, second, third, fourth = sums[1:] / sums[0]
    variance = second - mean**2
    skew = third - 3.0 * mean * second + 2.0 * mean**3
    kurt = fourth - 4.0 * mean * third + 6.0 * mean**2 * second - 3.0 * mean**4
    return np.array([np.sqrt(variance), deviation, skew / variance**1.5, kurt / variance**2])


def _logarithms(spectrum):
    """Wave vectors, logarithms of the unfiltered density without bias, and their errors."""
    used = spectrum.transfer >= LEAST_TRANSFER
    estimates = spectrum.estimates[used]
    bias = scipy.special.digamma(estimates) - np.log(estimates)
    logarithm = np.log(spectrum.density[used] / spectrum.transfer[used]) - bias
    error = np.sqrt(scipy.special.polygamma(1, estimates))
    return spectrum.wave_vector[used], logarithm, error


def _least_squares(basis, values, error):
    """Coefficients of a weighted linear fit and their covariance."""
    weighted = basis / error[:, None]
    fit, *_ = np.linalg.lstsq(weighted, values / error, rcond=None)
    freedom = max(values.size - basis.shape[1], 1)
    misfit = np.sum(((values - basis @ fit) / error) ** 2) / freedom
    return fit, np.linalg.pinv(weighted.T @ weighted) * max(misfit, 1.0)
