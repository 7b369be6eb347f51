"""What sensitivity indices tell: which of them are not noise, and what a measurement gains."""

import numpy as np
import xarray as xr

from lube.sensitivity.samples import SEED

LEFT = 0.1
"""Part of a quantity's variance that a good measurement of it leaves."""


def above_noise(found: xr.Dataset, index: str) -> xr.DataArray:
    """Find which indices are told from those of the random numbers.

    Parameters
    ----------
    found : xarray.Dataset
        A ``sensitivity`` dataset.
    index : str
        Name of one of its indices with an interval.

    Returns
    -------
    xarray.DataArray
        Whether the interval of the index lies above that of the seed.
    """
    return found[f"{index}_lower"] > found[f"{index}_upper"].sel(factor=SEED, drop=True)


def narrowing(found: xr.Dataset, factors: list[str]) -> xr.DataArray:
    r"""Find by how much a good measurement of each factor alone narrows the band.

    The band is that of the assumptions, all choices of the model being open. On average over the
    values that may be found, the variance falls by :math:`(1 - L) S`, with the first-order index S
    and the part L of the factor's own variance that is left, `LEFT`:

    .. math:: 1 - \sqrt{1 - (1 - L) S}

    Parameters
    ----------
    found : xarray.Dataset
        A ``sensitivity`` dataset.
    factors : list of str
        Names of the factors.

    Returns
    -------
    xarray.DataArray
        Part by which the standard deviation of the logarithm of the probability falls; 0 where the
        index is not above the noise.
    """
    index = found["first_order"].clip(0.0, 1.0)
    index = index.where(above_noise(found, "first_order") | index.isnull(), 0.0)
    return 1.0 - np.sqrt(1.0 - (1.0 - LEFT) * index.sel(factor=factors))
