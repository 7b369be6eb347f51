"""The constant stage: contact by the paper's Eq. 3, by its source, and by the computed film.

Eq. 3 is printed with the constant 2.992; its source has 2.922. Two digits are transposed.
"""

import numpy as np
import scipy.special
import xarray as xr

from lube.ehl.film_formulas import formula
from lube.inference.map_curves import curve_at
from lube.physics import dimensionless
from lube.schema import OPERATING_DIMS, label
from lube.study.study import Study
from lube.types import Datasets

FILMS = ("paper", "pan-hamrock", "computed")
"""Eq. 3 as printed, as in its source, and the solution of Reynolds' equation."""


def make(study: Study, inputs: Datasets, threads: int = 1) -> xr.Dataset:
    """Make ``constant.nc``; see `lube.stages`."""
    return constant_effect(inputs["lubricant"], inputs["film"], inputs["master"])


def constant_effect(lubricant: xr.Dataset, film: xr.Dataset, master: xr.Dataset) -> xr.Dataset:
    r"""Read the master map at the film of Eq. 3 as printed, as in its source, and as computed.

    Parameters
    ----------
    lubricant, film, master : xarray.Dataset
        The files of these names of `lube.schema`; any film formulas.

    Returns
    -------
    xarray.Dataset
        The ``constant`` file of `lube.schema`. One map of the same lines gives all three
        probabilities, so that they differ by the film alone. A probability is NaN where no run of
        the map had contact, and where the film was not computed.
    """
    points = film.drop_dims("film_formula")
    with xr.set_options(arithmetic_join="exact", keep_attrs=False):
        thickness = _films(lubricant, points) * points["reduced_radius"]
        ratio = thickness / points["composite_rms_roughness"]
    ratio = ratio.transpose(*OPERATING_DIMS)
    probability = [
        _read(curve_at(master, 2.0 * width), ratio.isel(force=at).values)
        for at, width in enumerate(points["contact_half_width"].values)
    ]
    table = {
        "film_thickness": thickness.transpose(*OPERATING_DIMS),
        "lambda_ratio": ratio,
        "breakthrough_probability": ratio.copy(data=np.stack(probability, axis=-1)),
    }
    return label(xr.Dataset(table).assign_coords(revolutions=1), "constant")


def _films(lubricant, points):
    """Films over R* by each of `FILMS`."""
    film_modulus = 2.0 * points["reduced_modulus"]
    scale = film_modulus, points["reduced_radius"]
    load = 0.5 * np.pi * points["hertz_pressure"] * points["contact_half_width"]  # per length
    viscosity, alpha = lubricant["dynamic_viscosity"], lubricant["pressure_viscosity_coefficient"]
    groups = (
        dimensionless.dimensionless_load(load, *scale),
        dimensionless.dimensionless_speed(viscosity, points["entrainment_speed"], *scale),
        dimensionless.dimensionless_material(alpha, film_modulus),
        *(viscosity, film_modulus),
    )
    films = [xr.apply_ufunc(formula(name).film, *groups, join="exact") for name in FILMS]
    return xr.concat(films, xr.Variable("film_formula", list(FILMS)), join="exact")


def _read(curve, ratios):
    """Probability at lambda ratios, NaN beyond the last film that had contact."""
    films = np.log(ratios)
    if not curve.films.size:
        return np.full(ratios.shape, np.nan)
    seen = films <= curve.thickest + 1e-9  # the film itself, but for rounding
    logits = curve.logit_at(np.clip(films, *curve.films[[0, -1]]))
    return np.where(seen, scipy.special.expit(logits), np.nan)
