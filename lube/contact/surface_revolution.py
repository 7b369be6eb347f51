"""Contact of a pair of whole rollers over a revolution of pure rolling, drawn surface and all.

Rollers of one size that roll without slip meet with the same points in every revolution. So only
the sum of both surfaces matters, and it passes through the contact as one surface. It is put
together of independent pieces, each as wide and as long as a few of the longest waves. The joins
cut few contacts.

Of a piece only its summits are kept, and how high the saddles between them are: these tell which
summits are of one contact. In contact they are paraboloids, and the areas of those of one contact
add up. A contact breaks its boundary layer if its highest summit in the strip is sharp enough.
"""

import math
import os
from dataclasses import replace

import numpy as np
import scipy
import xarray as xr

from lube.contact.rough_pair import RoughPair
from lube.contact.surface_answers import COARSEST
from lube.contact.surface_strip import mean_breaking_curvature, smallest_contacts, strip_films
from lube.ehl.line_contact import one_blas_thread
from lube.kernels.summits import Summits, connected_summits, passing_contacts
from lube.surfaces.rough_surface import longest_waves, rough_surface, surface_waves
from lube.threads import on_threads
from lube.types import Array

ENOUGH = 25.0
"""Expected number of breakthroughs in the strip that is enough: lower summits are left out. The
layer is then broken for all but 1e-4 of the time, with a resistance far below that of the leads."""


def revolution_contact(
    pair: RoughPair, film: xr.Dataset, number: int, threads: int | None = None
) -> Array:
    """Find the length of contact over a revolution of one pair of rollers, at some films.

    Parameters
    ----------
    pair, film, threads
        As in `lube.contact.surface_strip.surface_contact`; the films over ``operating_point``.
        Both rollers have the same perimeter.
    number : int
        Number of the pair's surfaces, which are others for each number.

    Returns
    -------
    numpy.ndarray
        Shape (points, T), float32: summed diameters of contacts whose layer breaks, m, at T equal
        steps of a revolution; NaN where the film is not known.
    """
    strips = strip_films(pair, film)
    known = {point: strip for point, strip in enumerate(strips) if strip}
    if not known:
        return np.full((len(strips), 1), np.nan, np.float32)
    surface, passages = _passages(pair, film, known)
    steps = round(pair.spec.points[0] * pair.spec.spacing / surface.spacing[1])
    rows = max(int(pair.length / surface.spacing[0]), 1)
    found = np.full((len(strips), steps), np.nan, np.float32)
    found[list(known)] = 0.0
    least = min(passage.lowest_drawn for passage in passages.values())
    many = threads or os.cpu_count() or 1

    def of_column(column):
        """Contacts of all pieces side by side that begin at one column."""
        columns = min(steps - column * surface.points[1], surface.points[1])
        sums = {point: np.zeros(passage.steps) for point, passage in passages.items()}
        for piece, begin in enumerate(range(0, rows, surface.points[0])):
            seeds = np.random.SeedSequence((pair.seed, number, column, piece))
            summits, waves = _drawn(surface, seeds, least, rows - begin, columns)
            for point, passage in passages.items():
                passage.add(summits, waves, sums[point])
        return sums

    numbers = range(math.ceil(steps / surface.points[1]))
    for begin in range(0, len(numbers), 4 * many):  # few pieces are in memory at once
        some = numbers[begin : begin + 4 * many]
        for column, sums in zip(some, on_threads(of_column, some, threads), strict=True):
            for point, contact in sums.items():
                first = passages[point].first_step - column * surface.points[1]
                np.add.at(found[point], (first + np.arange(contact.size)) % steps, contact)
    return found


def _passages(pair, film, known):
    """Surface of which pieces are drawn, and their passages through known strips, by point."""
    strips = list(known.values())
    widest, multiple = max(one.width for one in strips), 2**COARSEST if pair.gap.is_answered else 1
    # The grid resolves the smallest contacts under the film under which there are most.
    smallest = tuple(smallest_contacts(pair.spec, strips).max(axis=0).tolist())
    surface = rough_surface(pair.spec, widest, smallest, multiple=multiple)
    sharp = mean_breaking_curvature(pair, film)
    with one_blas_thread():
        passages = {point: _Passage(strip, pair, surface, sharp) for point, strip in known.items()}
    return surface, passages


def _drawn(surface, seeds, lowest, rows, columns):
    """Summits in the first rows and columns of a piece, column by column, and its waves."""
    heights, curvatures, waves = surface.draw(np.random.default_rng(seeds))
    summits = connected_summits(heights, curvatures, surface.spacing, lowest)
    inside = np.flatnonzero((summits.row < rows) & (summits.column < columns))
    by_column = inside[np.argsort(summits.column[inside], kind="stable")]
    return _selected(summits, by_column), waves


class _Passage:
    """Summits of pieces of a surface on their way through the strip of an operating point."""

    def __init__(self, strip, pair, surface, sharp):
        spec, along = pair.spec, surface.spacing[1]
        self._along = along
        self._film = strip.films(along) / spec.height_step
        self._sharp = strip.breaking_curvatures(strip.columns(along), sharp) / spec.height_step
        self._lowest = _lowest(strip, spec, pair.length, sharp) / spec.height_step
        self._has_edges, self._answer = strip.has_edges, strip.answered(surface)
        self.lowest_drawn = self._lowest
        if self._answer:
            self.lowest_drawn -= _most_added(spec, strip) / spec.height_step
        # Steps at which a contact may be in the strip.
        extent = math.ceil(0.5 * longest_waves(spec)[1] / along)
        self.first_step = -surface.points[1] - extent
        self.steps = surface.points[1] + self._film.size + 2 * extent

    def add(self, summits, waves, contact):
        """Add the contacts of a piece."""
        summits = _selected(summits, np.flatnonzero(summits.height > self.lowest_drawn))
        by_oil, shapes = np.zeros((4, summits.row.size, 0)), np.zeros((self._film.size, 0))
        if self._answer:
            oil = self._answer.of_waves([waves])
            places = np.stack([summits.row, summits.column]) / (1 << oil.shift)
            each = oil.fields[1:-1, 1:-1], self._answer.curvatures(oil.fields)
            each += self._answer.slopes(oil.fields)
            by_oil = np.stack([_interpolated(fields, places) for fields in each])
            by_oil[2] *= self._along
            by_oil[3] *= self._inverse_root(summits)[:, None]
            most = np.einsum("sm,nm->sn", by_oil[0], oil.shapes).max(axis=1, initial=-np.inf)
            some = np.flatnonzero(summits.height + most > self._lowest)
            summits, by_oil = _selected(summits, some), by_oil[:, some]
            nodes = 1.0 + np.arange(self._film.size) / (1 << oil.shift)
            shapes = _interpolated(oil.shapes, nodes[None])
        passing_contacts(
            summits,
            by_oil,
            self._film,
            self._sharp,
            shapes,
            self._has_edges,
            self.first_step,
            contact,
        )

    def _inverse_root(self, summits):
        """Inverse square root of the curvature of summits along the rollers, m."""
        # Ridges at an angle are taken as ridges along the rollers or along rolling.
        along = 0.5 * summits.reach * self._along**2
        product = (summits.area / (2.0 * np.pi)) ** 2
        return np.sqrt(np.maximum(2.0 * summits.curvature * product - along, 0.0))


def _interpolated(values, places):
    """Linear interpolation between nodes, over all axes but the last."""
    linear = {"order": 1, "mode": "nearest"}
    each = np.moveaxis(values, -1, 0)
    return np.stack([scipy.ndimage.map_coordinates(one, places, **linear) for one in each], axis=-1)


def _selected(summits, some):
    """Keep some summits, given by their numbers, in this order."""
    number = np.full(summits.row.size, -1, np.int32)
    number[some] = np.arange(some.size)
    kept = Summits(*(each[some] for each in summits))
    higher = number[kept.higher]
    return kept._replace(higher=higher, saddle=np.where(higher < 0, -np.inf, kept.saddle))


def _most_added(spec, strip):
    """Height that the oil adds to a summit at most, m: three times its rms, where that is greatest.

    What is high in the gap is nearly always higher as drawn, so that few summits add more.
    """
    answer, square = strip.answers[0], 0.0
    shapes = answer.at(strip.middles / answer.half_width)
    for roller in range(2):
        along, across, power = surface_waves(spec, roller)
        by_oil = np.einsum("nm,wm->nw", shapes, answer.filters_at(along, across))
        square = square + np.sum(np.abs(by_oil) ** 2 * power, axis=1)
    return 3.0 * math.sqrt(square.max())


def _lowest(strip, spec, length, sharp):
    """Height above which summits are looked at, m."""
    drawn = replace(strip, answers=None)

    def too_many(times):
        return drawn.thicker(times).expected(spec, length, sharp)[1] - ENOUGH

    times = scipy.optimize.brentq(too_many, 1.0, 40.0, xtol=0.01) if too_many(1.0) > 0.0 else 1.0
    return times * strip.thickness(strip.middles).min()
