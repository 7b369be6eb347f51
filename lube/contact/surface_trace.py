"""Contact of surfaces along the rollers at every step of a way.

The strip is put together of independent pieces, each of which is a surface as wide as a few of the
longest waves. Their joins cut few contacts. The rollers move by one period of these surfaces.
"""

import itertools
from functools import partial

import numpy as np
import scipy.ndimage
import xarray as xr

from lube.contact.rough_pair import RoughPair
from lube.contact.surface_answers import COARSEST
from lube.contact.surface_strip import mean_breaking_curvature, smallest_contacts, strip_films
from lube.ehl.line_contact import one_blas_thread
from lube.grid.operating_points import surface_speeds
from lube.study.surface_checks import check_surfaces
from lube.surfaces.rough_surface import UNRESOLVED, field, rough_surface
from lube.threads import on_threads

STEPS = 200
"""Time steps."""
PLACES = 100
"""Places along the rollers at which contacts are shown."""


def surface_traces(
    pair: RoughPair, film: xr.Dataset, slide_to_roll_ratio: float = 0.0, threads: int | None = None
) -> xr.Dataset:
    """Follow the contacts of surfaces along the rollers, at some films on the same surfaces.

    Parameters
    ----------
    pair, film, threads
        As in `lube.contact.surface_strip.surface_contact`; the films over ``operating_point``.
    slide_to_roll_ratio : float, optional
        Slide-to-roll ratio, by default pure rolling.

    Returns
    -------
    xarray.Dataset
        Over operating_point and step: the numbers ``contacts``, and ``breakthroughs`` of contacts
        whose boundary layer breaks, and the summed diameters ``contact_length`` (m) of the latter,
        of circles of the same area, as far as they lie in the strip; as ``contact_length_at`` also
        over roller_position (m), by the highest point of each contact. ``step`` is the way of the
        rollers, m. NaN where the film is not known.

    Raises
    ------
    StudyError, DataError
        As from `lube.study.surface_checks.check_surfaces`.
    """
    spec, widest = pair.spec, 2.0 * film["contact_half_width"].max().item()
    check_surfaces(spec, pair.length, widest, pair.gap)
    strips = strip_films(pair, film)
    some = [strip for strip in strips if strip]
    wide = max([widest, *(strip.width for strip in some)])
    smallest = tuple(smallest_contacts(spec, some).min(axis=0)) if some else UNRESOLVED
    multiple = 2**COARSEST if pair.gap.is_answered else 1
    surface = rough_surface(spec, wide, smallest, multiple=multiple)
    sharp, each = mean_breaking_curvature(pair, film), enumerate(strips)
    with one_blas_thread():
        known = {point: _Passage(strip, pair, surface, sharp) for point, strip in each if strip}
    down = surface.spacing[0]
    rows = max(int(pair.length / down), 1)
    begins = range(0, rows, surface.points[0])
    speeds = surface_speeds(1.0, slide_to_roll_ratio)
    way = surface.sides[1] / max(speeds) / STEPS * np.arange(STEPS)

    def of_piece(begin):
        seeds = np.random.SeedSequence((pair.seed, begin // surface.points[0])).spawn(9)[8]
        moving = _moving(surface, np.random.default_rng(seeds), speeds)
        count = min(rows - begin, surface.points[0])
        return {point: strip.contacts(moving, count, way) for point, strip in known.items()}

    found = on_threads(of_piece, begins, threads, "trace of surfaces")
    return _table(dict(zip(begins, found, strict=True)), len(strips), way, rows, down)


def _moving(surface, generator, speeds):
    """Surfaces that move alike: speed, heights, curvatures, and waves; one in pure rolling."""
    heights, curvatures, waves = surface.draw(generator)
    if speeds[0] == speeds[1]:
        return [(speeds[0], heights, curvatures, waves)]
    both = []
    for speed, own in zip(speeds, surface.of_each(waves, generator), strict=True):
        curved = own * surface.curvatures.astype(np.float32)
        both.append((speed, *(field(each, surface.points) for each in (own, curved)), own))
    return both


class _Passage:
    """Pieces of a surface on their way through the strip of an operating point."""

    def __init__(self, strip, pair, surface, sharp):
        along, step = surface.spacing[1], pair.spec.height_step
        self._film = (strip.films(along) / step).astype(np.float32)
        self._sharp = strip.breaking_curvatures(strip.columns(along), sharp) / step
        self._surface, self._answer = surface, strip.answered(surface)
        self._shift = self._answer.shift if self._answer else 0

    def contacts(self, moving, rows, way):
        """Contacts of a piece at every step: their row, diameter, and whether they break."""
        surface, answer, shift = self._surface, self._answer, self._shift
        added, columns, steps = self._added(moving), np.arange(self._film.size), []
        for here in way:
            overlap, curvature, by_oil = np.float32(0.0) - self._film, [], 0.0
            for (speed, heights, curvatures, _), more in zip(moving, added, strict=True):
                # Points of the surface that lie upstream come into the strip.
                place = round(-here * speed / surface.spacing[1]) >> shift << shift
                at = (place + columns) % surface.points[1]
                overlap = overlap + heights[:rows].take(at, axis=1)
                curvature.append((curvatures, at))
                if answer:
                    by_oil = by_oil + more(place >> shift)
            if answer:
                inner = _finer(by_oil[1:-1, 1:-1], shift)
                overlap += _finer(inner.T, shift).T[:rows, : columns.size]
            row, column, points = _summits(overlap, surface.diagonal)
            curved = sum(curvatures[row, at[column]] for curvatures, at in curvature)
            if answer:
                nodes = np.stack([row, column]) / (1 << shift)
                from_oil = answer.curvatures(by_oil)
                curved = curved + scipy.ndimage.map_coordinates(from_oil, nodes, order=1)
            diameter = np.sqrt(4.0 * (surface.spacing[0] * surface.spacing[1] * points) / np.pi)
            steps.append(np.column_stack([row, diameter, curved > self._sharp[column]]))
        return steps

    def _added(self, moving):
        """Functions of the strip's place for what the oil adds to each moving surface at nodes."""
        answer = self._answer
        if answer is None:
            return [None] * len(moving)
        # In pure rolling the film responds to both surfaces alike, and their sum has one answer.
        by_oil = answer.of_waves([own for *_, own in moving])
        ends = np.cumsum([0, *(one.shapes.shape[1] for one in answer.answers)]).tolist()
        number = np.arange(by_oil.shapes.shape[0])

        def added(begin, end, first):
            nodes = (first - 1 + number) % answer.points[1] + 1
            fields = by_oil.fields[:, nodes, begin:end]
            return np.sum(fields * by_oil.shapes[:, begin:end], axis=-1)

        return [partial(added, *each) for each in itertools.pairwise(ends)]


def _summits(overlap, diagonal):
    """Row and column of the highest point of each contact, and its number of points."""
    near = np.array([[0, 1, 0], [1, 1, 1], [0, 1, 0]])
    if diagonal:
        near[0, 1 - diagonal] = near[2, 1 + diagonal] = 1
    # Rows with a contact, each with the next row, so that others stay apart.
    touched = (overlap > 0.0).any(axis=1)
    touched[1:] |= touched[:-1]
    some = np.flatnonzero(touched)
    labels, count = scipy.ndimage.label(overlap[some] > 0.0, near)
    if not count:
        return np.empty((3, 0), int)
    summits = scipy.ndimage.maximum_position(overlap[some], labels, np.arange(1, count + 1))
    row, column = np.array(summits).T
    return some[row], column, np.bincount(labels.ravel())[1:]


def _finer(nodes, shift):
    """Linear interpolation between rows of nodes."""
    part = (np.arange(1 << shift) / np.float32(1 << shift))[None, :, None]
    between = nodes[:-1, None] * (1.0 - part) + nodes[1:, None] * part
    return between.reshape(-1, nodes.shape[1])


def _table(found, points, way, rows, spacing):
    """Numbers and lengths over operating point, step and place along the rollers."""
    names = "contacts", "breakthroughs", "contact_length"
    values = np.full((len(names), points, way.size), np.nan)
    at = np.full((points, way.size, PLACES), np.nan)
    known = list(found[0])
    values[:, known] = at[known] = 0.0
    for begin, of_points in found.items():
        for point, steps in of_points.items():
            for step, contacts in enumerate(steps):
                row, diameter, breaks = contacts.T
                broken = breaks > 0.0
                values[:, point, step] += row.size, np.count_nonzero(broken), diameter[broken].sum()
                place = ((begin + row[broken]) * PLACES / rows).astype(np.int64)
                at[point, step] += np.bincount(place, diameter[broken], PLACES)
    middle = (np.arange(PLACES) + 0.5) * rows * spacing / PLACES
    dims = "operating_point", "step"
    table = {name: (dims, each) for name, each in zip(names, values, strict=True)}
    table["contact_length_at"] = (*dims, "roller_position"), at
    return xr.Dataset(table, {"step": way, "roller_position": middle})
