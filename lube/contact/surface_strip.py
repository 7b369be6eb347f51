r"""Contact of the surface that the lines stand for, in the strip 2a x L'.

The strip is followed row by row along the rollers. Row j is the first of the strip that touches
with the probability :math:`g_j`, so that a strip of n rows touches with

.. math:: P = \sum_{j=0}^{n-1} g_j

Importance sampling finds :math:`g_0` from rows that touch, and the other :math:`g_j` from contacts
that begin in row j while no row of the strip before it touches. Rows further apart than a longest
wavelength are independent, so from there on a row is the first with the same probability if none
before it has touched.

A contact breaks its boundary layer if the mean curvature of the overlap at its highest point
exceeds :math:`\pi \tau_0/(2 E^* h_c)`. The line's criterion is twice that, because the mapping
doubles the curvature of a summit. Under a film of the shape h(x), half of h'' adds to the mean
curvature of the surface.

Where the oil answers the surface, heights and their covariances are those in the gap, which differ
across the strip.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import partial

import numpy as np
import scipy
import xarray as xr

from lube.contact.pair_scatter import RecurringContacts, pair_deviation, turn_ratio
from lube.contact.rough_pair import RoughPair
from lube.contact.strip_film import COLUMNS, StripFilm, surface_moments
from lube.contact.surface_answers import COARSEST, AnsweredStrip, SurfaceAnswer
from lube.contact.waves import answers_at
from lube.ehl.line_contact import one_blas_thread
from lube.grid.film_profiles import shaped_films
from lube.kernels.areal import BLOCK, GROUP, contacts_per_row, touching_strips
from lube.kernels.moved_surface import NO_ANSWER
from lube.physics.summits import breaking_curvature
from lube.schema import LIMITS, values_with_limits
from lube.statistics.confidence import breakthrough_limit, jackknife_interval, mean_interval
from lube.study.surface_checks import check_surfaces
from lube.surfaces.lay import extents
from lube.surfaces.rough_surface import longest_waves, rough_surface, surface_grid
from lube.surfaces.synthetic import LineSpecLike
from lube.threads import on_threads
from lube.types import Array, Values

SURFACES = 24
"""Surfaces drawn; the errors follow from the scatter between them."""
STRIPS = 750
"""Strips on each surface."""
SEVERAL = 3.0
"""Expected number of contacts above which half as many strips tell the probability as well."""
MANY = 30.0
"""Expected number of contacts above which contact is certain, and contacts are counted."""
CERTAIN = 0.95
"""Probability of breakthrough above which few strips suffice where contact is certain."""
FEWER_STRIPS = 30
"""Strips on each surface where contact is certain."""
COUNTED_STRIPS = 5
"""The first of these, in which contacts are counted."""
AROUND = 100
"""Rows beyond a known point in which its contact is followed; a first contact begins within as many
before it."""
FADING = 6.0
"""How fast points are chosen less often the more they overlap, over the density of heights at the
film. Without it large contacts are chosen far more often than small ones, in proportion to their
area."""
AT_ONCE = 10
"""Operating points at which the oil answers that are sampled together, for which surfaces are drawn
again: what the oil adds to the covariances takes 5 to 40 MB a point."""
_ALL = 1.0 - 1e-12
"""Probability taken as certain."""
_CERTAIN = 40.0
"""Number of independent contacts from which on the probability is 1 in floating point."""
_COUNTS = {"geometric_contact_probability": "contacts", "breakthrough_probability": "breakthroughs"}
_EXPECTED = "expected_contacts", "expected_breakthroughs"
_RATIO = "breakdown_ratio"
_SAMPLED = [f"{name}{end}" for name in (*_COUNTS, *_COUNTS.values(), _RATIO) for end in LIMITS]
_VARIABLES = (*_EXPECTED, *_SAMPLED, "pair_deviation")


def surface_contact(
    pair: RoughPair,
    film: xr.Dataset,
    threads: int | None = None,
    weaker: Values = 1.0,
    fewer: int = 1,
    slide_to_roll_ratio: xr.DataArray | float = 0.0,
    wanted: xr.DataArray | None = None,
    thicker: Values = 1.0,
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
    slide_to_roll_ratio : xarray.DataArray or float, optional
        For both widths, which also have its dimensions; by default pure rolling.
    wanted : xarray.DataArray, optional
        At which of the films contact is sampled, by default at all. The choice does not change the
        results there.
    thicker : float or numpy.ndarray, optional
        How many times thicker the films are under which contact is sampled, at all or at each. The
        surfaces, and how finely they are drawn, are those for the given films, so that contact
        changes by the film alone; way and scatter are those under the given films too.

    Returns
    -------
    xarray.Dataset
        ``geometric_contact_probability`` and ``breakthrough_probability``, the numbers ``contacts``
        and ``breakthroughs`` in the strip, and the part of its area where the layer is broken,
        ``breakdown_ratio``, each with ``_lower`` and ``_upper``; the numbers that theory expects,
        ``expected_contacts`` and ``expected_breakthroughs``; the distance that the
        rollers move while a contact is in the strip, ``passage_width`` (m), and while the layer of
        a contact is broken, ``breakthrough_width`` (m); and the scatter of a pair's share of
        breakthrough in a revolution of pure rolling, ``pair_deviation``, as
        `lube.contact.pair_scatter` explains; over the dimensions of the films, NaN where the film
        is not known or not wanted.

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
    values = {name: np.full(thickness.size, np.nan) for name in _VARIABLES}
    wanted = xr.DataArray(True) if wanted is None else wanted
    wanted = wanted.broadcast_like(thickness).transpose(*thickness.dims).values.ravel()
    if known.any():
        some = [strip for strip in strips if strip is not None]
        seeds = surface_seeds(pair.seed, SURFACES // fewer)
        changed = np.broadcast_to(thicker, thickness.size)[known].tolist()
        changed = [one.thicker(times) for one, times in zip(some, changed, strict=True)]
        sampled = _contacts(pair, some, changed, sharp[known], wanted[known], seeds, threads)
        for name, of_known in sampled.items():
            values[name][known] = of_known
    dims, shape = thickness.dims, thickness.shape
    values = {name: (dims, each.reshape(shape)) for name, each in values.items()}
    found = xr.Dataset(values, thickness.coords)
    for name in (f"{_RATIO}{end}" for end in LIMITS):
        found[name] = found[name] / (2.0 * half_width)
    points = thickness.copy(data=np.arange(thickness.size).reshape(shape))
    widths = partial(_widths, pair, strips, sharp, known & wanted)
    widths = np.vectorize(widths, otypes=[float, float])
    widths = xr.apply_ufunc(widths, slide_to_roll_ratio, points, output_core_dims=[(), ()])
    return found.assign(dict(zip(("passage_width", "breakthrough_width"), widths, strict=True)))


def _widths(pair, strips, sharp, wanted, slip, point):
    """Passage width and breakthrough width at an operating point, m; NaN where not wanted."""
    if not wanted[point]:
        return np.nan, np.nan
    strip, spec, length = strips[point], pair.spec, pair.length
    of_broken = strip.breakthrough_width(spec, length, sharp[point], slip)
    return strip.passage_width(spec, length, slip), of_broken


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
    expected, broken = (found[name] for name in _EXPECTED)
    for point in np.flatnonzero(wanted):
        expected[point], broken[point] = strips[point].expected(spec, length, sharp[point])
    certain = expected > MANY
    most = np.where(expected > SEVERAL, STRIPS // 2, STRIPS)

    def sample(surface, some, is_certain):
        own = [changed[point] for point in some]
        counts = np.where(is_certain, FEWER_STRIPS, most[some])
        sampled = _sampled(pair, surface, own, counts, is_certain, sharp[some], seeds, threads)
        for name, values in sampled.items():
            found[name][some] = values

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

    They are those of parabolas as high as the mean summit above the film, rounded down to powers of
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
    films = np.array([strip.films(strip.width / COLUMNS).min() for strip in strips])
    slopes = np.array([moments.across, moments.along])
    smallest = np.sqrt(4.0 / slopes) * moments.height / films[:, None]
    return 2.0 ** (0.5 * np.floor(2.0 * np.log2(smallest)))


@dataclass(frozen=True)
class _SampledStrip:
    """How an operating point is sampled on each surface.

    Attributes
    ----------
    film, sharp : numpy.ndarray
        Film, height steps, and breaking curvature, height steps per square metre, at the columns of
        the strip.
    rms : numpy.ndarray
        Rms height in the gap at the columns, height steps.
    count : int
        Number of strips.
    is_certain : bool
        Whether contact is certain, so that contacts are counted in some strips.
    answered : AnsweredStrip or None
        What the oil adds to the surfaces.
    """

    film: Array
    sharp: Array
    rms: Array
    count: int
    is_certain: bool
    answered: AnsweredStrip | None

    @property
    def fading(self):
        """How fast points are chosen less often the more they overlap, at each column."""
        return FADING * self.film / self.rms**2

    def by_oil(self, waves, of_each):
        """Find what the oil adds to drawn waves, given those of both surfaces and of each."""
        if self.answered is None:
            return NO_ANSWER
        return self.answered.of_waves(of_each if len(self.answered.answers) > 1 else [waves])

    def places(self, points, reach, chosen):
        """Rows and columns of a surface of so many points at which chosen strips begin."""
        shift, around = self.answered.shift if self.answered else 0, reach[1]
        first_row, sizes = sum(reach), [one + 1 - (1 << shift) for one in points]
        room = sizes[0] - first_row - around, sizes[1] - self.film.size + 1
        row, column = ((room[side] * chosen[side]).astype(np.int64) for side in range(2))
        # Strips begin at nodes.
        return tuple(-(-place >> shift << shift) for place in (first_row + row, column))

    def known_points(self, chosen):
        """Columns and heights of points that touch, and the weight of each strip with one.

        The density of a known height is that of all heights, times exp(-fading overlap): a normal
        one with another mean.
        """
        film, rms = self.film, self.rms
        log_tails = scipy.special.log_ndtr(-(1.0 + FADING) * film / rms)
        log_chances = log_tails + FADING * (1.0 + 0.5 * FADING) * (film / rms) ** 2
        likely = np.cumsum(np.exp(log_chances - log_chances.max()))
        known = np.searchsorted(likely, chosen[1] * likely[-1])
        heights = np.log(chosen[0]) + log_tails[known]
        heights = -rms[known] * scipy.special.ndtri_exp(heights) - FADING * film[known]
        weight = likely[-1] * np.exp(log_chances.max()) / self.count
        return (known, heights.astype(np.float32)), weight


def _sampled(pair, surface, strips, counts, is_certain, sharp, seeds, threads):
    """Probabilities and numbers of contacts, with their intervals, shape (strips,) each."""
    down, along = surface.spacing
    reach, step = _reach(pair.spec, down), pair.spec.height_step
    rows = sum(reach), reach[1]
    answered = [strip.answered(surface) for strip in strips]
    with one_blas_thread():
        answered = [oil and oil.with_covariances(*rows, threads) for oil in answered]
    sampled = []
    each = zip(strips, sharp, counts.tolist(), is_certain.tolist(), answered, strict=True)
    for strip, own, count, certain, oil in each:
        film, limit = strip.films(along) / step, strip.breaking_curvatures(along, own) / step
        rms = np.broadcast_to(surface.rms * oil.rms if oil else surface.rms, film.shape)
        sampled.append(_SampledStrip(film, limit, rms, count, certain, oil))
    covariances = tuple(surface.covariances(*rows, max(one.film.size for one in sampled)))
    on_one_surface = partial(_on_one_surface, surface, covariances, sampled, reach)
    found = on_threads(on_one_surface, seeds, threads, "contact of surfaces")
    first, numbers = map(np.stack, zip(*found, strict=True))
    return _with_limits(first, numbers, max(int(pair.length / down), 1), along, counts * len(seeds))


def _with_limits(first, numbers, rows, spacing, sampled):
    """Variables and their limits from all surfaces, for a strip of so many rows."""
    results = {}
    for which, (name, of_contacts) in enumerate(_COUNTS.items()):
        # The limits are of the number of contacts: near 1 a probability scatters to one side.
        limits = jackknife_interval(first[:, :, which], partial(_up_to_certain, rows=rows))
        results |= values_with_limits(name, [-np.expm1(-each) for each in limits])
        results |= values_with_limits(of_contacts, mean_interval(rows * numbers[:, :, which]))
    in_contact, broken = (mean_interval(spacing * numbers[:, :, which]) for which in (2, 3))
    results |= values_with_limits(_RATIO, broken)  # m, of the strip's width
    contacts = results["contacts_upper"]
    for name in ("breakthroughs_upper", "breakthrough_probability_upper", f"{_RATIO}_upper"):
        of_contact = in_contact[2] if name == f"{_RATIO}_upper" else contacts
        results[name] = breakthrough_limit(results[name], of_contact, sampled)
    geometric, breakthrough = _COUNTS
    for end in LIMITS:  # no layer breaks without contact, but both are known with an error
        most = results[f"{geometric}{end}"]
        results[f"{breakthrough}{end}"] = np.minimum(results[f"{breakthrough}{end}"], most)
    return results


def _up_to_certain(first, rows):
    """As `first_contacts`; greater numbers scatter far, and tell nothing more."""
    return np.minimum(first_contacts(first, rows), _CERTAIN)


def _reach(spec, spacing):
    """Rows beyond which rows are independent, and over which contacts are followed."""
    longest = math.ceil(longest_waves(spec)[0] / spacing)
    # Ridges at an angle reach further along the rollers than a cut through one along the rollers.
    lays = [(line.lay_ratio, line.lay_angle) for line in spec.lines]
    oblique = max(math.prod(extents(*lay)) / lay[0] for lay in lays)
    return longest, min(math.ceil(AROUND * oblique), longest)


def _on_one_surface(surface, covariances, strips, reach, seeds):
    """Probability of first rows, shape (strips, 2, R + 1), and contacts per row, (strips, 4)."""
    drawing, choosing = map(np.random.default_rng, seeds)
    heights, curvatures, waves = surface.draw(drawing)
    fields, chosen, both = (heights, curvatures), choosing.random((4, STRIPS)), []
    if any(one.answered and len(one.answered.answers) > 1 for one in strips):
        both = surface.of_each(waves, drawing)
    tops = np.maximum.reduceat(heights, np.arange(0, surface.points[1], BLOCK), axis=1)
    tops = tops, np.maximum.reduceat(tops, np.arange(0, surface.points[0], GROUP))
    around, diagonal, first, numbers = reach[1], surface.diagonal, [], []
    for strip in strips:
        film, sharp, fading = strip.film, strip.sharp, strip.fading
        own, oil = chosen[:, : strip.count], strip.by_oil(waves, both)
        touching, weight = strip.known_points(own[2:])
        places = strip.places(surface.points, reach, own[:2])
        *each, contacts = touching_strips(
            fields, tops, covariances, places, touching, film, sharp, fading, around, oil, diagonal
        )
        first.append(weight * np.stack(each))
        if strip.is_certain:
            some = tuple(place[:COUNTED_STRIPS] for place in places)
            contacts = contacts_per_row(
                fields, covariances, some, film, sharp, around, oil, diagonal
            )
        else:
            contacts = weight * contacts
        numbers.append(contacts)
    return np.stack(first), np.stack(numbers)


def first_contacts(first: np.ndarray, rows: int) -> np.ndarray:
    """Compute how many independent contacts in a strip would make it touch as often.

    Parameters
    ----------
    first : numpy.ndarray
        Shape (..., R + 1): probability that a row touches while none of the 0, 1, ... R rows
        before it does.
    rows : int
        Rows of the strip.

    Returns
    -------
    numpy.ndarray
        Shape (...): -log(1 - P) of the probability P that any row touches.

    Examples
    --------
    Independent rows, one in ten of which touches:

    >>> first = 0.1 * 0.9 ** np.arange(4)
    >>> [f"{-np.expm1(-first_contacts(first, rows)):.6f}" for rows in (2, 10)]
    ['0.190000', '0.651322']
    """
    touched = np.cumsum(first, axis=-1)
    if rows <= first.shape[-1]:
        return -np.log1p(-np.minimum(touched[..., rows - 1], _ALL))
    # After R rows, or once half of the strips have touched, the probability that a row touches if
    # none before it has is taken as constant: its mean over the second half of the rows so far.
    before = np.concatenate([np.zeros_like(touched[..., :1]), touched[..., :-1]], axis=-1)
    counted = np.minimum(np.sum(before < 0.5, axis=-1), first.shape[-1] - 1)[..., None]
    number = np.arange(first.shape[-1])
    late = (number >= counted // 2) & (number <= counted)
    hazard = np.sum(first * late, axis=-1) / np.sum((1.0 - before) * late, axis=-1)
    here = np.take_along_axis(before, counted, axis=-1)[..., 0]
    further = (rows - counted[..., 0]) * np.log1p(-np.minimum(hazard, _ALL))
    return -np.log1p(-np.minimum(here, _ALL)) - further
