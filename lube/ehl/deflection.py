"""Elastic deflection of a half-plane under a pressure that is linear between nodes."""

import numpy as np

from lube.types import Array


def deflection_matrix(position: Array, nodes: Array) -> Array:
    r"""Deflection of the rollers by a unit pressure at each node.

    .. math:: D(X) = -\frac{1}{\pi} \int P(X') \ln|X - X'| \, dX'

    Parameters
    ----------
    position : numpy.ndarray, shape (m,)
        Positions X at which the deflection is wanted.
    nodes : numpy.ndarray, shape (n,)
        Positions of the nodes, rising. The pressure at the first and the last is zero.

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
    square = distance * distance
    # Twofold antiderivative of ln|X|; its logarithm does not matter at 0, where the square is 0.
    kernel = 0.25 * square * (np.log(np.where(square > 0.0, square, 1.0)) - 3.0)
    slope = np.diff(kernel, axis=1) / np.diff(nodes)
    matrix = np.zeros_like(kernel)
    matrix[:, 1:-1] = np.diff(slope, axis=1) / -np.pi
    return matrix
