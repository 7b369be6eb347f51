"""Summits: paraboloids exactly, connected ones as a library labels them, and their way by hand."""

import numpy as np
import pytest
import scipy.ndimage

from lube.kernels.summits import LONGEST, Summits, connected_summits, passing_contacts

SPACING = 2e-6, 1e-6


def waves(shape, seed):
    """Sum of some waves on a periodic grid, heights with a standard deviation of 1000."""
    generator = np.random.default_rng(seed)
    noise = np.fft.rfft2(generator.standard_normal(shape))
    down, along = np.fft.fftfreq(shape[0])[:, None], np.fft.rfftfreq(shape[1])
    noise[np.maximum(np.abs(down), along) > 0.15] = 0.0
    heights = np.fft.irfft2(noise, shape)
    return (1000.0 * heights / heights.std()).astype(np.float32)


def test_a_paraboloid_is_found_exactly_between_grid_points():
    # Curvatures along rolling, along the rollers and mixed, per grid point.
    along, down, mixed, top = 6.0, 2.0, 1.5, (10.3, 12.8)
    row, column = np.indices((24, 30)) - np.reshape(top, (2, 1, 1))
    heights = 5000.0 - 0.5 * (along * column**2 + down * row**2 + 2.0 * mixed * row * column)
    mean = 0.5 * (along / SPACING[1] ** 2 + down / SPACING[0] ** 2)
    curvatures = np.full(heights.shape, mean, np.float32)
    found = connected_summits(heights.astype(np.float32), curvatures, SPACING, 4900.0)
    assert found.row.size == 1
    np.testing.assert_allclose([found.row[0], found.column[0]], top, atol=1e-3)
    assert found.height[0] == pytest.approx(5000.0, abs=1e-3)
    product = along * down - mixed**2
    area = 2.0 * np.pi * SPACING[0] * SPACING[1] / np.sqrt(product)
    np.testing.assert_allclose(found.area, area, rtol=1e-3)
    # The ellipse of 1 height step extends that far along rolling.
    np.testing.assert_allclose(found.reach, 2.0 * down / product, rtol=1e-3)
    assert found.saddle[0] == -np.inf and found.higher[0] == 0


def test_a_long_ridge_is_no_longer_than_the_limit():
    column = np.indices((24, 30))[1] - 12.0
    row = np.indices((24, 30))[0] - 10.0
    heights = (5000.0 - 3.0 * column**2 - 1e-4 * row**2).astype(np.float32)
    curvatures = np.full(heights.shape, 3.0 / SPACING[1] ** 2, np.float32)
    found = connected_summits(heights, curvatures, SPACING, 4990.0)
    mean = 3.0 * SPACING[0] / SPACING[1]  # over the area of a grid point
    area = 2.0 * np.pi * SPACING[0] * SPACING[1] / (mean * np.sqrt(LONGEST))
    np.testing.assert_allclose(found.area[0], area, rtol=1e-2)


@pytest.mark.parametrize("level", [0.0, 800.0, 1500.0])
def test_groups_of_summits_are_those_that_a_library_labels(level):
    heights = waves((90, 120), 3)
    curvatures = np.ones(heights.shape, np.float32)
    found = connected_summits(heights, curvatures, SPACING, level - 500.0)
    # The library does not join contacts across the sides of a periodic grid. So the grid is
    # repeated three times each way, and contacts count whose top is in the middle.
    repeated = np.tile(heights, (3, 3))
    labels, count = scipy.ndimage.label(repeated > level, np.ones((3, 3)))
    places = scipy.ndimage.maximum_position(repeated, labels, np.arange(1, count + 1))
    middle = [place for place in places if 90 <= place[0] < 180 and 120 <= place[1] < 240]
    whole = {(int(row) - 90, int(column) - 120) for row, column in middle}
    near = np.rint([found.row, found.column]).astype(int)
    around = np.array([near.T + np.array(at) - 1 for at in np.ndindex(3, 3)]) % heights.shape
    highest = heights[around[..., 0], around[..., 1]].argmax(axis=0)
    places = around[highest, np.arange(near.shape[1])]
    tops = (heights[tuple(places.T)] > level) & (found.saddle <= level)
    assert set(map(tuple, places[tops].tolist())) == whole


def test_saddles_lie_below_both_summits_and_lead_to_a_higher_one():
    heights = waves((90, 120), 4)
    found = connected_summits(heights, np.ones(heights.shape, np.float32), SPACING, -1000.0)
    inner = found.saddle > -np.inf
    assert inner.sum() > 20
    assert (found.saddle < found.height)[inner].all()
    peaks = heights[np.rint(found.row).astype(int) % 90, np.rint(found.column).astype(int) % 120]
    assert (found.higher[inner] < np.flatnonzero(inner)).all()  # the highest come first
    assert (peaks[found.higher[inner]] >= found.saddle[inner]).all()


def summits(columns, heights, curvatures=None, saddles=None, higher=None):
    """Summits with an area of 2 square metres, and a reach of 4, at an overlap of 1."""
    size = len(columns)
    each = [np.zeros(size), columns, heights, curvatures or [1.0] * size, [2.0] * size]
    each += [[4.0] * size, saddles or [-np.inf] * size]
    return Summits(
        *(np.array(one, float) for one in each), np.array(higher or range(size), np.int32)
    )


def passed(some, film, sharp=0.0, has_edges=False, added=None, shapes=None, steps=60):
    film, count = np.array(film, float), some.row.size
    contact = np.zeros(steps)
    added = np.zeros((4, count, 0)) if added is None else np.array(added, float)
    shapes = np.zeros((film.size, 0)) if shapes is None else np.array(shapes, float)
    sharp = np.broadcast_to(float(sharp), film.shape).copy()
    passing_contacts(some, added, film, sharp, shapes, has_edges, -40, contact)
    return contact


def diameter(area):
    return np.sqrt(4.0 / np.pi * area)


def test_a_summit_touches_where_the_film_is_thinner_than_it_is_high():
    contact = passed(summits([20.0], [5.0]), [9.0, 9.0, 4.0, 4.0, 4.0, 3.0, 3.0, 3.0, 9.0, 9.0])
    # In step t, counted from -40, column 20 is in column t - 20 of the strip.
    np.testing.assert_allclose(contact[[23, 26]], diameter(2.0 * np.array([1.0, 2.0])))


def test_under_a_bent_film_the_overlap_is_greatest_beside_the_summit():
    """The summit is 4 - (x - s)^2 / 4 high, the film 3 + (x - 4)^2 / 4."""
    contact = passed(summits([20.0], [4.0]), 3.0 + 0.25 * (np.arange(9.0) - 4.0) ** 2)
    overlap = 1.0 - (np.arange(9.0) - 4.0) ** 2 / 8.0
    expected = np.zeros(60)
    expected[22:27] = diameter(2.0 * overlap[2:7] / np.sqrt(2.0))
    np.testing.assert_allclose(contact, expected)


def test_a_slope_that_the_oil_adds_moves_a_summit_up():
    """By 0.3 along rolling, over 4 - x^2 / 4, and along the rollers over 4 - 0.5 x^2."""
    added = np.array([0.0, 0.0, 0.3, 0.2])[:, None, None]
    contact = passed(summits([20.0], [4.0]), [3.0, 3.0, 3.0], 0.0, False, added, np.ones((3, 1)))
    assert contact[21] == pytest.approx(diameter(2.0 * (1.0 + 0.3**2 + 0.5 * 0.2**2)))


def test_an_edge_cuts_the_area_of_a_contact():
    contact = passed(summits([20.0], [5.0]), np.full(10, 4.0), has_edges=True)
    whole = contact.max()
    assert whole == pytest.approx(diameter(2.0))
    # Half a length of 2 columns: cut up to 2 columns inside of the edges at columns 0 and 9.
    column = np.arange(60.0) - 20.0
    inside = np.minimum(column, 9.0 - column) / 2.0
    inside = np.clip(inside, -1.0, 1.0)
    part = (np.arccos(-inside) + inside * np.sqrt(1.0 - inside**2)) / np.pi
    np.testing.assert_allclose(contact, whole * np.sqrt(part), atol=1e-12)


def test_summits_of_one_contact_add_up_and_the_highest_decides():
    pair = summits([20.0, 22.0], [5.0, 6.0], [1.0, 3.0], [4.5, -np.inf], [1, 1])
    apart = passed(pair, np.full(20, 4.7))
    together = passed(pair, np.full(20, 4.0))
    both = slice(22, 38)
    np.testing.assert_allclose(apart[both], diameter(0.6) + diameter(2.6))
    np.testing.assert_allclose(together[both], diameter(2.0 + 4.0))
    # The lower summit holds alone, and breaks where the sharper one is in the strip too.
    np.testing.assert_allclose(passed(pair, np.full(20, 4.7), 2.0)[both], diameter(2.6))
    np.testing.assert_allclose(passed(pair, np.full(20, 4.0), 2.0)[both], diameter(6.0))
    alone = passed(pair, np.full(20, 4.0), 2.0)[38:40]
    np.testing.assert_allclose(alone, [0.0, 0.0])


def test_what_the_oil_adds_raises_summits_and_saddles_alike():
    shapes, added = np.linspace(-1.0, 1.0, 5)[:, None], [[[2.0], [2.0]], *3 * [[[0.0], [0.0]]]]
    pair = summits([20.0, 20.0], [5.0, 6.0], None, [4.5, -np.inf], [1, 1])
    moved = passed(pair, np.full(5, 5.0), added=added, shapes=shapes)
    for column in range(5):
        by_hand = passed(
            summits([0.0, 0.0], [5.0, 6.0], None, [4.5, -np.inf], [1, 1]),
            [5.0 - 2.0 * shapes[column, 0]],
        )
        assert moved[20 + column] == pytest.approx(by_hand[40])


def test_a_layer_breaks_where_a_summit_is_sharp_enough_with_what_the_oil_adds():
    shapes, added = np.array([[-1.0], [0.0], [1.0]]), [[[0.0]], [[0.4]]]
    some = summits([20.0], [6.0], curvatures=[1.0])
    for sharp, columns in ((0.5, 3), (0.8, 2), (1.2, 1), (1.5, 0)):
        found = passed(some, [5.0] * 3, sharp=sharp, added=added, shapes=shapes)
        assert np.flatnonzero(found).tolist() == list(range(23 - columns, 23))
