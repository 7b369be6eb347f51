"""Computed films across the contact, at the same positions for all operating points."""

from collections.abc import Callable

import numpy as np
import xarray as xr

from lube.digits import six_digits
from lube.physics.hertz import hertz_gap
from lube.types import Array

_STEP, _EVEN, _GROWTH = 0.01, 1.5, 1.03
"""Spacing of the positions near the contact, end of this even spacing (both over the half-width),
and ratio of neighbouring positions beyond it."""
_REACH = 12.0
"""Height of the undeformed gap at the last position, over the composite roughness: no roughness
line is so high."""


def film_positions(
    contact: xr.Dataset, step: float = _STEP, growth: float = _GROWTH, reach: float = 0.0
) -> Array:
    """Choose the positions at which computed films are stored.

    Parameters
    ----------
    contact : xarray.Dataset
        With ``contact_half_width``, ``reduced_radius`` and ``composite_rms_roughness``, m.
    step, growth : float, optional
        Even spacing of positions near the contact, and ratio of neighbouring positions beyond.
    reach : float, optional
        Distance over the half-width that the positions span at least.

    Returns
    -------
    numpy.ndarray
        Positions over the half-width, rising and symmetric about 0: evenly spaced near the contact,
        farther and farther apart outside. At the last one, the gap of every contact is higher than
        any roughness.

    Examples
    --------
    >>> lengths = {"contact_half_width": 50e-6, "reduced_radius": 0.025}
    >>> positions = film_positions(xr.Dataset(lengths | {"composite_rms_roughness": 0.28e-6}))
    >>> positions.size, float(positions[-1])
    (425, 9.375603)
    """
    # The gap is at least (X - 1)^2 a^2 / 2 R*; duty points may differ in radius and in width.
    scale = contact["contact_half_width"] ** 2 / (2.0 * contact["reduced_radius"])
    farthest = 1.0 + np.sqrt(_REACH * (contact["composite_rms_roughness"] / scale).max().item())
    farthest = max(farthest, reach)
    even = np.arange(0.0, _EVEN + step / 2, step)
    count = max(1, int(np.ceil(np.log(farthest / _EVEN) / np.log(growth))))
    half = np.concatenate([even, _EVEN * growth ** np.arange(1, count + 1)]).round(6)
    return np.concatenate([-half[:0:-1], half])


def over_positions(solved: xr.DataArray, sample, positions: Array) -> xr.DataArray:
    """Sample a quantity of every film at some positions, such as those of `film_positions`.

    Parameters
    ----------
    solved : xarray.DataArray
        Elements are a `lube.ehl.line_contact.FilmProfile`, or None where there is no film.
    sample : callable
        Function of a `FilmProfile` and positions that returns the quantity there.
    positions : numpy.ndarray
        Positions over the half-width.

    Returns
    -------
    xarray.DataArray
        Values to six digits, over the dimensions of `solved` and film_position; NaN where there is
        no film.
    """

    def values(film):
        return six_digits(sample(film, positions)) if film else np.full(positions.size, np.nan)

    options = {"output_core_dims": [["film_position"]], "vectorize": True}
    found = xr.apply_ufunc(values, solved, output_dtypes=[float], **options)
    return found.assign_coords(film_position=positions)


def shaped_films(film: xr.Dataset) -> xr.DataArray:
    """Films with the computed shape and the thickness of each film formula.

    The shape is scaled so that it has the thickness of the formula at the line of centres, at the
    thinnest point, or on average over Hertz' contact, whichever the formula gives. The gap of the
    dry contact is not scaled. It is zero in the contact, and far outside it is most of the film.

    Parameters
    ----------
    film : xarray.Dataset
        A ``film`` dataset with ``film_profile``, or rows of one.

    Returns
    -------
    xarray.DataArray
        Over the dimensions of ``film_thickness`` and film_position, m.
    """
    return shaping(film)(film["film_thickness"])


def shaping(film: xr.Dataset) -> Callable[[xr.DataArray], xr.DataArray]:
    """Return the function that gives a film thickness, m, its shape, as in `shaped_films`."""
    profile, options = film["film_profile"], {"arithmetic_join": "exact", "keep_attrs": False}
    with xr.set_options(**options):
        gap = xr.apply_ufunc(hertz_gap, profile["film_position"])
        gap = gap * film["contact_half_width"] ** 2 / film["reduced_radius"]
        places, above = film_at_places(film), profile - gap

    def shaped(thickness):
        with xr.set_options(**options):
            found = thickness / places * above + gap
        return found.transpose(*thickness.dims, "film_position")

    return shaped


def scaled_film(film: xr.Dataset, factor: xr.DataArray, has_shape: bool) -> xr.Dataset:
    """Multiply films by a factor, with their shape and the gap around the contact if they have one.

    A scaled profile reaches as far as rollers rougher by the inverse factor may touch.
    """
    scaled = {"film_thickness": factor * film["film_thickness"]}
    if has_shape:
        film = _continued(film, film["composite_rms_roughness"].max() / factor.min())
        scaled["film_profile"] = factor * shaped_films(film)
    return film.assign(scaled)


def _continued(film, roughness):
    """Continue profiles beyond their ends by the dry gap, as far as a roughness, m, may touch."""
    known = film["film_position"]
    positions = film_positions(film.assign(composite_rms_roughness=roughness))
    if positions.size <= known.size:
        return film
    positions = xr.DataArray(positions, dims="film_position")
    inside = positions.clip(known[0], known[-1])
    beyond = xr.apply_ufunc(hertz_gap, positions) - xr.apply_ufunc(hertz_gap, inside)
    profile = film["film_profile"].sel(film_position=inside).drop_vars("film_position")
    profile = profile + beyond * film["contact_half_width"] ** 2 / film["reduced_radius"]
    film = film.drop_dims("film_position").assign(film_profile=profile)
    return film.assign_coords(film_position=positions)


def film_at_places(film: xr.Dataset) -> xr.DataArray:
    """Find the thickness of the computed film that each film formula refers to.

    Parameters
    ----------
    film : xarray.Dataset
        With ``film_profile``, and ``formula_place`` over film_formula.

    Returns
    -------
    xarray.DataArray
        At the line of centres, at the thinnest point, or on average over Hertz' contact, m; over
        film_formula and the dimensions of the profile without film_position.
    """
    profile, place = film["film_profile"], film["formula_place"]
    central = profile.sel(film_position=0.0, drop=True)
    minimum = profile.min("film_position", skipna=False)
    mean = profile.sel(film_position=slice(-1.0, 1.0)).integrate("film_position") / 2.0
    return xr.where(place == "central", central, xr.where(place == "minimum", minimum, mean))
