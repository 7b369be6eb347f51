"""Sharing of the load between the oil and the asperities of both surfaces."""

from collections.abc import Callable
from functools import partial

import numpy as np
import xarray as xr

from lube.grid.film_profiles import shaping
from lube.surfaces.contact_pressure import contact_pressure

MOST = 0.95
"""Largest share that asperities may take of the load where it is shared with the oil."""
ROUNDS, HALVINGS = 3, 40
"""How often the film is found anew, and halvings of the range of shares each time."""


def surface_load_share(film: xr.Dataset, spec, has_shape: bool) -> xr.DataArray:
    r"""Compute the share of the load that the asperities of both rollers' surfaces carry.

    At each place the asperities carry the pressure p at which dry, elastic surfaces with the
    roughness as drawn have the film as their mean gap. Over Hertz' contact,

    .. math:: \frac{4}{\pi p_0} \, \frac12 \int p(h(\xi))\, d\xi

    Parameters
    ----------
    film : xarray.Dataset
        Variables of the ``film`` file, over any dimensions; with ``film_profile`` if the film has a
        shape.
    spec : LineSpec
        The lines that stand for the surfaces.
    has_shape : bool
        Whether the film has the computed shape.

    Returns
    -------
    xarray.DataArray
        Over the dimensions of ``film_thickness``. Above 1 where asperities would carry more than
        the load, NaN where the film is not known.
    """
    return _share_under(film, spec, has_shape)(film["film_thickness"])


def _share_under(film, spec, has_shape):
    """Return the share as a function of the film thickness alone."""
    pressure = partial(contact_pressure, spec, film["reduced_modulus"].item())
    gap_under = shaping(film) if has_shape else lambda thickness: thickness

    def share(thickness):
        pressures = xr.apply_ufunc(pressure, gap_under(thickness))
        mean = 0.5 * pressures.integrate("film_position") if has_shape else pressures
        return 4.0 / np.pi * mean / film["hertz_pressure"]

    return share


def share_load(
    film: xr.Dataset, films_at: Callable[[xr.DataArray], xr.DataArray], spec, has_shape: bool
) -> tuple[xr.DataArray, xr.DataArray]:
    """Find the films at which oil and asperities together carry the load.

    Parameters
    ----------
    film, spec, has_shape
        As in `surface_load_share`; the oil carries the whole load.
    films_at : callable
        Gives the film thickness, m, if the oil carries a part of the load.

    Returns
    -------
    films, share : xarray.DataArray
        Film thickness, m, and the share of the load that asperities carry under it. Above `MOST`
        no balance was found.

    Notes
    -----
    The film is nearly a power of the load on the oil; the power follows from the film at the last
    share found. The width of the contact stays that of the whole load.
    """
    whole, share_under = film["film_thickness"], _share_under(film, spec, has_shape)

    def balanced(power):
        """Share at which the asperities, under the film that it leaves, carry just as much."""
        low, high = xr.zeros_like(whole), xr.full_like(whole, MOST)
        for _ in range(HALVINGS):
            share = 0.5 * (low + high)
            is_low = share_under(whole * (1.0 - share) ** -power) > share
            low, high = low.where(~is_low, share), high.where(is_low, share)
        return low.where(whole.notnull())

    share = share_under(whole).clip(1e-6, 0.5)
    for _ in range(ROUNDS):
        share = balanced(-np.log(films_at(1.0 - share) / whole) / np.log1p(-share)).clip(1e-6)
    films = films_at(1.0 - share)
    return films, share_under(films)
