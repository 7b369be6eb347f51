r"""Sampling of contact on surfaces, in the strips of operating points.

A strip is followed row by row along the rollers. Row j is the first of the strip that touches
with the probability :math:`g_j`, so that a strip of n rows touches with

.. math:: P = \sum_{j=0}^{n-1} g_j

Importance sampling finds :math:`g_0` from rows that touch, and the other :math:`g_j` from contacts
that begin in row j while no row of the strip before it touches. Rows further apart than a longest
wavelength are independent, so from there on a row is the first with the same probability if none
before it has touched.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import partial

import numpy as np
import scipy

from lube.contact.rough_pair import RoughPair
from lube.contact.strip_film import StripFilm
from lube.contact.surface_answers import AnsweredStrip
from lube.ehl.line_contact import one_blas_thread
from lube.kernels.areal import BLOCK, GROUP, contacts_per_row, touching_strips
from lube.kernels.moved_surface import NO_ANSWER
from lube.schema import LIMITS, values_with_limits
from lube.statistics.confidence import (
    breakthrough_limit,
    jackknife_interval,
    left_out,
    mean_interval,
)
from lube.surfaces.lay import extents
from lube.surfaces.rough_surface import Surface, longest_waves
from lube.threads import on_threads
from lube.types import Array

STRIPS = 750
"""Strips on each surface."""
COUNTED_STRIPS = 5
"""The first of these, in which contacts are counted."""
AROUND = 100
"""Rows beyond a known point in which its contact is followed; a first contact begins within as many
before it."""
FADING = 6.0
"""How fast points are chosen less often the more they overlap, over the density of heights at the
film. Without it large contacts are chosen far more often than small ones, in proportion to their
area."""
_ALL = 1.0 - 1e-12
"""Probability taken as certain."""
_CERTAIN = 40.0
"""With this many independent contacts or more, the probability is 1 in floating point."""
COUNTS = {"geometric_contact_probability": "contacts", "breakthrough_probability": "breakthroughs"}
"""Probabilities, and the numbers in the strip that belong to them."""
RATIO = "breakdown_ratio"
"""Variable of the part of the strip's area where the layer is broken."""
WITHOUT = "groups_without"
"""Variable of the number of groups of breakthroughs, -ln(1 - P), without each of the surfaces."""


def sampled_strips(
    pair: RoughPair,
    surface: Surface,
    strips: Sequence[StripFilm],
    counts: Array,
    is_certain: Array,
    sharp: Array,
    seeds: Sequence,
    threads: int | None,
) -> dict[str, Array]:
    """Sample contact in some strips on surfaces of one kind.

    Parameters
    ----------
    pair : RoughPair
        The rollers.
    surface : Surface
        How their surfaces are drawn.
    strips : sequence of StripFilm
        The strips, whose contacts the surface resolves.
    counts : numpy.ndarray of int, shape (strips,)
        Number of strips on each surface, `STRIPS` at most.
    is_certain : numpy.ndarray of bool, shape (strips,)
        Whether contact is certain, so that contacts are counted in some strips.
    sharp : numpy.ndarray, shape (strips,)
        Mean curvature of an overlap above which its boundary layer breaks, 1/m.
    seeds : sequence
        For each surface, seeds that draw it and that choose strips on it.
    threads : int or None
        As in `lube.contact.surface_strip.surface_contact`.

    Returns
    -------
    dict of str to numpy.ndarray, shape (strips,)
        The probabilities and numbers of `COUNTS`, and `RATIO`, still as m of the strip's width,
        each with ``_lower`` and ``_upper``; and `WITHOUT`, shape (surfaces, strips).
    """
    down, along = surface.spacing
    reach, step = _reach(pair.spec, down), pair.spec.height_step
    rows = sum(reach), reach[1]
    answered = [strip.answered(surface) for strip in strips]
    with one_blas_thread():
        answered = [oil and oil.with_covariances(*rows, threads) for oil in answered]
    sampled = []
    each = zip(strips, sharp, counts.tolist(), is_certain.tolist(), answered, strict=True)
    for strip, own, count, certain, oil in each:
        limit = strip.breaking_curvatures(strip.columns(along), own) / step
        film = strip.films(along) / step
        rms = np.broadcast_to(surface.rms * oil.rms if oil else surface.rms, film.shape)
        sampled.append(_SampledStrip(film, limit, rms, count, certain, oil))
    covariances = tuple(surface.covariances(*rows, max(one.film.size for one in sampled)))
    on_one_surface = partial(_on_one_surface, surface, covariances, sampled, reach)
    found = on_threads(on_one_surface, seeds, threads, "contact of surfaces")
    first, numbers = map(np.stack, zip(*found, strict=True))
    # With columns at both edges there is one more than the strip has room for.
    columns = zip(strips, sampled, strict=True)
    apart = np.array(
        [one.width / own.film.size if one.has_edges else along for one, own in columns]
    )
    return _with_limits(first, numbers, max(int(pair.length / down), 1), apart, counts * len(seeds))


def _with_limits(first, numbers, rows, widths, sampled):
    """Variables and their limits from all surfaces, for a strip of so many rows."""
    results, groups = {}, partial(_groups, rows=rows)
    both = np.concatenate([first, numbers[:, :, :2, None]], axis=-1)
    for which, (name, of_contacts) in enumerate(COUNTS.items()):
        # The limits are of the number of contacts: near 1 a probability scatters to one side.
        limits = jackknife_interval(both[:, :, which], groups)
        results |= values_with_limits(name, [-np.expm1(-each) for each in limits])
        results |= values_with_limits(of_contacts, mean_interval(rows * numbers[:, :, which]))
    in_contact, broken = (mean_interval(widths * numbers[:, :, which]) for which in (2, 3))
    results |= values_with_limits(RATIO, broken)  # m, of the strip's width
    contacts = results["contacts_upper"]
    for name in ("breakthroughs_upper", "breakthrough_probability_upper", f"{RATIO}_upper"):
        of_contact = in_contact[2] if name == f"{RATIO}_upper" else contacts
        results[name] = breakthrough_limit(results[name], of_contact, sampled)
    geometric, breakthrough = COUNTS
    for end in LIMITS:  # no layer breaks without contact, but both are known with an error
        most = results[f"{geometric}{end}"]
        results[f"{breakthrough}{end}"] = np.minimum(results[f"{breakthrough}{end}"], most)
    return results | {WITHOUT: left_out(both[:, :, 1], groups)}


def _groups(both, rows):
    """Compute `first_contacts` from first rows and, as the last value, new contacts per row.

    The probability is at most the number of contacts in the strip: those that begin in it, and the
    one at its first row. Where few of many contacts count, the first rows alone scatter far beyond
    that. Where none of those counted does, they are all that is known.
    """
    first, new = both[..., :-1], both[..., -1]
    most = first[..., 0] + rows * new
    is_limit = (new > 0.0) & (most < _ALL)
    # Numbers beyond certainty scatter far, and tell nothing more.
    most = np.where(is_limit, -np.log1p(-np.where(is_limit, most, 0.0)), _CERTAIN)
    return np.minimum(first_contacts(first, rows), most)


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
