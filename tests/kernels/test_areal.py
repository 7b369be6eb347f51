"""Contacts in a strip with a known touching point, by a naive implementation."""

import numpy as np
import pytest
import scipy.ndimage
from scipy.interpolate import RegularGridInterpolator

from lube.kernels.areal import BLOCK, GROUP, contacts_per_row, touching_strips
from lube.kernels.moved_surface import NO_ANSWER, Answered

REACH, AROUND, WIDTH = 60, 20, 24
ACROSS = np.linspace(-1.0, 1.0, WIDTH)
SHIFT, NODES = 2, (WIDTH - 1 >> 2) + 4
FIRST, APART = -REACH >> SHIFT, (3.0, 4.0)


def smooth_surface(rng, size):
    noise = rng.standard_normal((size, size))
    heights = 3.0 * scipy.ndimage.gaussian_filter(noise, 1.5, mode="wrap")
    return heights.astype(np.float32), (-scipy.ndimage.laplace(heights)).astype(np.float32)


def bump(width):
    """Covariance of a surface with a lay at an angle."""
    down, across = np.arange(-REACH, AROUND + 1)[:, None], np.arange(1 - WIDTH, WIDTH)
    return np.exp(-0.5 * (down**2 + across**2 + down * across) / width**2).astype(np.float32)


def random_answer(rng, size):
    """Two smooth surfaces that the oil adds, and smooth covariances of what it adds."""
    fields = rng.standard_normal((2, size >> SHIFT, size >> SHIFT))
    fields = np.pad(scipy.ndimage.gaussian_filter(fields, (0, 1, 1)), ((0, 0), (1, 2), (1, 2)))
    shapes = np.linspace([0.5, -1.0], [2.0, 1.0], NODES)
    node = np.arange(NODES)
    across = (node[:, None] - node)[:, None]
    rows = np.arange(FIRST - 1, (AROUND >> SHIFT) + 3)[:, None]
    distance = across**2 + rows**2 + rows * across
    covariances = (0.1 * node[:, None, None] - 0.3) * np.exp(-0.1 * distance)
    values = np.moveaxis(fields, 0, -1), shapes, covariances
    values = (each.astype(np.float32, order="C") for each in values)
    return Answered(*values, FIRST, SHIFT, APART)


def interpolated(values, *places):
    """Linear interpolation between nodes, over the last axes of some values."""
    nodes = [np.arange(-1, size - 1) << SHIFT for size in values.shape]
    return RegularGridInterpolator(nodes, values)(tuple(np.meshgrid(*places, indexing="ij")))


def added(answered, row, column, origin):
    """What the oil adds to the heights of a strip, and to the covariance with its known point.

    Each with what it adds to curvatures.
    """
    if answered is NO_ANSWER:
        return (0.0, 0.0), (0.0, 0.0)
    first, far = column >> SHIFT, 1 << SHIFT
    part = answered.fields[:, first : first + NODES]
    fields, lags = np.sum(part * answered.shapes, axis=-1), np.array([origin])

    def at(down, along):
        rows, columns = np.arange(-REACH, AROUND + 1) + down, np.arange(WIDTH) + along
        known = interpolated(answered.covariances, lags, rows - (FIRST << SHIFT), columns)
        return np.stack([interpolated(fields, row + rows, columns), known[0]])

    here = at(0, 0)
    curved = (2.0 * here - at(-far, 0) - at(far, 0)) / APART[0] ** 2
    curved += (2.0 * here - at(0, -far) - at(0, far)) / APART[1] ** 2
    return zip(here, 0.5 * curved, strict=True)


def neighbours(diagonal):
    """Points that are neighbours, those of the next row and the next column too if it is 1."""
    found = np.array([[0, 1, 0], [1, 1, 1], [0, 1, 0]])
    if diagonal:
        found[0, 1 - diagonal] = found[2, 1 + diagonal] = 1
    return found


def naive(
    fields, covariances, row, column, origin, height, film, sharp, fading, answered, diagonal
):
    """First touching row and contacts of one strip, with all contacts labelled at once."""
    rows = np.arange(-REACH, AROUND + 1)
    columns = np.arange(WIDTH)
    part = np.ix_(row + rows, column + columns)
    lags = covariances[0].shape[1] // 2 + columns - origin
    (by_oil, curved_by_oil), known_by_oil = added(answered, row, column, origin)
    known, known_curvature = (
        drawn[:, lags] + by_oil for drawn, by_oil in zip(covariances, known_by_oil, strict=True)
    )
    heights = fields[0][part] + by_oil
    rise = (height - heights[REACH, origin]) / known[REACH, origin]
    curvatures = fields[1][part] + curved_by_oil + known_curvature * rise
    heights = heights + known * rise
    labels, count = scipy.ndimage.label(heights > film, neighbours(diagonal))
    breaks = {0: False}
    for number in range(1, count + 1):
        summit = np.argmax(np.where(labels == number, heights - film, -np.inf))
        breaks[number] = curvatures.ravel()[summit] > sharp[summit % WIDTH]
    mine = labels[REACH, origin]
    chosen = np.exp(-fading * (heights - film))
    size, begin = np.sum(chosen[labels == mine]), np.min(np.nonzero(labels == mine)[0])
    results = [np.zeros(REACH - AROUND + 1), np.zeros(REACH - AROUND + 1)]
    points = np.count_nonzero(labels == mine)
    numbers = np.array([1.0, breaks[mine], points, points * breaks[mine]]) / size
    touches = labels[REACH] > 0
    here = labels[REACH][touches]
    for which, result in enumerate(results):
        counted = [number for number in breaks if number and (which == 0 or breaks[number])]
        result[0] = bool(set(here) & set(counted)) / np.sum(chosen[REACH][touches])
        if mine not in counted or begin <= REACH - AROUND:
            continue
        together = len(set(labels[begin]) & set(counted))
        for before in range(1, REACH - AROUND + 1):
            if set(labels[begin - before]) & set(counted):
                break
            result[before] = 1.0 / (size * together)
    return *results, numbers


@pytest.mark.parametrize("is_answered", [False, True])
@pytest.mark.parametrize("shape", [0.0, 0.8])
@pytest.mark.parametrize(("least", "diagonal"), [(1.0, 0), (1.6, 1), (1.6, -1), (2.4, 0)])
def test_strips_are_weighed_as_by_a_naive_implementation(least, diagonal, shape, is_answered):
    film, sharp, fading = least + shape * ACROSS**2, 0.9 + shape * ACROSS, 2.0 + ACROSS
    rng = np.random.default_rng(5)
    fields = smooth_surface(rng, 200)
    covariances = bump(2.0), 0.5 * bump(1.5)
    count = 150
    places = rng.integers(REACH, 200 - AROUND, count), rng.integers(0, 200 - WIDTH, count)
    answered = NO_ANSWER
    if is_answered:
        answered = random_answer(rng, 200)
        places = tuple(each >> SHIFT << SHIFT for each in places)
    known = rng.integers(0, WIDTH, count)
    touching = known, (film[known] + rng.exponential(0.3, count)).astype(np.float32)
    expected = [0.0, 0.0, 0.0]
    for each in zip(*places, *touching, strict=True):
        parts = naive(fields, covariances, *each, film, sharp, fading, answered, diagonal)
        expected = [total + part for total, part in zip(expected, parts, strict=True)]
    tops = np.maximum.reduceat(fields[0], np.arange(0, 200, BLOCK), axis=1)
    tops = tops, np.maximum.reduceat(tops, np.arange(0, 200, GROUP))
    strips = places, touching, film, sharp, fading, AROUND
    found = touching_strips(fields, tops, covariances, *strips, answered, diagonal)
    for one, other in zip(found, expected, strict=True):
        np.testing.assert_allclose(one, other, rtol=1e-6)
    assert 0.0 < found[1][1] < found[0][1] and 0.0 < found[2][1] < found[2][0]


@pytest.mark.parametrize("by", ["drawn", "known", "oil"])
def test_the_one_row_that_touches_before_a_contact_is_found_wherever_it_is(by):
    """Groups of rows are skipped together."""
    rng = np.random.default_rng(7)
    film, sharp, fading = np.full(WIDTH, 1.0), np.full(WIDTH, -1.0), np.full(WIDTH, 2.0)
    for distance in range(1, REACH - AROUND + 1):
        row, column = SHIFT**2 * rng.integers(16, 44), SHIFT**2 * rng.integers(1, 43)
        heights, known = np.full((200, 200), -5.0, np.float32), 0.1 * bump(0.5)
        known[REACH, WIDTH - 1], answered = 1.0, NO_ANSWER
        if by == "drawn":
            heights[row - distance, column + rng.integers(WIDTH)] = 9.0
        elif by == "known":
            known[REACH - distance] = 1.5
        else:
            added = np.zeros((53, 53, 1), np.float32)
            added[(row - distance >> SHIFT) + 1, (column >> SHIFT) + 4] = 50.0
            heights[row - distance >> SHIFT << SHIFT : row] = -60.0
            nodes = np.zeros((NODES, (AROUND >> SHIFT) + 4 - FIRST, NODES), np.float32)
            shapes = np.ones((NODES, 1), np.float32)
            answered = Answered(added, shapes, nodes, FIRST, SHIFT, APART)
        fields, place = (heights, 0.0 * heights), (row, column)
        strip = film, sharp, fading, answered, 0
        expected = naive(fields, (known, known), *place, 9, np.float32(1.5), *strip)
        tops = np.maximum.reduceat(heights, np.arange(0, 200, BLOCK), axis=1)
        tops = tops, np.maximum.reduceat(tops, np.arange(0, 200, GROUP))
        places = tuple(np.array([each]) for each in place)
        touching = np.array([9]), np.array([1.5], np.float32)
        found = touching_strips(
            fields, tops, (known, known), places, touching, *strip[:3], AROUND, *strip[3:]
        )
        np.testing.assert_allclose(found[0], expected[0], rtol=1e-6)


@pytest.mark.parametrize("is_answered", [False, True])
@pytest.mark.parametrize(("shape", "diagonal"), [(0.0, 0), (0.0, 1), (0.8, 0)])
def test_contacts_are_counted_in_the_row_in_which_they_begin(shape, diagonal, is_answered):
    film, sharp = 0.5 + shape * ACROSS**2, 0.9 + shape * ACROSS
    rng = np.random.default_rng(6)
    fields = smooth_surface(rng, 300)
    places = rng.integers(REACH, 300 - AROUND, 20), rng.integers(0, 300 - WIDTH, 20)
    answered = NO_ANSWER
    if is_answered:
        answered = random_answer(rng, 300)
        places = tuple(each >> SHIFT << SHIFT for each in places)
    expected = np.zeros(4)
    for row, column in zip(*places, strict=True):
        part = np.s_[row - REACH : row + AROUND + 1, column : column + WIDTH]
        (by_oil, curved), _ = added(answered, row, column, 0)
        overlap, curvatures = fields[0][part] + by_oil - film, fields[1][part] + curved
        labels, count = scipy.ndimage.label(overlap > 0.0, neighbours(diagonal))
        begun = [number for number in range(1, count + 1) if not (labels[0] == number).any()]
        summits = scipy.ndimage.maximum_position(overlap, labels, begun)
        breaks = [curvatures[summit] > sharp[summit[1]] for summit in summits]
        points = np.bincount(labels.ravel())[begun]
        expected += len(begun), sum(breaks), points.sum(), points[breaks].sum()
    covariances = (np.zeros((REACH + 1 + AROUND, 2 * WIDTH - 1), np.float32),) * 2
    strips = places, film, sharp, AROUND, answered
    found = contacts_per_row(fields, covariances, *strips, diagonal)
    np.testing.assert_allclose(found * 20 * (REACH + AROUND), expected)
    assert 0 < expected[1] < 0.9 * expected[0]
