"""The literal scan: the paper's model step by step and point by point.

It costs O(time steps x window points) and is the reference for every faster method. It is valid
for any two surface speeds.
"""

import numpy as np

from lube.kernels.compiler import kernel
from lube.kernels.layer import layer_breaks
from lube.kernels.motion import surface_position
from lube.types import Array, Pair, Ratios


@kernel
def scan_window(
    lines: Pair, first_1: int, first_2: int, film: Array, factor: float
) -> tuple[int, int, int]:
    r"""Find the segments in one contact window, and those whose boundary layer breaks.

    A segment is the longest possible run of neighbouring points with positive overlap

    .. math:: \Delta z = z_1 + z_2 - h > 0 ,

    cut at the window's edges.

    Parameters
    ----------
    lines : tuple of numpy.ndarray
        Heights of the two periodic lines, shapes (N1,) and (N2,), int32 height steps.
    first_1, first_2 : int
        Indices of the window's first point on the two lines.
    film : numpy.ndarray
        Film thickness h at each point of the window, shape (W,), int64 height steps.
    factor : float
        From `lube.kernels.layer.layer_factor`.

    Returns
    -------
    contact_points : int
        Points with positive overlap.
    broken_points : int
        Points of the segments whose boundary layer breaks.
    overlap : int
        Sum of the positive overlaps, height steps.

    Examples
    --------
    Two segments, of one and of two points; the layer breaks on the first only:

    >>> line = np.array([5, 0, 2, 2, 0], np.int32)
    >>> scan_window((line, np.zeros_like(line)), 0, 0, np.full(5, 1), 1.0)
    (3, 1, 6)
    """
    contact_points = broken_points = total_overlap = 0
    segment_points = segment_overlap = 0
    line_1, line_2 = lines
    i, k = first_1, first_2
    for point in range(film.size + 1):
        overlap = 0  # beyond the right edge, which cuts the last segment
        if point < film.size:
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
        i += 1
        if i == line_1.size:
            i = 0
        k += 1
        if k == line_2.size:
            k = 0
    return contact_points, broken_points, total_overlap


@kernel
def scan_trace(
    lines: Pair, speed_ratios: Ratios, steps: int, film: Array, before: int, factor: float
) -> Array:
    """Compute the contact at every time step of one operating point.

    Parameters
    ----------
    lines : tuple of numpy.ndarray
        Heights of the two periodic lines, shapes (N1,) and (N2,), int32 height steps.
    speed_ratios : tuple of float
        Surface speeds over that of the faster surface.
    steps : int
        Number T of time steps.
    film : numpy.ndarray
        Film thickness at each point of the window, shape (W,), int64 height steps.
    before : int
        Points of the window before its centre; floor(a / dx) of a flat film.
    factor : float
        From `lube.kernels.layer.layer_factor`.

    Returns
    -------
    numpy.ndarray
        Shape (T, 3), int64: contact points, broken points and overlap (height steps) in the
        window.

    Examples
    --------
    One high point passes a window of three points in pure rolling:

    >>> line = np.array([5, 0, 0, 0, 0], np.int32)
    >>> lines, film = (line, np.zeros_like(line)), np.full(3, 3)
    >>> scan_trace(lines, (1.0, 1.0), 5, film, 1, 1.0)[:, 0].tolist()
    [1, 1, 0, 0, 1]
    """
    trace = np.empty((steps, 3), np.int64)
    for step in range(steps):
        first_1 = (surface_position(step, speed_ratios[0]) - before) % lines[0].size
        first_2 = (surface_position(step, speed_ratios[1]) - before) % lines[1].size
        trace[step] = scan_window(lines, first_1, first_2, film, factor)
    return trace
