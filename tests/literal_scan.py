"""Contact statistics by the literal scan, which the fast kernels are compared with."""

import numpy as np
from literal import scan_trace

from lube.types import Array, Pair, Ratios


def scan_statistics(
    lines: Pair, speed_ratios: Ratios, steps: int, films: Array, half_windows: Array, factor: float
) -> Array:
    """Compute the contact statistics of many operating points with flat films by the literal scan.

    Parameters
    ----------
    lines, speed_ratios, steps, factor
        As in `benchmarks/literal.py`.
    films, half_windows : numpy.ndarray
        Film thickness (height steps) and points on either side of the window's centre, shape
        (P,), int64.

    Returns
    -------
    numpy.ndarray
        Shape (P, 4), int64: time steps with contact, time steps with a broken boundary layer,
        and the sums over all time steps of broken points and of overlap (height steps).

    Examples
    --------
    >>> line = np.array([5, 0, 0, 0, 0], np.int32)
    >>> lines, films = (line, np.zeros_like(line)), np.array([3, 9])
    >>> scan_statistics(lines, (1.0, 1.0), 5, films, np.array([1, 1]), 1.0).tolist()
    [[3, 3, 3, 6], [0, 0, 0, 0]]
    """
    statistics = np.empty((films.size, 4), np.int64)
    for point in range(films.size):
        film = np.full(2 * half_windows[point] + 1, films[point])
        trace = scan_trace(lines, speed_ratios, steps, film, half_windows[point], factor)
        statistics[point, 0] = np.sum(trace[:, 0] > 0)
        statistics[point, 1] = np.sum(trace[:, 1] > 0)
        statistics[point, 2:] = np.sum(trace[:, 1:], axis=0)
    return statistics
