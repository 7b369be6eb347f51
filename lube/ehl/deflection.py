"""Elastic deflection of a half-plane, or a half-space, under a pressure linear between nodes."""

from functools import cache

import numpy as np
import scipy

from lube.types import Array

_SERIES_TERMS = 9
"""Terms of the series of the twofold antiderivative of K0, exact in double precision up to 1."""
_FAR = 40.0
"""Argument beyond which the antiderivative of K0 is linear, in double precision."""
_TABLE_STEP = 0.01


def deflection_matrix(position: Array, nodes: Array, across: float = 0.0) -> Array:
    r"""Deflection of the rollers by a unit pressure at each node.

    .. math:: D(X) = -\frac{1}{\pi} \int P(X') \ln|X - X'| \, dX'

    for a pressure that does not change along the rollers. For one that is a wave along the rollers,
    :math:`P(X) \cos(k_y Y)`, the deflection is the same wave times

    .. math:: D(X) = \frac{1}{\pi} \int P(X') K_0(k_y |X - X'|) \, dX'

    with the modified Bessel function :math:`K_0`.

    Parameters
    ----------
    position : numpy.ndarray, shape (m,)
        Positions X at which the deflection is wanted.
    nodes : numpy.ndarray, shape (n,)
        Positions of the nodes, rising. The pressure at the first and the last is zero.
    across : float, optional
        Wavenumber :math:`k_y` along the rollers, in the unit of 1/X.

    Returns
    -------
    numpy.ndarray, shape (m, n)
        Scaled deflection H at each position; its product with the pressures P at the nodes is
        exact for a pressure that is linear in between. Against Hertz' pressure it is the constant
        1/4 + ln(2)/2 less X^2/2, for \|X\| < 1.

    Examples
    --------
    >>> nodes = np.sin(np.linspace(-np.pi / 2, np.pi / 2, 1001))
    >>> hertz = np.sqrt(1.0 - nodes**2)
    >>> deflection_matrix(np.array([0.0, 0.5]), nodes) @ hertz + np.array([0.0, 0.125])
    array([0.59657..., 0.59657...])
    """
    distance = position[:, None] - nodes
    # Twofold antiderivative of -ln|X|, or of K0.
    if across:
        kernel = bessel_antiderivative(across * np.abs(distance)) / across**2
    else:
        square = distance * distance
        # The logarithm does not matter at 0, where the square is 0.
        kernel = -0.25 * square * (np.log(np.where(square > 0.0, square, 1.0)) - 3.0)
    slope = np.diff(kernel, axis=1) / np.diff(nodes)
    matrix = np.zeros_like(kernel)
    matrix[:, 1:-1] = np.diff(slope, axis=1) / np.pi
    return matrix


def bessel_antiderivative(argument: Array) -> Array:
    r"""Twofold antiderivative of the modified Bessel function :math:`K_0`.

    .. math:: \int_0^u (u - s) K_0(s) \, ds = u \int_0^u K_0(s) \, ds - 1 + u K_1(u)

    Parameters
    ----------
    argument : numpy.ndarray
        Arguments u, 0 or greater.

    Returns
    -------
    numpy.ndarray
        The antiderivative; it and its slope are 0 at 0.

    Notes
    -----
    Below 1 it is a series, so that differences between near nodes are exact. Up to 40 a table is
    interpolated, which is right to 1e-9. Beyond that :math:`K_0` has vanished.

    Examples
    --------
    >>> bessel_antiderivative(np.array([0.0, 0.5, 2.0, 50.0]))
    array([ 0.        ,  0.29177...,  2.22708..., 77.53981...])
    """
    found = argument * (0.5 * np.pi) - 1.0
    between = argument < _FAR
    found[between] = _table()(argument[between])
    near = argument < 1.0
    small = argument[near]
    square = small * small
    powers, logarithms = (np.polynomial.polynomial.polyval(square, each) for each in _series())
    found[near] = square * (powers - logarithms * np.log(np.where(small > 0.0, small, 1.0)))
    return found


@cache
def _series():
    """Coefficients of the series over the square of u: without, and with the factor -ln u."""
    order = np.arange(_SERIES_TERMS)
    low, high = 2.0 * order + 1.0, 2.0 * order + 2.0
    logarithms = 0.25**order / (scipy.special.factorial(order) ** 2 * low * high)
    harmonic = np.append(0.0, np.cumsum(1.0 / order[1:]))
    added = np.log(2.0) - np.euler_gamma + harmonic + 1.0 / low + 1.0 / high
    return logarithms * added, logarithms


@cache
def _table():
    argument = np.arange(0.5, _FAR + 0.5, _TABLE_STEP)
    integral, first = scipy.special.iti0k0(argument)[1], scipy.special.k1(argument)
    return scipy.interpolate.CubicSpline(argument, argument * integral - 1.0 + argument * first)
