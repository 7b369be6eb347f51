r"""Contact in an uneven window, whose film stays in the contact while the roughness moves through.

The film may vary along the window, and the oil may answer the roughness: its pressure flattens the
waves in the contact. The answer is a change of the heights. At the position X of the window it is
a sum of filtered lines, each times a function of the position, so the roughness there is

.. math:: z(s) + \sum_m u_m(X)\, z_m(s)

The answer is smooth, so it is computed at some points of the window, the nodes, and taken as linear
between them.

Blocks of points are skipped where even the sum of both lines' highest points lies below the film.
All other points are read as in the literal scan, so the results equal it to the last bit. Windows a
tenth of the contact apart see nearly the same points, so a probability does not need a window at
every time step.
"""

from typing import NamedTuple

import numpy as np

from lube.kernels.compiler import inlined, kernel
from lube.kernels.layer import layer_breaks
from lube.kernels.motion import surface_position
from lube.kernels.runs import BLOCK, highest_ahead
from lube.types import Array, Ratios


class Surface(NamedTuple):
    """Rough surface of a roller in the contact.

    Attributes
    ----------
    line : numpy.ndarray
        Heights, shape (N,), int32 height steps.
    highest : numpy.ndarray
        From `highest_ahead`.
    filtered : numpy.ndarray
        M filtered lines on a coarser grid of n points, the first point repeated at the end, shape
        (n + 1, M), float32 height steps; M = 0 if the oil does not answer.
    shapes : numpy.ndarray
        Functions of the position that multiply the filtered lines, at the nodes, shape (nodes, M).
    """

    line: Array
    highest: Array
    filtered: Array
    shapes: Array


class Window(NamedTuple):
    """Points of the contact window.

    Attributes
    ----------
    films : numpy.ndarray
        Film thickness at each point, shape (F, W), int64 height steps, for F operating points with
        the same window and the same answers of the oil.
    before : int
        Number of points of the window before its centre.
    shift : int
        Binary logarithm of the number of points from node to node, which divides `BLOCK`.
    """

    films: Array
    before: int
    shift: int


@kernel
def _least_by_block(films):
    """Thinnest film in each block of a window, shape (F, blocks)."""
    blocks = (films.shape[1] + BLOCK - 1) // BLOCK
    least = np.empty((len(films), blocks), films.dtype)
    for f in range(len(films)):
        for b in range(blocks):
            least[f, b] = films[f, b * BLOCK : (b + 1) * BLOCK].min()
    return least


@inlined
def phase_of(window):
    """Points from the first node to the first point: the window's centre is a node."""
    return -window.before & ((1 << window.shift) - 1)


@inlined
def node_count(window):
    """Count the nodes of a window, including those beyond its last block."""
    blocks = (window.films.shape[1] + BLOCK - 1) // BLOCK
    return blocks * (BLOCK >> window.shift) + 2


@inlined
def answer_at(surface, first, step, node):
    """Answer of the oil to a surface, at a node of the window that begins at a point."""
    points, rows = surface.line.size, surface.filtered.shape[0] - 1
    at = ((first + node * step) % points) * (rows / points)
    row = int(at)
    part = at - row
    total = 0.0
    for m in range(surface.shapes.shape[1]):
        here = (1.0 - part) * surface.filtered[row, m] + part * surface.filtered[row + 1, m]
        total += surface.shapes[node, m] * here
    return total


@kernel
def _highest_by_block(lift, shift, highest):
    """Highest answer in each block of a window."""
    nodes = (BLOCK >> shift) + 2
    for block in range(highest.size):
        begin = block * (BLOCK >> shift)
        highest[block] = lift[begin : begin + nodes].max()


@kernel
def _answer(surfaces, speed_ratios, step, window, lift):
    """Compute the answers to both surfaces at a time step, at the nodes, height steps."""
    distance, before = 1 << window.shift, window.before + phase_of(window)
    first_1 = surface_position(step, speed_ratios[0]) - before
    first_2 = surface_position(step, speed_ratios[1]) - before
    last = (window.films.shape[1] - 1 + phase_of(window)) >> window.shift
    for node in range(last + 2):
        answers = answer_at(surfaces[0], first_1, distance, node)
        answers += answer_at(surfaces[1], first_2, distance, node)
        lift[node] = np.int64(np.rint(answers))


@kernel
def _window(lines, ahead, first_1, first_2, film, least, answers, factor):
    """Sum contact points, broken points and overlap in one window, as in the literal scan."""
    (line_1, line_2), (is_answered, lift, highest, shift, phase) = lines, answers
    step = 1 << shift
    contact_points = broken_points = total_overlap = 0
    segment_points = segment_overlap = 0
    for block in range(least.size):
        begin = block * BLOCK
        i, k = (first_1 + begin) % line_1.size, (first_2 + begin) % line_2.size
        touched = np.int64(ahead[0][i]) + ahead[1][k] + highest[block] > least[block]
        if not touched and segment_points == 0:
            continue
        for point in range(begin, min(begin + BLOCK, film.size)):
            overlap = np.int64(line_1[i]) + line_2[k] - film[point]
            if is_answered:
                node, part = (point + phase) >> shift, (point + phase) & (step - 1)
                overlap += lift[node] + ((lift[node + 1] - lift[node]) * part >> shift)
            if overlap > 0:
                contact_points += 1
                total_overlap += overlap
                segment_points += 1
                segment_overlap += overlap
            elif segment_points > 0:
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
    if layer_breaks(segment_points, segment_overlap, factor):  # cut by the window's edge
        broken_points += segment_points
    return contact_points, broken_points, total_overlap


@kernel
def shaped_trace(
    surfaces: tuple[Surface, Surface],
    speed_ratios: Ratios,
    steps: int,
    windows: int,
    window: Window,
    factors: Array,
) -> Array:
    """Compute the contact of some operating points, in windows evenly spread over the time steps.

    Parameters
    ----------
    surfaces : tuple of Surface
        Both rough surfaces.
    speed_ratios : tuple of float
        Surface speeds over that of the faster surface.
    steps : int
        Number T of time steps.
    windows : int
        Number of windows; T for one at each time step.
    window : Window
        Films over the window.
    factors : numpy.ndarray
        From `lube.kernels.layer.layer_factor`, shape (F,).

    Returns
    -------
    numpy.ndarray
        Shape (F, windows, 3), int64: contact points, broken points and overlap (height steps).

    Notes
    -----
    The answers change as slowly with time as along the window. With a window at every time step
    they are computed as many steps apart as there are points from node to node, and taken as linear
    in between.

    Examples
    --------
    One high point passes a window of three points, with a film that is thin in the middle only:

    >>> line = np.array([5, 0, 0, 0, 0], np.int32)
    >>> surfaces = as_drawn(line), as_drawn(np.zeros_like(line))
    >>> window = Window(np.array([[9, 3, 9]]), 1, 6)
    >>> shaped_trace(surfaces, (1.0, 1.0), 5, 5, window, np.ones(1))[0, :, 0].tolist()
    [1, 0, 0, 0, 0]
    """
    trace = np.empty((len(window.films), windows, 3), np.int64)
    least = _least_by_block(window.films)
    now, then, lift = np.zeros((3, node_count(window)), np.int64)
    is_answered = surfaces[0].shapes.size + surfaces[1].shapes.size > 0
    highest = np.zeros(least.shape[1], np.int64)
    lines = surfaces[0].line, surfaces[1].line
    ahead = surfaces[0].highest, surfaces[1].highest
    answers = is_answered, lift, highest, window.shift, phase_of(window)
    for number in range(windows):
        step = number * steps // windows
        part = step & ((1 << window.shift) - 1) if windows == steps else 0
        if is_answered:
            if part == 0:
                _answer(surfaces, speed_ratios, step, window, now)
            if part == 1:
                _answer(surfaces, speed_ratios, step - 1 + (1 << window.shift), window, then)
            # Numba takes seconds to compile the same with whole arrays, whose shapes it compares.
            for node in range(lift.size):
                lift[node] = now[node] + ((then[node] - now[node]) * part >> window.shift)
            _highest_by_block(lift, window.shift, highest)
        first_1 = surface_position(step, speed_ratios[0]) - window.before
        first_2 = surface_position(step, speed_ratios[1]) - window.before
        first_1, first_2 = first_1 % surfaces[0].line.size, first_2 % surfaces[1].line.size
        for f in range(len(window.films)):
            found = _window(
                lines, ahead, first_1, first_2, window.films[f], least[f], answers, factors[f]
            )
            for which, value in enumerate(found):
                trace[f, number, which] = value
    return trace


def means_of(traces: Array) -> Array:
    """Average the contact over the windows of some operating points.

    Parameters
    ----------
    traces : numpy.ndarray
        From `shaped_trace`, shape (F, windows, 3).

    Returns
    -------
    numpy.ndarray
        Shape (F, 4): fraction of the windows with contact, fraction with a broken boundary layer,
        mean number of broken points, and mean overlap (height steps).

    Examples
    --------
    >>> means_of(np.array([[[0, 0, 0], [3, 2, 8]]])).tolist()
    [[0.5, 0.5, 1.0, 4.0]]
    """
    points, broken, overlap = np.moveaxis(traces, -1, 0)
    sums = [each.sum(axis=1) for each in (points > 0, broken > 0, broken, overlap)]
    return np.stack(sums, axis=1) / traces.shape[1]


def as_drawn(line: Array) -> Surface:
    """Return the surface of a line that enters the gap as drawn.

    Parameters
    ----------
    line : numpy.ndarray
        Heights, shape (N,), int32 height steps.

    Returns
    -------
    Surface
        The line, which the oil does not answer.
    """
    return Surface(line, highest_ahead(line), np.zeros((2, 0), np.float32), np.zeros((0, 0)))
