"""What the report says of a study first, and that it says what the datasets say."""

import numpy as np
import pytest
import xarray as xr
from studies import CONFIG

from lube.report.summary import facts, findings, made
from lube.study.oil_properties import lubricant_table
from lube.study.rollers import OwnRoughness
from lube.study.study import load_study


def test_the_numbers_of_the_study_are_stated(study, datasets):
    text = facts(study, datasets["lubricant"])
    for words in (
        "two equal rollers: radius 50 mm, Young's modulus 210 GPa, Poisson's ratio 0.3, rms",
        "Mobilgear SHC XMP 320: viscosity and pressure-viscosity coefficient 335 mm²/s and 16 1/GPa"
        " at 40 °C, 68.5 mm²/s and 13 1/GPa at 80 °C",
        "16: 800 and 1600 N; 85.7 and 100 r/min; 40 and 80 °C; slide-to-roll ratio 0 and 0.1",
        "20,000 points",
        "critical thickness 5 nm, shear strength 1 MPa",
        "4 pairs of roughness lines, 1 revolution each; seed 20181109",
        "a simulated rig: one pair of rollers turns 4 revolutions at every operating point of the "
        "slide-to-roll ratio nearest to 0; a",
    ):
        assert words in text
    assert "numpy 2" in made(study) and "The authors of lube" in made(study)


def test_the_deformation_of_the_roughness_is_stated(study, datasets):
    assert "the oil (`" not in facts(study, datasets["lubricant"])
    for choice, words in (("venner-1997", "flattened"), ("computed", "deformed")):
        deformed = study.model_copy(update={"roughness_deformation": choice})
        text = facts(deformed, datasets["lubricant"])
        assert f"in the contact {words} by the oil (`{choice}`" in text


def test_two_oils_of_one_title_are_both_stated(study):
    (oil,) = study.lubricants
    oils = [oil, oil.model_copy(update={"name": "b"})]
    table = lubricant_table(oils, study.operating_grid.temperature)
    text = facts(study.model_copy(update={"lubricants": tuple(oils)}), table)
    assert text.count("| **Lubricants** | Mobilgear SHC XMP 320: ") == 2
    assert "| **Operating points** | 16 for each lubricant: 800 and" in text


def test_several_pairs_and_their_drift_are_stated(study, datasets):
    rig = study.rig.model_copy(update={"pairs": 3, "drift": 0.3})
    text = facts(study.model_copy(update={"rig": rig}), datasets["lubricant"])
    assert "3 pairs of rollers turn 4 revolutions at every operating point of the" in text
    assert "each revolution renews 30 % of the roughness variance; a" in text
    rolling = study.operating_grid.model_copy(update={"slide_to_roll_ratio": (0.0,)})
    text = facts(study.model_copy(update={"operating_grid": rolling}), datasets["lubricant"])
    assert "turns 4 revolutions at every operating point; a" in text


def test_unequal_rollers_many_levels_and_measured_records_are_stated(study, datasets):
    second = study.rollers.second.model_copy(update={"radius": 0.03, "young_modulus": 3.1e11})
    grid = study.operating_grid.model_copy(update={"force": tuple(map(float, range(1587, 1601)))})
    changes = {
        "rollers": study.rollers.model_copy(update={"second": second}),
        "operating_grid": grid,
        "experiment": study.experiment.model_copy(update={"manifest": "records.csv"}),
    }
    text = facts(study.model_copy(update=changes), datasets["lubricant"])
    assert "first: radius 50 mm, Young's modulus 210 GPa" in text
    assert "second: radius 30 mm, Young's modulus 310 GPa" in text
    assert "14 levels from 1590 to 1600 N" in text
    assert "measured records; a resistance below 100 Ω" in text and "simulated" not in text


def test_rollers_with_a_roughness_of_their_own_are_stated(study, datasets):
    own = {"rms_roughness": None, "ra_roughness": 1.6e-7}
    own["roughness"] = OwnRoughness(hurst_exponent=0.9, roll_off_wavelength="0.2 mm", kurtosis=4)
    second = study.rollers.second.model_copy(update=own)
    rollers = study.rollers.model_copy(update={"second": second})
    text = facts(study.model_copy(update={"rollers": rollers}), datasets["lubricant"])
    assert "rms roughness 0.201 µm (from Ra 0.16 µm)" in text
    assert "first: Hurst exponent 0.7; second: Hurst exponent 0.9, roll-off at 200 µm, skew" in text
    band = "waves 420 µm (contact width at the largest force) to 157 µm"
    assert f"skewness 0 and kurtosis 4; {band} |" in text


def test_rollers_with_one_measured_map_are_equal(datasets):
    study = load_study(CONFIG / "measured.yaml")
    # As jobs load it: each roller has what was read of the map as an object of its own.
    study = load_study(CONFIG / "measured.yaml", **study.readings)
    assert "| two equal rollers: radius 50 mm" in facts(study, datasets["lubricant"])


def test_ground_rollers_have_no_lines(study, datasets):
    lay = study.roughness.model_copy(update={"lay_ratio": 5.0, "lay_angle": 0.0})
    ground = study.model_copy(update={"roughness": lay, "contact_model": ("surface",)})
    text = facts(ground, datasets["lubricant"])
    assert "| **Roughness** | Hurst exponent 0.7; waves 420 µm" in text
    assert "lines" not in text.partition("**Experiment**")[0]
    assert "| **Roughness lines** | 20,000 points around the first roller, Hurst exponent" in (
        facts(study, datasets["lubricant"])
    )


@pytest.fixture
def results(study, datasets):
    """The datasets of the study, with chosen values."""
    film, contact = datasets["film"].copy(deep=True), datasets["contact"].copy(deep=True)
    film["film_thickness"][:], film["lambda_ratio"][:] = 2.834e-7, 1.002
    film["film_thickness"].loc[{"film_formula": "pan-hamrock", "temperature": 80}] *= 1.1
    film["in_validity_range"][:] = film["temperature"] + 0.0 * film["film_thickness"] == 40.0
    film["regime"][:] = 1
    film["regime"].loc[{"temperature": 80}] = 3
    mean = 0.0 * contact["breakthrough_probability_mean"]
    most = {"force": 1600, "temperature": 80, "speed": 100, "slide_to_roll_ratio": 0.1}
    mean.loc[most | {"film_formula": "paper"}] = 0.4321
    mean.loc[most | {"film_formula": "pan-hamrock"}] = 0.5432
    mean.loc[most | {"film_formula": "paper", "force": 800}] = 0.0008
    for name, values in (("mean", mean), ("lower", 0.5 * mean), ("upper", 2.0 * mean + 1e-4)):
        contact[f"breakthrough_probability_{name}"] = values
    for name, factor in (("lower", 0.8), ("upper", 1.2)):
        contact[f"breakthrough_probability_pair_{name}"] = factor * mean
    # Two records of a point, and one near no level.
    comparison = datasets["comparison"].isel(record=[0, 0, 0]).copy(deep=True)
    levels = {"force": 1600.0, "speed": 100.0, "temperature": [80.0, 80.0, np.nan]}
    for name, values in levels.items():
        comparison[f"{name}_level"][:] = values
    comparison["measured_share"][:] = [0.4421, 0.4321, 0.2]
    comparison["bias"][:], comparison["rms_difference"][:] = -0.012, 0.024
    comparison["overlap_share"][:], comparison["compared_records"][:] = 0.75, 3
    comparison["overlap_share_expected_lower"][:] = 0.6
    comparison["overlap_share_expected_upper"][:] = 1.0
    gauge = datasets["gauge"].isel(record=[0, 0, 0]).copy(deep=True)
    gauge["gauged_film_thickness_lower"][:] = [1e-7, 2e-7, 0.0]
    gauge["gauged_film_thickness_upper"][:] = [3e-7, np.inf, 1e-7]
    changed = {"film": film, "contact": contact, "comparison": comparison, "gauge": gauge}
    known = {kind: each for kind, each in datasets.items() if kind != "sensitivity"}
    return known | changed


def test_the_answers_are_those_of_the_datasets(study, results):
    text = findings(study, results)
    for words in (
        "Metal contact occurs at 2 of 16 operating points: more than 10 % of the time at 1, less",
        "less than 0.1 % at 1. At the other 14 no contact was seen, so it is less frequent "
        "there than 0.01 %",
        "**43.2 %** of the time (95 % interval 21.6 % to 86.4 %; one pair of rollers 34.6 % to "
        "51.9 %), at 1600 N, 100 r/min, 80 °C, slide-to-roll ratio 0.1, and least frequent where "
        "it was seen, 0.08 % (0.04 % to 0.17 %; one pair 0.064 % to 0.096 %), at 800 N",
        "The contact is 280 µm to 396 µm wide, 1.8 to 2.5 times the shortest wavelength",
        "piezoviscous and rigid at 4, piezoviscous and elastic at 4 of the 8 combinations",
        "outside the validity range of the film formula: 4 with `paper`, 4 with `pan-hamrock`.",
        "The 2 formulas of the central film differ by up to 10 % at one operating point, by up to "
        "0 % where they are within their validity ranges. Where contact is most frequent, they "
        "give contact for 43.2 % to 54.3 % of the time.",
        "Against a simulated rig (3 records of 1 pair of rollers) the simulation is on average "
        "1.2 percentage points too low; the rms difference is 2.4 points. 75 % of the records lie "
        "within their 95 % prediction intervals; with a correct model, 60 % to 100 % would, a "
        f"range that is too narrow from only {study.realisations} realisations.",
        "- **Contact width: 1.8 times the shortest wave at the smallest force; with less than 20",
        "has both limits for 1 of 3 records; contact is too rare, or the film among the study's "
        "thickest, for an upper limit in 1; contact is too frequent for a lower limit in 1.",
        "| normal force | 800 N: 0.01 %; 1600 N: 5.4 % |",
        "| 1600 N, 100 r/min, 80 °C, slide-to-roll ratio 0 | 0.283 µm | 1 | **0 %** "
        "(0 % to 0.01 %) | 0 % (0.",
    ):
        assert words in text
    assert text.count(" | 43.2 % to 44.2 % (2 records) |") == 1 and text.count(" | – |") == 1


def test_a_single_operating_point_is_stated_as_one(study, results):
    one = {"slide_to_roll_ratio": [0], "temperature": [0], "speed": [1], "force": [0]}
    parts = {name: results[name].isel(one, missing_dims="ignore") for name in ("film", "contact")}
    text = findings(study.model_copy(update={"traces": study.traces[:1]}), results | parts)
    assert "With the film formula `paper`, at the one operating point:" in text
    assert "µm thick, the lambda ratio 1.\n" in text
    assert "The regime is piezoviscous and rigid.\n" in text


def test_points_at_which_the_model_does_not_hold_are_stated(study, results):
    assert "outside the model" not in findings(study, results)
    assert "merge" not in findings(study, results)
    contact = results["contact"].copy(deep=True)
    contact["contact_load_share"].loc[{"force": 800, "temperature": 80}] = 1.41
    # The film is the same everywhere but at 80 degC, where it is made thinner.
    film = results["film"].copy(deep=True)
    film["film_thickness"].loc[{"temperature": 80}] *= 0.5
    more = (contact["temperature"] == 40) + 0.0 * contact["breakthrough_probability"]
    contact["breakthrough_probability"] = more.transpose("realisation", ...)
    contact["geometric_contact_probability_mean"][:] = 1.0
    text = findings(study, results | {"contact": contact, "film": film})
    assert "Asperities of the line carry up to 141 % of the load" in text
    assert "**At 4 of the 16 operating points they would carry more than the load" in text
    assert "At 8 of the 16 operating points contact is less frequent than at a thicker film" in text


def test_a_formula_whose_film_is_known_nowhere_leaves_the_others(study, results):
    film, contact = results["film"].copy(deep=True), results["contact"].copy(deep=True)
    for values in (*film.values(), *contact.values()):
        if "film_formula" in values.dims and values.dtype == float:
            values.loc[{"film_formula": "paper"}] = np.nan
    text = findings(study, results | {"film": film, "contact": contact})
    assert "The 2 formulas of the central film" in text


def test_points_whose_roughness_is_not_answered_linearly_are_counted(study, results):
    assert "linear response" not in findings(study, results)
    slips = results["contact"]["slide_to_roll_ratio"]
    film = results["film"].assign(film_thickness=results["film"]["film_thickness"] + 0.0 * slips)
    half = film["film_thickness"].isel(film_formula=0, drop=True) / 2.0
    text = findings(study, results | {"film": film.assign(rms_deformation=half.where(slips > 0))})
    # The film has a dimension of slip although no heating is applied.
    assert "Heating of the oil at the inlet, which is not applied, would make" in text
    assert "At 8 of the 16 operating points the oil changes the roughness by more than 10 %" in text


def test_the_range_over_the_assumptions_is_stated_where_it_is_known(study, results):
    assert "assumptions" not in findings(study, results)
    rolling = xr.ones_like(results["film"]["film_thickness"].isel(film_formula=0, drop=True))
    ends = {"lower": 0.03, "upper": 0.9}
    band = {f"breakthrough_probability_{end}": level * rolling for end, level in ends.items()}
    known = xr.Dataset(band, {"factor": ["temperature"]})
    text = findings(study, results | {"sensitivity": known})
    assert "| one pair of rollers, 95 % (standard deviation) | assumptions, 5 to 95 % |" in text
    rows = [line for line in text.splitlines() if "slide-to-roll ratio" in line and line[0] == "|"]
    assert ["| 3 % to 90 % |" in row for row in rows] == ["ratio 0 |" in row for row in rows]
    assert any("| 3 % to 90 % |" in row for row in rows)


def test_points_where_the_oil_may_keep_touching_lines_apart_are_counted(study, results):
    film = results["film"].copy(deep=True)
    film["lambda_ratio"][:] = 2.5
    assert "may keep lines apart" not in findings(study, results | {"film": film})
    film["rms_deformation"] = 0.0 * film["film_thickness"].isel(film_formula=0)
    text = findings(study, results | {"film": film})
    assert "At 2 of the points where the lines touch, the lambda ratio is at least 2.5. " in text
    surfaces = study.model_copy(update={"contact_model": ("surface",)})
    tail = results["tail"].expand_dims(contact_model=["surface"])
    tail["surface_pair_deviation"] = tail["breakthrough_probability"].isel(slide_to_roll_ratio=0)
    text = findings(surfaces, results | {"film": film, "tail": tail})
    assert "may keep lines apart" not in text


def test_points_whose_surfaces_carry_much_of_the_load_are_counted(study, results):
    assert "Asperities of the surfaces" not in findings(study, results)
    film = results["film"]
    share = (film["temperature"] == 80.0) * 0.3 + 0.0 * film["film_thickness"]
    text = findings(study, results | {"film": film.assign(surface_load_share=share)})
    assert "Asperities of the surfaces carry up to 30 % of the load, although the film" in text
    assert "more than 10 % at 8 of the 16 operating points.\n" in text  # at either slip
    rough = findings(study, results | {"film": film.assign(surface_load_share=4.0 * share)})
    assert "more than 10 % at 8 of the 16 operating points, more than all of it at 8.\n" in rough
    assert "% of the load, although the film is that of the whole load.\n" in text  # of the line
    shared = study.model_copy(update={"load_sharing": "iterated"})
    text = findings(shared, results | {"film": film.assign(surface_load_share=share)})
    assert "of the load; the films follow from the share that the surfaces carry" in text
    assert "surfaces carry up to 30 % of the load; the film is that of the rest: more" in text
    assert "whole load" not in text
    rough = findings(shared, results | {"film": film.assign(surface_load_share=4.0 * share)})
    assert "more than all of it at 8, where asperities and oil have no balance.\n" in rough


def test_contact_of_surfaces_is_stated_beside_that_of_lines_or_alone(study, results):
    mean = results["contact"]["breakthrough_probability_mean"]
    models = xr.DataArray(["line", "surface"], dims="contact_model", name="contact_model")
    probability = xr.concat([np.nan * mean, 0.0 * mean + 0.7], models)
    ends = {"": 1.0, "_lower": 0.9, "_upper": 1.1}
    tail = {f"breakthrough_probability{end}": probability * by for end, by in ends.items()}
    rolling = mean.isel(slide_to_roll_ratio=0, drop=True)
    tail["surface_pair_deviation"] = xr.full_like(rolling, 0.02)
    results = results | {"tail": xr.Dataset(tail)}
    both = findings(study.model_copy(update={"contact_model": ("line", "surface")}), results)
    sentence = "Metal contact of the surfaces occurs at 16 of 16 operating points: more than 10 %"
    row = "| 0.283 µm | 1 | surfaces | **70 %** (63 % to 77 %) | 61.7 % to 78.3 % (2 %) |"
    assert f"{row} – |" in both  # the simulated rig runs with lines
    lines = "Metal contact of the lines occurs at 2 of 16", "1 | lines | **0 %**", "0.01 %; 1600"
    for words in (sentence, row, *lines, "| normal force | 800 N: 70 %; 1600 N: 70 % |"):
        assert words in both
    alone = findings(study.model_copy(update={"contact_model": ("surface",)}), results)
    assert sentence in alone and row.replace(" surfaces |", "") in alone
    assert "43.2 %**" not in alone and "of the lines" not in alone


def test_measured_records_are_not_called_simulated(study, results):
    comparison = results["comparison"].assign_coords(origin="measured")
    text = findings(study, results | {"comparison": comparison})
    assert "Against the measured records (3 records" in text and "simulated" not in text
    assert "contradict the model" not in text
    comparison["overlap_share"][:] = 0.5
    for realisations, verdict in ((38, ", a range"), (39, ", so these records contradict")):
        some = study.model_copy(update={"realisations": realisations})
        text = findings(some, results | {"comparison": comparison})
        assert f"60 % to 100 % would{verdict}" in text


def test_a_study_without_contact_and_records_says_so(study, results):
    comparison = results["comparison"]
    comparison["bias"][:] = np.nan
    comparison["measured_share"][:] = np.nan
    none = results["contact"] * 0.0
    none["breakthrough_probability_upper"] += 0.002
    text = findings(study, results | {"contact": none})
    assert "No metal contact was seen at any of the 16 operating points, so it is less" in text
    assert "less frequent than 0.2 %, the" in text
    assert "Against" not in text and " – |" in text


def test_refused_records_and_remarks_are_listed_with_their_reasons(study, results):
    assert "Records that were refused" not in findings(study, results)
    refused = "a.csv: line 3: <no> number\nb.csv: no such file"
    experiment = results["experiment"].assign_attrs(refused=refused, remarks="c is short")
    comparison = results["comparison"].assign_attrs(remarks="c and d contradict each other")
    text = findings(study, results | {"experiment": experiment, "comparison": comparison})
    assert "in no result:\n\n- a.csv: line 3: \\<no> number\n- b.csv: no such file\n" in text
    assert "Remarks on records:\n\n- c is short\n- c and d contradict each other" in text


def test_a_study_without_named_authors_says_so(study):
    nobody = study.model_copy(update={"about": study.about.model_copy(update={"creators": ()})})
    assert made(nobody).startswith("No author is named in the study. Made with the code of commit")
