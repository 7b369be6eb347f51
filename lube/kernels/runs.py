"""Where the sum of two rough lines lies above a film.

Only blocks of points that may do so are looked at. In pure rolling the two lines keep one
alignment for the whole revolution, so their sum is made once and the highest of each block found.
With slip, alignments come and go, few steps each. The highest points of two blocks then bound
their sum: these are found once for all blocks that may ever meet, wherever they begin, and most
windows are known to be free of contact before a single height is added.
"""

import numpy as np

from lube.kernels.compiler import kernel

BLOCK = 32
"""Points whose highest decides on whether any of them is looked at."""


@kernel
def add_lines(line_1, line_2, first_1, first_2, line):
    """Fill the line of a strip with the sum of the two lines from the given indices on.

    Parameters
    ----------
    line_1, line_2 : numpy.ndarray
        Heights of the two periodic lines, shapes (N1,) and (N2,), int32 steps.
    first_1, first_2 : int
        Indices that come first, wrapped around.
    line : numpy.ndarray
        Filled, int32 steps.
    """
    i, k = first_1 % line_1.size, first_2 % line_2.size
    done = 0
    while done < line.size:  # in stretches without wrap-around, which the compiler vectorises
        stretch = min(line_1.size - i, line_2.size - k, line.size - done)
        for n in range(stretch):
            line[done + n] = line_1[i + n] + line_2[k + n]
        done += stretch
        i = (i + stretch) % line_1.size
        k = (k + stretch) % line_2.size


@kernel
def high_stretches(line, film, starts, stops):
    """Find the stretches of blocks in which some point lies above a film.

    Parameters
    ----------
    line : numpy.ndarray
        Heights, int32 steps.
    film : int
        Film thickness, steps.
    starts, stops : numpy.ndarray
        Filled with the first index and the index after the last of each stretch.

    Returns
    -------
    int
        How many stretches were found.
    """
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
def block_maxima(line, reach):
    """Highest point of every block of a periodic line, wherever the block begins.

    Parameters
    ----------
    line : numpy.ndarray
        Heights of a periodic line, shape (N,), int32 steps.
    reach : int
        Points, wrapped around, that stretches from anywhere on the line extend to.

    Returns
    -------
    numpy.ndarray
        Shape (BLOCK, C), int32: in row r and column c the highest of the `BLOCK` points from
        index r + c BLOCK on. So the blocks that follow one another stand side by side.
    """
    size = (line.size + reach) // BLOCK * BLOCK + BLOCK
    highest = np.empty(size + BLOCK, np.int32)
    done = 0
    while done < highest.size:
        stretch = min(line.size, highest.size - done)
        for i in range(stretch):
            highest[done + i] = line[i]
        done += stretch
    known = 1  # points that each maximum is taken of so far
    while known < BLOCK:
        for i in range(highest.size - known):
            highest[i] = max(highest[i], highest[i + known])
        known *= 2
    maxima = np.empty((BLOCK, size // BLOCK), np.int32)
    for column in range(maxima.shape[1]):
        for row in range(BLOCK):
            maxima[row, column] = highest[row + column * BLOCK]
    return maxima


@kernel
def possible_stretches(maxima_1, maxima_2, first_1, first_2, size, film, starts, stops):
    """Find the stretches of blocks in which the sum of two lines may lie above a film.

    Parameters
    ----------
    maxima_1, maxima_2 : numpy.ndarray
        From `block_maxima`, of either line.
    first_1, first_2 : int
        Indices that come first, not below zero.
    size : int
        Number of points to look at.
    film : int
        Film thickness, steps.
    starts, stops : numpy.ndarray
        Filled with the first index and the index after the last of each stretch, counted
        from the points that come first.

    Returns
    -------
    int
        How many stretches were found.
    """
    blocks = (size + BLOCK - 1) // BLOCK
    column_1, column_2 = first_1 // BLOCK, first_2 // BLOCK
    highest_1 = maxima_1[first_1 % BLOCK, column_1 : column_1 + blocks]
    highest_2 = maxima_2[first_2 % BLOCK, column_2 : column_2 + blocks]
    highest = np.int32(highest_1[0] + highest_2[0])
    for block in range(1, blocks):  # without a branch, so the compiler vectorises it
        highest = max(highest, np.int32(highest_1[block] + highest_2[block]))
    if highest <= film:
        return 0
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
    line_1, line_2, maxima_1, maxima_2, first_1, first_2, film, line, starts, stops
):
    """Add two lines in all stretches of blocks where their sum may lie above a film.

    Parameters
    ----------
    line_1, line_2 : numpy.ndarray
        Heights of the two periodic lines, shapes (N1,) and (N2,), int32 steps.
    maxima_1, maxima_2 : numpy.ndarray
        From `block_maxima`, of either line; empty to add the lines everywhere, which is the
        shorter way where the same sum serves many steps.
    first_1, first_2 : int
        Indices that come first, within the lines.
    film : int
        Film thickness, steps.
    line : numpy.ndarray
        Shape (L,), int32, filled with the sum wherever it lies above the film.
    starts, stops : numpy.ndarray
        Filled with the first index in `line` and the index after the last of each stretch.

    Returns
    -------
    int
        How many stretches were found.
    """
    if maxima_1.size == 0:
        add_lines(line_1, line_2, first_1, first_2, line)
        return high_stretches(line, film, starts, stops)
    count = possible_stretches(maxima_1, maxima_2, first_1, first_2, line.size, film, starts, stops)
    for stretch in range(count):
        start, stop = starts[stretch], stops[stretch]
        add_lines(line_1, line_2, first_1 + start, first_2 + start, line[start:stop])
    return count


@kernel
def find_runs(line, film, starts, stops, count, new_starts, new_stops):
    """Find the runs of points above a film, looking only within given stretches.

    Parameters
    ----------
    line : numpy.ndarray
        Heights, shape (L,), int32 steps.
    film : int
        Film thickness, steps.
    starts, stops : numpy.ndarray
        First index and index after the last of the stretches to look in, int64.
    count : int
        How many stretches there are.
    new_starts, new_stops : numpy.ndarray
        Filled with the runs found, in order; length at least (L + 1) // 2.

    Returns
    -------
    int
        How many runs were found.
    """
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
