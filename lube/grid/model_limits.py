"""Operating points at which the model cannot hold, or where its contact falls as the film thins."""

import numpy as np
import xarray as xr


def overloaded(contact: xr.Dataset) -> xr.DataArray:
    """Find the points where asperities would carry more than the load: outside the model.

    Parameters
    ----------
    contact : xarray.Dataset
        The ``contact`` dataset.

    Returns
    -------
    xarray.DataArray
        Whether `contact_load_share` is above 1 on average over realisations.
    """
    return contact["contact_load_share"].mean("realisation") > 1.0


def merged(contact: xr.Dataset, film: xr.Dataset) -> xr.DataArray:
    """Find the points where breakthrough is rarer than at a thicker film.

    In the model merged segments hold, as h_l grows with D^3/F (Eq. 6): although more of the lines
    is in contact, fewer segments break.

    Parameters
    ----------
    contact, film : xarray.Dataset
        The datasets of these names, with the same levels.

    Returns
    -------
    xarray.DataArray
        Whether at a thicker film, at the same force and so the same contact width, the
        breakthrough probability is greater by more than both intervals, and the geometric contact
        probability is not. False where an interval is not known.
    """
    lower, upper = (contact[f"breakthrough_probability_{end}"] for end in ("lower", "upper"))
    geometric = contact["geometric_contact_probability_mean"]
    thickness = film["film_thickness"].broadcast_like(lower)
    films = ["temperature", "speed"]
    return xr.apply_ufunc(
        _falls, *(thickness, lower, upper, geometric),
        input_core_dims=[films] * 4, output_core_dims=[films], vectorize=True, join="exact",
    ).transpose(*lower.dims)  # fmt: skip


def _falls(film, lower, upper, geometric):
    """Compare every point of one contact width, by rows, with every other, by columns."""
    thicker = np.ravel(film) > np.ravel(film)[:, None]
    rarer = np.ravel(upper)[:, None] < np.ravel(lower)
    touches = np.ravel(geometric)[:, None] >= np.ravel(geometric)
    return (thicker & rarer & touches).any(axis=1).reshape(film.shape)
