"""Contacts of a rough surface in a strip, found from one point that is known to touch.

The strip is the contact area: its rows lie across it, in the direction of rolling, and follow one
another along the rollers. The surface in it is that of `lube.kernels.moved_surface`. A *contact* is
a group of touching points that are neighbours in a row or a column, or along the diagonal in the
direction of oblique ridges, which are narrow on the grid.
"""

from typing import NamedTuple

import numpy as np

from lube.kernels.compiler import kernel
from lube.kernels.moved_surface import (
    Answered,
    MovedSurface,
    Oil,
    Rows,
    along,
    column_of_covariances,
    curvature_at,
    fill_by_known,
    fill_nodes,
    fill_row,
    height_at,
    most_added,
    node_before,
)
from lube.types import Array, Pair

BLOCK = 32
"""Number of points of a row that are searched, or skipped, together."""
GROUP = 16
"""Number of rows that are skipped together."""


class _Search(NamedTuple):
    """A search for contacts: the strip, as in `touching_strips`, and the marks of points found."""

    film: Array
    sharp: Array
    fading: Array
    seen: Array
    mark: int
    stack: Array
    diagonal: int


@kernel
def touching_strips(
    fields: Pair,
    tops: Pair,
    covariances: Pair,
    places: Pair,
    touching: Pair,
    film: Array,
    sharp: Array,
    fading: Array,
    around: int,
    answered: Answered,
    diagonal: int,
) -> tuple[Array, Array, Array]:
    r"""Weigh rows of a strip in which one point is known to touch.

    The surface in the gap is moved so that it passes through a given height at the known point,

    .. math:: z = z' + \rho \, (z_\tau - z'_\tau) ,

    and its curvature with it. The boundary layer of a contact breaks if the surface is sharp enough
    where it is highest above the film. A point that overlaps by e is chosen with a probability in
    proportion to :math:`e^{-f e}`, where f is `fading`. A row could have been chosen by any of its
    touching points, so it counts :math:`1 / \sum e^{-f e}` over them.

    Parameters
    ----------
    fields : tuple of numpy.ndarray
        Heights and curvatures of a Gaussian surface, shape (M, M) each, float32, height steps and
        height steps per square metre.
    tops : tuple of numpy.ndarray
        Greatest heights of every `BLOCK` points of a row, shape (M, ceil(M / `BLOCK`)), float32,
        and of these in every `GROUP` rows, shape (ceil(M / `GROUP`), ceil(M / `BLOCK`)).
    covariances : tuple of numpy.ndarray
        Shape (R + 1 + A, 2 C - 1) each, float32: covariance of the height at a point with heights
        and with curvatures around it, over the variance of the heights; at distances of -R .. A
        rows and of -(C - 1) .. C - 1 columns, at least the W columns of the strip.
    places : tuple of numpy.ndarray
        Shape (K,) each: row of the surface in which each strip's known point lies, at least R from
        the first row and A from the last, and column of the surface in which the strip
        begins; both at nodes if the oil answers.
    touching : tuple of numpy.ndarray
        Shape (K,) each: column of the strip in which the known point lies, and its height,
        float32 height steps.
    film : numpy.ndarray, shape (W,)
        Film thickness at each column of the strip, height steps.
    sharp : numpy.ndarray, shape (W,)
        Curvature above which the boundary layer breaks there, in the unit of the curvatures.
    fading : numpy.ndarray, shape (W,)
        How fast the probability to be the known point falls with the overlap there, one over height
        steps.
    around : int
        Number A of rows ahead of the known one in which its contact is followed; it is followed
        back through all R rows. A contact that begins as many rows back, or more, is too long for
        the sums over first contacts.
    answered : Answered
        What the oil adds to the surface; `lube.kernels.moved_surface.NO_ANSWER` if nothing.
    diagonal : int
        1 if points are neighbours of those in the next row and the next column too, -1 if of those
        in the next row and the column before, 0 if of neither.

    Returns
    -------
    contact, breakthrough : numpy.ndarray
        Shape (R - A + 1,) each, sums of weights. Element 0 is the sum over the known rows.
        Element k is the sum over the first contacts: they count one over the sum of their points'
        :math:`e^{-f e}` if the strip does not touch in the k rows before the contact begins, and
        contacts that begin in the same row divide it among them. `breakthrough` counts only
        contacts whose boundary layer breaks.
    contacts : numpy.ndarray
        Shape (4,), sums over all contacts, over those whose boundary layer breaks, and over the
        points of either.
    """
    reach, width = covariances[0].shape[0] - 1 - around, film.size
    rows = reach - around
    contact, breakthrough, contacts = np.zeros(rows + 1), np.zeros(rows + 1), np.zeros(4)
    seen = np.zeros((reach + 1 + around, width), np.int32)
    stack = np.empty((seen.size, 2), np.int32)
    heights, filled = np.empty(seen.shape, np.float32), np.full(seen.shape[0], -1)
    # Least and greatest covariance of each row, and of the group of rows that ends with it.
    known = np.empty((4, reach + 1 + around), np.float32)
    for row in range(known.shape[1]):
        known[0, row], known[1, row] = covariances[0][row].min(), covariances[0][row].max()
        known[2, row] = known[0, max(row - GROUP + 1, 0) : row + 1].min()
        known[3, row] = known[1, max(row - GROUP + 1, 0) : row + 1].max()
    least = np.empty((width - 2) // BLOCK + 2, np.float32)
    known_row = np.int64(0)  # for the literal 0, Numba would compile `_row` and `_contact` again
    one, unmoved = np.float32(1.0), np.float32(0.0)
    by_known = np.empty(answered.covariances.shape[1:], np.float32)
    nodes = np.empty(answered.shapes.shape[0], np.float32)
    highest = np.empty(by_known.shape[0], np.float32)  # what the oil adds at most, rows of nodes
    for k in range(places[0].size):
        origin = touching[0][k]
        node, part = node_before(origin, answered.shift)
        fill_by_known(by_known, answered, node, part)
        highest[:] = np.nan
        oil, own_rows = Oil(answered, by_known, nodes, highest), Rows(heights, filled, k)
        place = reach, places[0][k], places[1][k], origin
        drawn = MovedSurface(fields, covariances, *place, unmoved, oil, own_rows)
        variance = one + along(by_known[1 - answered.first], origin, answered.shift)
        rise = (touching[1][k] - height_at(drawn, known_row, origin)) / variance
        moved = MovedSurface(fields, covariances, *place, rise, oil, own_rows)
        own, others_too = np.int32(2 * k + 1), np.int32(2 * k + 2)
        search = _Search(film, sharp, fading, seen, own, stack, diagonal)
        chosen, points, breaks, first = _contact(moved, search, known_row, origin)
        in_row = _Search(film, sharp, fading, seen, others_too, stack, diagonal)
        broken = 0
        if not breaks:
            broken = _row(moved, in_row, known_row, own)[1]
        chosen_in_row = 0.0
        for column in range(width):
            overlap = heights[reach, column] - film[column]
            if overlap > 0.0 or column == origin:  # the known point may be rounded to the film
                chosen_in_row += np.exp(-fading[column] * overlap)
        contact[0] += 1.0 / chosen_in_row
        breakthrough[0] += (breaks or broken > 0) / chosen_in_row
        contacts[0] += 1.0 / chosen
        contacts[1] += breaks / chosen
        contacts[2] += points / chosen
        contacts[3] += breaks * points / chosen
        if first <= -around:
            continue  # too long a contact to be a first one
        _least_by_block(places[1][k], film, least)
        others, broken, _, _, earliest = _row(moved, search, first, own)
        # Several contacts that begin in the same row count as one first contact.
        alone, alone_broken = 1 + others, 1 + broken
        if not breaks or earliest < first:
            alone_broken = 0
        low = 0  # as many rows before the contact are known to lie too low to touch
        for before in range(1, rows + 1):
            row = first - before
            if (places[0][k] + row + 1) % GROUP == 0 and _lie_low(moved, tops, known, least, row):
                low = before + GROUP - 1
            if before > low and _touches(moved, tops, known, film, least, row):
                alone = 0
                if alone_broken > 0 and _row(moved, search, row, own)[1] > 0:
                    alone_broken = 0
            if alone > 0:
                contact[before] += 1.0 / (chosen * alone)
            if alone_broken > 0:
                breakthrough[before] += 1.0 / (chosen * alone_broken)
            if alone == 0 and alone_broken == 0:
                break
    return contact, breakthrough, contacts


@kernel
def contacts_per_row(
    fields: Pair,
    covariances: Pair,
    places: Pair,
    film: Array,
    sharp: Array,
    around: int,
    answered: Answered,
    diagonal: int,
) -> Array:
    """Count the contacts that begin in a row of a strip, where no point is known to touch.

    Parameters
    ----------
    fields, covariances, film, sharp, around, answered, diagonal
        As in `touching_strips`; of the covariances only the shape is used.
    places : tuple of numpy.ndarray
        As in `touching_strips`: of each strip R rows before this row, and `around` rows after it,
        are searched.

    Returns
    -------
    numpy.ndarray
        Shape (4,): mean number of contacts, of those whose boundary layer breaks, and of the points
        of either.
    """
    reach = covariances[0].shape[0] - 1 - around
    seen = np.zeros((reach + 1 + around, film.size), np.int32)
    stack = np.empty((seen.size, 2), np.int32)
    heights, filled = np.empty(seen.shape, np.float32), np.full(seen.shape[0], -1)
    counts = np.zeros(4)
    origin, unmoved, first = np.int64(0), np.float32(0.0), np.int64(-reach)
    by_known = np.zeros(answered.covariances.shape[1:], np.float32)
    nodes, fading = np.empty(answered.shapes.shape[0], np.float32), np.zeros(film.size)
    oil = Oil(answered, by_known, nodes, np.empty(0, np.float32))
    for k in range(places[0].size):
        moved = MovedSurface(
            fields,
            covariances,
            reach,
            places[0][k],
            places[1][k],
            origin,
            unmoved,
            oil,
            Rows(heights, filled, k),
        )
        search = _Search(film, sharp, fading, seen, np.int32(k + 1), stack, diagonal)
        for row in range(first, around + 1):
            found = _row(moved, search, row, search.mark)
            if row > first:  # those of the first row may begin before it
                for number in range(4):
                    counts[number] += found[number]
    return counts / (places[0].size * (reach + around))


@kernel
def _row(moved, search, row, followed):
    """Follow the contacts of a row that were not followed before, under the same or another mark.

    Returns the numbers of new contacts, of new contacts whose boundary layer breaks, and of the
    points of either, and the earliest row of those that break.
    """
    contacts, broken, points, broken_points, earliest = 0, 0, 0, 0, row
    film, seen, mark, reach = search.film, search.seen, search.mark, moved.reach
    heights, filled, strip = moved.rows
    if filled[reach + row] != strip:
        fill_row(moved, row)
    for column in range(film.size):
        before = seen[reach + row, column]
        if heights[reach + row, column] > film[column] and before != mark and before != followed:
            _, own_points, breaks, first = _contact(moved, search, row, column)
            contacts += 1
            points += own_points
            if breaks:
                broken += 1
                broken_points += own_points
                earliest = min(earliest, first)
    return contacts, broken, points, broken_points, earliest


@kernel
def _least_by_block(first_column, film, least):
    """Find the thinnest film, less some rounding, in each block of the surface's columns."""
    least[:] = np.inf
    for column in range(film.size):
        block = (first_column + column) // BLOCK - first_column // BLOCK
        least[block] = min(least[block], film[column] - 1e-5 * abs(film[column]))


@kernel
def _lie_low(moved, tops, known, least, last):
    """Whether a group of rows lies too low to touch."""
    reach, rise, answered = moved.reach, moved.rise, moved.oil.answered
    most = max(known[2, reach + last] * rise, known[3, reach + last] * rise)
    if moved.oil.nodes.size > 0:
        before = max(last - GROUP + 1, -reach) >> answered.shift
        added = most_added(moved, before - answered.first)
        while before <= last >> answered.shift:
            before += 1
            added = max(added, most_added(moved, before - answered.first))
        most += added
    group, first = (moved.first_row + last) // GROUP, moved.first_column // BLOCK
    for block in range(least.size):
        if tops[1][group, min(first + block, tops[1].shape[1] - 1)] + most > least[block]:
            return False
    return True


@kernel
def _touches(moved, tops, known, film, least, row):
    """Whether any point of a row touches; blocks that lie too low are skipped."""
    at, here, rise = moved.reach + row, moved.first_row + row, moved.rise
    nodes, answered = moved.oil.nodes, moved.oil.answered
    heights, covariances, shift = moved.fields[0][here], moved.covariances[0][at], answered.shift
    most = max(known[0, at] * rise, known[1, at] * rise)
    if nodes.size > 0:
        # Between rows of nodes, what the oil adds is linear.
        before = (row >> shift) - answered.first
        most += max(most_added(moved, before), most_added(moved, before + 1))
    first_column, from_known = moved.first_column, column_of_covariances(moved)
    first, filled = first_column // BLOCK, False
    for block in range(least.size):
        top = tops[0][here, min(first + block, tops[0].shape[1] - 1)]
        if not top + most > least[block]:
            continue
        begin = max((first + block) * BLOCK - first_column, 0)
        end = min((first + block + 1) * BLOCK - first_column, film.size)
        if nodes.size > 0 and not filled:
            fill_nodes(moved, row)
            filled = True
        touched = False
        for column in range(begin, end):
            height = heights[first_column + column]
            height += covariances[from_known + column] * rise
            height += along(nodes, column, shift)
            touched |= height > film[column]
        if touched:
            return True
    return False


@kernel
def _contact(moved, search, row, column):
    """Follow the contact at a touching point.

    Returns the sum of its points' probabilities to be known, over that of a point without overlap,
    the number of its points, whether its boundary layer breaks, and its earliest row.
    """
    film, fading, seen, stack = search.film, search.fading, search.seen, search.stack
    mark, diagonal, reach = search.mark, search.diagonal, moved.reach
    # Taken out of their tuples before the loop, in which Numba would count references each time.
    heights, filled, strip = moved.rows
    if filled[reach + row] != strip:
        fill_row(moved, row)
    ahead = seen.shape[0] - reach - 1
    seen[reach + row, column] = mark
    stack[0, 0], stack[0, 1] = row, column
    waiting, points, earliest = 1, 1, row
    highest = heights[reach + row, column] - film[column]
    summit_row, summit_column = row, column
    chosen = np.exp(-fading[column] * highest)
    while waiting > 0:
        waiting -= 1
        here_row, here_column = stack[waiting, 0], stack[waiting, 1]
        for side in range(6 if diagonal else 4):
            next_row = here_row + (side == 0) - (side == 1)
            next_column = here_column + (side == 2) - (side == 3)
            if side > 3:
                next_row += 1 if side == 4 else -1
                next_column += diagonal if side == 4 else -diagonal
            inside = -reach <= next_row <= ahead and 0 <= next_column < seen.shape[1]
            if not inside or seen[reach + next_row, next_column] == mark:
                continue
            if filled[reach + next_row] != strip:
                fill_row(moved, next_row)
            overlap = heights[reach + next_row, next_column] - film[next_column]
            if overlap > 0.0:
                seen[reach + next_row, next_column] = mark
                stack[waiting, 0], stack[waiting, 1] = next_row, next_column
                waiting, points, earliest = waiting + 1, points + 1, min(earliest, next_row)
                chosen += np.exp(-fading[next_column] * overlap)
                if overlap > highest:
                    highest, summit_row, summit_column = overlap, next_row, next_column
    breaks = curvature_at(moved, summit_row, summit_column) > search.sharp[summit_column]
    return chosen, points, breaks, earliest
