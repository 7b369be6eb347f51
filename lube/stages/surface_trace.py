"""The surface trace stage: contacts along the rollers at every step of a way."""

import numpy as np
import xarray as xr

from lube.contact.rough_pair import RoughPair
from lube.contact.surface_trace import surface_traces
from lube.grid.film_responses import with_surface_responses
from lube.grid.operating_points import rows_at
from lube.physics.electrical import contact_resistance, resistance_from_voltage
from lube.rig.simulator import recorded, whole_points
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
    found = surface_traces(RoughPair.of(study), film, slip, threads)
    # All traces have the same speed, and so the same times.
    times = found["step"].values / film["entrainment_speed"].values[0]
    levels = {name: ("operating_point", film[name].values) for name in CONTACT_DIMS}
    found = found.assign_coords(step=times, **levels).rename(step="time")
    found = found.assign(film[["film_thickness", "contact_half_width", "entrainment_speed"]])
    lengths = found["contact_length"].values
    resistance = contact_resistance(lengths, study.resistivity if study.conducts else np.nan)
    found["contact_resistance"] = ("operating_point", "time"), resistance
    known = np.flatnonzero(np.isfinite(lengths).all(axis=1)) if study.conducts else ()
    logged = {number: _logged(study, found.isel(operating_point=number)) for number in known}
    unknown = np.full_like(next(iter(logged.values()), np.zeros(1)), np.nan)
    read = [logged.get(number, unknown) for number in range(len(points))]
    found["read_resistance"] = ("operating_point", "rig_time"), read
    times = np.arange(unknown.size) / study.rig.sampling_rate
    return label(found.assign_coords(rig_time=times).drop_attrs(), "surface_trace")


def _logged(study, point):
    """Resistances that the study's rig logs, ohm."""
    contact = whole_points(point["contact_length"].values, study.line_spec)
    record = recorded(contact, point, study, (study.seed,), point["time"].values[1])
    return resistance_from_voltage(record.voltage(study.rig), study.rig)
