"""Effects of single lines on the contact share, whatever line they are paired with."""

import numpy as np

from lube.statistics.one_pair import joint_effects
from lube.types import Array


def line_effects(in_first: Array, in_second: Array) -> Array:
    r"""Effect of the first and the second line of each number together.

    The mean over the partners of a line still has a part of the joint effects of the pairs, which
    are less alike at different points than those of single lines. Without it the covariance is
    :math:`S - N`, with that of the means, :math:`S`, and of the part, :math:`N`. The means
    :math:`W` are made to have it,

    .. math:: W S^{-1/2} (S - N)^{1/2}

    Parameters
    ----------
    in_first, in_second : numpy.ndarray
        Shape (R, R, P), as for `lube.statistics.one_pair.persistent_share`.

    Returns
    -------
    numpy.ndarray, shape (R, P)
        The effects, over the standard deviation of the means at each point; to six decimals.

    Examples
    --------
    Lines alone, without joint effects:

    >>> first, second = np.array([0.1, 0.2, 0.4]), np.array([0.0, 0.3, 0.1])
    >>> shares = (first[:, None] + second)[..., None]
    >>> line_effects(shares, shares).ravel()
    array([-1.154701,  0.57735 ,  0.57735 ])
    """
    lines = len(in_first)
    means = in_first.mean(axis=1) + in_second.mean(axis=0)
    scale = means.std(axis=0, ddof=1)
    scale = np.where(scale > 0.0, scale, 1.0)
    means = (means - means.mean(axis=0)) / scale
    both = [joint_effects(shares) / scale for shares in (in_first, in_second)]
    parts = sum(np.einsum("rki,rkj->ij", joint, joint) for joint in both)
    covariance = np.einsum("ri,rj->ij", means, means) / (lines - 1)
    alone = _power(covariance - parts / ((lines - 1) ** 2 * lines), 0.5)
    return np.round(means @ _power(covariance, -0.5) @ alone, 6)


def _power(matrix, exponent):
    """Power of a symmetric matrix, without the directions in which it is not positive."""
    values, vectors = np.linalg.eigh(matrix)
    known = values > 1e-9 * values.max()
    return (vectors[:, known] * values[known] ** exponent) @ vectors[:, known].T
