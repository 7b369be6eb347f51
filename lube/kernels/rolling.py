"""Pure rolling in O(N): both surfaces advance together, so the overlap line never changes.

The window then slides along one fixed line, the sum of the two. Every run of points above
the film is met in the same three ways by all windows: its beginning enters at the right
edge, it is seen whole (or fills the window), its end leaves at the left edge. So each run is
visited once, point by point, whatever the window's width, and all operating points share one
search for runs: a thicker film's runs lie within a thinner film's.
"""

import numpy as np

from lube.kernels.compiler import kernel
from lube.kernels.layer import layer_breaks


@kernel
def composite_line(line_1, line_2, steps, margin):
    """Sum of the two lines as the windows of pure rolling meet it.

    Parameters
    ----------
    line_1, line_2 : numpy.ndarray
        Heights of the two periodic lines, shapes (N1,) and (N2,), int32 steps.
    steps : int
        Number T of time steps.
    margin : int
        Points that the widest window reaches beyond its middle.

    Returns
    -------
    numpy.ndarray
        Shape (T + 2 margin,), int32 steps; the middle of the window at step t is at index
        t + margin.
    """
    line = np.empty(steps + 2 * margin, np.int32)
    i = -margin % line_1.size
    k = -margin % line_2.size
    done = 0
    while done < line.size:  # in stretches without wrap-around, which the compiler vectorises
        stretch = min(line_1.size - i, line_2.size - k, line.size - done)
        line[done : done + stretch] = line_1[i : i + stretch] + line_2[k : k + stretch]
        done += stretch
        i = (i + stretch) % line_1.size
        k = (k + stretch) % line_2.size
    return line


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


@kernel
def _record(step, points, steps, broken, lengths):
    """Note that at one step a segment of so many points has broken."""
    if step < 0 or step >= steps:
        return 0
    broken[step] = 1
    if lengths is not None:
        lengths[step] += points
    return points


@kernel
def _record_many(first, last, points, steps, broken, lengths):
    """Note the same for all the steps first..last."""
    first = max(first, 0)
    last = min(last, steps - 1)
    if first > last:
        return 0
    broken[first : last + 1] = 1
    if lengths is not None:
        lengths[first : last + 1] += points
    return points * (last - first + 1)


@kernel
def visit_run(line, start, stop, film, width, steps, factor, broken, lengths):
    """Let every window see one run, and note where its boundary layer breaks.

    The window of step t covers the indices t .. t + width - 1 of `line`.

    Parameters
    ----------
    line : numpy.ndarray
        Heights, int32 steps.
    start, stop : int
        The run's first index, and the index after its last.
    film : int
        Film thickness, steps.
    width : int
        Number of points in the window.
    steps : int
        Number T of time steps.
    factor : float
        From `lube.kernels.layer.layer_factor`.
    broken : numpy.ndarray
        Shape (T,), uint8; set to one at the steps where the layer breaks.
    lengths : numpy.ndarray or None
        Shape (T,), int64, the broken points at each step, added to; None if not wanted,
        which the compiler makes a kernel of its own of.

    Returns
    -------
    int
        Broken points summed over the steps.
    """
    total = 0
    points = min(stop - start, width)
    overlap = 0
    for i in range(1, points):  # the first i points have entered at the right edge
        overlap += line[start + i - 1] - film
        if layer_breaks(i, overlap, factor):
            step = start + i - width
            total += _record(step, i, steps, broken, lengths)
    overlap += line[start + points - 1] - film
    if layer_breaks(points, overlap, factor):  # seen whole, or filling the window first
        total += _record_many(
            stop - width if points < width else start, start, points, steps, broken, lengths
        )
    for step in range(start + 1, stop - width + 1):  # the run is longer than the window
        overlap += line[step + width - 1] - line[step - 1]
        if layer_breaks(width, overlap, factor):
            total += _record(step, width, steps, broken, lengths)
    for i in range(points - 1, 0, -1):  # the last i points have not yet left at the left edge
        overlap -= line[stop - i - 1] - film
        if layer_breaks(i, overlap, factor):
            total += _record(stop - i, i, steps, broken, lengths)
    return total


@kernel
def seen_overlap(line, start, stop, film, width, steps):
    """Sum of a run's overlaps over all windows that see them.

    Parameters
    ----------
    line, start, stop, film, width, steps
        As in `visit_run`.

    Returns
    -------
    int
        Overlap in steps, each point counted once for every window that holds it.
    """
    total = 0
    if start >= width - 1 and stop <= steps:  # away from the ends all windows pass over it
        for i in range(start, stop):
            total += line[i] - film
        return width * total
    for i in range(start, stop):
        windows = min(i, steps - 1) - max(0, i - width + 1) + 1
        total += windows * (line[i] - film)
    return total


@kernel
def rolling_statistics(line, margin, films, half_windows, factor):
    """Contact statistics of many operating points in pure rolling.

    Equal to `lube.kernels.scan.scan_statistics` to the last bit.

    Parameters
    ----------
    line : numpy.ndarray
        From `composite_line`, shape (T + 2 margin,).
    margin : int
        Points before the first window's middle; the largest of `half_windows`.
    films, half_windows : numpy.ndarray
        Film thickness in steps and points beside the window's middle, shape (P,), int64.
    factor : float
        From `lube.kernels.layer.layer_factor`.

    Returns
    -------
    numpy.ndarray
        Shape (P, 4), int64, as from `scan_statistics`.
    """
    steps = line.size - 2 * margin
    statistics = np.zeros((films.size, 4), np.int64)
    broken = np.empty(steps, np.uint8)
    capacity = line.size // 2 + 1
    starts, stops = np.zeros(capacity, np.int64), np.full(capacity, line.size)
    new_starts, new_stops = np.empty_like(starts), np.empty_like(stops)
    runs = 1
    for point in np.argsort(films, kind="mergesort"):
        film = films[point]
        runs = find_runs(line, film, starts, stops, runs, new_starts, new_stops)
        starts, new_starts = new_starts, starts
        stops, new_stops = new_stops, stops
        width = 2 * half_windows[point] + 1
        first = margin - half_windows[point]
        seen = line[first : line.size - first]  # what this window's size ever sees
        broken[:] = 0
        touched_until = -1
        for run in range(runs):
            start = max(starts[run] - first, 0)
            stop = min(stops[run] - first, seen.size)
            if start >= stop:
                continue
            # The run is touched at the steps start - width + 1 .. stop - 1.
            last = min(stop - 1, steps - 1)
            statistics[point, 0] += last - max(start - width, touched_until)
            touched_until = last
            statistics[point, 2] += visit_run(
                seen, start, stop, film, width, steps, factor, broken, None
            )
            statistics[point, 3] += seen_overlap(seen, start, stop, film, width, steps)
        statistics[point, 1] = np.sum(broken)
    return statistics


@kernel
def rolling_trace(line, film, half_window, factor):
    """Broken points at every time step of pure rolling, for one operating point.

    Parameters
    ----------
    line : numpy.ndarray
        From `composite_line` with this window's half as the margin, shape (T + 2 m,).
    film : int
        Film thickness, steps.
    half_window : int
        Points m beside the window's middle.
    factor : float
        From `lube.kernels.layer.layer_factor`.

    Returns
    -------
    numpy.ndarray
        Shape (T,), int64: points of broken segments in the window.
    """
    steps = line.size - 2 * half_window
    broken = np.zeros(steps, np.uint8)
    lengths = np.zeros(steps, np.int64)
    starts, stops = np.zeros(1, np.int64), np.full(1, line.size)
    new_starts = np.empty(line.size // 2 + 1, np.int64)
    new_stops = np.empty_like(new_starts)
    runs = find_runs(line, film, starts, stops, 1, new_starts, new_stops)
    width = 2 * half_window + 1
    for run in range(runs):
        visit_run(
            line, new_starts[run], new_stops[run], film, width, steps, factor, broken, lengths
        )
    return lengths
