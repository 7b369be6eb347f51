"""Contact of rough lines at any rarity: windows and runs in which one point is known to touch.

Heights are height steps in single precision: a line that is moved until it touches the film has no
whole-number heights any more.
"""

from typing import NamedTuple

import numpy as np

from lube.kernels.compiler import inlined, kernel
from lube.kernels.layer import layer_breaks
from lube.kernels.runs import BLOCK
from lube.types import Array, Pair


class _MovedLines(NamedTuple):
    """Two lines around a known point, moved by `rise` times their covariance with it."""

    lines: Pair
    place: int
    correlations: Pair
    reach: int
    rise: float
    film: float


@kernel
def touching_windows(
    line: Array, starts: Array, correlation: Array, touching: Pair, film: Array, factor: float
) -> tuple[float, float]:
    r"""Weigh windows in which one point is known to touch.

    In each window a Gaussian line is moved so that it passes through a given height above the
    film at a given point,

    .. math:: z_j = z'_j + \rho_{j - \tau} (z_\tau - z'_\tau) ,

    with the line z' as it was drawn. A window of n touching points could have been chosen by any
    of them, so it counts 1/n.

    Parameters
    ----------
    line : numpy.ndarray
        Sum z' of two Gaussian lines, float32 height steps.
    starts : numpy.ndarray
        Shape (M,), index of each window's first point in the line.
    correlation : numpy.ndarray
        Shape (2 W - 1,), float32: autocorrelation :math:`\rho` of the sum at the lags
        -(W - 1) .. W - 1 points.
    touching : tuple of numpy.ndarray
        Shape (M,) each: the point :math:`\tau` that is known to touch in each window, counted from
        the window's first, and its height :math:`z_\tau`, float32 height steps.
    film : numpy.ndarray
        Shape (W,), float32: film thickness at each point of the window, height steps.
    factor : float
        From `lube.kernels.layer.layer_factor`.

    Returns
    -------
    contact, breakthrough : float
        Mean weight of all windows, and of those in which a boundary layer breaks, the others
        counted as zero.

    Examples
    --------
    A flat line without correlation touches a film of 2 at one point only:

    >>> line, film = np.zeros(9, np.float32), np.full(3, 2, np.float32)
    >>> correlation = np.array([0, 0, 1, 0, 0], np.float32)
    >>> touching = np.array([1]), np.array([3], np.float32)
    >>> touching_windows(line, np.array([4]), correlation, touching, film, 2.0)
    (1.0, 1.0)
    """
    width = film.size
    contact = breakthrough = 0.0
    overlap = np.empty(width, np.float32)
    for m in range(starts.size):
        origin = touching[0][m]
        window = line[starts[m] : starts[m] + width]
        shape = correlation[width - 1 - origin : 2 * width - 1 - origin]
        rise = touching[1][m] - window[origin]
        for j in range(width):  # without a branch, so the compiler vectorises it
            overlap[j] = window[j] + shape[j] * rise - film[j]
        points, broken, _ = judged(overlap, factor)
        weight = 1.0 / max(points, 1)  # rounding may put the known point just below the film
        contact += weight
        if broken:
            breakthrough += weight
    return contact / starts.size, breakthrough / starts.size


@inlined
def judged(overlap, factor):
    """Count touching points, and find the first segment whose boundary layer breaks.

    Returns the number of touching points, whether there is such a segment, and its first point, or
    the number of points of the window if there is none.
    """
    points, total, touching = 0, 0.0, 0
    broken, begin = False, overlap.size
    for first in range(0, overlap.size, BLOCK):
        block = overlap[first : first + BLOCK]
        here = np.int32(0)  # as wide as the heights, so the compiler vectorises the loop
        for j in range(block.size):
            here = np.int32(here + np.int32(block[j] > np.float32(0.0)))
        touching += here
        # In most blocks no point touches: no segment begins, goes on or ends there.
        if broken or (here == 0 and points == 0):
            continue
        for j in range(block.size):
            if block[j] > 0.0:
                points += 1
                total += block[j]
            elif points > 0:
                if layer_breaks(points, total, factor):
                    broken, begin = True, first + j - points
                    break
                points, total = 0, 0.0
    if not broken and layer_breaks(points, total, factor):
        broken, begin = True, overlap.size - points
    return touching, broken, begin


@kernel
def touching_runs(
    lines: Pair,
    places: Array,
    correlations: Pair,
    heights: Array,
    film: float,
    width: int,
    factor: float,
) -> Array:
    r"""Weigh runs of points above a film, each found from one point that is known to touch.

    The lines are moved as in `touching_windows`, each by its part of the autocorrelation. A
    run of n points could have been found from any of them, so it counts 1/n. Runs are not cut by a
    window.

    Parameters
    ----------
    lines : tuple of numpy.ndarray
        Two Gaussian lines, float32 height steps.
    places : numpy.ndarray
        Shape (M,), index of the known point in the lines.
    correlations : tuple of numpy.ndarray
        Shape (2 L + 1,) each, float32: autocovariance of each line over the variance of their
        sum, at the lags -L .. L points.
    heights : numpy.ndarray
        Shape (M,), float32 height steps: the sum of the lines at the known point.
    film : float
        Film thickness, height steps.
    width : int
        Points in a contact window.
    factor : float
        From `lube.kernels.layer.layer_factor`.

    Returns
    -------
    numpy.ndarray
        Shape (10,), sums over the M runs. A run is *broken* if its boundary layer breaks.

        - 0: weights of all runs; 1: of the broken runs;
        - 2: weights of the broken runs without another one within L points behind the known point;
        - 3: weights of the broken runs without a forerunner one relative step earlier;
        - 4, 5: as 1 and 3, each weight times the points of the run;
        - 6: as 2, each weight times the points that were searched behind the run;
        - 7 to 9: weights of the broken runs with another one behind; 7: each times the points
          between the two; 8: times the windows that hold neither; 9: times the sum over these
          windows of the steps until the next run.
    """
    sums = np.zeros(10)
    reach = correlations[0].size // 2
    behind = np.empty(reach + 1, np.float32)
    correlation = correlations[0] + correlations[1]
    for m in range(places.size):
        place = places[m]
        rise = heights[m] - (lines[0][place] + lines[1][place])
        moved = _MovedLines(lines, place, correlations, reach, rise, film)
        start, stop, total = _run_around(moved, 0, 0)
        points = max(stop - start, 1)  # rounding may put the known point just below the film
        weight = 1.0 / points
        sums[0] += weight
        if layer_breaks(points, total, factor):
            sums[1] += weight
            sums[4] += 1.0
            rest = behind[: reach + 1 - stop]
            first, second = lines[0][place + stop :], lines[1][place + stop :]
            known = correlation[reach + stop :]
            for j in range(rest.size):  # without a branch, so the compiler vectorises it
                rest[j] = first[j] + second[j] + known[j] * rise - film
            _, broken, between = judged(rest, factor)
            if broken:
                gap = max(between - width + 1, 0)
                sums[7] += weight * between
                sums[8] += weight * gap
                sums[9] += weight * (gap * (gap + 1) / 2.0)
            else:
                sums[2] += weight
                sums[6] += weight * rest.size
            if not _broke_before(moved, start, stop, factor):
                sums[3] += weight
                sums[5] += 1.0
    return sums


@inlined
def _overlap(moved, point, step):
    """Overlap at a point, counted from the known one, after a relative step of the first line."""
    lines, place, correlations, reach, rise, film = moved
    first = lines[0][place + point + step] + correlations[0][reach + point + step] * rise
    second = lines[1][place + point] + correlations[1][reach + point] * rise
    return first + second - film


@inlined
def _run_around(moved, point, step):
    """Return first point, point after the last and sum of the overlaps of the run at a point."""
    reach = moved.reach
    start = stop = point
    total = 0.0
    overlap = _overlap(moved, stop, step)
    while overlap > 0.0 and stop < reach - 1:
        total += overlap
        stop += 1
        overlap = _overlap(moved, stop, step)
    overlap = _overlap(moved, start - 1, step)
    while overlap > 0.0 and start > 2 - reach:
        total += overlap
        start -= 1
        overlap = _overlap(moved, start - 1, step)
    return start, stop, total


@inlined
def _broke_before(moved, start, stop, factor):
    """Decide whether a layer broke in points of either line one relative step earlier."""
    point = start
    while point <= stop:
        first, after, total = _run_around(moved, point, -1)
        if _overlap(moved, point, -1) > 0.0 and layer_breaks(after - first, total, factor):
            return True
        point = max(after, point + 1)
    return False
