"""Numbers to look at before a long computation, and remarks on values that may be mistakes."""

from collections.abc import Sequence

import numpy as np
import xarray as xr

from lube.grid.model_limits import SEPARATING_RATIO, deformed, separated
from lube.physics.excursions import mean_overlap
from lube.units import with_unit


def expected_load_share(film: xr.Dataset, rollers) -> xr.DataArray:
    r"""Compute the expected share of the load that the asperities of Gaussian lines carry.

    It is the expectation of ``contact_load_share`` in ``contact.nc``. With the mean overlap
    :math:`\bar z` of the lines it is

    .. math:: \frac{E^* L' \bar z}{F_N}

    Parameters
    ----------
    film : xarray.Dataset
        With ``film_thickness`` (m) and ``force`` (N).
    rollers : RollerPair
        The rollers, with the rms heights of their lines.

    Returns
    -------
    xarray.DataArray
        Over the dimensions of the films and forces.
    """
    overlap = mean_overlap(film["film_thickness"], rollers.composite_rms_roughness)
    return overlap * rollers.reduced_modulus * rollers.length / film["force"]


def overview(film: xr.Dataset, lines, rollers) -> dict[str, str]:
    """Describe pressures, films and roughness of rollers at their operating points.

    Parameters
    ----------
    film : xarray.Dataset
        A ``film`` dataset; only its first film formula is used.
    lines : LineSpec
        The roughness lines.
    rollers : RollerPair
        The rollers, with the rms heights of their lines.

    Returns
    -------
    dict of str to str
        Texts by the names of the quantities.
    """
    film = film.isel(film_formula=0)
    width, shortest = 2.0 * film["contact_half_width"], lines.shortest_wavelength
    invalid = ~film["in_validity_range"].astype(bool)
    shares = {
        "line": expected_load_share(film, rollers) if lines.follows_rolling else None,
        "surface": film.get("surface_load_share"),
    }
    carried = [
        f"{float(f'{100.0 * share.max().item():.2g}'):g} % by asperities of the {model}"
        for model, share in shares.items()
        if share is not None
    ]
    texts = {
        "Hertz pressure": _range(film["hertz_pressure"], "Pa"),
        "film": f"{_range(film['film_thickness'], 'm')}, by {film['film_formula'].item()}; "
        f"{int(invalid.sum())} of {invalid.size} outside its range of validity",
        "lambda ratio": _range(film["lambda_ratio"]),
        "contact width": f"{_range(width, 'm')}, "
        f"{_range(width / shortest)} times the shortest wave",
        "grid": f"{shortest / lines.spacing:.3g} points in the shortest wave, "
        f"{_range(width / lines.spacing)} in the contact width",
        "load share": f"at most {', '.join(carried)}",
    }
    if not lines.follows_rolling:  # surfaces have a grid of their own
        del texts["grid"]
    return texts


def remarks(film: xr.Dataset, lines, rollers, models: Sequence[str] = ("line",)) -> list[str]:
    """List values that may be mistakes, and those beyond the limits of the model.

    Parameters
    ----------
    film, lines, rollers
        As in `overview`.
    models : sequence of str, optional
        Contact models; without ``line`` nothing is said of lines.

    Returns
    -------
    list of str
        A line for each: the value, and what is usual.

    References
    ----------
    K. L. Johnson, Contact Mechanics, Cambridge University Press, 1985, chapter 6, for the pressure
    at which steel begins to yield.
    """
    film = film.isel(film_formula=0, missing_dims="ignore")
    found = _beyond_model(film, rollers, _has_lines(lines, models)) | _unknown(film)
    return [*unusual(film, lines, rollers, models), *_that_apply(found)]


def _has_lines(lines, models):
    # No line stands for surfaces whose ridges run along rolling.
    return "line" in models and lines.follows_rolling


def _that_apply(found):
    return [text for text, is_so in found.items() if is_so]


def unusual(film: xr.Dataset, lines, rollers, models: Sequence[str] = ("line",)) -> list[str]:
    """List those of the `remarks` that are on values that may be mistakes; for one film formula."""
    moduli = rollers.first.young_modulus, rollers.second.young_modulus
    widths, shortest = 2.0 * film["contact_half_width"], lines.shortest_wavelength
    width, widest = widths.min().item(), widths.max().item()
    pressure = film["hertz_pressure"].max().item()
    films = film["film_thickness"]
    waves, points = width / shortest, shortest / lines.spacing
    found = {
        f"Young's modulus: {_range(moduli, 'Pa')}; plastics have 1 GPa and more, steel "
        "210 GPa": min(moduli) < 1e9 or max(moduli) > 1.2e12,
        f"Hertz pressure: up to {with_unit(pressure, 'Pa', 3)}; gears and bearings have less than "
        "2.5 GPa, hardened steel yields from some 3 GPa on, and the model is "
        "elastic": pressure > 2.5e9,
        f"length of the rollers: {with_unit(rollers.length, 'm', 3)}, but the contact is up to "
        f"{with_unit(widest, 'm', 3)} wide; the model is for a line contact, longer than "
        "wide": rollers.length < widest,
        f"film: {_range(films, 'm')}; most are from 10 nm to 10 µm, so units may be "
        "wrong": films.min() < 2e-9 or films.max() > 2e-5,
        f"contact width: {waves:.2g} times the shortest wave at the smallest force; with less than "
        "20 times the probability means little": waves < 20.0,
        f"shortest wave: {with_unit(shortest, 'm', 3)}; waves of some 3 µm decide whether the "
        "boundary layer breaks, so contact will be underestimated": shortest > 5e-6,
        f"grid: {points:.3g} points in the shortest wave; the curvature of asperities needs "
        "10": _has_lines(lines, models) and points < 10.0 * (1.0 - 1e-6),
    }
    return _that_apply(found)


def _beyond_model(film, rollers, of_lines):
    """Remarks on operating points beyond the limits of the model, each with their number."""
    share = expected_load_share(film, rollers)
    loaded, overloaded = (int((share > part).sum()) * of_lines for part in (0.1, 1.0))
    apart = int(separated(film).sum()) * of_lines
    carried = film.get("surface_load_share", xr.zeros_like(share))
    rubs, overrubs = (int((carried > part).sum()) for part in (0.1, 1.0))
    more, most = (f"at {n} more than all of it, " if n else "" for n in (overloaded, overrubs))
    bends = int((deformed(film) | deformed(film, film)).sum())  # lines or surfaces
    return {
        f"load share: at {loaded} of {share.size} operating points the line's asperities carry "
        f"more than a tenth of the load, {more}where the film of smooth rollers is less "
        "certain": loaded,
        f"load share: at {rubs} of {share.size} operating points the surfaces' asperities carry "
        f"more than a tenth of the load, {most}where the film of smooth rollers is less "
        "certain": rubs,
        f"roughness: at {bends} of {share.size} operating points the oil changes it by more than a "
        "tenth of the film, where the linear response is not valid": bends,
        f"roughness: at {apart} of {share.size} operating points the lambda ratio is at least "
        f"{SEPARATING_RATIO}; lines that touch there by the linear response may be kept apart by "
        "the oil, whose response is not linear": apart,
    }


def _unknown(film):
    """Remark on operating points whose film is not known, with their number."""
    unknown = film["film_thickness"].isnull()
    if "film_profile" in film:
        unknown = unknown | film["film_profile"].isnull().any("film_position")
    return {
        f"film: unknown at {int(unknown.sum())} of {unknown.size} operating points, and so is "
        "contact: Reynolds' equation was not solved there, or the heating at the inlet is beyond "
        "the range of its model": unknown.any(),
    }


def _range(values, unit=""):
    # Unknown values are left out.
    ends = (with_unit(end.reduce(np.ravel(values)), unit, 3) for end in (np.fmin, np.fmax))
    return " to ".join(dict.fromkeys(ends))
