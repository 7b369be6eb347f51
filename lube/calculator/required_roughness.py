"""The roughness that keeps contact rare."""

from __future__ import annotations

from collections.abc import Mapping
from copy import copy
from dataclasses import replace
from typing import Any

import numpy as np
import xarray as xr
from scipy.interpolate import PchipInterpolator

from lube import types
from lube.calculator.answers import Answer
from lube.calculator.arguments import checked, single
from lube.calculator.bands import Assumptions
from lube.calculator.choices import FORMULA, REALISATIONS, SEED, Choices, Inlet
from lube.calculator.film import conditions_of, film_in_si
from lube.calculator.film_search import FilmSearch, check_known, labelled
from lube.calculator.oil import Oil
from lube.calculator.rollers import Rollers
from lube.errors import RangeError
from lube.grid.film_profiles import scaled_film
from lube.grid.gap import Gap
from lube.grid.load_sharing import MOST, surface_load_share
from lube.study.uncertainty import deviating_lines

RATIOS = np.geomspace(0.25, 5.0, 24)
"""Lambda ratios, under the film of the heights as given, of the heights that are tried. Asperities
carry nothing beyond the last, and nearly all of the load below the first."""
_HEIGHTS = "rms_roughness", "first_rms_roughness", "second_rms_roughness"
_CHANGED = "rms_deformation", "surface_rms_deformation"
"""Variables of a film in proportion to the heights."""


@checked
def required_roughness(
    rollers: Rollers,
    oil: Oil,
    force: types.OneAmount,
    speed: types.OneAmount,
    temperature: types.OneAmount,
    *,
    share: float | str = 0.01,
    film_formula: str = FORMULA,
    film_shape: types.FilmShape = "flat",
    roughness_deformation: types.RoughnessDeformation = "none",
    inlet_shear_heating: types.InletHeating = "none",
    inlet_meniscus: types.OneAmount | None = None,
    load_sharing: types.LoadSharing = "none",
    slide_to_roll_ratio: float = 0.0,
    contact_model: types.ContactModel = "line",
    realisations: int = REALISATIONS,
    seed: int = SEED,
    bands: bool | Mapping[str, Any] = False,
) -> Answer:
    r"""Roughness that keeps metal contact below a share of time.

    The heights of both rollers are multiplied by the same factor. Overlaps and the forces on
    segments grow with it, so lines of :math:`s` times the height, at a film :math:`h`, break as
    the given lines do at a film :math:`h / s` with a boundary layer :math:`s` times weaker.

    Parameters
    ----------
    rollers, oil, force, speed, temperature, film_formula, film_shape, roughness_deformation
        As in `lube.contact_probability`, one value of each.
    inlet_shear_heating, inlet_meniscus, slide_to_roll_ratio
        As in `lube.film`.
    load_sharing
        As in `lube.contact_probability`. The film is then computed for 24 other heights, too.
    share, contact_model, realisations, seed
        As in `lube.required_film`.
    bands
        As in `lube.required_viscosity`; the ranges of the rms roughness are left out.

    Returns
    -------
    Answer
        ``composite_rms_roughness`` (um), ``lambda_ratio`` and ``roughness_factor``, the factor of
        both rollers' heights, each with ``_lower`` and ``_upper``.

    Raises
    ------
    LubeError
        Which argument, what came, what is needed; or that no roughness tried is low enough.
    """
    gap, inlet = Gap(film_shape, roughness_deformation), Inlet(inlet_shear_heating, inlet_meniscus)
    choices = Choices.of(film_formula, gap, inlet, load_sharing, slide_to_roll_ratio, contact_model)
    assumed = Assumptions(bands, rollers, oil, choices, seed, _HEIGHTS)
    search = FilmSearch(assumed, share, realisations)

    def film_of(rollers, choices):
        return film_in_si(rollers, oil, force, speed, temperature, choices)

    film = film_of(rollers, choices)
    own = single(film["lambda_ratio"])
    check_known(np.isfinite(own))
    factor_at, least = _factors(film_of, rollers, choices, own)

    def table_at(ratios):
        # Lines of s times the height break as the given ones do under the film over s.
        return scaled_film(film, xr.DataArray(ratios / own, dims="film"), gap.has_shape)

    def points_at(ratios):
        factors = xr.DataArray(factor_at(ratios), dims="film")
        return conditions_of(film, choices) | {"roughness_factor": factors}

    half_width = film["contact_half_width"].item()
    with np.errstate(divide="ignore"):  # a limit may be 0
        ratios = search.films(half_width, points_at, table_at, factor_at=factor_at)["lambda_ratio"]
        factor = factor_at(ratios)
    _check_ratio(ratios[0], least, share)
    sigma = rollers.pair.composite_rms_roughness * factor
    found = {"roughness_factor": factor, "composite_rms_roughness": sigma, "lambda_ratio": ratios}
    changed = _changed(film, factor[0], ratios[0])
    if choices.has_surfaces:  # pressures grow with heights and film
        share_here = surface_load_share(table_at(ratios[:1]), rollers.lines, gap.has_shape)
        changed["surface_load_share"] = factor[0] * share_here
    return labelled(found, changed, _rougher(rollers, factor[0]), choices)


def _factors(film_of, rollers, choices, own):
    """Return a function that finds the factor of the heights at lambda ratios, and the least ratio.

    `own` is the lambda ratio of the heights as given.
    """
    if choices.load_sharing == "none":
        return lambda ratios: own / ratios, 0.0
    # What the oil does to the roughness does not change how much its asperities carry.
    as_drawn = replace(choices, gap=Gap(choices.gap.film_shape))
    levels = own / RATIOS[::-1]
    films = [film_of(_rougher(rollers, each), as_drawn) for each in levels]
    return _factors_of_films(films, levels)


def _factors_of_films(films, levels):
    """As `_factors`, from films that grow with the heights, as asperities share the load."""
    names = "lambda_ratio", "surface_load_share"
    ratios, shares = np.array([[one[name].item() for one in films] for name in names])
    # Where little of the load is left for the oil, the film grows faster than the heights.
    falls = np.diff(ratios, prepend=np.inf) < 0.0
    known = np.logical_and.accumulate(falls & (shares < MOST))
    check_known(np.count_nonzero(known) > 1)
    # The film over the rms height as given changes smoothly with the heights.
    heights, thickness = np.log(levels[known]), np.log(ratios[known] * levels[known])
    every = np.linspace(*heights[[0, -1]], 1000)
    film = PchipInterpolator(heights, thickness)(every)

    def factor_at(ratio):
        ratio = np.log(ratio)
        return np.exp(np.interp(ratio, (film - every)[::-1], film[::-1]) - ratio)

    return factor_at, ratios[known][-1]


def _rougher(rollers, factor):
    """Return the rollers with some times their heights."""
    changed = copy(rollers)
    changed.lines = deviating_lines(rollers.lines, {"rms_roughness": factor - 1.0})
    changed.pair = rollers.pair.with_rms_heights(changed.lines.rms_height)
    return changed


def _check_ratio(ratio, least, share):
    """Refuse a lambda ratio below the least one whose film is known."""
    if ratio < least:
        raise RangeError(
            f"share: got {share}, which no film is known to have: the asperities of such rough "
            f"rollers carry more than {100.0 * MOST:g} % of the load"
        )


def _changed(film, factor, ratio):
    """Film of rollers with some times the heights, at their lambda ratio."""
    changed = {name: factor * film[name] for name in _CHANGED if name in film}
    return film.assign(changed | {"lambda_ratio": xr.full_like(film["lambda_ratio"], ratio)})
