"""Runs of points at which the sum of two rough lines lies above a film.

Points are searched in blocks, and blocks that cannot reach above the film are skipped. In pure
rolling the two lines keep one alignment for the whole revolution, so their sum is computed once,
and then the maximum of each block. With slip an alignment lasts for a few time steps only. There
the maxima of two blocks together are an upper limit of their sum. They are computed once, for
blocks that begin at any point, and exclude most windows before any heights are added.
"""

import numpy as np

from lube.kernels.compiler import kernel
from lube.types import Array, Pair

BLOCK = 32
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
def _high_stretches(line, film, stretches):
    """Find the stretches of successive blocks that each have a point above a film.

    Parameters
    ----------
    line : numpy.ndarray
        Heights, shape (L,), int32 height steps.
    film : int
        Film thickness, height steps.
    stretches : tuple of numpy.ndarray
        Filled with the first index of each stretch and the index after its last.

    Returns
    -------
    int
        Number of stretches.

    Examples
    --------
    >>> line = np.zeros(5 * BLOCK, np.int32)
    >>> line[[BLOCK + 1, 2 * BLOCK + 5, 4 * BLOCK]] = 9
    >>> starts, stops = np.empty((2, 9), np.int64)
    >>> count = _high_stretches(line, 8, (starts, stops))
    >>> starts[:count] // BLOCK, stops[:count] // BLOCK
    (array([1, 4]), array([3, 5]))
    """
    starts, stops = stretches
    found = 0
    inside = False
    for start in range(0, line.size, BLOCK):
        stop = min(start + BLOCK, line.size)
        highest = line[start]
        for i in range(start, stop):
            highest = max(highest, line[i])
        if highest > film:
            if not inside:
                starts[found] = start
                found += 1
            stops[found - 1] = stop
        inside = highest > film
    return found


@kernel
def block_maxima(line: Array, reach: int) -> Array:
    """Compute the maximum of each block of a periodic line, for blocks that begin at any point.

    Parameters
    ----------
    line : numpy.ndarray
        Heights of a periodic line, shape (N,), int32 height steps.
    reach : int
        Number of points to include beyond the end of the line, wrapped around.

    Returns
    -------
    numpy.ndarray
        Shape (BLOCK, C), int32: in row r and column c the maximum of the `BLOCK` points from
        index r + c BLOCK on. Successive blocks are neighbours in a row.

    Examples
    --------
    >>> maxima = block_maxima(np.arange(100, dtype=np.int32), 0)
    >>> maxima[0, :3].tolist()
    [31, 63, 95]
    """
    size = (line.size + reach) // BLOCK * BLOCK + BLOCK
    highest = np.empty(size + BLOCK, np.int32)
    done = 0
    while done < highest.size:
        stretch = min(line.size, highest.size - done)
        for i in range(stretch):
            highest[done + i] = line[i]
        done += stretch
    covered = 1  # points in each maximum so far
    while covered < BLOCK:
        for i in range(highest.size - covered):
            highest[i] = max(highest[i], highest[i + covered])
        covered *= 2
    maxima = np.empty((BLOCK, size // BLOCK), np.int32)
    for column in range(maxima.shape[1]):
        for row in range(BLOCK):
            maxima[row, column] = highest[row + column * BLOCK]
    return maxima


@kernel
def _possible_stretches(maxima, first_1, first_2, size, film, stretches):
    """Find the stretches of blocks in which the sum of two lines may lie above a film.

    Parameters
    ----------
    maxima : tuple of numpy.ndarray
        From `block_maxima`, for each line.
    first_1, first_2 : int
        Indices of the first points, zero or more.
    size : int
        Number of points to search.
    film : int
        Film thickness, height steps.
    stretches : tuple of numpy.ndarray
        Filled with the first index of each stretch and the index after its last, counted from
        the first points.

    Returns
    -------
    int
        Number of stretches.

    Examples
    --------
    >>> line = np.zeros(4 * BLOCK, np.int32)
    >>> line[2 * BLOCK] = 9
    >>> maxima = block_maxima(line, line.size)
    >>> starts, stops = np.empty((2, 9), np.int64)
    >>> maxima = maxima, maxima
    >>> count = _possible_stretches(maxima, 0, 0, line.size, 8, (starts, stops))
    >>> starts[:count] // BLOCK, stops[:count] // BLOCK
    (array([2]), array([3]))
    """
    blocks = (size + BLOCK - 1) // BLOCK
    column_1, column_2 = first_1 // BLOCK, first_2 // BLOCK
    highest_1 = maxima[0][first_1 % BLOCK, column_1 : column_1 + blocks]
    highest_2 = maxima[1][first_2 % BLOCK, column_2 : column_2 + blocks]
    highest = np.int32(highest_1[0] + highest_2[0])
    for block in range(1, blocks):  # without a branch, so the compiler vectorises it
        highest = max(highest, np.int32(highest_1[block] + highest_2[block]))
    if highest <= film:
        return 0
    starts, stops = stretches
    found = 0
    inside = False
    for block in range(blocks):
        high = highest_1[block] + highest_2[block] > film
        if high:
            if not inside:
                starts[found] = block * BLOCK
                found += 1
            stops[found - 1] = min((block + 1) * BLOCK, size)
        inside = high
    return found


@kernel
def fill_high_stretches(
    lines: Pair, maxima: Pair, first_1: int, first_2: int, film: int, line: Array, stretches: Pair
) -> int:
    """Add two lines in all stretches of blocks where their sum may lie above a film.

    Parameters
    ----------
    lines : tuple of numpy.ndarray
        Heights of the two periodic lines, shapes (N1,) and (N2,), int32 height steps.
    maxima : tuple of numpy.ndarray
        From `block_maxima`, for each line; empty to add the lines everywhere, which is faster
        where one sum serves many time steps.
    first_1, first_2 : int
        Indices of the first points, within the lines.
    film : int
        Film thickness, height steps.
    line : numpy.ndarray
        Shape (L,), int32; filled with the sum, height steps, in the stretches at least.
    stretches : tuple of numpy.ndarray
        Filled with the first index of each stretch in `line` and the index after its last.

    Returns
    -------
    int
        Number of stretches.
    """
    if maxima[0].size == 0:
        add_lines(lines, first_1, first_2, line)
        return _high_stretches(line, film, stretches)
    count = _possible_stretches(maxima, first_1, first_2, line.size, film, stretches)
    for stretch in range(count):
        start, stop = stretches[0][stretch], stretches[1][stretch]
        add_lines(lines, first_1 + start, first_2 + start, line[start:stop])
    return count


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
