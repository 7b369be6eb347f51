"""Computed films across the contact, at the same positions for all operating points."""

import numpy as np
import xarray as xr

from lube.types import Array

_STEP, _EVEN, _GROWTH = 0.01, 1.5, 1.03
"""Spacing of the positions near the contact, end of this even spacing (both over the half-width),
and ratio of neighbouring positions beyond it."""
_REACH = 12.0
"""Height of the undeformed gap at the last position, over the composite roughness: no roughness
line is so high."""


def film_positions(contact: xr.Dataset, step: float = _STEP, growth: float = _GROWTH) -> Array:
    """Choose the positions at which computed films are stored.

    Parameters
    ----------
    contact : xarray.Dataset
        With ``contact_half_width``, ``reduced_radius`` and ``composite_rms_roughness``, m.
    step, growth : float, optional
        Even spacing of positions near the contact, and ratio of neighbouring positions beyond.

    Returns
    -------
    numpy.ndarray
        Positions over the half-width, rising and symmetric about 0: evenly spaced near the contact,
        farther and farther apart outside. At the last one, the gap of the narrowest contact is
        higher than any roughness.

    Examples
    --------
    >>> lengths = {"contact_half_width": 50e-6, "reduced_radius": 0.025}
    >>> positions = film_positions(xr.Dataset(lengths | {"composite_rms_roughness": 0.28e-6}))
    >>> positions.size, float(positions[-1])
    (425, 9.375603)
    """
    names = "contact_half_width", "reduced_radius", "composite_rms_roughness"
    half_width, reduced_radius, roughness = (contact[name].min().item() for name in names)
    farthest = 1.0 + np.sqrt(2.0 * reduced_radius * _REACH * roughness) / half_width
    even = np.arange(0.0, _EVEN + step / 2, step)
    count = max(1, int(np.ceil(np.log(farthest / _EVEN) / np.log(growth))))
    half = np.concatenate([even, _EVEN * growth ** np.arange(1, count + 1)]).round(6)
    return np.concatenate([-half[:0:-1], half])


def six_digits(values: Array) -> Array:
    """Round to six digits: further ones depend on the processor.

    Parameters
    ----------
    values : numpy.ndarray
        Values, finite.

    Returns
    -------
    numpy.ndarray
        The values, rounded to six significant digits.

    Examples
    --------
    >>> six_digits(np.array([0.0, 1.23456789e-6])).tolist()
    [0.0, 1.23457e-06]
    """
    return np.vectorize(lambda value: float(f"{value:.6g}"), otypes=[float])(values)


def over_positions(solved: xr.DataArray, sample, contact: xr.Dataset) -> xr.DataArray:
    """Sample a quantity of every film at the positions of `film_positions`.

    Parameters
    ----------
    solved : xarray.DataArray
        Elements are a `lube.ehl.line_contact.FilmProfile`, or None where there is no film.
    sample : callable
        Function of a `FilmProfile` and positions that returns the quantity there.
    contact : xarray.Dataset
        As in `film_positions`.

    Returns
    -------
    xarray.DataArray
        Values to six digits, over the dimensions of `solved` and film_position; NaN where there is
        no film.
    """
    positions = film_positions(contact)

    def values(film):
        return six_digits(sample(film, positions)) if film else np.full(positions.size, np.nan)

    options = {"output_core_dims": [["film_position"]], "vectorize": True}
    found = xr.apply_ufunc(values, solved, output_dtypes=[float], **options)
    return found.assign_coords(film_position=positions)
