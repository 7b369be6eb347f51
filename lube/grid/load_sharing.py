"""Sharing of the load between the oil and the asperities of both surfaces."""

from collections.abc import Callable
from functools import partial

import numpy as np
import xarray as xr

from lube.grid.film_profiles import shaping
from lube.surfaces.contact_pressure import contact_pressure

MOST = 0.999
"""Largest share that asperities may take of the load where it is shared with the oil."""
ROUNDS, HALVINGS = 10, 40
"""How often the film is found anew at most, and halvings of the range of shares each time."""
FOUND, NEAR = 1e-5, 1e-3
"""Change of a share below which it is found, and change of the logarithm of the load on the oil
below which the power is kept, since computed films are rounded."""


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
        no balance was found; both are NaN where a film on the way is not known.

    Notes
    -----
    Between the last two shares the film is taken as a power of the load on the oil, and the next
    share is the one that is balanced under this film. The width of the contact stays that of the
    whole load.
    """
    whole, share_under = film["film_thickness"], _share_under(film, spec, has_shape)

    def balanced(films, share, power):
        """Share at which the asperities, under the film that it leaves, carry just as much."""
        low, high = xr.zeros_like(whole), xr.full_like(whole, MOST)
        for _ in range(HALVINGS):
            tried = 0.5 * (low + high)
            is_low = share_under(films * ((1.0 - tried) / (1.0 - share)) ** -power) > tried
            low, high = low.where(~is_low, tried), high.where(is_low, tried)
        return low.where(films.notnull() & power.notnull()).clip(1e-6)

    films, share, power = whole, xr.zeros_like(whole), xr.zeros_like(whole)
    other = share_under(whole).clip(1e-6, 0.5)
    for _ in range(ROUNDS):
        before, films = films, films_at(1.0 - other)
        change = np.log1p(-other) - np.log1p(-share)
        apart = np.abs(change) > NEAR
        power = power.where(~apart, -np.log(films / before) / change.where(apart))
        share, other = other, balanced(films, other, power)
        moves = np.abs(other - share) > FOUND
        if not moves.any():
            break
        other = other.where(moves, share)  # found, whatever other points still need
    return films, share_under(films)
