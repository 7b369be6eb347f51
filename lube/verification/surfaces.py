"""Checks of the surfaces that the lines stand for."""

from functools import partial

import numpy as np
import scipy

from lube.contact.strip_film import surface_moments
from lube.physics.excursions import expected_contacts
from lube.study.study import Study
from lube.surfaces.rough_surface import rough_surface
from lube.threads import on_threads
from lube.types import Array
from lube.verification.check import errors_apart, percent_off

SURFACES = 16
LEVELS = np.array([2.0, 2.5, 3.0])
"""Levels at which contacts are counted, over the rms height."""


def surface_checks(study: Study, threads: int | None) -> dict[str, float]:
    """Make all checks of surfaces.

    Parameters
    ----------
    study : Study
        A study whose lines stand for surfaces.
    threads : int, optional
        Threads that share the work.

    Returns
    -------
    dict of str to float
        Deviation of each check of `lube.verification.check.CHECKS`.
    """
    spec = study.line_spec
    surface, moments = rough_surface(spec), surface_moments(spec)
    levels = LEVELS * np.sqrt(moments.height)

    def drawn(number):
        heights, *_ = surface.draw(np.random.default_rng((study.seed, number)))
        above = [heights > level / spec.height_step for level in levels]
        return heights.std(), [[euler_characteristic(one), contact_count(one)] for one in above]

    heights, counts = zip(*on_threads(drawn, range(SURFACES), threads), strict=True)
    squares = (np.array(heights) * spec.height_step) ** 2
    characteristic, contacts = np.moveaxis(np.array(counts), 2, 0)
    # The surface closes on itself, so it has no sides: the part that grows with the area is left.
    (down, along), count = surface.sides, partial(expected_contacts, levels, moments)
    expected = count(down, along) - count(down, 0.0) - count(0.0, along) + count(0.0, 0.0)
    expected = np.broadcast_to(expected, characteristic.shape)
    return {
        "surface_height": errors_apart(squares[:, None], np.full((SURFACES, 1), moments.height)),
        "euler": errors_apart(characteristic, expected),
        "contacts": percent_off(contacts[:, -1].mean(), expected[0, -1]),
    }


def euler_characteristic(above: Array) -> int:
    """Count the contacts less the holes in them, on a rectangle that closes on itself.

    Parameters
    ----------
    above : numpy.ndarray of bool
        Points above a level.

    Returns
    -------
    int
        Points, less pairs of neighbours, and squares of four points, all of them above.

    Examples
    --------
    >>> ring = np.zeros((5, 5), bool)
    >>> ring[1:4, 1:4] = True
    >>> euler_characteristic(ring)
    1
    >>> ring[2, 2] = False
    >>> euler_characteristic(ring)
    0
    """
    down, along = (above & np.roll(above, -1, axis) for axis in (0, 1))
    squares = down & np.roll(down, -1, 1)
    points, pairs, fours = map(np.count_nonzero, (above, np.stack([down, along]), squares))
    return int(points - pairs + fours)


def contact_count(above: Array) -> int:
    """Count the contacts, on a rectangle that closes on itself.

    Parameters
    ----------
    above : numpy.ndarray of bool
        Points above a level.

    Returns
    -------
    int
        Groups of neighbouring points.

    Examples
    --------
    >>> contact_count(np.eye(3, dtype=bool)), contact_count(np.array([[True, False, True]]))
    (3, 1)
    """
    labels, count = scipy.ndimage.label(above)
    # Groups that are joined across a side count once.
    ends = np.concatenate([labels[[0, -1]], labels[:, [0, -1]].T], axis=1)
    pairs = ends[:, (ends > 0).all(axis=0)]
    joined = scipy.sparse.coo_array((np.ones(pairs.shape[1]), pairs), shape=(count + 1, count + 1))
    return scipy.sparse.csgraph.connected_components(joined, directed=False)[0] - 1
