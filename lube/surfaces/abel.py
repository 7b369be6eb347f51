r"""From the spectrum of an isotropic surface to the spectrum of a profile cut from it, and back.

All spectra are one-sided densities over the wave vector, whose integral is the mean square height.
The line that stands for an isotropic surface has the density :math:`C(q)`: the mean square height
of all waves of the surface between :math:`q` and :math:`q + dq`, in whatever direction, is
:math:`C(q)\, dq` (the rule :math:`C_{1D} = \pi q\, C_{2D}` of the method of dimensionality
reduction). On a profile cut along :math:`x` a wave in another direction looks longer, so the
profile's density is

.. math::

    C_p(x) = \frac{2}{\pi} \int_x^\infty \frac{C(q)}{\sqrt{q^2 - x^2}}\, dq , \qquad
    C(q) = -q \int_q^\infty \frac{C_p'(x)}{\sqrt{x^2 - q^2}}\, dx ,

a pair of Abel transforms. With :math:`C \propto q^{-2H-1}` the ratio is
:math:`C / C_p = \sqrt\pi\, \Gamma(H + 1) / \Gamma(H + 1/2)`, 1.75 at :math:`H = 0.7`.

References
----------
P. R. Nayak, Some aspects of surface roughness measurement, Wear 26 (1973) 165-174.
"""

import numpy as np
import scipy

from lube.types import Array

_REACH = 12.0  # cosh(12) = 8e4: the waves beyond are negligible for H >= 0
_NODES = 240

END_RANGE = 3.0
"""The power law beyond the last wave vector is fitted to the densities above a third of it."""


def monotone(density: Array, estimates: Array) -> Array:
    """Fit a falling spectrum to a measured one.

    The density of a profile cut from an isotropic surface never rises. Means over independent
    estimates are gamma distributed, so the weighted isotonic regression is the fit of maximum
    likelihood.

    Parameters
    ----------
    density : numpy.ndarray
        Measured densities, shape (n,).
    estimates : numpy.ndarray
        Number of independent estimates of each, shape (n,).

    Returns
    -------
    numpy.ndarray
        Shape (n,).

    Examples
    --------
    >>> monotone(np.array([4.0, 1.0, 3.0, 0.5]), np.array([1.0, 1.0, 3.0, 1.0]))
    array([4. , 2.5, 2.5, 0.5])
    """
    return scipy.optimize.isotonic_regression(density, weights=estimates, increasing=False).x


def line_of_profile(wave_vector: Array, density: Array, wanted: Array) -> Array:
    r"""Density of the line from that of a profile, by Abel inversion.

    With :math:`x = q \cosh u` and the local exponent :math:`p(x) = -d \ln C_p / d \ln x` the
    inversion becomes :math:`C(q) = \int_0^\infty p\, C_p / \cosh u \; du`. Between the given
    values :math:`\ln C_p` is a monotone cubic of :math:`\ln x`; beyond the last it is a power
    law. As :math:`p \ge 0`, no density becomes negative.

    Parameters
    ----------
    wave_vector : numpy.ndarray
        Shape (n,), rising, rad/m.
    density : numpy.ndarray
        The profile's densities, shape (n,), positive and never rising, m^3.
    wanted : numpy.ndarray
        Wave vectors of the result, shape (m,), rad/m, within the others.

    Returns
    -------
    numpy.ndarray
        Shape (m,), m^3.

    Examples
    --------
    >>> q = np.geomspace(1e3, 1e6, 60)
    >>> f"{np.median(line_of_profile(q, q**-2.4, q) / q**-2.4):.3f}"
    '1.754'
    """
    known, values = np.log(wave_vector), np.log(density)
    curve = scipy.interpolate.PchipInterpolator(known, values)
    end = known >= known[-1] - np.log(END_RANGE)
    last_slope = np.polyfit(known[end], values[end], 1)[0]
    step = _REACH / _NODES
    stretch = np.cosh(step * np.arange(_NODES + 1))
    place = np.log(wanted)[:, None] + np.log(stretch)
    inside = np.minimum(place, known[-1])
    beyond = place - inside
    exponent = -np.where(beyond > 0.0, last_slope, curve(inside, 1))
    profile = np.exp(curve(inside) + last_slope * beyond)
    # The trapezoidal rule: the integrand is even in u and vanishes at the end.
    weights = np.where(np.arange(_NODES + 1) == 0, 0.5 * step, step)
    return np.sum(exponent * profile / stretch * weights, axis=-1)
