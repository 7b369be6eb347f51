r"""What a record would tell: expected intervals of film, oil and layer inferred from one.

A record measures the contact share P of one pair of rollers. With the standard error
:math:`\sigma` of the share, a quantity q that changes it is inferred with the relative error

.. math:: \frac{\sigma_q}{q} = \frac{\sigma / P}{|\partial \ln P / \partial \ln q|}
"""

from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np
import xarray as xr

from lube.contact.rough_pair import RoughPair
from lube.contact.strip_sampling import WITHOUT
from lube.contact.surface_strip import surface_contact
from lube.contact.windows import ContactWindows
from lube.grid.discretise import speed_ratios
from lube.grid.films import film_at
from lube.grid.gap import Gap
from lube.inference.record_scatter import crosswise
from lube.inference.surface_scatter import revolution_size, surface_scatter
from lube.schema import LIMITS
from lube.statistics.confidence import error_of_limits, jackknife_error, left_out
from lube.statistics.one_pair import distinct_alignments, persistent_share, quantile, scatter_ratio
from lube.study.rollers import RollerPair
from lube.types import Array, Values

PAIRS = 16
"""Pairs of lines on which slopes are sampled; all quantities have the same."""
LINES = 24
"""Lines of either roller that are paired crosswise for the scatter of records with slip."""
FEWER = 4
"""Surfaces drawn for a probability, for each one drawn for its slopes."""
HOLDS = 1e-3
"""Part of the time in contact for which the layer must hold for its strength to be sampled."""
STEP = 0.03
"""Relative change of a quantity for its slope."""
KNOWN = 1.0 / 3.0
"""Standard error of a slope, relative to the slope, beyond which half-widths by it mean nothing."""
LEAST = 4.0
"""Expected number of independent contacts in a record, or of times without contact, below which it
tells too little."""
GIVEN = {
    "film thickness": ("oil", "temperature", "speed"),
    "pressure-viscosity coefficient": ("pressure_viscosity_coefficient",),
    "layer strength": ("layer",),
}
"""For each quantity inferred from a record, the uncertain quantities, or groups of them, that need
not be known for it."""
QUANTITIES = tuple(GIVEN)
_THICKER = np.array([1.0 + STEP, 1.0 - STEP, 1.0, 1.0])
_WEAKER = _THICKER[::-1]
"""Changes of the film, and of the layer, for the slopes."""


class Slopes(NamedTuple):
    """Probability of breakthrough and how it changes.

    Attributes
    ----------
    probability : numpy.ndarray
        Shape (P,), at each operating point.
    by_film, by_layer : numpy.ndarray
        Slopes of its logarithm over those of the film thickness and of the layer's strength.
    film_error, layer_error : numpy.ndarray
        Their standard errors.
    """

    probability: Array
    by_film: Array
    by_layer: Array
    film_error: Array
    layer_error: Array


def slopes(pair: RoughPair, film: xr.Dataset, threads: int | None = None) -> Slopes:
    """Sample the probability of breakthrough, and its slopes, at some operating points.

    Parameters
    ----------
    pair : RoughPair
        The rollers.
    film : xarray.Dataset
        As in `lube.contact.windows.ContactWindows`.
    threads : int, optional
        Threads that share the work.

    Returns
    -------
    Slopes
        In the order of the film's dimensions; NaN where the film is not known.
    """

    def sampled(thicker, weaker):
        changed = film.assign(film_thickness=film["film_thickness"] * thicker)
        windows = ContactWindows(pair.spec, changed, pair.layer, pair.gap, weaker)
        return windows.on_pairs(pair.spec, pair.seed, PAIRS, threads)[:, 1]

    changed = np.stack([sampled(*one) for one in zip(_THICKER, _WEAKER, strict=True)], axis=1)
    # An estimate of the probability may exceed one.
    share = np.minimum(sampled(1.0, 1.0).mean(axis=0), 1.0)
    return Slopes(share, *_slopes(changed.mean(axis=0), left_out(changed, lambda mean: mean)))


def line_ratios(
    pair: RoughPair,
    film: xr.Dataset,
    slide_to_roll_ratio: float,
    turns: Sequence[float],
    drift: float = 0.0,
    known: float = 1.0,
) -> Array:
    """Find the scatter of records of one pair of lines.

    Where the lines meet in new alignments, the part of the scatter that these do not average out is
    taken as in pure rolling, on lines as drawn.

    Parameters
    ----------
    pair, film
        As in `slopes`.
    slide_to_roll_ratio, turns, drift
        As in `on_surfaces`.
    known : float, optional
        Length of a realisation, revolutions.

    Returns
    -------
    numpy.ndarray, shape (turns, P)
        Variance of a record's share over that of a realisation.
    """
    spec = pair.spec
    reach, speeds = spec.longest_wavelength / spec.spacing, speed_ratios(slide_to_roll_ratio)
    windows = ContactWindows(spec, film, pair.layer, Gap(pair.gap.film_shape))
    persistent = np.ones((2, windows.size))
    if distinct_alignments(max(turns), speeds, spec.points, reach) > 1:
        persistent = persistent_share(*crosswise(windows, spec, pair.seed, LINES))
        persistent = np.where(np.isfinite(persistent), persistent, 1.0)
    each = known, *turns
    by_turns = [
        [scatter_ratio(one, speeds, spec.points, reach, part, drift) for part in persistent.T]
        for one in each
    ]
    return np.array(by_turns[1:]) / by_turns[0]


def on_surfaces(
    pair: RoughPair,
    film: xr.Dataset,
    contact: xr.Dataset,
    slide_to_roll_ratio: float,
    turns: Sequence[float],
    drift: float = 0.0,
    threads: int | None = None,
) -> tuple[Slopes, Array, Array, Array]:
    r"""Sample the slopes of contact of surfaces, and find the scatter of records of one pair.

    Sampled are slopes of the number :math:`n = -\ln(1 - P)` of groups of contacts in the strip.
    Where contact is all but certain, they scatter far less than those of the probability:

    .. math::

        \frac{\partial \ln P}{\partial \ln q}
        = \frac{1 - P}{P}\, n\, \frac{\partial \ln n}{\partial \ln q}

    Parameters
    ----------
    pair, film, threads
        As in `lube.contact.surface_strip.surface_contact`.
    contact : xarray.Dataset
        Contact of the surfaces at these films, from the same function.
    slide_to_roll_ratio : float
        Slide-to-roll ratio of the records.
    turns : sequence of float
        Durations of records, in revolutions.
    drift : float, optional
        As in `lube.statistics.one_pair.drift_factor`.

    Returns
    -------
    slopes : Slopes
        As from `slopes`, but NaN where no record tells anything. Slopes by the layer are zero where
        hardly any contact holds it.
    sample_size : numpy.ndarray, shape (P,)
        Effective sample size of a revolution of pure rolling.
    ratios : numpy.ndarray, shape (turns, P)
        Variance of a record's share over that of such a revolution.
    curve_error : numpy.ndarray, shape (P,)
        Relative standard error of the probability, and so of the curve from which a film is read.
    """
    contact = contact.transpose(*film["film_thickness"].dims)
    limits = [contact[f"breakthrough_probability{end}"].values.ravel() for end in LIMITS]
    share = limits[0]
    size = revolution_size(pair.spec, contact).ravel()
    records = np.repeat(np.array(turns)[:, None], share.size, axis=1)
    ratios = surface_scatter(
        pair, film, share, np.full(share.size, slide_to_roll_ratio), records, drift
    )
    tells = np.any([np.isfinite(relative_error(share, size, one)) for one in ratios], axis=0)
    touch = contact["geometric_contact_probability"].values.ravel()
    holds = tells & (share < (1.0 - HOLDS) * touch)
    # All changes are sampled at once, for which surfaces are drawn once.
    films = film["film_thickness"].expand_dims(change=len(_THICKER))
    wanted = films.copy(data=np.reshape([tells, tells, holds, holds], films.shape))
    changed = {"thicker": np.repeat(_THICKER, share.size), "weaker": np.repeat(_WEAKER, share.size)}
    film = film.assign(film_thickness=films)
    found = surface_contact(
        pair, film, threads, fewer=FEWER, wanted=wanted, left_out=True, **changed
    )
    changed = found["breakthrough_probability"].values.reshape(len(_THICKER), -1)
    without = found[WITHOUT].values.reshape(-1, *changed.shape)
    with np.errstate(divide="ignore", invalid="ignore"):
        groups, own = -np.log1p(-changed), -np.log1p(-share) * (1.0 - share) / share
    by_film, by_layer, film_error, layer_error = (own * each for each in _slopes(groups, without))
    by_layer, layer_error = np.where(tells == holds, [by_layer, layer_error], 0.0)
    with np.errstate(divide="ignore", invalid="ignore"):
        curve_error = error_of_limits(limits) / share
    return Slopes(share, by_film, by_layer, film_error, layer_error), size, ratios, curve_error


def _slopes(changed, without):
    """Slopes by film and by layer and their errors, from values with the same random numbers.

    The values have the shape (4, P), and (samples, 4, P) without each of the samples.
    """
    across = np.log((1.0 + STEP) / (1.0 - STEP))
    with np.errstate(divide="ignore", invalid="ignore"):
        slopes = np.log(changed[::2] / changed[1::2]) / across
        each = np.log(without[:, ::2] / without[:, 1::2]) / across
        return *slopes, *jackknife_error(each)


def film_by_coefficient(
    lubricant: xr.Dataset,
    rollers: RollerPair,
    force: Values,
    speed: Values,
    film_formula: str,
    **model: Any,
) -> xr.DataArray:
    """Find the slope of the film's logarithm over that of the pressure-viscosity coefficient.

    Parameters
    ----------
    lubricant, rollers, force, speed, film_formula, **model
        As in `lube.grid.films.film_at`; one film formula.

    Returns
    -------
    xarray.DataArray
        Over the dimensions of the film.
    """
    coefficient = lubricant["pressure_viscosity_coefficient"]

    def film(factor):
        oil = lubricant.assign(pressure_viscosity_coefficient=coefficient * factor)
        table = film_at(oil, rollers, force, speed, [film_formula], **model)
        return table["film_thickness"].isel(film_formula=0)

    return np.log(film(1.0 + STEP) / film(1.0 - STEP)) / np.log((1.0 + STEP) / (1.0 - STEP))


def relative_error(
    probability: Array, sample_size: Array, ratio: Array | float, reading: Array | float = 0.0
) -> Array:
    r"""Relative standard error of the contact share that one pair's record shows.

    .. math:: \frac{\sigma^2}{P^2} = v \frac{1 - P}{n P} + r^2

    Parameters
    ----------
    probability : numpy.ndarray
        Probability P.
    sample_size : numpy.ndarray
        Effective sample size n of one revolution.
    ratio : numpy.ndarray or float
        Variance v of the record's share over that of a revolution, at all points or at each.
    reading : numpy.ndarray or float, optional
        Relative error r of the rig's reading. It is a bias, the same in every record, seen on one
        simulated pair. It is added as if it were random, with either sign. What single samples miss
        by chance is no part of it.

    Returns
    -------
    numpy.ndarray
        Infinite where fewer independent contacts than `LEAST` are expected, or fewer times without.

    Examples
    --------
    >>> relative_error(np.array([0.5, 0.001]), np.array([100.0, 100.0]), 1.0).round(3)
    array([0.1, inf])
    """
    with np.errstate(divide="ignore", invalid="ignore"):
        variance = ratio * (1.0 - probability) / (sample_size * probability)
        enough = sample_size / ratio * np.minimum(probability, 1.0 - probability) >= LEAST
    return np.where(enough, np.sqrt(variance + np.square(reading)), np.inf)


def reading_of_surfaces(reading: Array, probability: Array) -> Array:
    r"""Find the relative error of a rig's reading of surfaces, from that of lines.

    The rig misses the part r of the contacts, or shows them for so much longer. On a line, where
    contact is rare, r is the error of the share. On surfaces some of these contacts overlap:
    :math:`-\ln(1 - P)` groups of them are in the strip on average, so that

    .. math:: \frac{\Delta P}{P} = -\frac{1 - P}{P} \ln(1 - P)\, r

    Parameters
    ----------
    reading : numpy.ndarray
        Relative error r.
    probability : numpy.ndarray
        Probability P of contact of surfaces.

    Returns
    -------
    numpy.ndarray
        Relative error of the share; no greater than `reading`.

    Examples
    --------
    >>> reading_of_surfaces(np.array([0.1, 0.1]), np.array([1e-6, 0.9])).round(3)
    array([0.1  , 0.026])
    """
    known = np.clip(probability, 1e-12, 1.0 - 1e-12)
    return reading * -np.log1p(-known) * (1.0 - known) / known


def reading_of_lines(reading: Array, probability: Array) -> Array:
    """Find the relative error of a rig's reading of lines, from that of surfaces.

    Parameters
    ----------
    reading : numpy.ndarray
        Relative error of the share of surfaces.
    probability : numpy.ndarray
        Probability P of contact of surfaces.

    Returns
    -------
    numpy.ndarray
        Relative error r of `reading_of_surfaces`; its mean where surfaces touch for more than 90 %
        of the time, which does not tell it, and 0 if they do everywhere.

    Examples
    --------
    >>> reading_of_lines(np.array([0.1, 0.0402, 0.0]), np.array([1e-6, 0.8, 1.0])).round(2)
    array([0.1, 0.1, 0.1])
    """
    found = reading / reading_of_surfaces(np.ones_like(reading), probability)
    known = np.isfinite(found) & (probability < 0.9)
    return np.where(known, found, found[known].mean() if known.any() else 0.0)


def half_widths(found: Slopes, by_coefficient: Array, error: Array, realisations: int) -> Array:
    """Half-widths of the 95 % intervals of all quantities, relative to them.

    Parameters
    ----------
    found : Slopes
        From `slopes`.
    by_coefficient : numpy.ndarray
        Slope of the film's logarithm over that of the pressure-viscosity coefficient.
    error : numpy.ndarray
        From `relative_error`, of some records, shape (records, P); or, if it differs between the
        quantities, of shape (quantities, records, P).
    realisations : int
        Number of realisations from whose scatter the error follows.

    Returns
    -------
    numpy.ndarray
        Shape (quantities, records, P); NaN where a record tells nothing, or less than that the
        quantity is between zero and twice its value, or where the slope is not known to `KNOWN`.
    """
    film, layer = np.abs([found.by_film, found.by_layer])
    slopes = np.array([film, film * np.abs(by_coefficient), layer])[:, None]
    with np.errstate(divide="ignore", invalid="ignore"):
        of_film, of_layer = found.film_error / film, found.layer_error / layer
        known = np.array([of_film, of_film, of_layer])[:, None] <= KNOWN
        widths = quantile(realisations) * error / slopes
    return np.where(known & (widths < 1.0), widths, np.nan)
