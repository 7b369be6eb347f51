"""Whole surfaces, as drawn or as the oil answers them, of which any columns can be asked for."""

import functools

import numpy as np
import scipy
import xarray as xr
from scipy.interpolate import NdBSpline, make_interp_spline

from lube.contact.rough_pair import RoughPair
from lube.contact.strip_film import surface_moments
from lube.contact.surface_strip import strip_films
from lube.grid.films import film_at
from lube.grid.gap import Gap
from lube.grid.operating_points import surface_speeds
from lube.study.oil_properties import lubricant_table
from lube.surfaces.rough_surface import field


def answered_strip(study, spec, film_shape, slip, ratio):
    """Strip and film of some lambda ratio at an operating point: the oil answers the waves."""
    oil = lubricant_table(study.lubricants, [80.0]).isel(lubricant=0, temperature=0)
    choices = ["computed"], True, slip
    point = xr.DataArray(1600.0), xr.DataArray(100.0)
    film = film_at(oil, study.rollers, *point, *choices, answered_surfaces=spec).squeeze()
    scale = ratio * np.sqrt(surface_moments(spec).height) / film["film_thickness"]
    film = film.assign({name: scale * film[name] for name in ("film_thickness", "film_profile")})
    gap = Gap(film_shape, "computed")
    pair = RoughPair(spec, study.rollers.length, study.boundary_layer, study.seed, gap)
    (strip,) = strip_films(pair, film)
    return strip, film


def drawn_waves(surface, generator):
    """Waves of both rollers' surfaces."""
    return [
        np.fft.rfft2(generator.standard_normal(surface.coarse), norm="ortho")
        * np.sqrt(part * surface.variances)
        for part in (surface.first_part, 1.0 - surface.first_part)
    ]


class Unchanged:
    """Surfaces as drawn."""

    def __init__(self, surface):
        self._surface = surface

    def heights(self, waves):
        """Make the heights of some columns, given the waves of both surfaces."""
        heights = field(sum(waves), self._surface.points)
        return lambda column, width: heights[:, column : column + width]


def cubic(levels, values):
    """Tensor product of cubic splines through values on a grid of levels."""
    knots = []
    for axis, level in enumerate(levels):
        spline = make_interp_spline(level, values, axis=axis)
        values = np.moveaxis(spline.c, 0, axis)
        knots.append(spline.t)
    return NdBSpline(tuple(knots), values, 3)


class Filtered:
    """Surfaces of both rollers, each of whose waves has the film's response at each column."""

    def __init__(self, surface, strip, film):
        self._surface, half_width = surface, film["contact_half_width"].item()
        position = strip.columns(surface.spacing[1]) / half_width
        rows, columns = surface.coarse
        numbers = np.fft.fftfreq(rows, 1.0 / rows), np.arange(columns // 2 + 1)
        down, along = np.meshgrid(*numbers, indexing="ij")
        inverse = np.hypot(down / surface.sides[0], along / surface.sides[1])
        wavelength = 1.0 / np.where(inverse, inverse, 1e-9)
        known = film["wavelength"].values
        self._changed = np.nonzero(np.isfinite(wavelength) & (wavelength >= known[-1]))
        down, along = down / surface.sides[0], along / surface.sides[1]
        angle = np.degrees(np.arctan2(np.abs(down), along))
        place = angle[self._changed], -np.log(np.minimum(wavelength[self._changed], known[0]))
        self._responses = []
        for roller in (1, 2):
            parts = (film[f"surface_response_{each}"] for each in ("real", "imaginary"))
            real, imaginary = (part.sel(roller=roller).values for part in parts)
            levels = film["wave_angle"].values, -np.log(known), film["response_position"].values
            values = real + 1j * imaginary - 1.0
            # Between the waves, outside the contact: with the phase at its edge.
            outside = levels[2] - np.clip(levels[2], -1.0, 1.0)
            slope = np.cos(np.radians(levels[0]))[:, None] * 2.0 * np.pi * half_width / known
            values = values * np.exp(1j * slope[..., None] * outside)
            response = cubic(levels, values)
            beyond = position - np.clip(position, -1.0, 1.0)
            slope = 2.0 * np.pi * half_width * along[self._changed][:, None]
            sought = [*np.broadcast_arrays(*(each[:, None] for each in place), position)]
            found = response(np.stack(sought, axis=-1))
            self._responses.append(found * np.exp(-1j * slope * beyond))

    def heights(self, waves):
        """Make the heights of some columns, given the waves of both surfaces."""
        shape = self._surface.points
        heights = field(sum(waves), shape)
        rows, first = np.unique(self._changed[0], return_index=True)
        changed_rows = np.where(
            rows < self._surface.coarse[0] / 2, rows, rows - self._surface.coarse[0]
        )

        def across(column, width):
            added = np.zeros((shape[0], width), complex)
            for own, answer in zip(waves, self._answers(column, width), strict=True):
                added[changed_rows] += np.add.reduceat(own[self._changed][:, None] * answer, first)
            added = np.fft.ifft(added, axis=0, norm="forward").real
            return heights[:, column : column + width] + added

        return across

    @functools.cache  # noqa: B019 - a surface lives as long as its test
    def _answers(self, column, width):
        """What the oil adds at some columns to each wave of unit height, of either roller."""
        along = self._changed[1][:, None]
        at = 2j * np.pi / self._surface.points[1] * along * (column + np.arange(width))
        return [response * np.where(along, 2.0, 1.0) * np.exp(at) for response in self._responses]


def curved_more(added, spacing):
    """Mean curvature of heights that change little from column to column, periodic in the rows."""
    down = 2.0 * added - np.roll(added, 1, axis=0) - np.roll(added, -1, axis=0)
    along = np.pad(-np.diff(added, 2, axis=1), ((0, 0), (1, 1)), mode="edge")
    return 0.5 * (down / spacing[0] ** 2 + along / spacing[1] ** 2)


def summits_in(overlap, diagonal):
    """Label contacts, and find the highest point of each."""
    neighbours = np.array([[0, 1, 0], [1, 1, 1], [0, 1, 0]])
    if diagonal:
        neighbours[0, 1 - diagonal] = neighbours[2, 1 + diagonal] = 1
    labels, count = scipy.ndimage.label(overlap > 0.0, neighbours)
    return labels, scipy.ndimage.maximum_position(overlap, labels, range(1, count + 1))


def contacts_in(overlap, sharper, diagonal):
    """Labels of contacts, then of each whether it breaks its boundary layer."""
    labels, summits = summits_in(overlap, diagonal)
    return labels, *(bool(sharper[summit]) for summit in summits)


def in_motion(surface, generator, slip, steps):
    """Yield the waves of both surfaces at each step, in which they move by a column on average."""
    phase = 2j * np.pi / surface.points[1] * np.arange(surface.coarse[1] // 2 + 1)
    both = surface.of_each(surface.draw(generator)[2], generator)
    for step in range(steps):
        moved = zip(both, surface_speeds(1.0, slip), strict=True)
        yield [waves * np.exp(-step * speed * phase) for waves, speed in moved]


def begun(touching):
    """Number of bodies in space and time that are not there at the first step."""
    # A body may be narrower than its way in a step.
    labels, count = scipy.ndimage.label(touching, np.ones((3, 3, 3)))
    return count - np.unique(labels[0])[1:].size
