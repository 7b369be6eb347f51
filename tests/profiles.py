"""Spectra of profiles cut from isotropic surfaces, by theory, and the rms height of a spectrum."""

import numpy as np
import scipy.special

from lube.surfaces.spectrum_table import band_table, power_law_integral
from lube.types import Array


def line_over_profile(hurst_exponent: float) -> float:
    """Ratio of the line's density to the profile's, of a self-affine surface without limits.

    Parameters
    ----------
    hurst_exponent : float
        Hurst exponent H.

    Returns
    -------
    float
        The ratio.

    Examples
    --------
    >>> f"{line_over_profile(0.7):.3f}"
    '1.754'
    """
    gamma = scipy.special.gamma
    return np.sqrt(np.pi) * gamma(hurst_exponent + 1.0) / gamma(hurst_exponent + 0.5)


def profile_of_line(wave_vector: Array, density: Array) -> Array:
    r"""Density of a profile from that of the line, which is zero outside its wave vectors.

    Parameters
    ----------
    wave_vector : numpy.ndarray
        Shape (n,), rising, rad/m.
    density : numpy.ndarray
        The line's densities, shape (n,), m^3; between them :math:`C` is linear in :math:`q`.

    Returns
    -------
    numpy.ndarray
        Shape (n,), m^3.

    Examples
    --------
    >>> q = np.geomspace(1e3, 1e8, 1000)
    >>> f"{q[0] ** -2.4 / profile_of_line(q, q**-2.4)[0]:.3f}"
    '1.754'
    """
    q = wave_vector[None, :]
    x = wave_vector[:, None]
    reached = np.maximum(q, x)
    # Integrals of 1 / sqrt(q^2 - x^2) and q / sqrt(q^2 - x^2) from x to q.
    first = np.arccosh(reached / x)
    second = np.sqrt(reached**2 - x**2)
    slope = np.diff(density) / np.diff(wave_vector)
    constant = density[:-1] - slope * wave_vector[:-1]
    parts = np.diff(first) * constant + np.diff(second) * slope
    return 2.0 / np.pi * np.sum(parts, axis=-1)


def rms_height(spectrum, q_min=None, q_max=None):
    """Rms height of a `LineSpectrum`'s waves between two wave vectors, m; by default of all."""
    begin, end = spectrum.limits or spectrum.wave_vector[[0, -1]]
    table = band_table(spectrum, q_min or begin, q_max or end)
    return np.sqrt(power_law_integral(*table))
