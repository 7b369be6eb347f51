"""A study: read whole, frozen, and what follows from its values."""

import math
import pickle

import pytest
import xarray as xr
from studies import OIL, PAPER

from lube.errors import LubeError, StudyError
from lube.pipeline.figure_list import study_figures
from lube.schema import STAGES
from lube.study.oil_properties import lubricant_table
from lube.study.rig_settings import Experiment, Rig
from lube.study.study import load_study

# What the paper says


def test_the_papers_study_has_the_papers_125_operating_points():
    grid = load_study(PAPER).operating_grid
    assert grid.force == (100.0, 200.0, 400.0, 800.0, 1600.0)
    # A minute over tenths of a second.
    assert grid.speed == pytest.approx([60.0 / (0.1 * tenths) for tenths in (7, 6, 5, 4, 3)])
    assert grid.speed[0] == 600.0 / 7.0
    assert grid.temperature == (40.0, 50.0, 60.0, 70.0, 80.0)
    assert grid.slide_to_roll_ratio == (0.0,)


def test_a_study_can_be_handed_to_another_process():
    study = load_study(PAPER)
    assert pickle.loads(pickle.dumps(study)) == study


def test_the_papers_rollers_layer_roughness_and_trace_are_in_si():
    study = load_study(PAPER)
    rollers, layer, trace = study.rollers, study.boundary_layer, study.trace_points[0]
    given = [rollers.length, rollers.first.radius, rollers.first.rms_roughness]
    assert given == pytest.approx([10e-3, 50e-3, 0.2e-6])
    assert rollers.reduced_radius == pytest.approx(25e-3)
    assert rollers.composite_rms_roughness == pytest.approx(0.2e-6 * 2**0.5)
    assert (layer.critical_thickness, layer.shear_strength) == pytest.approx((5e-9, 1e6))
    assert (study.roughness.points, study.roughness.hurst_exponent) == (1_000_000, 0.7)
    assert (trace["force"], trace["speed"], trace["temperature"]) == (800.0, 100.0, 40.0)


def test_the_defaults_of_the_rig_are_those_of_the_papers_study():
    study = load_study(PAPER)
    assert study.rig == Rig()
    assert study.experiment == Experiment()


# What follows from what is written


def test_the_rig_draws_one_realisation_a_pair_and_for_drift_one_a_turn(paper_with):
    cases = (1, 12, 0, 1), (1, 0.3, 0, 1), (5, 12, 0, 5), (1, 12, 0.1, 12), (5, 2.5, 0.1, 15)
    for pairs, revolutions, drift, drawn in cases:
        changes = ("rig.pairs", pairs), ("rig.revolutions", revolutions), ("rig.drift", drift)
        study = load_study(paper_with(*changes, ("realisations", 10**6), ("batch_size", 100)))
        assert len(study.rig_realisations) == drawn
        assert not set(study.rig_realisations) & set(range(study.realisations))


def test_the_force_of_a_record_needs_a_contact_that_the_grid_resolves():
    study = load_study(PAPER)
    study.check_window(123.4)
    with pytest.raises(StudyError, match=r"contact at 1e-06 N is .* need at least two grid spac"):
        study.check_window(1e-6)
    with pytest.raises(StudyError, match="less than a roller's perimeter"):
        study.check_window(1e12)


def test_the_papers_film_is_flat_and_not_corrected_and_another_asks_for_what_it_needs(paper_with):
    plain = {"with_shape": False, "inlet_shear_heating": "none", "inlet_meniscus": None}
    plain |= {"answered_lines": None, "rough_surfaces": None, "load_sharing": "none"}
    assert load_study(PAPER).film_model == plain
    changes = ("inlet_shear_heating", "zhu-cheng-1988"), ("inlet_meniscus", "0.4 mm")
    study = load_study(paper_with(*changes))
    heated = {"inlet_shear_heating": "zhu-cheng-1988", "inlet_meniscus": 4e-4}
    assert study.film_model == plain | heated
    # So is the force of a record.
    with pytest.raises(StudyError, match=r"got 400 µm, need more than .* the contact at 6000 N"):
        study.check_window(6000.0)
    oil = study.lubricants[0].model_copy(update={"thermal_conductivity": None})
    values = dict(study) | {"lubricants": (oil,)}
    with pytest.raises(
        StudyError, match=r"need none, or the thermal_conductivity of the lubricant"
    ):
        study.model_copy(update=values).check_conductivity("need none, or")


def test_the_lines_follow_from_the_largest_contact_width_and_the_radii(paper_with):
    study = load_study(PAPER)
    width = 2.0 * study.rollers.contact_half_width(max(study.operating_grid.force))
    assert 2.0 * math.pi / study.line_spec.q_min == pytest.approx(width, rel=1e-12)
    written = load_study(paper_with(("roughness.longest_wavelength", f"{float(width)!r} m")))
    assert written.line_spec.q_min == pytest.approx(study.line_spec.q_min, rel=1e-12)
    half = load_study(paper_with(("rollers.second.radius", "25 mm")))
    assert half.line_spec.points == (1_000_000, 500_000)


def test_batches_take_every_realisation_once(paper_with):
    for realisations, size in [(64, 8), (7, 3), (1, 5), (6, 6)]:
        study = load_study(paper_with(("realisations", realisations), ("batch_size", size)))
        taken = [number for first in study.batches for number in study.batch(first)]
        assert taken == list(range(realisations))
        assert all(len(study.batch(first)) <= size for first in study.batches)


def test_a_trace_takes_levels_in_any_unit_and_the_first_of_what_it_does_not_name(paper_with):
    study = load_study(paper_with(("operating_grid.slide_to_roll_ratio", [0.1, 0.2])))
    point = study.trace_points[0]
    assert point["slide_to_roll_ratio"] == 0.1
    assert point["film_formula"] == study.film_formulas[0]
    assert point["lubricant"] == study.lubricants[0].name
    path = paper_with(("traces.0.force", "0.8 kN"), ("traces.0.temperature", "313.15 K"))
    assert load_study(path).trace_points == load_study(PAPER).trace_points


# What a stage depends on


def newtons(*forces):
    return {"values": list(forces), "units": "N"}


@pytest.fixture
def changed_stages(paper_with):
    """Stages whose inputs a change of the paper's study changes."""

    def compare(*changes):
        before, after = load_study(PAPER), load_study(paper_with(*changes))
        return {name for name in STAGES if before.stage_inputs(name) != after.stage_inputs(name)}

    return compare


MECHANICS = {"contact", "tail", "areal", "trace", "surface_trace", "experiment"}
MECHANICS |= {"sensitivity_runs"}
# Those that are for pure rolling too.
LAYER = MECHANICS | {"master", "height_distribution", "variants", "passage", "verification"}
LAYER |= {"plan"}
BY_MODEL = {"tail", "film", "comparison", "sensitivity_runs", "sensitivity_responses", "plan"}
DEFORMED = {"variants", "height_distribution", "sensitivity_responses"}
LINES = LAYER | {"roughness", "patch", "sensitivity_responses"}
SPECTRUM = LINES | {"surface", "film_response", "surface_response"}
SLIDING = {"film", "film_response", "surface_response", "passage"}
SENSITIVITY = "sensitivity_runs", "sensitivity", "record_bands", "verification"
SENSITIVITY += ("electrical", "plan")
GRID = {"experiment"}  # whose records are labelled by the levels that they are near


def test_a_change_touches_the_stages_that_depend_on_it_and_no_other(changed_stages):
    for key, value, stages in [
        ("resistivity", "0.3 uohm*m", {"trace", "surface_trace", "experiment", "electrical"}),
        ("boundary_layer.critical_thickness", "6 nm", LAYER),
        ("operating_grid.slide_to_roll_ratio", [0, 0.05], MECHANICS | SLIDING),
        ("inlet_shear_heating", "zhu-cheng-1988", {"film"}),
        ("inlet_meniscus", "0.4 mm", {"film"}),
        ("revolutions", 3, {"contact"}),
        ("seed", 1, LINES),
        ("roughness.points", 500_000, SPECTRUM),
        ("roughness.longest_wavelength", "0.4 mm", SPECTRUM),
        ("rollers.second.rms_roughness", "0.3 um", SPECTRUM | {"film", "indicators"}),
        ("rollers.first.radius", "60 mm", SPECTRUM | {"film"}),
        ("film_formulas", ["paper"], {"film"}),
        ("film_shape", "computed", {"film"}),
        ("roughness_deformation", "venner-1997", MECHANICS | DEFORMED),
        ("roughness_deformation", "computed", MECHANICS | DEFORMED | {"film"}),
        ("operating_grid.speed", {"values": [100, 110], "units": "rpm"}, GRID | {"film"}),
        ("operating_grid.temperature", {"values": [40, 80], "units": "degC"}, GRID | {"lubricant"}),
        ("contact_model", ["line", "surface"], BY_MODEL),
        ("uncertainty.force.range", "+- 3 %", {"sensitivity_runs", "sensitivity_responses"}),
        ("load_sharing", "iterated", {"film"}),
        ("traces.1.temperature", "60 degC", {"trace", "surface_trace", "rig"}),
        ("rig.bandwidth", "10 kHz", {"surface_trace", "experiment", "electrical"}),
        ("rig.drift", 0.1, {"surface_trace", "experiment", "electrical", "plan"}),
        ("experiment.threshold", "10 ohm", {"experiment", "electrical"}),
        ("realisations", 128, {"coverage", "variants"}),
        ("batch_size", 8, set()),
        ("kept_realisations", [0, 1], set()),
        ("name", "another", set()),
        # Of the forces, the largest sets the lines by its contact width.
        ("operating_grid.force", newtons(150, 400, 800, 1600), GRID | {"film"}),
        ("operating_grid.force", newtons(800, 1600, 1700), SPECTRUM | {"film"}),
    ]:
        assert changed_stages((key, value)) == stages


@pytest.mark.parametrize(
    ("key", "value", "lost"),
    [
        ("film_shape", "computed", set()),
        ("roughness_deformation", "venner-1997", {"areal", "surface_trace", *SENSITIVITY}),
        ("roughness_deformation", "computed", set()),
    ],
)
def test_the_master_map_needs_the_plain_gap_and_the_surface_one_that_no_formula_flattens(
    paper_with, key, value, lost
):
    paper, study = load_study(PAPER), load_study(paper_with((key, value)))
    lost = lost | {"master", "areal_gauge"}
    assert all(paper.has(stage) for stage in lost)
    assert {stage for stage in STAGES if paper.has(stage) and not study.has(stage)} == lost


def test_the_same_value_in_another_unit_changes_nothing(changed_stages):
    same = ("rollers.length", "0.01 m"), ("rollers.first.young_modulus", "210000 MPa")
    assert changed_stages(*same) == set()


def test_a_lubricants_values_are_inputs_of_the_lubricant_stage_alone(changed_stages):
    assert changed_stages(("lubricants", [OIL, "n-dodecane"])) == {"lubricant"}


def test_rollers_that_do_not_conduct_have_no_rig(paper_with):
    insulator, paper = load_study(paper_with(("resistivity", "insulator"))), load_study(PAPER)
    assert paper.conducts and not insulator.conducts
    rigs = {"rig", "experiment", "comparison", "gauge", "areal_gauge", "coverage"}
    rigs |= {"electrical", "plan", "record_bands"}
    assert {stage for stage in STAGES if paper.has(stage) and not insulator.has(stage)} == rigs
    figures = set(study_figures(paper)) - set(study_figures(insulator))
    assert {name[:5] for name in figures} >= {"fig13", "fig14", "fig15", "fig16", "fig17", "fig18"}
    assert "fig05_contact_length" not in figures


def test_measured_records_of_insulators_are_refused(paper_with):
    changes = ("resistivity", "insulator"), ("experiment.manifest", "records.csv")
    with pytest.raises(LubeError, match="resistivity: got insulator together with"):
        load_study(paper_with(*changes))
    with pytest.raises(LubeError, match=r"got 'wood', need a number .*, or insulator"):
        load_study(paper_with(("resistivity", "wood")))


def test_an_oils_title_changes_no_stage(study):
    """Nor `lubricant.nc`, so that a new title makes nothing again but what shows it."""
    other = tuple(record.model_copy(update={"title": "Other"}) for record in study.lubricants)
    renamed = study.model_copy(update={"lubricants": other})
    for stage in STAGES:
        assert renamed.origin(stage) == study.origin(stage)
    tables = (lubricant_table(one.lubricants, [40.0]) for one in (study, renamed))
    xr.testing.assert_identical(*tables)
