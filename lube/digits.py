"""Rounding to the digits that every processor gives alike."""

import numpy as np

from lube.types import Array


def six_digits(values: Array) -> Array:
    """Round to six digits: further ones depend on the processor.

    Parameters
    ----------
    values : numpy.ndarray
        Values; NaN stays NaN.

    Returns
    -------
    numpy.ndarray
        The values, rounded to six significant digits.

    Examples
    --------
    >>> six_digits(np.array([0.0, 1.23456789e-6])).tolist()
    [0.0, 1.23457e-06]
    """
    return rounded(values, 6)


def rounded(values: Array, digits: int) -> Array:
    """Round to some digits; see `six_digits`."""
    return np.vectorize(lambda value: float(f"{value:.{digits}g}"), otypes=[float])(values)
