"""Contact at any slip, strip by strip, equal to the literal scan to the last bit.

While both surfaces advance by one point per time step their alignment stays the same, and the
window slides along one fixed line, the sum of the two. Such a sequence of time steps is a *strip*:
the whole revolution in pure rolling, about 1 / slip steps at small slip, a single step at large
slip. On a strip the windows pass every run of points above the film in the same three phases: its
beginning enters at the right edge, it lies inside the window (or fills it), and its end leaves at
the left edge. So each run is visited once, point by point, for any width of the window. The search
for runs serves all operating points: the runs of a thicker film lie within those of a thinner one.
"""

import numpy as np

from lube.kernels.compiler import kernel
from lube.kernels.layer import layer_breaks
from lube.kernels.motion import surface_position
from lube.kernels.runs import fill_high_stretches, find_runs, highest_ahead
from lube.types import Array, Pair, Ratios

LONGEST_STRIP = 2**14
"""Time steps in the longest strip; the data of one strip stay in the processor's cache."""


@kernel
def _positions(step, speed_ratios):
    return surface_position(step, speed_ratios[0]), surface_position(step, speed_ratios[1])


@kernel
def strip_end(step: int, steps: int, speed_ratios: Ratios) -> int:
    """Find the end of the strip that begins at a time step.

    Parameters
    ----------
    step : int
        First time step of the strip.
    steps : int
        Number T of time steps.
    speed_ratios : tuple of float
        Surface speeds over that of the faster surface.

    Returns
    -------
    int
        The first time step after the strip: the alignment changes there, or the strip is cut
        at `LONGEST_STRIP` time steps, or T is reached.

    Examples
    --------
    >>> strip_end(0, 1000, (1.0, 0.99)), strip_end(0, 1000, (1.0, 1.0))
    (51, 1000)
    """
    last = min(steps, step + LONGEST_STRIP)
    if speed_ratios[0] == speed_ratios[1]:
        return last
    first_1, first_2 = _positions(step, speed_ratios)
    ahead_1, ahead_2 = first_1 - step, first_2 - step
    end = step + 1
    while end < last and _positions(end, speed_ratios) == (ahead_1 + end, ahead_2 + end):
        end += 1
    return end


@kernel
def _overlap_sum(line, start, stop, film):
    """Sum the overlaps of the points start .. stop - 1, in height steps."""
    total = np.int64(0)
    for i in range(np.uint64(start), np.uint64(stop)):
        total += line[i]
    return total - (stop - start) * film


@kernel
def _mark_step(step, points, broken, lengths):
    """Mark a time step at which the layer on a segment of n points is broken; return n."""
    broken[np.uint64(step)] = 1
    if lengths is not None:
        lengths[step] += points
    return points


@kernel
def _mark_steps(first, last, points, broken, lengths):
    """Mark the time steps first .. last in the same way; return n times their number."""
    # Numba takes seconds to compile the same with slices.
    for step in range(np.uint64(first), np.uint64(last + 1)):
        _mark_step(step, points, broken, lengths)
    return points * (last - first + 1)


@kernel
def _visit_run(line, start, stop, film, width, factor, broken, lengths):
    """Pass all windows of a strip over one run, and mark the steps at which the layer breaks on it.

    The window at the strip's time step t covers the indices t .. t + width - 1 of `line`.

    Parameters
    ----------
    line : numpy.ndarray
        Heights, shape (T + width - 1,), int32 height steps.
    start, stop : int
        First index of the run and the index after its last.
    film : int
        Film thickness, height steps.
    width : int
        Number of points in the window.
    factor : float
        From `lube.kernels.layer.layer_factor`.
    broken : numpy.ndarray
        Shape (T,), uint8; set to one at the time steps where the layer breaks.
    lengths : numpy.ndarray or None
        Shape (T,), int32; the broken points are added at each time step. With None they are
        not counted step by step, and Numba compiles a kernel without them.

    Returns
    -------
    int
        Broken points summed over the time steps.

    Examples
    --------
    A run of two points breaks in all four windows of three points that hold one of them:

    >>> line = np.array([0, 0, 9, 9, 0, 0], np.int32)
    >>> broken, lengths = np.zeros(4, np.uint8), np.zeros(4, np.int32)
    >>> _visit_run(line, 2, 4, 1, 3, 1.0, broken, lengths), lengths.tolist()
    (6, [1, 2, 2, 1])
    """
    total = 0
    steps = broken.size
    points = min(stop - start, width)

    # The first i points have entered at the right edge: time step start + i - width.
    least, most = max(1, width - start), min(points - 1, steps - 1 + width - start)
    overlap = _overlap_sum(line, start, start + least - 1, film) if least <= most else 0
    for i in range(least, most + 1):
        overlap += line[np.uint64(start + i - 1)] - film
        if layer_breaks(i, overlap, factor):
            total += _mark_step(start + i - width, i, broken, lengths)

    if stop - start <= width:  # lies inside the window
        first, last = max(stop - width, 0), min(start, steps - 1)
        if first <= last and layer_breaks(points, _overlap_sum(line, start, stop, film), factor):
            total += _mark_steps(first, last, points, broken, lengths)
    else:  # fills the window, which slides along it
        overlap = _overlap_sum(line, start, start + width, film)
        for step in range(start, min(stop - width, steps - 1) + 1):
            if step > start:
                overlap += line[step + width - 1] - line[step - 1]
            if layer_breaks(width, overlap, factor):
                total += _mark_step(step, width, broken, lengths)

    # The last i points have not yet left at the left edge: time step stop - i.
    least, most = max(1, stop - steps + 1), min(points - 1, stop)
    overlap = _overlap_sum(line, stop - most, stop, film) if least <= most else 0
    for i in range(most, least - 1, -1):
        if layer_breaks(i, overlap, factor):
            total += _mark_step(stop - i, i, broken, lengths)
        overlap -= line[np.uint64(stop - i)] - film
    return total


@kernel
def _windowed_overlap(line, start, stop, film, width, steps):
    """Sum the overlaps of a run over all windows of a strip.

    Parameters
    ----------
    line, start, stop, film, width
        As in `_visit_run`.
    steps : int
        Number of time steps in the strip.

    Returns
    -------
    int
        Overlap in height steps, each point counted once for every window that holds it.

    Examples
    --------
    >>> _windowed_overlap(np.array([0, 0, 9, 9, 0, 0], np.int32), 2, 4, 1, 3, 4)
    48
    """
    if start >= width - 1 and stop <= steps:  # away from the ends every window passes over it
        return width * _overlap_sum(line, start, stop, film)
    total = 0
    for i in range(start, stop):
        windows = min(i, steps - 1) - max(0, i - width + 1) + 1
        total += windows * (line[i] - film)
    return total


@kernel
def _strip_point(line, runs, found, film, width, factor, broken, lengths, counts):
    """Add one operating point's statistics of one strip to its counts."""
    steps = broken.size
    first = (line.size - steps + 1 - width) // 2  # the widest window's margin, less this one's
    line = line[first : line.size - first]
    broken[:] = 0
    contact_until = -1
    for run in range(found):
        start = max(runs[0][run] - first, 0)
        stop = min(runs[1][run] - first, line.size)
        if start >= stop:
            continue
        # The window holds a part of the run at the time steps start - width + 1 .. stop - 1.
        last = min(stop - 1, steps - 1)
        counts[0] += last - max(start - width, contact_until)
        contact_until = last
        counts[2] += _visit_run(line, start, stop, film, width, factor, broken, lengths)
        counts[3] += _windowed_overlap(line, start, stop, film, width, steps)
    marked = np.uint32(0)
    for step in range(steps):
        marked = np.uint32(marked + broken[step])
    counts[1] += marked


@kernel
def _steps_of(trace, point, begin, end):
    """Return one operating point's part of a trace, or None."""
    if trace is None:
        return None
    return trace[point, begin:end]


@kernel
def _run_strips(
    lines, speed_ratios, steps, films, half_windows, factor, thinnest_first, ahead, trace
):
    """Return the statistics of `strip_statistics`; fill the trace of `strip_trace` if given.

    The operating points are sorted outside, because compiling a sort takes longer than compiling
    this kernel.
    """
    statistics, margin = np.zeros((films.size, 4), np.int64), half_windows.max()
    buffer = np.empty(min(steps, LONGEST_STRIP) + 2 * margin, np.int32)
    marks = np.empty(buffer.size - 2 * margin, np.uint8)
    capacity = buffer.size // 2 + 1
    runs = np.empty(capacity, np.int64), np.empty(capacity, np.int64)
    found_before = np.empty(capacity, np.int64), np.empty(capacity, np.int64)
    begin = 0
    while begin < steps:
        end = strip_end(begin, steps, speed_ratios)
        line, broken = buffer[: end - begin + 2 * margin], marks[: end - begin]
        position_1, position_2 = _positions(begin, speed_ratios)
        first_1 = (position_1 - margin) % lines[0].size
        first_2 = (position_2 - margin) % lines[1].size
        searched = films[thinnest_first[0]]
        found = fill_high_stretches(lines, ahead, first_1, first_2, searched, line, runs)
        searched -= 1  # the stretches are not yet divided into runs
        for point in thinnest_first:
            if found == 0:  # a thicker film has none either
                break
            film, width = films[point], 2 * half_windows[point] + 1
            if film > searched:
                runs, found_before = found_before, runs
                found = find_runs(line, film, found_before, found, runs)
                searched = film
            lengths, counts = _steps_of(trace, point, begin, end), statistics[point]
            _strip_point(line, runs, found, film, width, factor, broken, lengths, counts)
        begin = end
    return statistics


def _run(lines, speed_ratios, steps, films, half_windows, factor, trace):
    """Prepare and call `_run_strips`."""
    # For another layout in memory Numba would compile the kernel once more.
    films, half_windows = np.ascontiguousarray([films, half_windows])
    order, ahead = np.argsort(films, kind="stable"), (np.zeros(0, np.int32),) * 2
    if speed_ratios[0] != speed_ratios[1]:
        reach = min(steps, LONGEST_STRIP) + 2 * half_windows.max()
        ahead = highest_ahead(lines[0], reach), highest_ahead(lines[1], reach)
    return _run_strips(lines, speed_ratios, steps, films, half_windows, factor, order, ahead, trace)


def strip_statistics(
    lines: Pair, speed_ratios: Ratios, steps: int, films: Array, half_windows: Array, factor: float
) -> Array:
    """Compute the contact statistics of many operating points at any slip.

    Equal to the literal scan, `benchmarks/literal.py`, to the last bit.

    Parameters
    ----------
    lines : tuple of numpy.ndarray
        Heights of the two periodic lines, shapes (N1,) and (N2,), int32 height steps.
    speed_ratios : tuple of float
        Surface speeds over that of the faster surface.
    steps : int
        Number T of time steps.
    films, half_windows : numpy.ndarray
        Film thickness (height steps) and points on either side of the window's centre, shape
        (P,), int64.
    factor : float
        From `lube.kernels.layer.layer_factor`.

    Returns
    -------
    numpy.ndarray
        Shape (P, 4), int64: time steps with contact, time steps with a broken boundary layer,
        and the sums over all time steps of broken points and of overlap (height steps).

    Examples
    --------
    >>> line = np.array([5, 0, 0, 0, 0], np.int32)
    >>> lines, films = (line, np.zeros_like(line)), np.array([3, 9])
    >>> strip_statistics(lines, (1.0, 1.0), 5, films, np.array([1, 1]), 1.0).tolist()
    [[3, 3, 3, 6], [0, 0, 0, 0]]
    """
    return _run(lines, speed_ratios, steps, films, half_windows, factor, None)


def strip_trace(
    lines: Pair, speed_ratios: Ratios, steps: int, films: Array, half_windows: Array, factor: float
) -> Array:
    """Count the broken points at every time step of many operating points, at any slip.

    Equal to the broken points of `benchmarks/literal.py`.

    Parameters
    ----------
    lines, speed_ratios, steps, films, half_windows, factor
        As in `strip_statistics`.

    Returns
    -------
    numpy.ndarray
        Shape (P, T), int32: points in the window whose segment's boundary layer is broken.

    Examples
    --------
    >>> line = np.array([5, 0, 0, 0, 0], np.int32)
    >>> lines, film, half_window = (line, np.zeros_like(line)), np.array([3]), np.array([1])
    >>> strip_trace(lines, (1.0, 1.0), 5, film, half_window, 1.0).tolist()
    [[1, 1, 0, 0, 1]]
    """
    trace = np.zeros((films.size, steps), np.int32)
    _run(lines, speed_ratios, steps, films, half_windows, factor, trace)
    return trace
