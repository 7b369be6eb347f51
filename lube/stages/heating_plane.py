"""The heating plane stage: how heating at the inlet thins the film, by each of the models."""

import numpy as np
import xarray as xr

from lube.grid.films import inlet_loading
from lube.physics.inlet_heating import INLET_HEATING, heating_factor
from lube.physics.regimes import asymptotic_gap
from lube.schema import label, with_dims
from lube.study.study import Study
from lube.types import Datasets

LOADINGS = np.geomspace(1e-3, 10.0, 41)
"""Levels of the thermal loading."""
SLIPS = np.linspace(0.0, 2.0, 41)
"""Levels of the slide-to-roll ratio."""


def make(study: Study, inputs: Datasets, threads: int = 1) -> xr.Dataset:
    """Make ``heating_plane.nc``: factors of heating at the inlet over thermal loading and slip.

    Parameters
    ----------
    study, inputs, threads
        As in `lube.stages`. A factor depends a little on the pressure and the film. These are taken
        at the middle force, speed and temperature, with the first lubricant.

    Returns
    -------
    xarray.Dataset
        The ``heating_plane`` file of `lube.schema`.
    """
    lubricant, film = inputs["lubricant"], inputs["film"]
    middle = {name: film.sizes[name] // 2 for name in ("temperature", "speed", "force")}
    point = film.isel(middle | {"lubricant": 0})
    pressure = (0.5 * point["hertz_pressure"] / point["reduced_modulus"]).item()
    thickness = asymptotic_gap(point["moes_load"].item(), point["moes_material"].item())
    models = INLET_HEATING[1:]
    factors = [
        heating_factor(model, LOADINGS[:, None], SLIPS, pressure, thickness) for model in models
    ]
    loading = inlet_loading(lubricant, film["entrainment_speed"])
    values = {
        "inlet_shear_heating_factor": factors,
        "relative_hertz_pressure": pressure,
        "relative_film": thickness,
        "heating_model": list(models),
        "thermal_loading": LOADINGS,
        "slide_to_roll_ratio": SLIPS,
    }
    table = xr.Dataset(with_dims("heating_plane", values))
    table["operating_loading"] = loading.transpose("lubricant", "temperature", "speed")
    return label(table, "heating_plane")
