"""Summits of a rough surface, which of them are of one contact, and how they pass the strip.

A summit that touches is a paraboloid: the area of its contact follows from its overlap and its
curvatures. Heights are height steps, as in `lube.kernels.areal`.
"""

import math
from typing import NamedTuple

import numpy as np

from lube.kernels.compiler import inlined, kernel
from lube.types import Array, Pair

LONGEST = 0.1
"""Least Gaussian curvature of a summit over the square of its mean curvature: on a longer ridge the
paraboloid would leave the surface."""


class Summits(NamedTuple):
    """Summits of a piece of a surface.

    Attributes
    ----------
    row, column : numpy.ndarray
        Where they are, between the grid points of the surface.
    height : numpy.ndarray
        Heights, height steps.
    curvature : numpy.ndarray
        Mean curvatures, height steps per square metre.
    area : numpy.ndarray
        Area in contact, over the overlap, square metres per height step.
    reach : numpy.ndarray
        Square of half of the contact's length along rolling, over the overlap, squared columns per
        height step.
    saddle : numpy.ndarray
        Height of the highest path to a higher summit, at its lowest point; -inf if there is none.
    higher : numpy.ndarray
        That summit: the highest one around that is above the saddle.
    """

    row: Array
    column: Array
    height: Array
    curvature: Array
    area: Array
    reach: Array
    saddle: Array
    higher: Array


@kernel
def connected_summits(heights: Array, curvatures: Array, spacing: Pair, least: float) -> Summits:
    """Find the summits of a periodic surface, and at which height they are connected.

    A summit is a point higher than its eight neighbours. Its height and position are those of the
    paraboloid through these nine points. The curvatures of the paraboloid are multiplied by a
    factor, so that their mean is the exact one.

    Parameters
    ----------
    heights, curvatures : numpy.ndarray
        Shape (M, N) each, float32: heights, height steps, and mean curvatures, height steps per
        square metre.
    spacing : tuple of float
        Distances of neighbouring rows and columns, m.
    least : float
        Height above which summits are wanted, height steps.

    Returns
    -------
    Summits
        In the order of their grid points' heights, the highest first.
    """
    rows, columns = heights.shape
    flat = heights.ravel()
    places = np.flatnonzero(flat > np.float32(least))
    places = places[np.argsort(-flat[places], kind="mergesort")]
    # Points are taken from the highest to the lowest. Each belongs to the summit of a neighbour, is
    # a new summit, or connects several.
    summit_of = np.full(flat.size, -1, np.int32)
    tops, saddle = np.empty(places.size, np.int64), np.empty(places.size)
    roots, higher = np.empty(places.size, np.int32), np.empty(places.size, np.int32)
    count = 0
    for place in places:
        row, column = place // columns, place % columns
        own = -1
        for down in range(-1, 2):
            for along in range(-1, 2):
                other = summit_of[(row + down) % rows * columns + (column + along) % columns]
                if other >= 0:
                    other = _root(roots, other)
                    if own >= 0 and other != own:
                        lower = max(own, other)
                        own = min(own, other)
                        roots[lower] = higher[lower] = own
                        saddle[lower] = flat[place]
                    else:
                        own = other
        if own < 0:
            own = count
            tops[own], roots[own] = place, own
            saddle[own], higher[own] = -np.inf, own
            count += 1
        summit_of[place] = own
    fitted = np.empty((6, count))
    for number in range(count):
        row, column = tops[number] // columns, tops[number] % columns
        _fit(fitted[:, number], heights, curvatures, spacing, row, column)
    each = fitted[0], fitted[1], fitted[2], fitted[3], fitted[4], fitted[5]
    return Summits(*each, saddle[:count].copy(), higher[:count].copy())


@kernel
def _root(roots, number):
    """Highest summit that is connected to a summit so far."""
    while roots[number] != number:
        roots[number] = roots[roots[number]]
        number = roots[number]
    return number


@inlined
def _around(heights, row, column, down, along):
    rows, columns = heights.shape
    return np.float64(heights[(row + down) % rows, (column + along) % columns])


@kernel
def _fit(summit, heights, curvatures, spacing, row, column):
    """Fit a paraboloid to nine points, by differences."""
    here, mean = np.float64(heights[row, column]), np.float64(curvatures[row, column])
    before, after = _around(heights, row, column, 0, -1), _around(heights, row, column, 0, 1)
    above, below = _around(heights, row, column, -1, 0), _around(heights, row, column, 1, 0)
    along, down = 0.5 * (after - before), 0.5 * (below - above)
    curved_along, curved_down = 2.0 * here - before - after, 2.0 * here - above - below
    falling = _around(heights, row, column, -1, -1) + _around(heights, row, column, 1, 1)
    rising = _around(heights, row, column, -1, 1) + _around(heights, row, column, 1, -1)
    mixed = 0.25 * (rising - falling)
    product = curved_along * curved_down - mixed * mixed
    shifts = curved_down * along - mixed * down, curved_along * down - mixed * along
    summit[0], summit[1], summit[2], summit[3] = row, column, here, mean
    if max(abs(shifts[0]), abs(shifts[1])) < product:
        summit[0] += shifts[1] / product
        summit[1] += shifts[0] / product
        summit[2] += 0.5 * (shifts[0] * along + shifts[1] * down) / product
    else:  # the top of the paraboloid is not between the neighbours: only its mean is known
        curved_along, curved_down = mean * spacing[1] ** 2, mean * spacing[0] ** 2
        product = curved_along * curved_down
    fitted = 0.5 * (curved_along / spacing[1] ** 2 + curved_down / spacing[0] ** 2)
    exact, side = mean / fitted, fitted * spacing[0] * spacing[1]
    product = max(product, LONGEST * side * side)
    summit[4] = 2.0 * math.pi * spacing[0] * spacing[1] / (exact * math.sqrt(product))
    summit[5] = 2.0 * curved_down / (exact * product)


@kernel
def passing_contacts(
    summits: Summits,
    added: Array,
    film: Array,
    sharp: Array,
    shapes: Array,
    has_edges: bool,
    first_step: int,
    contact: Array,
) -> None:
    """Add the contacts of a piece of a surface that passes through a strip, at every step.

    In a step the surface moves by one column. At step t its column s is in the column s + t of the
    strip.

    Parameters
    ----------
    summits : Summits
        In the order of their columns.
    added : numpy.ndarray
        What the oil adds to each summit's height and curvature, to its slope along rolling, height
        steps per column, and to that along the rollers, over the square root of the curvature, as
        factors of `shapes`, shape (4, S, M).
    film, sharp : numpy.ndarray
        Shape (W,) each, as in `lube.kernels.areal.touching_strips`.
    shapes : numpy.ndarray
        Functions of the column of the strip, shape (W, M).
    has_edges : bool
        Whether contacts are cut where the strip ends, at its first and its last column.
    first_step : int
        Step of the first element of `contact`.
    contact : numpy.ndarray
        Shape (T,), float64, changed: sums of the diameters of contacts whose layer breaks, of
        circles of the area that lies in the strip.
    """
    strip = film, shapes, has_edges
    count, width = summits.column.size, film.size
    columns, areas, sums = np.empty(count, np.int32), np.zeros(count), np.zeros(count)
    margin = 0.0
    if has_edges:
        for number in range(count):
            overlap = max(summits.height[number] - film.min(), 0.0)
            margin = max(margin, math.sqrt(summits.reach[number] * overlap))
    begin = end = count
    for step in range(contact.size):
        # The lower a column of the surface, the later it comes to the strip.
        moved = step + first_step
        while begin > 0 and summits.column[begin - 1] + moved >= -margin:
            begin -= 1
        while end > begin and summits.column[end - 1] + moved > width - 1 + margin:
            end -= 1
        for number in range(begin, end):
            columns[number] = min(max(round(summits.column[number] + moved), 0), width - 1)
            areas[number] = _touching(summits, added, strip, moved, number, columns[number])
        for number in range(begin, end):
            if areas[number] > 0.0:
                top = number
                while areas[summits.higher[top]] > 0.0 and top != summits.higher[top]:
                    column = columns[top]
                    if summits.saddle[top] + _by_oil(added[0], shapes, top, column) <= film[column]:
                        break
                    top = summits.higher[top]
                sums[top] += areas[number]
        for number in range(begin, end):
            if sums[number] > 0.0:
                column = columns[number]
                curved = summits.curvature[number] + _by_oil(added[1], shapes, number, column)
                if curved > sharp[column]:
                    contact[step] += math.sqrt(4.0 / math.pi * sums[number])
            areas[number] = sums[number] = 0.0


@inlined
def _by_oil(added, shapes, number, column):
    """Height, or curvature, that the oil adds to a summit in a column of the strip."""
    total = 0.0
    for m in range(shapes.shape[1]):
        total += added[number, m] * shapes[column, m]
    return total


@kernel
def _touching(summits, added, strip, moved, number, column):
    """Area of a summit in contact, as far as it lies in the strip."""
    film, shapes, has_edges = strip
    here, width = summits.column[number] + moved, film.size
    overlap = summits.height[number] - film[column] + _by_oil(added[0], shapes, number, column)
    # Where film and oil slope, the overlap is greatest beside the summit: by a parabola, which is
    # no longer one where the film bends away by half of the summit's curvature.
    before, after = film[max(column - 1, 0)], film[min(column + 1, width - 1)]
    bent = max(1.0 + 0.5 * summits.reach[number] * (before + after - 2.0 * film[column]), 0.5)
    along = 0.5 * (before - after) + _by_oil(added[2], shapes, number, column)
    down = _by_oil(added[3], shapes, number, column)
    overlap += 0.25 * summits.reach[number] / bent * along * along + 0.5 * down * down
    inside = min(here, width - 1 - here)
    if overlap <= 0.0 or (inside < 0.0 and not has_edges):
        return 0.0
    area = summits.area[number] * overlap / math.sqrt(bent)
    if has_edges:
        inside /= math.sqrt(summits.reach[number] * overlap)
        if inside <= -1.0:
            return 0.0
        if inside < 1.0:  # the edge cuts the ellipse
            chord = inside * math.sqrt(1.0 - inside * inside)
            area *= (math.acos(-inside) + chord) / math.pi
    return area
