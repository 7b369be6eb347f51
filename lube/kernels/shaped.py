"""Contact under a film that is not flat: its thickness rides with the contact window.

Where no line can reach the film, blocks of points are passed over by the highest heights of both
lines there; where it can, the points are read as in the literal scan, to which this is equal to the
last bit. Windows a tenth of the contact apart see nearly the same, so for probabilities not every
time step needs one.
"""

import numpy as np

from lube.kernels.compiler import kernel
from lube.kernels.layer import layer_breaks
from lube.kernels.motion import surface_position
from lube.types import Array, Pair, Ratios

BLOCK = 64
"""Points that are passed over together."""


@kernel
def highest_ahead(line: Array) -> Array:
    """Find the highest of the next `BLOCK` points of a periodic line, from each point on.

    Parameters
    ----------
    line : numpy.ndarray
        Heights, shape (N,), int32 height steps.

    Returns
    -------
    numpy.ndarray
        Shape (N,), int32.

    Examples
    --------
    >>> line = np.zeros(200, np.int32)
    >>> line[100] = 5
    >>> np.flatnonzero(highest_ahead(line))[[0, -1]].tolist()
    [37, 100]
    """
    size = line.size
    # Of windows of 1, 2, 4, ... points, each twice as long as the one before.
    highest = line.copy()
    length = 1
    while length < BLOCK:
        ahead = np.empty_like(highest)
        for i in range(size):
            ahead[i] = max(highest[i], highest[(i + length) % size])
        highest = ahead
        length *= 2
    return highest


@kernel
def _least_by_block(film):
    """Thinnest film in each block of a window."""
    blocks = (film.size + BLOCK - 1) // BLOCK
    least = np.empty(blocks, film.dtype)
    for b in range(blocks):
        least[b] = film[b * BLOCK : (b + 1) * BLOCK].min()
    return least


@kernel
def _window(lines, highest, first_1, first_2, films, factor):
    """Contact points, broken points and overlap in one window, as in the literal scan."""
    film, least = films
    line_1, line_2 = lines
    contact_points = broken_points = total_overlap = 0
    segment_points = segment_overlap = 0
    for block in range(least.size):
        begin = block * BLOCK
        i, k = (first_1 + begin) % line_1.size, (first_2 + begin) % line_2.size
        touched = np.int64(highest[0][i]) + highest[1][k] > least[block]
        if not touched and segment_points == 0:
            continue
        for point in range(begin, min(begin + BLOCK, film.size)):
            overlap = np.int64(line_1[i]) + line_2[k] - film[point]
            if overlap > 0:
                segment_points += 1
                segment_overlap += overlap
            elif segment_points > 0:
                contact_points += segment_points
                total_overlap += segment_overlap
                if layer_breaks(segment_points, segment_overlap, factor):
                    broken_points += segment_points
                segment_points = segment_overlap = 0
                if not touched:
                    break  # the segment began in the block before; no other begins in this one
            i += 1
            if i == line_1.size:
                i = 0
            k += 1
            if k == line_2.size:
                k = 0
    if segment_points > 0:  # cut by the window's edge
        contact_points += segment_points
        total_overlap += segment_overlap
        if layer_breaks(segment_points, segment_overlap, factor):
            broken_points += segment_points
    return contact_points, broken_points, total_overlap


@kernel
def shaped_trace(
    lines: Pair,
    speed_ratios: Ratios,
    steps: int,
    windows: int,
    film: Array,
    before: int,
    factor: float,
) -> Array:
    """Compute the contact in windows evenly spread over the time steps of one operating point.

    Parameters
    ----------
    lines : tuple of numpy.ndarray
        Heights of the two periodic lines, shapes (N1,) and (N2,), int32 height steps.
    speed_ratios : tuple of float
        Surface speeds over that of the faster surface.
    steps : int
        Number T of time steps.
    windows : int
        Number of windows; T for one at each time step.
    film : numpy.ndarray
        Film thickness at each point of the window, shape (W,), int64 height steps.
    before : int
        Points of the window before its centre.
    factor : float
        From `lube.kernels.layer.layer_factor`.

    Returns
    -------
    numpy.ndarray
        Shape (windows, 3), int64: contact points, broken points and overlap (height steps).

    Examples
    --------
    One high point passes a window of three points, with a film that is thin in the middle only:

    >>> line = np.array([5, 0, 0, 0, 0], np.int32)
    >>> film = np.array([9, 3, 9])
    >>> lines = line, np.zeros_like(line)
    >>> shaped_trace(lines, (1.0, 1.0), 5, 5, film, 1, 1.0)[:, 0].tolist()
    [1, 0, 0, 0, 0]
    """
    trace = np.empty((windows, 3), np.int64)
    films = film, _least_by_block(film)
    highest = highest_ahead(lines[0]), highest_ahead(lines[1])
    for window in range(windows):
        step = window * steps // windows
        first_1 = (surface_position(step, speed_ratios[0]) - before) % lines[0].size
        first_2 = (surface_position(step, speed_ratios[1]) - before) % lines[1].size
        trace[window] = _window(lines, highest, first_1, first_2, films, factor)
    return trace


@kernel
def shaped_statistics(
    lines: Pair,
    speed_ratios: Ratios,
    steps: int,
    windows: Array,
    films: tuple[Array, Array, Array],
    factor: float,
) -> Array:
    """Compute the contact statistics of many operating points.

    Parameters
    ----------
    lines, speed_ratios, steps, factor
        As in `shaped_trace`.
    windows : numpy.ndarray
        Number of windows of each operating point, shape (P,), int64.
    films : tuple of numpy.ndarray
        Films of all windows one behind the other, int64 height steps; where the film of each
        operating point begins, and the end of the last, shape (P + 1,); and the points of each
        window before its centre, shape (P,).

    Returns
    -------
    numpy.ndarray
        Shape (P, 4), means over the windows: share with contact, share with a broken boundary
        layer, broken points, and overlap (height steps).

    Examples
    --------
    >>> line = np.array([5, 0, 0, 0, 0], np.int32)
    >>> films = np.array([9, 3, 9]), np.array([0, 3]), np.array([1])
    >>> lines = line, np.zeros_like(line)
    >>> shaped_statistics(lines, (1.0, 1.0), 5, np.array([5]), films, 1.0).tolist()
    [[0.2, 0.2, 0.2, 0.4]]
    """
    film, begin, before = films
    highest = highest_ahead(lines[0]), highest_ahead(lines[1])
    sums = np.zeros((windows.size, 4), np.int64)
    for point in range(windows.size):
        own = film[begin[point] : begin[point + 1]]
        both = own, _least_by_block(own)
        for window in range(windows[point]):
            step = window * steps // windows[point]
            first_1 = surface_position(step, speed_ratios[0]) - before[point]
            first_2 = surface_position(step, speed_ratios[1]) - before[point]
            found = _window(
                lines, highest, first_1 % lines[0].size, first_2 % lines[1].size, both, factor
            )
            sums[point, 0] += found[0] > 0
            sums[point, 1] += found[1] > 0
            sums[point, 2] += found[1]
            sums[point, 3] += found[2]
    return sums / windows.reshape(-1, 1)
