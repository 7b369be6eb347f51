r"""Numbers that describe a measured surface, each with its 95 % confidence interval.

The Hurst exponent and the roll-off come from the spectrum by weighted least squares of its
logarithm. The fits allow for the variance and the bias of the logarithm of a mean of :math:`n`
exponentially distributed powers, :math:`\psi'(n)` and :math:`\psi(n) - \ln n`. If the residuals
are larger than this scatter, the intervals are widened accordingly.

An instrument blurs or cuts off the shortest waves. `waves_of_surface` finds them, so that the fits
describe the surface.

Intervals of the moments of the heights follow by the jackknife over blocks of the surface, which
are longer than its waves and so nearly independent.
"""

from typing import NamedTuple

import numpy as np
import scipy.ndimage
import scipy.special

from lube.surfaces.spectrum_table import LineSpectrum
from lube.types import Array

BLOCKS = 16
"""Blocks of a profile, or four times four of a map."""

LEAST_TRANSFER = 0.25
"""Waves of which the Gaussian filters leave a smaller fraction of the power, those beyond the
cutoffs, are left out of fits. The densities of the others are divided by the fraction left."""

TOLERANCE = 0.05
"""Relative deviation from a self-affine spectrum that need not come from the instrument. It is
added to the standard errors of the densities, in quadrature."""

PRICE = 9.0
"""A density is left out of the fits, or a blur is added, if it reduces the squared deviation, in
standard errors, by more than this."""

LEAST_DENSITIES = 6
"""Fewest densities that the search for the instrument's resolution keeps."""

LEAST_CHANGE = 2.0
"""A roll-off within this factor of either end of the spectrum cannot be distinguished from no
roll-off."""


SPIKE = 5.0
"""A spike differs from the median of its neighbours so many times as far as 99 % of the points."""
SPIKE_POINTS = 3
"""Most points that a spike reaches across."""


class Estimate(NamedTuple):
    """A value and the limits of its 95 % confidence interval."""

    value: float
    lower: float
    upper: float


class Waves(NamedTuple):
    """Waves of a spectrum that show the surface.

    Attributes
    ----------
    longest, shortest : float
        Limits of the waves to fit, m.
    blurred : bool
        Whether the instrument blurs them: their power falls as :math:`e^{-b q^2}`.
    resolution : float
        Shortest wave that shows the surface rather than the instrument, m; NaN if all do. A blur
        leaves `LEAST_TRANSFER` of the power of this wave.
    """

    longest: float
    shortest: float
    blurred: bool = False
    resolution: float = np.nan


def waves_of_surface(spectrum: LineSpectrum, longest: float, shortest: float) -> Waves:
    r"""Find the waves of a spectrum that show the surface rather than the instrument.

    A spectrum with a roll-off and a power law, with a blur :math:`e^{-b q^2}` or without, is fitted
    up to every wave vector. The fit with the least sum of misfit and `PRICE` is chosen. An optical
    instrument blurs; a digital filter may cut off all waves beyond one.

    Parameters
    ----------
    spectrum : LineSpectrum
        The spectrum of the line.
    longest, shortest : float
        Limits of the search, m.

    Returns
    -------
    Waves
        The waves.

    Examples
    --------
    >>> q = np.geomspace(1e4, 1e6, 40)
    >>> seen = q**-2.4 * np.exp(-((q / 5e5) ** 2))
    >>> blurred = LineSpectrum("a", q, seen, np.full(40, 1e4), np.ones(40), False)
    >>> found = waves_of_surface(blurred, 1e-3, 1e-6)
    >>> found.blurred, f"{found.resolution:.3g}"
    (True, '1.07e-05')
    """
    wave_vector, logarithm, error = _logarithms(spectrum, Waves(longest, shortest))
    places, error = np.log(wave_vector), np.hypot(error, TOLERANCE)

    def tried():
        """Price, number of densities, and strength of the blur at the last of them."""
        for count in range(min(LEAST_DENSITIES, places.size), places.size + 1):
            for blurred in (False, True):
                for bend in places[: max(count - LEAST_DENSITIES + 2, 1)]:
                    basis = _basis(places[:count], bend, blurred)
                    fit, _, misfit = _least_squares(basis, logarithm[:count], error[:count])
                    blur = fit[2] if blurred else 0.0
                    if blur >= 0.0:
                        yield misfit + PRICE * (places.size - count + blurred), count, blur

    _, count, blur = min(tried(), default=(0.0, 0, 0.0))
    if count == 0:
        return Waves(longest, shortest)
    end = wave_vector[count - 1]
    seen = end * np.sqrt(-np.log(LEAST_TRANSFER) / blur) if blur else np.inf
    seen = min(seen, end if count < places.size else np.inf)
    resolution = 2.0 * np.pi / seen if seen <= wave_vector[-1] else np.nan
    return Waves(longest, 2.0 * np.pi / end, bool(blur > 0.0), resolution)


def hurst_exponent(spectrum: LineSpectrum, waves: Waves) -> Estimate | None:
    r"""Fit the Hurst exponent, :math:`C \propto q^{-2H-1}`, to a range of wavelengths.

    Parameters
    ----------
    spectrum : LineSpectrum
        The spectrum of the line.
    waves : Waves
        The range of waves to fit.

    Returns
    -------
    Estimate or None
        The exponent; None if fewer than three densities lie in the range. A surface with an
        exponent outside 0 to 1 is not self-affine.

    Examples
    --------
    >>> q = np.geomspace(1e4, 1e6, 40)
    >>> many = np.full(40, 1e4)
    >>> exact = LineSpectrum("a", q, q**-2.4, many, np.ones(40), True)
    >>> f"{hurst_exponent(exact, Waves(1e-4, 1e-5)).value:.4f}"
    '0.7000'
    """
    wave_vector, logarithm, error = _logarithms(spectrum, waves)
    if wave_vector.size < 3:
        return None
    basis = _basis(np.log(wave_vector), -np.inf, waves.blurred)
    fit, covariance, _ = _least_squares(basis, logarithm, error)
    exponent = 0.5 * float(fit[1] - 1.0 - spectrum.isotropic)
    half = 0.98 * float(np.sqrt(covariance[1, 1]))
    return Estimate(exponent, exponent - half, exponent + half)


def roll_off(spectrum: LineSpectrum, waves: Waves) -> Estimate | None:
    r"""Fit the wavelength above which the spectrum rises no more.

    The model is a constant below the wave vector of the roll-off and a power law above it. It is
    fitted to the surface's density :math:`C/q` if the surface is isotropic, and to the profile's
    density :math:`C` if not.

    Parameters
    ----------
    spectrum : LineSpectrum
        The spectrum of the line.
    waves : Waves
        The range of waves to fit.

    Returns
    -------
    Estimate or None
        The wavelength, m; None if fewer than three densities lie in the range, or if the best fit
        is too near to one of its ends.

    Examples
    --------
    >>> q = np.geomspace(1e4, 1e6, 40)
    >>> density = q * np.where(q < 5e4, 1.0, (q / 5e4) ** -3.6)
    >>> exact = LineSpectrum("a", q, density, np.full(40, 1e4), np.ones(40), True)
    >>> f"{2 * np.pi / roll_off(exact, Waves(1e-3, 1e-6)).value:.3g}"
    '4.97e+04'
    """
    wave_vector, logarithm, error = _logarithms(spectrum, waves)
    places = np.log(wave_vector)
    if places.size < 3:
        return None
    tried = np.linspace(places[0], places[-1], 400)
    bases = (_basis(places, place, waves.blurred) for place in tried)
    misfit = np.array([_least_squares(basis, logarithm, error)[2] for basis in bases])
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
    columns = 1 if heights.ndim == 1 else round(BLOCKS**0.5)
    rows = np.array_split(heights, BLOCKS // columns)
    blocks = (block for row in rows for block in np.array_split(row, columns, axis=-1))
    sums = np.array([_power_sums(block) for block in blocks])
    whole = sums.sum(axis=0)
    values = _moments(whole)
    without = np.array([_moments(whole - part) for part in sums])
    count = len(sums)
    error = np.sqrt((count - 1) * np.var(without, axis=0))
    half = scipy.special.stdtrit(count - 1, 0.975) * error
    names = ("rms_height", "mean_deviation", "skewness", "kurtosis")
    limits = zip(values, values - half, values + half, strict=True)
    return {name: Estimate(*map(float, each)) for name, each in zip(names, limits, strict=True)}


def spikes(heights: Array) -> Array:
    """Heights of spikes, points that stick out of their neighbours by more than the rms height.

    Narrow grooves, which are longer than `SPIKE_POINTS`, do not count.

    Parameters
    ----------
    heights : numpy.ndarray
        Shape (n,) or (nx, ny), m, without form and holes.

    Returns
    -------
    numpy.ndarray
        Shape (spikes,), m, above or below the neighbours.

    Examples
    --------
    >>> heights = np.random.default_rng(1).normal(size=(64, 64))
    >>> heights[[3, 20], [7, 60]] = 50.0
    >>> spikes(heights).size
    2
    """
    away = np.abs(heights - scipy.ndimage.median_filter(heights, size=3, mode="nearest"))
    out = away > max(SPIKE * np.quantile(away, 0.99), np.std(heights))
    regions, _ = scipy.ndimage.label(out, np.ones((3,) * out.ndim))
    for number, place in enumerate(scipy.ndimage.find_objects(regions), 1):
        if max(part.stop - part.start for part in place) > SPIKE_POINTS:
            out[place] &= regions[place] != number
    return away[out]


def _power_sums(block):
    """Return the number of points and the sums of z, |z|, z^2, z^3 and z^4."""
    square = block * block
    sums = block.sum(), np.abs(block).sum(), square.sum()
    return np.array([block.size, *sums, np.vdot(square, block), np.vdot(square, square)])


def _moments(sums):
    """Rms height, mean deviation, skewness and kurtosis; the mean is nearly zero."""
    mean, deviation, second, third, fourth = sums[1:] / sums[0]
    variance = second - mean**2
    skew = third - 3.0 * mean * second + 2.0 * mean**3
    kurt = fourth - 4.0 * mean * third + 6.0 * mean**2 * second - 3.0 * mean**4
    return np.array([np.sqrt(variance), deviation, skew / variance**1.5, kurt / variance**2])


def _logarithms(spectrum, waves):
    """Wave vectors, logarithms of the unfiltered density without bias, and their errors.

    For an isotropic map it is the density of the surface, otherwise the density of the profile.
    """
    wavelength = 2.0 * np.pi / spectrum.wave_vector
    used = (wavelength <= waves.longest * (1 + 1e-9)) & (wavelength >= waves.shortest * (1 - 1e-9))
    used &= spectrum.transfer >= LEAST_TRANSFER
    estimates = spectrum.estimates[used]
    bias = scipy.special.digamma(estimates) - np.log(estimates)
    logarithm = np.log(spectrum.density[used] / spectrum.transfer[used]) - bias
    if spectrum.isotropic:
        logarithm = logarithm - np.log(spectrum.wave_vector[used])
    return spectrum.wave_vector[used], logarithm, np.sqrt(scipy.special.polygamma(1, estimates))


def _basis(places, bend, blurred):
    """Functions of ln q of which a spectrum's logarithm is a sum: level, fall from a bend, blur."""
    fall = -np.maximum(places - max(bend, places[0]), 0.0)
    terms = [np.ones(places.size), fall, -np.exp(2.0 * (places - places[-1]))]
    return np.stack(terms[: 2 + blurred], axis=1)


def _least_squares(basis, values, error):
    """Coefficients of a weighted linear fit, their covariance, and the sum of squares left."""
    weighted = basis / error[:, None]
    fit, *_ = np.linalg.lstsq(weighted, values / error, rcond=None)
    freedom = max(values.size - basis.shape[1], 1)
    misfit = np.sum(((values - basis @ fit) / error) ** 2)
    return fit, np.linalg.pinv(weighted.T @ weighted) * max(misfit / freedom, 1.0), misfit
