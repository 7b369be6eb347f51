"""The literal scan: the model as the paper tells it, step by step and point by point.

It costs O(steps x window) and serves as the reference for every faster method. It holds
for any two surface speeds.
"""

import numpy as np

from lube.kernels.compiler import kernel
from lube.kernels.layer import layer_breaks
from lube.kernels.motion import surface_position


@kernel
def scan_window(line_1, line_2, first_1, first_2, width, film, factor):
    """Find the segments in one window and what becomes of their boundary layers.

    A segment is a maximal run of points with positive overlap z1 + z2 - h0; the edges of
    the window cut it.

    Parameters
    ----------
    line_1, line_2 : numpy.ndarray
        Heights of the two periodic lines, shapes (N1,) and (N2,), int32 steps.
    first_1, first_2 : int
        Indices of the window's first point on either line.
    width : int
        Number of points in the window.
    film : int
        Film thickness h0, steps.
    factor : float
        From `lube.kernels.layer.layer_factor`.

    Returns
    -------
    contact_points : int
        Points with positive overlap.
    broken_points : int
        Points of segments whose layer breaks.
    overlap : int
        Sum of the positive overlaps, steps.
    """
    contact_points = broken_points = total_overlap = 0
    segment_points = segment_overlap = 0
    i, k = first_1, first_2
    for _ in range(width):
        overlap = np.int64(line_1[i]) + line_2[k] - film
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
    if segment_points > 0:  # cut by the right edge
        contact_points += segment_points
        total_overlap += segment_overlap
        if layer_breaks(segment_points, segment_overlap, factor):
            broken_points += segment_points
    return contact_points, broken_points, total_overlap


@kernel
def scan_trace(line_1, line_2, speed_ratios, steps, film, half_window, factor):
    """Contact at every time step, for one operating point (physics: section 5).

    Parameters
    ----------
    line_1, line_2 : numpy.ndarray
        Heights of the two periodic lines, shapes (N1,) and (N2,), int32 steps.
    speed_ratios : tuple of float
        Surface speeds over the faster one's.
    steps : int
        Number T of time steps.
    film : int
        Film thickness h0, steps.
    half_window : int
        Points m on either side of the window's middle, floor(a / dx).
    factor : float
        From `lube.kernels.layer.layer_factor`.

    Returns
    -------
    numpy.ndarray
        Shape (T, 3), int64: contact points, broken points and overlap (steps) in the window.
    """
    trace = np.empty((steps, 3), np.int64)
    width = 2 * half_window + 1
    for step in range(steps):
        first_1 = (surface_position(step, speed_ratios[0]) - half_window) % line_1.size
        first_2 = (surface_position(step, speed_ratios[1]) - half_window) % line_2.size
        trace[step] = scan_window(line_1, line_2, first_1, first_2, width, film, factor)
    return trace


@kernel
def scan_statistics(line_1, line_2, speed_ratios, steps, films, half_windows, factor):
    """Contact statistics of many operating points by the literal scan.

    Parameters
    ----------
    line_1, line_2, speed_ratios, steps, factor
        As in `scan_trace`.
    films, half_windows : numpy.ndarray
        Film thickness in steps and points beside the window's middle, shape (P,), int64.

    Returns
    -------
    numpy.ndarray
        Shape (P, 4), int64: steps with contact, steps with a broken layer, and the sums
        over all steps of broken points and of overlap (steps).
    """
    statistics = np.zeros((films.size, 4), np.int64)
    for point in range(films.size):
        half_window = half_windows[point]
        width = 2 * half_window + 1
        for step in range(steps):
            first_1 = surface_position(step, speed_ratios[0]) - half_window
            first_2 = surface_position(step, speed_ratios[1]) - half_window
            contact, broken, overlap = scan_window(
                line_1,
                line_2,
                first_1 % line_1.size,
                first_2 % line_2.size,
                width,
                films[point],
                factor,
            )
            statistics[point, 0] += contact > 0
            statistics[point, 1] += broken > 0
            statistics[point, 2] += broken
            statistics[point, 3] += overlap
    return statistics
