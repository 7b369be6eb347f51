"""Contact of rough lines at any rarity, in an uneven window.

Windows and runs have a known touching point, as in `lube.kernels.tail`. The film may
vary along the window, and the oil may answer the lines, as in `lube.kernels.shaped`.
"""

from typing import NamedTuple

import numpy as np

from lube.kernels.compiler import kernel
from lube.kernels.layer import layer_breaks
from lube.kernels.motion import surface_position
from lube.kernels.shaped import Surface, answer_at
from lube.kernels.tail import judged
from lube.types import Array, Pair

FEW = 3
"""A run that is seen to break at no more moments than this is looked at in every time step."""


class _Answered(NamedTuple):
    """Lines that the oil answers, around a known point in the window.

    `with_known` has the covariances of the lines with the gap at the known point, and `answers`
    what the oil adds at the nodes of the window; both are NaN where they are not computed yet. The
    window begins `offset` points from the beginning of the lines.
    """

    surfaces: tuple[Surface, Surface]
    covariances: Array
    with_known: Array
    offset: int
    known: int
    answers: Array
    shift: int


class _MovedLines(NamedTuple):
    """The same, moved by `rise` times the covariance with the known point, and the film."""

    answered: _Answered
    correlations: Pair
    rise: float
    film: Array


@kernel
def answered_windows(
    surfaces: tuple[Surface, Surface],
    starts: Array,
    correlation: Array,
    touching: Pair,
    film: Array,
    covariances: Array,
    shift: int,
    factor: float,
) -> tuple[float, float]:
    """Weigh windows in which one point is known to touch, where the oil answers the lines.

    Parameters
    ----------
    surfaces : tuple of lube.kernels.shaped.Surface
        Both surfaces; lines of float32.
    starts, correlation, touching, film, factor
        As in `lube.kernels.tail.touching_windows`.
    covariances : numpy.ndarray
        Shape (C, C), float32: what the oil adds to the covariance of the sum of the lines at two of
        the C nodes of the window, over its variance as drawn.
    shift : int
        As in `lube.kernels.shaped.Window`.

    Returns
    -------
    contact, breakthrough : float
        As from `lube.kernels.tail.touching_windows`.
    """
    width, nodes = film.size, covariances.shape[0]
    contact = breakthrough = 0.0
    overlap = np.empty(width, np.float32)
    added, lift = np.empty(nodes, np.float32), np.empty(nodes, np.float32)
    for m in range(starts.size):
        first, origin = starts[m], touching[0][m]
        for node in range(nodes):
            answers = answer_at(surfaces[0], first, 1 << shift, node)
            lift[node] = answers + answer_at(surfaces[1], first, 1 << shift, node)
            added[node] = _between_nodes(covariances[node], origin, shift)
        shape = correlation[width - 1 - origin : 2 * width - 1 - origin]
        one, other = surfaces[0].line[first:], surfaces[1].line[first:]
        rise = touching[1][m] - one[origin] - other[origin] - _between_nodes(lift, origin, shift)
        rise /= np.float32(1.0) + _between_nodes(added, origin, shift)
        for j in range(width):
            known = (shape[j] + _between_nodes(added, j, shift)) * rise
            overlap[j] = one[j] + other[j] + _between_nodes(lift, j, shift) + known - film[j]
        points, broken, _ = judged(overlap, factor)
        weight = 1.0 / max(points, 1)
        contact += weight
        if broken:
            breakthrough += weight
    return contact / starts.size, breakthrough / starts.size


@kernel
def touching_runs_under(
    surfaces: tuple[Surface, Surface],
    places: Array,
    correlations: Pair,
    touching: Pair,
    film: Array,
    covariances: Array,
    shift: int,
    speed_ratios: Array,
    strides: Array,
    factor: float,
    most: int,
) -> Array:
    r"""Weigh runs of points in an uneven window, each found from one known point.

    A run may break and hold several times on its way through the window. A *breakthrough* is all of
    this together: the time steps at which the layer of a run breaks, as long as its points touch
    without a pause. Each of these T time steps counts 1/T, so that they make one together. At first
    only each k-th step before and after the present one is looked at. Where n steps break, with the
    present one, and n is above `FEW`, this step counts 1/(k n), which makes one in expectation.
    Else every step is looked at.

    Parameters
    ----------
    surfaces, shift
        As in `answered_windows`.
    covariances : numpy.ndarray
        Shape (2, 2 L + 1, M + 1, M + 1): covariance of each line (first index) and its M filtered
        lines, over the variance of the sum as drawn, at the lags -L .. L in distances between
        nodes. That of the line with itself, which `correlations` has, is left out as 0.
    places, correlations, factor
        As in `lube.kernels.tail.touching_runs`.
    touching : tuple of numpy.ndarray
        Shape (M,) each: point of the window at which each known point lies, and the sum of the
        lines there, float32 height steps.
    film : numpy.ndarray
        Shape (W,), float32: film thickness at each point of the window, height steps.
    speed_ratios : numpy.ndarray
        Shape (S, 2): surface speeds over that of the faster surface, at S slide-to-roll ratios.
    strides : numpy.ndarray
        Shape (S,), int64: number k of time steps from one look at a run to the next.
    most : int
        Most runs to follow. If the layer of more of them breaks, each j-th is followed.

    Returns
    -------
    numpy.ndarray
        Shape (1 + S,), sums of weights: over the runs whose boundary layer breaks, then, at each
        slide-to-roll ratio, over the breakthroughs.
    """
    sums = np.zeros(1 + len(speed_ratios))
    answers = np.empty((2, 2, (film.size >> shift) + 2), np.float32)
    answered = _Answered(
        surfaces, covariances, np.empty(covariances.shape[:3]), 0, 0, answers, shift
    )
    broken = np.empty(places.size, np.int64)
    count = 0
    for m in range(places.size):
        moved = _through(answered, correlations, places[m], touching[0][m], touching[1][m], film)
        start, stop, total = _run_under(moved, touching[0][m], 0, 0)
        points = max(stop - start, 1)  # rounding may put the known point just below the film
        if layer_breaks(points, total, factor):
            sums[0] += 1.0 / points
            broken[count] = m
            count += 1
    each = max(-(-count // most), 1)
    for m in broken[:count:each]:
        moved = _through(answered, correlations, places[m], touching[0][m], touching[1][m], film)
        start, stop, _ = _run_under(moved, touching[0][m], 0, 0)
        for s in range(len(speed_ratios)):
            steps = _steps_broken(moved, m, strides[s], speed_ratios[s], factor, start, stop)
            sums[1 + s] += 1.0 / (max(stop - start, 1) * steps)
    sums[1:] *= count / max(-(-count // each), 1)
    return sums


@kernel
def _through(answered, correlations, place, known, height, film):
    """Lines that are moved so that the gap at a known point of the window has some height."""
    surfaces, covariances, with_known, _, _, answers, shift = answered
    answered = _Answered(surfaces, covariances, with_known, place - known, known, answers, shift)
    with_known[..., 0] = answers[0, 0] = np.nan
    own = surfaces[0].line[place] + surfaces[1].line[place]
    rise = height - (own + _answers_at(answered, 0, known, 0, 0))
    rise /= np.float32(1.0) + _answers_at(answered, 1, known, 0, 0)
    return _MovedLines(answered, correlations, rise, film)


@kernel
def _steps_broken(moved, now, stride, ratios, factor, start, stop):
    """Estimate the time steps at which the layer of a run breaks on its way.

    Where every step is looked at, those count as in `touching_runs_under` that a stride from any of
    the steps would find: the phases of a stride in which more than `FEW` break count for their part
    of the breakthrough, and the steps in all other phases share the rest.
    """
    found = _looks_broken(moved, now, stride, ratios, factor, start, stop, 1)[0]
    if stride == 1 or found > FEW:
        return float(stride * found)
    counts = _looks_broken(moved, now, 1, ratios, factor, start, stop, stride)
    are_few = counts <= FEW
    are_few[0] = True
    return np.sum(counts[are_few]) * stride / np.sum(are_few)


@kernel
def _looks_broken(moved, now, stride, ratios, factor, start, stop, phases):
    """Count the looks at which a run breaks, by the time step from the present one modulo `phases`.

    The run is followed as long as any of its points touches, as either surface carries them on.
    """
    counts = np.zeros(phases, np.int64)
    counts[0] = 1
    for way in (-stride, stride):
        _follow(moved, now, way, ratios, factor, start, stop, counts)
    return counts


@kernel
def _follow(moved, now, stride, ratios, factor, start, stop, counts):
    """Follow a run before or after the present time step, and add to the counts of its breaks."""
    film, answers = moved.film, moved.answered.answers
    first = second = step = 0
    while stop > start:
        step += stride
        moved_1 = surface_position(now, ratios[0]) - surface_position(now + step, ratios[0])
        moved_2 = surface_position(now, ratios[1]) - surface_position(now + step, ratios[1])
        point = start + min(moved_1 - first, moved_2 - second)
        end = stop + max(moved_1 - first, moved_2 - second)
        first, second = moved_1, moved_2
        answers[0, 0] = np.nan
        start, stop = film.size, 0
        broke = False
        while point < end:
            begin, after, total = _run_under(moved, point, first, second)
            if after > begin:
                broke = broke or layer_breaks(after - begin, total, factor)
                start, stop = min(start, begin), max(stop, after)
            point = max(after, point) + 1
        counts[step % counts.size] += broke


@kernel
def _correlate(answered, roller, row):
    """Fill in the covariance of a line, and of its filtered lines, with the gap at the known point.

    At one lag; the indices are: roller, lag, line or filtered line.
    """
    surfaces, covariances, with_known, _, known, _, shift = answered
    shapes, of_roller = surfaces[roller].shapes, covariances[roller, row]
    node = known >> shift
    part = (known - (node << shift)) / (1 << shift)
    for line in range(1 + shapes.shape[1]):
        total = of_roller[line, 0]
        for m in range(shapes.shape[1]):
            here = (1.0 - part) * shapes[node, m] + part * shapes[node + 1, m]
            total += here * of_roller[line, 1 + m]
        with_known[roller, row, line] = total


@kernel
def _added(answered, roller, node, lag):
    """Return what the oil adds to the covariance of a line at a node with a point a lag behind."""
    surfaces, _, with_known, _, _, _, shift = answered
    row = (lag >> shift) + with_known.shape[1] // 2
    if row < 0 or row + 1 >= with_known.shape[1]:
        return 0.0
    for each in (row, row + 1):
        if np.isnan(with_known[roller, each, 0]):
            _correlate(answered, roller, each)
    before, after = with_known[roller, row], with_known[roller, row + 1]
    part = (lag & ((1 << shift) - 1)) / (1 << shift)
    total = (1.0 - part) * before[0] + part * after[0]
    shapes = surfaces[roller].shapes
    for m in range(shapes.shape[1]):
        here = (1.0 - part) * before[1 + m] + part * after[1 + m]
        total += shapes[node, m] * here
    return total


@kernel
def _answer(answered, node, first, second):
    """Fill in the answers to the lines at a node, and the covariance that they add.

    The covariance is that with the known point. The lines move on by some points each first, or
    back if these are negative. The indices are: answer or covariance, roller, node.
    """
    surfaces, _, _, offset, known, answers, shift = answered
    for roller, moved in enumerate((first, second)):
        lag = (node << shift) - moved - known
        answers[0, roller, node] = answer_at(surfaces[roller], offset - moved, 1 << shift, node)
        answers[1, roller, node] = _added(answered, roller, node, lag)


@kernel
def _answers_at(answered, kind, point, first, second):
    """Sum the answers to both lines (0), or what they add to the covariance (1), at a point.

    Nodes are filled in when they are needed, for a run meets few of them.
    """
    answers, shift = answered.answers, answered.shift
    node = point >> shift
    for each in (node, node + 1):
        if np.isnan(answers[0, 0, each]):
            _answer(answered, each, first, second)
    of_first = _between_nodes(answers[kind, 0], point, shift)
    return of_first + _between_nodes(answers[kind, 1], point, shift)


@kernel
def _overlap_under(moved, point, first, second):
    """Overlap at a point of the window before the lines moved; negative where it is unknown."""
    answered, correlations, rise, film = moved
    surfaces, offset = answered.surfaces, answered.offset
    centre = correlations[0].size // 2 - answered.known
    ahead, behind = point - max(first, second) + centre, point - min(first, second) + centre
    if point < 0 or point >= film.size or ahead < 0 or behind >= correlations[0].size:
        return np.float32(-1.0)
    one, other = offset + point - first, offset + point - second
    sum_of_both = surfaces[0].line[one] + surfaces[1].line[other]
    known = correlations[0][centre + point - first] + correlations[1][centre + point - second]
    known += _answers_at(answered, 1, point, first, second)
    answer = _answers_at(answered, 0, point, first, second)
    return sum_of_both + answer + known * rise - film[point]


@kernel
def _run_under(moved, point, first, second):
    """First point, point after the last and sum of the overlaps of the run at a point."""
    start = stop = point
    total = 0.0
    overlap = _overlap_under(moved, stop, first, second)
    if overlap > 0.0:
        while overlap > 0.0:
            total += overlap
            stop += 1
            overlap = _overlap_under(moved, stop, first, second)
        overlap = _overlap_under(moved, start - 1, first, second)
        while overlap > 0.0:
            total += overlap
            start -= 1
            overlap = _overlap_under(moved, start - 1, first, second)
    return start, stop, total


@kernel
def _between_nodes(values, point, shift):
    """Interpolate linearly between nodes, in single precision."""
    node = point >> shift
    part = np.float32((point - (node << shift)) / (1 << shift))
    return values[node] + part * (values[node + 1] - values[node])
