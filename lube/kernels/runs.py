"""Runs of points at which the sum of two rough lines lies above a film.

Blocks of points that cannot rise above the film are skipped. In pure rolling the two lines keep
one alignment for the whole revolution, so their sum is computed once and searched point by point.
With slip an alignment lasts for a few time steps only. There the maxima of two blocks together are
an upper limit of their sum. They are computed once, for blocks that begin at any point, and exclude
most windows before any heights are added.
"""

import numpy as np

from lube.kernels.compiler import kernel
from lube.types import Array, Pair

BLOCK_SHIFT = 6
BLOCK = 2**BLOCK_SHIFT
"""Number of points that are searched, or skipped, together."""


@kernel
def add_lines(lines: Pair, first_1: int, first_2: int, line: Array) -> None:
    """Add two periodic lines, starting from a given point of each.

    Parameters
    ----------
    lines : tuple of numpy.ndarray
        Heights of the two periodic lines, shapes (N1,) and (N2,), int32 height steps.
    first_1, first_2 : int
        Indices of these points, any whole numbers.
    line : numpy.ndarray
        Shape (L,), int32; filled with the sum, height steps.

    Examples
    --------
    >>> line = np.empty(5, np.int32)
    >>> add_lines((np.array([1, 2, 3], np.int32), np.array([0, 10], np.int32)), 2, 0, line)
    >>> line.tolist()
    [3, 11, 2, 13, 1]
    """
    line_1, line_2 = lines
    i, k = first_1 % line_1.size, first_2 % line_2.size
    done = 0
    while done < line.size:  # in pieces without wrap-around, which the compiler vectorises
        stretch = min(line_1.size - i, line_2.size - k, line.size - done)
        for n in range(np.uint64(stretch)):
            line[np.uint64(done) + n] = line_1[np.uint64(i) + n] + line_2[np.uint64(k) + n]
        done += stretch
        i = (i + stretch) % line_1.size
        k = (k + stretch) % line_2.size


@kernel
def _replace_by_highest(line):
    """Replace each point, except the last ones, by the highest of the `BLOCK` points from it on."""
    covered = 1
    while covered < BLOCK:
        for i in range(line.size - covered):
            line[i] = max(line[i], line[i + covered])
        covered *= 2


def highest_ahead(line: Array, reach: int = 0) -> Array:
    """Find the highest of the next `BLOCK` points of a periodic line, from each point on.

    Parameters
    ----------
    line : numpy.ndarray
        Heights of a periodic line, shape (N,), int32 height steps.
    reach : int, optional
        Number of points to include beyond the end of the line, wrapped around.

    Returns
    -------
    numpy.ndarray
        Shape (N + reach,), int32.

    Examples
    --------
    >>> line = np.zeros(200, np.int32)
    >>> line[100] = 5
    >>> np.flatnonzero(highest_ahead(line))[[0, -1]].tolist()
    [37, 100]
    """
    highest = np.resize(line, line.size + reach + BLOCK)
    _replace_by_highest(highest)
    return highest[:-BLOCK]


@kernel
def fill_high_stretches(
    lines: Pair, ahead: Pair, first_1: int, first_2: int, film: int, line: Array, stretches: Pair
) -> int:
    """Add two lines in all stretches of blocks where their sum may lie above a film.

    Parameters
    ----------
    lines : tuple of numpy.ndarray
        Heights of the two periodic lines, shapes (N1,) and (N2,), int32 height steps.
    ahead : tuple of numpy.ndarray
        From `highest_ahead`, for each line; empty to add the lines everywhere, which is faster
        where one sum serves many time steps.
    first_1, first_2 : int
        Indices of the first points, within the lines.
    film : int
        Film thickness, height steps.
    line : numpy.ndarray
        Shape (L,), int32; filled with the sum, height steps, at least in the stretches.
    stretches : tuple of numpy.ndarray
        Filled with the first index of each stretch in `line` and the index after its last.

    Returns
    -------
    int
        Number of stretches.
    """
    if ahead[0].size == 0:
        add_lines(lines, first_1, first_2, line)
        stretches[0][0], stretches[1][0] = 0, line.size
        return 1
    highest_1 = ahead[0][first_1 : first_1 + line.size : BLOCK]
    highest_2 = ahead[1][first_2 : first_2 + line.size : BLOCK]
    starts, stops = stretches
    found = 0
    inside = False
    for block in range(highest_1.size):
        high = highest_1[block] + highest_2[block] > film
        if high:
            if not inside:
                starts[found] = block * BLOCK
                found += 1
            stops[found - 1] = min((block + 1) * BLOCK, line.size)
        inside = high
    for stretch in range(found):
        start, stop = starts[stretch], stops[stretch]
        add_lines(lines, first_1 + start, first_2 + start, line[start:stop])
    return found


@kernel
def find_runs(line: Array, film: int, stretches: Pair, count: int, runs: Pair) -> int:
    """Find the runs of points above a film within given stretches.

    Parameters
    ----------
    line : numpy.ndarray
        Heights, shape (L,), int32 height steps.
    film : int
        Film thickness, height steps.
    stretches : tuple of numpy.ndarray
        First index of each stretch to search and index after its last, int64.
    count : int
        Number of stretches.
    runs : tuple of numpy.ndarray
        Filled with the first index of each run and the index after its last, in order; length
        at least (L + 1) // 2.

    Returns
    -------
    int
        Number of runs.

    Examples
    --------
    >>> line = np.array([0, 3, 4, 0, 5], np.int32)
    >>> starts, stops = np.empty((2, 3), np.int64)
    >>> count = find_runs(line, 2, (np.array([0]), np.array([5])), 1, (starts, stops))
    >>> starts[:count], stops[:count]
    (array([1, 4]), array([3, 5]))
    """
    starts, stops = stretches
    new_starts, new_stops = runs
    found = 0
    for stretch in range(count):
        inside = False
        for i in range(starts[stretch], stops[stretch]):
            if line[i] > film:
                if not inside:
                    new_starts[found] = i
                    inside = True
            elif inside:
                new_stops[found] = i
                found += 1
                inside = False
        if inside:
            new_stops[found] = stops[stretch]
            found += 1
    return found
