"""Contact judged by whole runs: what the edges of the contact window do not cut."""

import numpy as np

from lube.kernels.compiler import kernel
from lube.kernels.layer import layer_breaks
from lube.types import Array


@kernel
def whole_run_steps(line: Array, films: Array, half_windows: Array, factor: float) -> Array:
    """Count the windows that hold a part of a run whose boundary layer breaks as a whole.

    In `benchmarks/literal.py` the edges of the window cut a run, and the piece inside is judged.

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
        Shape (P,), int64: of the N windows, one around each point.

    Examples
    --------
    A run of two points breaks, so that the windows of three points that hold one of them count:

    >>> line = np.array([0, 0, 0, 8, 8, 0, 0, 0], np.int32)
    >>> whole_run_steps(line, np.array([2]), np.array([1]), 1.0).tolist()
    [4]
    """
    counts = np.zeros(films.size, np.int64)
    begin = np.argmin(line)
    for point in range(films.size):
        film, reach = films[point], half_windows[point]
        if line[begin] > film:  # one run without an end
            overlap = np.int64(line.sum()) - line.size * film
            counts[point] = line.size * layer_breaks(line.size, overlap, factor)
            continue
        first = covered = -line.size  # window after the last that counts
        points = overlap = 0
        # From a point that does not touch, so that the line's end cuts no run.
        for i in range(line.size + 1):
            height = line[(begin + i) % line.size] - film
            if height > 0:
                points += 1
                overlap += height
                continue
            if points > 0 and layer_breaks(points, overlap, factor):
                start = i - points - reach
                if counts[point] == 0:
                    first = start
                counts[point] += i + reach - max(start, covered)
                covered = i + reach
            points = overlap = 0
        # The last windows may be the first ones, seen again.
        counts[point] = min(counts[point] - max(0, covered - first - line.size), line.size)
    return counts
