"""Independent windows and effective sample size of one realisation of the roughness."""

import numpy as np

from lube.types import Array, Values


def independent_windows(travel: Values, width: Values, longest_wavelength: float) -> Array:
    r"""Count the contact windows of one realisation that have no roughness in common.

    Two windows see independent roughness if a longest wavelength lies between them:

    .. math:: n_w = \max\left( \frac{s}{2a + \lambda_{max}}, 1 \right)

    Parameters
    ----------
    travel : float or array
        Distance :math:`s` that the slower surface moves through the contact in the realisation,
        m. A surface at rest shows the same roughness to all windows.
    width : float or array
        Contact width :math:`2a`, m.
    longest_wavelength : float
        Longest wavelength :math:`\lambda_{max}` of the roughness, m.

    Returns
    -------
    float or array
        Number of windows :math:`n_w`, at least one; labelled if the arguments are.

    Examples
    --------
    >>> float(independent_windows(0.3, 2e-4, 4e-4).round(6))
    500.0
    """
    return np.maximum(travel / (width + longest_wavelength), 1.0)


def effective_sample_size(probabilities: Array, windows: Values) -> Array:
    r"""Effective sample size of one realisation, from the scatter between realisations.

    It is the number of independent trials with the probability :math:`p` that would scatter as much
    as one realisation, with the variance :math:`s^2`:

    .. math:: n = \frac{p (1 - p)}{s^2}

    The mean over :math:`R` realisations has the effective sample size :math:`R n`.

    Parameters
    ----------
    probabilities : numpy.ndarray
        Shape (R, ...), one probability for each realisation.
    windows : float or numpy.ndarray
        Independent windows in one realisation, broadcastable to shape (...); returned where the
        realisations do not scatter, or where there is only one.

    Returns
    -------
    numpy.ndarray
        Shape (...), :math:`n`.

    Examples
    --------
    >>> effective_sample_size(np.array([[0.45, 0.0], [0.55, 0.0]]), 500.0).round(6)
    array([ 50., 500.])
    """
    windows = np.broadcast_to(windows, probabilities.shape[1:]).astype(float)
    if probabilities.shape[0] == 1:
        return windows
    mean, variance = probabilities.mean(axis=0), probabilities.var(axis=0, ddof=1)
    # The values themselves decide: the variance of equal values need not round to zero.
    scattered = np.ptp(probabilities, axis=0) > 0.0
    return np.where(scattered, mean * (1.0 - mean) / np.where(scattered, variance, 1.0), windows)
