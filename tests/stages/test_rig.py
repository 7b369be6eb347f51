"""The trace points' records belong to the same rig as those of all points, at every bandwidth."""

import numpy as np
import pytest

from lube.inference.study_shares import over_grid
from lube.schema import EXPERIMENT_DIMS
from lube.stages.experiment import simulated_experiment
from lube.stages.rig import make


@pytest.fixture(scope="module")
def slow_points(study, with_rig):
    """The study with the trace points of one speed, and a rig of 30 kHz."""
    points = tuple(point for point in study.traces if point.speed == 100.0)
    roughness = study.roughness.model_copy(update={"points": 60_000})
    changes = {"traces": points, "roughness": roughness}
    return with_rig(study.model_copy(update=changes), bandwidth="30 kHz")


@pytest.fixture(scope="module")
def record(rig_film, slow_points):
    return make(slow_points, {"film": rig_film})


def test_the_trace_points_record_belongs_to_the_same_rig(record, rig_film, slow_points):
    everything = over_grid(simulated_experiment(rig_film, slow_points))
    for number, point in enumerate(slow_points.trace_points):
        levels = {name: point[name] for name in EXPERIMENT_DIMS}
        here, there = record.isel(operating_point=number), everything.sel(levels).squeeze("repeat")
        assert {name: here[name].item() for name in EXPERIMENT_DIMS} == levels
        assert here.true_contact_share == there.true_contact_share
        np.testing.assert_allclose(
            here.contact_share.sel(bandwidth=3e4), there.contact_share, atol=1e-3
        )


def test_a_revolution_is_logged_at_the_rigs_sampling_rate(record, rig_film):
    assert record.rig_time.diff("rig_time").values == pytest.approx(1e-5)
    perimeter = 2.0 * np.pi * 0.05
    duration = perimeter / rig_film.entrainment_speed.item()
    assert record.sizes["rig_time"] == int(duration / 1e-5)


def test_a_wider_band_misses_less(record):
    assert (record.contact_share.diff("bandwidth").isel(threshold=0) >= -1e-3).all()
    assert (record.contact_share.max("operating_point") > 0.0).all()


def test_each_point_has_the_film_of_its_own_formula(rig_film, slow_points):
    one = slow_points.traces[-1]
    formulas = rig_film.film_formula.values.tolist()
    traces = tuple(one.model_copy(update={"film_formula": name}) for name in formulas)
    study = slow_points.model_copy(update={"traces": traces, "film_formulas": tuple(formulas)})
    thick, thin = make(study, {"film": rig_film}).true_contact_share.values
    assert thick < thin  # the formula for the central film, and the one for the minimum
