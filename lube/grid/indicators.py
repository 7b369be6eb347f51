"""Published indicators of lubrication over any operating conditions."""

from functools import partial

import numpy as np
import xarray as xr

from lube.grid.films import FilmGroups
from lube.physics.indicators import (
    LOAD_SHARES,
    RESISTANCE_FORMULAS,
    micropitting_film,
    rolling_resistance,
)

COMPUTED = "computed"
"""The rolling resistance of the computed film."""


def indicators(film: xr.Dataset, resistance: xr.DataArray, rollers) -> xr.Dataset:
    """Find the indicators of some films.

    Parameters
    ----------
    film : xarray.Dataset
        Variables of a film table over any dimensions, without slip, and ``dynamic_viscosity``.
    resistance : xarray.DataArray
        Rolling resistance of the computed films, N/m.
    rollers : RollerPair
        The two rollers.

    Returns
    -------
    xarray.Dataset
        The variables of the ``indicators`` file. The load share by a curve that is not meant for
        the pressure is NaN.
    """
    groups = FilmGroups.of(film)
    numbers, radius = (groups.load, groups.speed, groups.material), rollers.reduced_radius
    gears = xr.apply_ufunc(micropitting_film, *numbers) * radius / rollers.mean_ra_roughness
    shares = [_load_share(curve, film, rollers) for curve in LOAD_SHARES.values()]
    scale = 2.0 * rollers.reduced_modulus * radius
    by_name = (partial(rolling_resistance, name) for name in RESISTANCE_FORMULAS)
    found = [scale * xr.apply_ufunc(one, *numbers) for one in by_name]
    curves = xr.DataArray(list(LOAD_SHARES), dims="load_share_curve", name="load_share_curve")
    names = [COMPUTED, *RESISTANCE_FORMULAS]
    formulas = xr.DataArray(names, dims="resistance_formula", name="resistance_formula")
    resistances = xr.concat([resistance, *found], formulas, join="exact")
    table = {
        "micropitting_film_ratio": gears,
        "asperity_load_share": xr.concat(shares, curves, join="exact"),
        "rolling_resistance": rollers.length * resistances,
    }
    return xr.Dataset(table)


def _load_share(curve, film, rollers):
    """Share of the load that asperities carry, by one curve."""
    share = curve.share(film["film_thickness"] / getattr(rollers, curve.roughness))
    return share.where(film["hertz_pressure"] <= curve.pressure, np.nan)
