"""Spectra and moments of roughness lines: of given heights, and expected from the parameters."""

import numpy as np
import scipy.fft

from lube.surfaces.synthetic import LineSpecLike, wave_amplitudes
from lube.types import Array, Pair


def line_moments(line: Array, spacing: float) -> dict[str, float]:
    """Moments of one periodic line.

    Slope and curvature are finite differences of neighbouring points, the finest scale that the
    contact model resolves.

    Parameters
    ----------
    line : numpy.ndarray
        Heights, shape (N,), m, of mean zero.
    spacing : float
        Distance dx of neighbouring points, m.

    Returns
    -------
    dict of str to float
        ``rms_height`` (m), ``rms_slope``, ``rms_curvature`` (1/m), ``skewness``, ``kurtosis``
        (3 for a Gaussian line).

    Examples
    --------
    >>> moments = line_moments(np.sin(2 * np.pi * np.arange(1000) / 1000), 2 * np.pi / 1000)
    >>> {name: f"{value:.2f}" for name, value in moments.items() if name != "skewness"}
    {'rms_height': '0.71', 'rms_slope': '0.71', 'rms_curvature': '0.71', 'kurtosis': '1.50'}
    """
    slope = (line - np.roll(line, 1)) / spacing
    curvature = (np.roll(slope, -1) - slope) / spacing
    variance = np.mean(line**2)
    return {
        "rms_height": np.sqrt(variance),
        "rms_slope": np.sqrt(np.mean(slope**2)),
        "rms_curvature": np.sqrt(np.mean(curvature**2)),
        "skewness": np.mean(line**3) / variance**1.5,
        "kurtosis": np.mean(line**4) / variance**2,
    }


def power_spectrum(line: Array, spacing: float) -> Pair:
    r"""One-sided power spectral density of a periodic line.

    .. math:: C_{1D}(q_k) = \frac{a_k^2}{2\, \Delta q}, \qquad \Delta q = \frac{2\pi}{N \Delta x}

    Parameters
    ----------
    line : numpy.ndarray
        Heights, shape (N,), m.
    spacing : float
        Distance dx of neighbouring points, m.

    Returns
    -------
    wave_vector : numpy.ndarray
        Shape (N // 2,), rad/m.
    density : numpy.ndarray
        Shape (N // 2,), m^3; its integral over the wavenumber is the mean square height.

    Examples
    --------
    >>> wave_vector, density = power_spectrum(np.sin(2 * np.pi * np.arange(100) / 20), 0.01)
    >>> peak = np.argmax(density)
    >>> f"{wave_vector[peak] / (2 * np.pi):.1f}", f"{density[peak] * wave_vector[0]:.1f}"
    ('5.0', '0.5')
    """
    step = 2.0 * np.pi / (line.size * spacing)
    power = 2.0 * np.abs(scipy.fft.rfft(line)[1:] / line.size) ** 2
    if line.size % 2 == 0:
        power[-1] /= 2.0  # the wave of two points has no partner of negative wavenumber
    return step * np.arange(1, power.size + 1), power / step


def spectrum_moments(spec: LineSpecLike, roller: int) -> dict[str, float]:
    r"""Moments of a line expected from its spectrum, comparable to those of `line_moments`.

    .. math::

        m_{2n} = \frac12 \sum_k a_k^2 \left( \frac{2}{\Delta x}
        \sin \frac{q_k \Delta x}{2} \right)^{2n}, \qquad n = 0, 1, 2

    Parameters
    ----------
    spec : LineSpecLike
        Parameters of the lines.
    roller : int
        0 for the first roller, 1 for the second.

    Returns
    -------
    dict of str to float
        Square roots of the moments: ``rms_height`` (m), ``rms_slope``, ``rms_curvature`` (1/m).
    """
    first_wave, amplitudes = wave_amplitudes(spec, roller)
    waves = np.arange(first_wave, first_wave + amplitudes.size)
    difference = 2.0 * np.sin(np.pi * waves / spec.points[roller]) / spec.spacing
    names = ("rms_height", "rms_slope", "rms_curvature")
    roots = (np.sqrt(0.5 * np.sum(amplitudes**2 * difference ** (2 * n))) for n in (0, 1, 2))
    return dict(zip(names, roots, strict=True))


def pair_moments(spec: LineSpecLike) -> list[float]:
    """Moments of the sum of both lines, expected from their spectra.

    Parameters
    ----------
    spec : LineSpecLike
        Parameters of the lines.

    Returns
    -------
    list of float
        :math:`m_0` (m^2), :math:`m_2` and :math:`m_4` (1/m^2), as in `lube.physics.excursions`.
    """
    lines = [spectrum_moments(spec, roller).values() for roller in (0, 1)]
    return [sum(root**2 for root in roots) for roots in zip(*lines, strict=True)]


def wave_powers(spec: LineSpecLike, roller: int) -> Pair:
    """Wave vectors of a line's waves, rad/m, and their mean squares, m^2.

    Parameters
    ----------
    spec, roller
        As in `spectrum_moments`.
    """
    first_wave, amplitudes = wave_amplitudes(spec, roller)
    step = spec.wave_step(roller)
    return step * (first_wave + np.arange(amplitudes.size)), 0.5 * amplitudes**2


def wave_moments(spec: LineSpecLike, roller: int) -> Array:
    r"""Moments of a line's waves themselves, without a grid.

    .. math:: m_{2n} = \frac12 \sum_k a_k^2 q_k^{2n}, \qquad n = 0, 1, 2

    Parameters
    ----------
    spec, roller
        As in `spectrum_moments`.

    Returns
    -------
    numpy.ndarray
        :math:`m_0` (m^2), :math:`m_2` and :math:`m_4` (1/m^2).
    """
    wave_vector, power = wave_powers(spec, roller)
    return np.array([np.sum(power * wave_vector**n) for n in (0, 2, 4)])


def autocovariance(spec: LineSpecLike, roller: int, lags: int) -> Array:
    r"""Covariance of the heights of one line at two points, against their distance.

    .. math:: R_n = \frac12 \sum_k a_k^2 \cos \frac{2 \pi k n}{N}

    Parameters
    ----------
    spec, roller
        As in `spectrum_moments`.
    lags : int
        Number of distances.

    Returns
    -------
    numpy.ndarray
        Shape (lags,), for distances of n = 0, 1, ... points, squared height steps.
    """
    first_wave, amplitudes = wave_amplitudes(spec, roller)
    points = spec.points[roller]
    power = np.zeros(points // 2 + 1)
    power[first_wave : first_wave + amplitudes.size] = (0.5 * amplitudes / spec.height_step) ** 2
    return scipy.fft.irfft(power, points, norm="forward")[:lags]


def spectrum_bands(spec: LineSpecLike, roller: int, bands: int) -> Pair:
    """Mean density of a line's spectrum over bands of equal logarithmic width.

    Parameters
    ----------
    spec, roller
        As in `spectrum_moments`.
    bands : int
        Number of bands, from the smallest to the largest wavenumber.

    Returns
    -------
    wave_vector : numpy.ndarray
        Shape (bands,), middle of each band, rad/m.
    density : numpy.ndarray
        Shape (bands,), m^3, one-sided; NaN where a band has no wave.
    """
    waves, powers = wave_powers(spec, roller)
    step = spec.wave_step(roller)
    edges = np.geomspace(waves[0] - 0.5 * step, waves[-1] + 0.5 * step, bands + 1)
    inside = np.digitize(waves, edges) - 1
    counts, power = (np.bincount(inside, each, bands) for each in (None, powers))
    with np.errstate(invalid="ignore"):
        density = power / (step * counts)
    return np.sqrt(edges[1:] * edges[:-1]), density


def line_attributes(spec: LineSpecLike) -> dict[str, float | np.ndarray]:
    """Global attributes of a roughness file: the spectrum and the height step.

    Parameters
    ----------
    spec : LineSpecLike
        Parameters of the lines.

    Returns
    -------
    dict
        Attribute names and values; lengths in m, wavenumbers in rad/m. The attributes of the
        spectrum are single values where both rollers have the same, else arrays of shape (2,), NaN
        where a measured line or spectrum has none.
    """
    of_rollers = {
        "hurst": [line.hurst_exponent for line in spec.lines],
        # A measured line has no lowest wavenumber.
        "q_min": [
            line.q_min / line.lay_ratio if line.heights is None else None for line in spec.lines
        ],
        "q_max": [line.q_max for line in spec.lines],
        "q_roll_off": [line.q_roll_off for line in spec.lines],
    }
    return {
        **{name: _one_or_both(values) for name, values in of_rollers.items()},
        "rms": np.array([line.rms_height for line in spec.lines]),
        "spacing": spec.spacing,
        "points": np.array(spec.points),
        "height_step": spec.height_step,
    }


def _one_or_both(values):
    """Return the value that both rollers have, or an array of both values; NaN for None."""
    values = [np.nan if value is None else value for value in values]
    return values[0] if values[0] == values[1] else np.array(values)
