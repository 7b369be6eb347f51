"""The surface trace stage: contacts along the rollers at every step of a way."""

import numpy as np
import xarray as xr

from lube.contact.surface_trace import surface_traces
from lube.grid.film_responses import with_surface_responses
from lube.grid.operating_points import rows_at
from lube.physics.electrical import contact_resistance
from lube.schema import CONTACT_DIMS, label
from lube.study.study import Study
from lube.types import Datasets


def make(study: Study, inputs: Datasets, threads: int = 1) -> xr.Dataset:
    """Make ``surface_trace.nc``: contacts of the surfaces at the points of the traces.

    Parameters
    ----------
    study, inputs, threads
        As in `lube.stages`.

    Returns
    -------
    xarray.Dataset
        The ``surface_trace`` file of `lube.schema`, by
        `lube.contact.surface_trace.surface_traces`.
    """
    points, slip = study.trace_points, study.trace_points[0]["slide_to_roll_ratio"]
    film = rows_at(with_surface_responses(inputs), points).transpose("operating_point", ...)
    choices = study.boundary_layer, study.seed, slip, study.gap, threads
    found = surface_traces(study.line_spec, study.rollers.length, film, *choices)
    resistivity = study.resistivity if study.conducts else np.nan
    resistance = contact_resistance(found["contact_length"].values, resistivity)
    # All traces have the same speed, and so the same times.
    times = found["step"].values / film["entrainment_speed"].values[0]
    levels = {name: ("operating_point", film[name].values) for name in CONTACT_DIMS}
    found = found.assign_coords(step=times, **levels).rename(step="time")
    found["contact_resistance"] = ("operating_point", "time"), resistance
    found = found.assign(film[["film_thickness", "contact_half_width", "entrainment_speed"]])
    return label(found.drop_attrs(), "surface_trace")
