r"""Contact of the surface that the lines stand for, in the strip 2a x L'.

`lube.contact.strip_sampling` explains how contact is sampled.

A contact breaks its boundary layer if the mean curvature of the overlap at its highest point
exceeds :math:`\pi \tau_0/(2 E^* h_c)`. The line's criterion is twice that, because the mapping
doubles the curvature of a summit. Under a film of the shape h(x), half of h'' adds to the mean
curvature of the surface.

Where the oil answers the surface, heights and their covariances are those in the gap, which differ
across the strip.
"""

import math
from collections.abc import Sequence
from dataclasses import replace

import numpy as np
import xarray as xr

from lube.contact import strip_sampling
from lube.contact.pair_scatter import RecurringContacts, pair_deviation, turn_ratio
from lube.contact.rough_pair import RoughPair
from lube.contact.strip_film import StripFilm, surface_moments
from lube.contact.strip_sampling import COUNTS, RATIO, WITHOUT
from lube.contact.surface_answers import COARSEST, SurfaceAnswer
from lube.contact.waves import answers_at
from lube.grid.film_profiles import shaped_films
from lube.physics.summits import breaking_curvature
from lube.schema import LIMITS
from lube.study.surface_checks import check_surfaces
from lube.surfaces.rough_surface import rough_surface, surface_grid
from lube.surfaces.synthetic import LineSpecLike
from lube.types import Array, Values

SURFACES = 24
"""Surfaces drawn; the errors follow from the scatter between them."""
SEVERAL = 3.0
"""Expected number of contacts above which half as many strips tell the probability as well."""
MANY = 30.0
"""Expected number of contacts above which contact is certain, and contacts are counted."""
CERTAIN = 0.95
"""Probability of breakthrough above which few strips suffice where contact is certain."""
FEWER_STRIPS = 30
"""Strips on each surface where contact is certain."""
AT_ONCE = 10
"""Operating points at which the oil answers that are sampled together, for which surfaces are drawn
again: what the oil adds to the covariances takes 5 to 40 MB a point."""
_EXPECTED = "expected_contacts", "expected_breakthroughs"
_SAMPLED = [f"{name}{end}" for name in (*COUNTS, *COUNTS.values(), RATIO) for end in LIMITS]
_VARIABLES = (*_EXPECTED, *_SAMPLED, "passage_width", "pair_deviation")


def surface_contact(
    pair: RoughPair,
    film: xr.Dataset,
    threads: int | None = None,
    weaker: Values = 1.0,
    fewer: int = 1,
    wanted: xr.DataArray | None = None,
    thicker: Values = 1.0,
    left_out: bool = False,
) -> xr.Dataset:
    """Find how often, and at how many positions, surfaces touch over the length of the rollers.

    Parameters
    ----------
    pair : RoughPair
        The rollers.
    film : xarray.Dataset
        ``film_thickness`` and ``contact_half_width`` (m) over any dimensions, and
        ``reduced_modulus`` (Pa); for a film with a shape also ``film_profile``, for surfaces that
        the oil answers also its responses, from `lube.grid.film_responses.surface_responses`.
    threads : int, optional
        Threads that share the work, by default one for each core; they do not change the results.
    weaker : float or numpy.ndarray, optional
        How many times weaker the boundary layer is, at all films or at each.
    fewer : int, optional
        How many times fewer surfaces are drawn than `SURFACES`, for a faster, less exact result.
    wanted : xarray.DataArray, optional
        At which of the films contact is sampled, by default at all. The choice does not change the
        results there.
    thicker : float or numpy.ndarray, optional
        How many times thicker the films are under which contact is sampled, at all or at each. The
        surfaces, and how finely they are drawn, are those for the given films, so that contact
        changes by the film alone; the scatter is that under the given films too.
    left_out : bool, optional
        Whether to return the results without each surface, too, from which the errors follow of
        what is made of several probabilities.

    Returns
    -------
    xarray.Dataset
        ``geometric_contact_probability`` and ``breakthrough_probability``, the numbers ``contacts``
        and ``breakthroughs`` in the strip, and the part of its area where the layer is broken,
        ``breakdown_ratio``, each with ``_lower`` and ``_upper``; the numbers that theory expects,
        ``expected_contacts`` and ``expected_breakthroughs``; and in pure rolling the distance that
        the rollers move while a contact is in the strip, ``passage_width`` (m), and the scatter of
        a pair's share of breakthrough in a revolution, ``pair_deviation``, as
        `lube.contact.pair_scatter` explains; over the dimensions of the films, NaN where the film
        is not known or not wanted. With `left_out` also ``groups_without``, the number of groups
        of breakthroughs, -ln(1 - P), without each of the surfaces; its first dimension is surface.

    Raises
    ------
    StudyError, DataError
        As from `lube.study.surface_checks.check_surfaces`.
    """
    thickness, half_width = xr.broadcast(film["film_thickness"], film["contact_half_width"])
    check_surfaces(pair.spec, pair.length, 2.0 * half_width.max().item(), pair.gap)
    strips = strip_films(pair, film)
    known = np.array([strip is not None for strip in strips])
    sharp = mean_breaking_curvature(pair, film) / weaker
    sharp = np.broadcast_to(sharp, thickness.size)
    seeds = surface_seeds(pair.seed, SURFACES // fewer)
    values = {name: np.full(thickness.size, np.nan) for name in _VARIABLES}
    values[WITHOUT] = np.full((len(seeds), thickness.size), np.nan)
    wanted = xr.DataArray(True) if wanted is None else wanted
    wanted = wanted.broadcast_like(thickness).transpose(*thickness.dims).values.ravel()
    if known.any():
        some = [strip for strip in strips if strip is not None]
        changed = np.broadcast_to(thicker, thickness.size)[known].tolist()
        changed = [one.thicker(times) for one, times in zip(some, changed, strict=True)]
        sampled = _contacts(pair, some, changed, sharp[known], wanted[known], seeds, threads)
        for name, of_known in sampled.items():
            values[name][..., known] = of_known
    dims, shape, without = thickness.dims, thickness.shape, values.pop(WITHOUT)
    values = {name: (dims, each.reshape(shape)) for name, each in values.items()}
    found = xr.Dataset(values, thickness.coords)
    if left_out:
        found[WITHOUT] = ("surface", *dims), without.reshape(-1, *shape)
    for name in (f"{RATIO}{end}" for end in LIMITS):
        found[name] = found[name] / (2.0 * half_width)
    return found


def surface_widths(
    pair: RoughPair,
    film: xr.Dataset,
    slide_to_roll_ratio: xr.DataArray | float = 0.0,
    wanted: xr.DataArray | None = None,
) -> xr.Dataset:
    """Find how far the rollers move while a contact, and while a broken layer, is in the strip.

    Parameters
    ----------
    pair, film, wanted
        As in `surface_contact`.
    slide_to_roll_ratio : xarray.DataArray or float, optional
        By default pure rolling.

    Returns
    -------
    xarray.Dataset
        ``passage_width`` and ``breakthrough_width`` (m) over the dimensions of the films and of the
        slip, NaN where the film is not known or not wanted.
    """
    strips, sharp = strip_films(pair, film), mean_breaking_curvature(pair, film)
    thickness, _ = xr.broadcast(film["film_thickness"], film["contact_half_width"])
    points = thickness.copy(data=np.arange(thickness.size).reshape(thickness.shape))

    def widths(slip, point, is_wanted):
        strip, spec = strips[point], pair.spec
        if strip is None or not is_wanted:
            return np.nan, np.nan
        of_broken = strip.breakthrough_width(spec, pair.length, sharp, slip)
        return strip.passage_width(spec, pair.length, slip), of_broken

    found = xr.apply_ufunc(
        np.vectorize(widths, otypes=[float, float]),
        slide_to_roll_ratio,
        points,
        xr.DataArray(True) if wanted is None else wanted,
        output_core_dims=[(), ()],
    )
    return xr.Dataset(dict(zip(("passage_width", "breakthrough_width"), found, strict=True)))


def mean_breaking_curvature(pair: RoughPair, film: xr.Dataset) -> float:
    """Mean curvature of an overlap above which its boundary layer breaks, 1/m."""
    return 0.5 * breaking_curvature(
        film["reduced_modulus"].item(), pair.layer.critical_thickness, pair.layer.shear_strength
    )


def surface_seeds(seed: int, count: int) -> list:
    """Seeds of some surfaces: for each one that draws it, and one that chooses strips on it."""
    # The first two children draw the lines of the realisation of this number, the next three are
    # those of `lube.surfaces.rare_contact`.
    return [np.random.SeedSequence((seed, number)).spawn(7)[5:] for number in range(count)]


def strip_films(pair: RoughPair, film: xr.Dataset) -> list[StripFilm | None]:
    """Films across the strips of operating points, None where they are not known.

    Parameters
    ----------
    pair, film
        As in `surface_contact`.
    """
    thickness, half_width = xr.broadcast(film["film_thickness"], film["contact_half_width"])
    widths = half_width.values.ravel().tolist()
    if pair.gap.has_shape:
        rms, position = math.sqrt(surface_moments(pair.spec).height), film["film_position"].values
        rows = shaped_films(film).values.reshape(thickness.size, -1)
        strips = [
            StripFilm.shaped(position * width, row, rms) if np.isfinite(row).all() else None
            for width, row in zip(widths, rows, strict=True)
        ]
    else:
        points = zip(thickness.values.ravel().tolist(), widths, strict=True)
        strips = [None if math.isnan(one[0]) else StripFilm.flat(*one) for one in points]
    if not pair.gap.is_answered:
        return strips
    answers = xr.broadcast(answers_at(film, pair.gap.has_shape, SurfaceAnswer), thickness)[0]
    answers = answers.transpose(*thickness.dims, "roller").values.reshape(-1, 2)
    each = zip(strips, answers, strict=True)
    return [replace(one, answers=tuple(both)) if one and both[0] else None for one, both in each]


def _contacts(pair, strips, changed, sharp, wanted, seeds, threads):
    """Variables of `surface_contact` at some strips, of which changed ones are sampled."""
    spec, length = pair.spec, pair.length
    found = {name: np.full(len(strips), np.nan) for name in _VARIABLES}
    found[WITHOUT] = np.full((len(seeds), len(strips)), np.nan)
    expected, broken = (found[name] for name in _EXPECTED)
    for point in np.flatnonzero(wanted):
        expected[point], broken[point] = strips[point].expected(spec, length, sharp[point])
        found["passage_width"][point] = strips[point].passage_width(spec, length)
    certain = expected > MANY
    most = np.where(expected > SEVERAL, strip_sampling.STRIPS // 2, strip_sampling.STRIPS)

    def sample(surface, some, is_certain):
        own = [changed[point] for point in some]
        counts = np.where(is_certain, FEWER_STRIPS, most[some])
        sampled = strip_sampling.sampled_strips(
            pair, surface, own, counts, is_certain, sharp[some], seeds, threads
        )
        for name, values in sampled.items():
            found[name][..., some] = values

    for surface, alike in _on_alike_grids(spec, strips):
        some = alike[wanted[alike]]
        if some.size:
            sample(surface, some, certain[some])
        holds = some[certain[some] & (found["breakthrough_probability"][some] < CERTAIN)]
        if holds.size:  # few strips do not tell how often the layer breaks
            sample(surface, holds, np.zeros(holds.size, bool))
    shares = found["breakthrough_probability"]
    found["pair_deviation"] = _pair_deviations(pair, strips, sharp, wanted, shares)
    return found


def _pair_deviations(pair, strips, sharp, wanted, shares):
    """Scatter of a pair's share of breakthrough in a revolution of pure rolling, at each strip."""
    spec, length, found = pair.spec, pair.length, np.full(len(strips), np.nan)
    perimeters = np.multiply(spec.points, spec.spacing)
    recurring = RecurringContacts(spec) if perimeters[0] != perimeters[1] else None
    for point in np.flatnonzero(wanted):
        strip, share = strips[point], shares[point]
        common = strip.common(spec, length)
        found[point] = pair_deviation(share, *common, perimeters[0])
        if recurring is not None:
            part = strip.breaking_part(spec, length, sharp[point])
            alone = recurring.at(strip.levels(spec).min(), part)
            found[point] *= turn_ratio(share, *common, alone, perimeters) ** 0.5
    return found


def _on_alike_grids(spec, strips):
    """Yield surfaces, each with the numbers of some strips, whose contacts it resolves.

    The grid of a strip depends on its own film, and on the width of the widest strip.
    """
    widest, is_answered = max(strip.width for strip in strips), strips[0].answers is not None
    smallest = smallest_contacts(spec, strips)
    spacings = np.array([surface_grid(spec, widest, tuple(size))[1] for size in smallest])
    at_once = AT_ONCE if is_answered else len(strips)
    for spacing in np.unique(spacings, axis=0):
        alike = np.flatnonzero((spacings == spacing).all(axis=1))
        multiple = 2**COARSEST if is_answered else 1
        surface = rough_surface(spec, widest, tuple(smallest[alike[0]]), multiple=multiple)
        for first in range(0, alike.size, at_once):
            yield surface, alike[first : first + at_once]


def smallest_contacts(spec: LineSpecLike, strips: Sequence[StripFilm]) -> Array:
    """Find the sizes of the smallest contacts in some strips along the rollers and along rolling.

    They are those of parabolas as high as the mean summit above the film, and an eighth of the
    strip's width at most, which the grid has to resolve, too. They are rounded down to powers of
    the root of two, so that strips share surfaces.

    Parameters
    ----------
    spec : LineSpecLike
        As in `surface_contact`.
    strips : sequence of StripFilm
        The strips.

    Returns
    -------
    numpy.ndarray, shape (strips, 2)
        Sizes, m.
    """
    moments = surface_moments(spec)
    levels = np.array([strip.levels(spec) for strip in strips])
    films = np.array([strip.thickness(strip.middles) for strip in strips])
    lowest = levels.argmin(axis=1)[:, None]
    levels, films = (np.take_along_axis(each, lowest, axis=1) for each in (levels, films))
    # The mean summit rises by the square of the rms height in the gap, over the film.
    smallest = np.sqrt(4.0 / np.array([moments.across, moments.along])) * films / levels**2
    smallest[:, 1] = np.minimum(smallest[:, 1], [strip.width / 8.0 for strip in strips])
    return 2.0 ** (0.5 * np.floor(2.0 * np.log2(smallest)))
