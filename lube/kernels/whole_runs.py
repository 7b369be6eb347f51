"""Breakthrough of runs of touching points that the edges of the contact window do not cut."""

import numpy as np

from lube.kernels.layer import layer_breaks
from lube.types import Array


def whole_run_steps(line: Array, films: Array, half_windows: Array, factor: float) -> Array:
    """Count the windows that hold at least a part of a run whose boundary layer breaks.

    The run is judged uncut. In `benchmarks/literal.py` the edges of the window cut a run, and only
    the piece inside is judged.

    Parameters
    ----------
    line : numpy.ndarray
        Sum of two lines that roll without slip, shape (N,), int32 height steps; periodic.
    films, half_windows : numpy.ndarray
        Film thickness (height steps) and points on either side of the window's centre, shape
        (P,), int64.
    factor : float
        From `lube.kernels.layer.layer_factor`.

    Returns
    -------
    numpy.ndarray
        Shape (P,), int64: number of such windows, of N, one around each point of the line.

    Examples
    --------
    A run of two points breaks, so that the windows of three points that hold one of them count:

    >>> line = np.array([0, 0, 0, 8, 8, 0, 0, 0], np.int32)
    >>> whole_run_steps(line, np.array([2]), np.array([1]), 1.0).tolist()
    [4]
    """
    counts = np.zeros(films.size, np.int64)
    line = np.roll(line, -np.argmin(line))  # so that the line's end cuts no run
    height_before = np.append(0, np.cumsum(line, dtype=np.int64))
    for point, (film, reach) in enumerate(zip(films, half_windows, strict=True)):
        edges = np.flatnonzero(np.diff(line > film, prepend=False, append=False))
        starts, stops = edges[::2], edges[1::2]
        points = stops - starts
        overlap = height_before[stops] - height_before[starts] - points * film
        broken = layer_breaks(points, overlap, factor)
        if broken.any():
            starts, stops = starts[broken], stops[broken]
            gaps = np.append(starts[1:], starts[0] + line.size) - stops
            counts[point] = line.size - np.maximum(gaps - 2 * reach, 0).sum()
    return counts
