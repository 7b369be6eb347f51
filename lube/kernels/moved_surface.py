"""A rough surface in a strip, moved so that it passes through a known height.

Heights are height steps in single precision, as in `lube.kernels.tail`. Rows of the strip are
computed when they are needed.

The oil may answer the surface: its pressure flattens the waves in the contact. What it adds to the
heights is smooth, so it is computed at some points, the nodes, and taken as linear between them.
What it adds to curvatures follows from the heights as far away as the next nodes.
"""

from typing import NamedTuple

import numpy as np

from lube.kernels.compiler import inlined, kernel
from lube.types import Array, Pair


class Answered(NamedTuple):
    """What the oil adds to a surface in a strip.

    Attributes
    ----------
    fields : numpy.ndarray
        M filtered surfaces at every 2^`shift`-th point, periodic, with one more node before the
        first and two after the last, shape (nodes, nodes, M), float32 height steps.
    shapes : numpy.ndarray
        Functions of the position across the strip that multiply the filtered surfaces, at the n
        nodes of the strip, of which one lies before its first point, shape (n, M), float32.
    covariances : numpy.ndarray
        Shape (n, R', n), float32: what the oil adds to the covariance of the height at a node
        of the strip with heights in R' rows of nodes around it and at each node across the strip;
        over the variance of the heights as drawn.
    first : int
        Row of the second of these rows of nodes, counted from that of the height.
    shift : int
        Binary logarithm of the number of points from node to node.
    apart : tuple of float
        Distances of neighbouring nodes along the rollers and along rolling, m.
    """

    fields: Array
    shapes: Array
    covariances: Array
    first: int
    shift: int
    apart: tuple[float, float]


_NOTHING = np.zeros((2, 2, 0), np.float32)
NO_ANSWER = Answered(_NOTHING, _NOTHING[0, :0], _NOTHING, 0, 30, (1.0, 1.0))
"""The oil does not change the surface."""


class Oil(NamedTuple):
    """What the oil adds to a strip: `Answered`, and what is computed of it for this strip.

    The covariances with the known point, shape (R', n); room for a row of nodes; and the most
    that the oil adds in each row of nodes, NaN before it is known.
    """

    answered: Answered
    by_known: Array
    nodes: Array
    highest: Array


class Rows(NamedTuple):
    """Heights of a strip, computed when a row is needed.

    `filled` has the number of the strip whose heights are in each row.
    """

    heights: Array
    filled: Array
    strip: int


class MovedSurface(NamedTuple):
    """A surface in a strip, moved by `rise` times the covariance with the known point.

    The known point lies in row `reach` of the covariances, in row `first_row` of the surface, and
    in column `origin` of the strip, which begins in column `first_column` of the surface.
    """

    fields: Pair
    covariances: Pair
    reach: int
    first_row: int
    first_column: int
    origin: int
    rise: float
    oil: Oil
    rows: Rows


@kernel
def fill_by_known(by_known, answered, node, part):
    """Fill in what the oil adds to the covariances with the known point, between two nodes."""
    # Numba takes seconds to compile the same with whole arrays, whose shapes it compares.
    for lag in range(by_known.shape[0]):
        for at in range(by_known.shape[1]):
            here = answered.covariances[node, lag, at]
            there = answered.covariances[node + 1, lag, at]
            by_known[lag, at] = here + part * (there - here)


@kernel
def fill_row(moved, row):
    """Fill in the heights of a row, counted from the known one."""
    at, rise, first, from_known = (
        moved.reach + row,
        moved.rise,
        moved.first_column,
        column_of_covariances(moved),
    )
    rows, filled, strip = moved.rows
    filled[at] = strip
    heights, width, nodes = rows[at], rows.shape[1], moved.oil.nodes
    drawn = moved.fields[0][moved.first_row + row, first : first + width]
    known = moved.covariances[0][at, from_known : from_known + width]
    for column in range(width):  # without a branch, so the compiler vectorises it
        heights[column] = drawn[column] + known[column] * rise
    if nodes.size > 0:
        fill_nodes(moved, row)
        shift = moved.oil.answered.shift
        for column in range(width):
            heights[column] += along(nodes, column, shift)


@inlined
def column_of_covariances(moved):
    """Column of the covariances that belongs to the first column of the strip."""
    return moved.covariances[0].shape[1] // 2 - moved.origin


@inlined
def height_at(moved, row, column):
    """Height at a point of the strip, rows counted from the known one."""
    found = _drawn_at(0, moved, row, column)
    if moved.oil.nodes.size > 0:
        found += _added_at(moved, row, column)
    return found


@inlined
def curvature_at(moved, row, column):
    """Mean curvature at a point of the strip, rows counted from the known one."""
    found = _drawn_at(1, moved, row, column)
    if moved.oil.nodes.size > 0:
        answered = moved.oil.answered
        far, here = 1 << answered.shift, 2.0 * _added_at(moved, row, column)
        down = _added_at(moved, row - far, column) + _added_at(moved, row + far, column)
        along = _added_at(moved, row, column - far) + _added_at(moved, row, column + far)
        found += 0.5 * (here - down) / answered.apart[0] ** 2
        found += 0.5 * (here - along) / answered.apart[1] ** 2
    return found


@inlined
def _drawn_at(surface, moved, row, column):
    """Height (0) or curvature (1) of the surface as drawn and moved."""
    known = moved.covariances[surface][moved.reach + row, column_of_covariances(moved) + column]
    drawn = moved.fields[surface][moved.first_row + row, moved.first_column + column]
    return drawn + known * moved.rise


@kernel
def _added_at(moved, row, column):
    """Height that the oil adds at a point."""
    node, part = node_before(column, moved.oil.answered.shift)
    left = _added_at_node(moved, row, node)
    return left + part * (_added_at_node(moved, row, node + 1) - left)


@kernel
def _added_at_node(moved, row, node):
    """Height that the oil adds at a node of the strip, in any row."""
    answered, by_known = moved.oil.answered, moved.oil.by_known
    fields, shapes, shift = answered.fields, answered.shapes, answered.shift
    added, column = np.float32(0.0), (moved.first_column >> shift) + node
    upper, part = node_before(moved.first_row + row, shift)
    for m in range(shapes.shape[1]):
        here = fields[upper, column, m]
        added += shapes[node, m] * (here + part * (fields[upper + 1, column, m] - here))
    lag, part = node_before(row - (answered.first << shift), shift)
    here = by_known[lag, node]
    return added + moved.rise * (here + part * (by_known[lag + 1, node] - here))


@kernel
def fill_nodes(moved, row):
    """Fill in what the oil adds to a row at the nodes."""
    nodes = moved.oil.nodes
    for node in range(nodes.size):
        nodes[node] = _added_at_node(moved, row, node)


@kernel
def most_added(moved, before):
    """Find the most that the oil adds in a row of nodes."""
    highest, answered = moved.oil.highest, moved.oil.answered
    if np.isnan(highest[before]):
        fill_nodes(moved, (answered.first + before) << answered.shift)
        highest[before] = moved.oil.nodes.max()
    return highest[before]


@inlined
def along(nodes, column, shift):
    """Value at a column of the strip, between nodes; 0 without nodes."""
    if nodes.size == 0:
        return np.float32(0.0)
    node, part = node_before(column, shift)
    return nodes[node] + part * (nodes[node + 1] - nodes[node])


@inlined
def node_before(point, shift):
    """Node before a point, and the part of the way to the next; node 0 lies before point 0."""
    node = point >> shift
    return node + 1, np.float32(point - (node << shift)) / np.float32(1 << shift)
