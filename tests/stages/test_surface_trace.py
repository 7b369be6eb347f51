"""What the rig logs of the contacts of surfaces."""

import numpy as np
import pytest

from lube.stages.surface_trace import make


@pytest.fixture(scope="module")
def trace(datasets, study):
    """Trace with a weak boundary layer, and its contacts at the times of the record."""
    film = datasets["film"]
    films = {"film": film.assign(film_thickness=1.1 * film["film_thickness"])}
    layer = study.boundary_layer.model_copy(update={"shear_strength": 2e4})
    trace = make(study.model_copy(update={"boundary_layer": layer}), films)
    step, at = trace["time"].values[1], trace["rig_time"]
    number = np.minimum((at.values / step + 1e-9).astype(int), trace.sizes["time"] - 1)
    contact, dims = trace["contact_resistance"].values, ("operating_point", "rig_time")
    now, *before = (np.isfinite(contact[:, np.maximum(number - past, 0)]) for past in range(4))
    settled = np.all([now == each for each in before], axis=0)
    return trace.assign(now=(dims, contact[:, number]), settled=(dims, settled))


def test_the_rig_logs_the_resistance_of_contacts_and_leak_in_parallel(trace, study):
    """Once the rig has followed: a step lasts longer than its filter delays."""
    rig = study.rig
    assert trace["time"].values[1] * rig.bandwidth > 0.5
    closed, read = np.isfinite(trace["now"]), trace["read_resistance"]
    # Six times the noise, where the voltage is nearly zero, and where it is nearly the bias.
    noise = 6.0 * rig.noise / rig.bias_voltage * rig.series_resistance
    assert (read - trace["now"] < noise + 0.1).where(closed & trace["settled"], True).all()
    open_gap = ~closed & trace["settled"]
    assert (read > 0.5 * rig.series_resistance**2 / noise).where(open_gap, True).all()
    assert (closed & trace["settled"]).any() and open_gap.any()


def test_the_share_below_the_threshold_is_nearly_that_of_contact(trace, study):
    below = (trace["read_resistance"] < study.experiment.threshold).mean("rig_time")
    share = np.isfinite(trace["contact_resistance"]).mean("time")
    assert (abs(below - share) < 0.05).all() and (share > 0.0).any()
