"""Contact at any slip, strip by strip, equal to the literal scan to the last bit.

As long as both surfaces advance by one point a step, their alignment stays, and the window
slides along one fixed line, the sum of the two. Such a stretch of steps is a strip: the whole
revolution in pure rolling, some 1 / slip steps at small slip, a single step at large slip. On a
strip every run of points above the film is met by the windows in the same three ways: its
beginning enters at the right edge, it is seen whole (or fills the window), its end leaves at the
left edge. So each run is visited once, point by point, whatever the window's width. All operating
points share one search for runs: a thicker film's runs lie within a thinner film's.
"""

import numpy as np

from lube.kernels.compiler import kernel
from lube.kernels.layer import layer_breaks
from lube.kernels.motion import surface_position
from lube.kernels.runs import block_maxima, fill_high_stretches, find_runs

LONGEST_STRIP = 2**14
"""Longer strips are cut: what belongs to one then stays in the processor's nearest memory."""


@kernel
def strip_end(step, steps, speed_ratios):
    """First step after the strip that begins at a step.

    Parameters
    ----------
    step : int
        First step of the strip.
    steps : int
        Number T of time steps.
    speed_ratios : tuple of float
        Surface speeds over the faster one's.

    Returns
    -------
    int
        The step at which the alignment differs, or the strip is cut, or all is over.
    """
    last = min(steps, step + LONGEST_STRIP)
    if speed_ratios[0] == speed_ratios[1]:
        return last
    first_1, first_2 = (
        surface_position(step, speed_ratios[0]),
        surface_position(step, speed_ratios[1]),
    )
    end = step + 1
    while (
        end < last
        and surface_position(end, speed_ratios[0]) - first_1 == end - step
        and surface_position(end, speed_ratios[1]) - first_2 == end - step
    ):
        end += 1
    return end


@kernel
def overlap_sum(line, start, stop, film):
    """Sum of the overlaps of the points start .. stop - 1, steps."""
    total = np.int64(0)
    for i in range(start, stop):
        total += line[i]
    return total - (stop - start) * film


@kernel
def _record(step, points, broken, lengths):
    """Note that at a step of the strip a segment of so many points has broken."""
    broken[step] = 1
    if lengths is not None:
        lengths[step] += points
    return points


@kernel
def _record_many(first, last, points, broken, lengths):
    """Note the same for all the steps first..last."""
    broken[first : last + 1] = 1
    if lengths is not None:
        lengths[first : last + 1] += points
    return points * (last - first + 1)


@kernel
def visit_run(line, start, stop, film, width, factor, broken, lengths):
    """Let every window of a strip see one run, and note where its boundary layer breaks.

    The window of the strip's step t covers the indices t .. t + width - 1 of `line`.

    Parameters
    ----------
    line : numpy.ndarray
        Heights, shape (T + width - 1,), int32 steps.
    start, stop : int
        The run's first index, and the index after its last.
    film : int
        Film thickness, steps.
    width : int
        Number of points in the window.
    factor : float
        From `lube.kernels.layer.layer_factor`.
    broken : numpy.ndarray
        Shape (T,), uint8; set to one at the steps where the layer breaks.
    lengths : numpy.ndarray or None
        Shape (T,), int32, the broken points at each step, added to; None if not wanted,
        which the compiler makes a kernel of its own of.

    Returns
    -------
    int
        Broken points summed over the steps.
    """
    total = 0
    steps = broken.size
    points = min(stop - start, width)

    # The first i points have entered at the right edge, at step start + i - width.
    least, most = max(1, width - start), min(points - 1, steps - 1 + width - start)
    overlap = overlap_sum(line, start, start + least - 1, film) if least <= most else 0
    for i in range(least, most + 1):
        overlap += line[start + i - 1] - film
        if layer_breaks(i, overlap, factor):
            total += _record(start + i - width, i, broken, lengths)

    if stop - start <= width:  # seen whole
        first, last = max(stop - width, 0), min(start, steps - 1)
        if first <= last and layer_breaks(points, overlap_sum(line, start, stop, film), factor):
            total += _record_many(first, last, points, broken, lengths)
    else:  # fills the window, which slides along it
        overlap = overlap_sum(line, start, start + width, film)
        for step in range(start, min(stop - width, steps - 1) + 1):
            if step > start:
                overlap += line[step + width - 1] - line[step - 1]
            if layer_breaks(width, overlap, factor):
                total += _record(step, width, broken, lengths)

    # The last i points have not yet left at the left edge, at step stop - i.
    least, most = max(1, stop - steps + 1), min(points - 1, stop)
    overlap = overlap_sum(line, stop - most, stop, film) if least <= most else 0
    for i in range(most, least - 1, -1):
        if layer_breaks(i, overlap, factor):
            total += _record(stop - i, i, broken, lengths)
        overlap -= line[stop - i] - film
    return total


@kernel
def seen_overlap(line, start, stop, film, width, steps):
    """Sum of a run's overlaps over all windows of a strip that see them.

    Parameters
    ----------
    line, start, stop, film, width
        As in `visit_run`.
    steps : int
        Number of steps in the strip.

    Returns
    -------
    int
        Overlap in steps, each point counted once for every window that holds it.
    """
    if start >= width - 1 and stop <= steps:  # away from the ends all windows pass over it
        return width * overlap_sum(line, start, stop, film)
    total = 0
    for i in range(start, stop):
        windows = min(i, steps - 1) - max(0, i - width + 1) + 1
        total += windows * (line[i] - film)
    return total


@kernel
def _strip_point(line, starts, stops, runs, film, width, factor, broken, lengths, counts):
    """Add one operating point's statistics of one strip to its counts."""
    steps = broken.size
    first = (line.size - steps + 1 - width) // 2  # the widest window's margin, less this one's
    seen = line[first : line.size - first]
    broken[:] = 0
    touched_until = -1
    for run in range(runs):
        start = max(starts[run] - first, 0)
        stop = min(stops[run] - first, seen.size)
        if start >= stop:
            continue
        # The run is touched at the steps start - width + 1 .. stop - 1.
        last = min(stop - 1, steps - 1)
        counts[0] += last - max(start - width, touched_until)
        touched_until = last
        counts[2] += visit_run(seen, start, stop, film, width, factor, broken, lengths)
        counts[3] += seen_overlap(seen, start, stop, film, width, steps)
    counts[1] += np.sum(broken)


@kernel
def _steps_of(lengths, point, begin, end):
    """Pick where one operating point's lengths at the steps of a strip are kept, if at all."""
    if lengths is None:
        return None
    return lengths[point, begin:end]


@kernel
def _run_strips(
    line_1,
    line_2,
    speed_ratios,
    steps,
    films,
    half_windows,
    factor,
    thinnest_first,
    margin,
    lengths,
):
    """Statistics as of `strip_statistics`; fills the lengths of `strip_trace` if wanted."""
    statistics = np.zeros((films.size, 4), np.int64)
    buffer = np.empty(min(steps, LONGEST_STRIP) + 2 * margin, np.int32)
    marks = np.empty(buffer.size - 2 * margin, np.uint8)
    capacity = buffer.size // 2 + 1
    starts, stops = np.empty(capacity, np.int64), np.empty(capacity, np.int64)
    new_starts, new_stops = np.empty(capacity, np.int64), np.empty(capacity, np.int64)
    if speed_ratios[0] != speed_ratios[1]:
        maxima_1, maxima_2 = block_maxima(line_1, buffer.size), block_maxima(line_2, buffer.size)
    else:
        maxima_1 = maxima_2 = np.empty((0, 0), np.int32)
    begin = 0
    while begin < steps:
        end = strip_end(begin, steps, speed_ratios)
        line, broken = buffer[: end - begin + 2 * margin], marks[: end - begin]
        first_1 = (surface_position(begin, speed_ratios[0]) - margin) % line_1.size
        first_2 = (surface_position(begin, speed_ratios[1]) - margin) % line_2.size
        thinnest = films[thinnest_first[0]]
        runs = fill_high_stretches(
            line_1, line_2, maxima_1, maxima_2, first_1, first_2, thinnest, line, starts, stops
        )
        for point in thinnest_first:
            if runs == 0:  # nor has any thicker film
                break
            film, width = films[point], 2 * half_windows[point] + 1
            runs = find_runs(line, film, starts, stops, runs, new_starts, new_stops)
            starts, new_starts = new_starts, starts
            stops, new_stops = new_stops, stops
            kept = _steps_of(lengths, point, begin, end)
            counts = statistics[point]
            _strip_point(line, starts, stops, runs, film, width, factor, broken, kept, counts)
        begin = end
    return statistics


def strip_statistics(line_1, line_2, speed_ratios, steps, films, half_windows, factor):
    """Contact statistics of many operating points at any slip.

    Equal to `lube.kernels.scan.scan_statistics` to the last bit.

    Parameters
    ----------
    line_1, line_2 : numpy.ndarray
        Heights of the two periodic lines, shapes (N1,) and (N2,), int32 steps.
    speed_ratios : tuple of float
        Surface speeds over the faster one's.
    steps : int
        Number T of time steps.
    films, half_windows : numpy.ndarray
        Film thickness in steps and points beside the window's middle, shape (P,), int64.
    factor : float
        From `lube.kernels.layer.layer_factor`.

    Returns
    -------
    numpy.ndarray
        Shape (P, 4), int64, as from `scan_statistics`.
    """
    motion = line_1, line_2, speed_ratios, steps
    plan = _plan(films, half_windows)
    return _run_strips(*motion, films, half_windows, factor, *plan, None)


def strip_trace(line_1, line_2, speed_ratios, steps, films, half_windows, factor):
    """Broken points at every time step of many operating points, at any slip.

    Equal to the broken points of `lube.kernels.scan.scan_trace`.

    Parameters
    ----------
    line_1, line_2, speed_ratios, steps, films, half_windows, factor
        As in `strip_statistics`.

    Returns
    -------
    numpy.ndarray
        Shape (P, T), int32: points of broken segments in the window.
    """
    lengths = np.zeros((films.size, steps), np.int32)
    motion = line_1, line_2, speed_ratios, steps
    plan = _plan(films, half_windows)
    _run_strips(*motion, films, half_windows, factor, *plan, lengths)
    return lengths


def _plan(films, half_windows):
    """Operating points by rising film, and the margin that the widest window needs.

    Left to NumPy: to compile a sort takes longer than to compile the kernel.
    """
    return np.argsort(films, kind="stable"), int(half_windows.max())
