"""What the report says of a study first, and that it says what the datasets say."""

import numpy as np
import pytest
import xarray as xr

from lube.report.summary import facts, findings, notes


def test_the_numbers_of_the_study_are_stated(study):
    html = facts(study)
    for words in (
        "two alike, radius 50 mm, 210 GPa, Poisson's ratio 0.3, rms roughness 0.2 µm",
        "Mobilgear SHC XMP 320",
        "16: 800 and 1600 N; 85.7 and 100 r/min; 40 and 80 °C; slide-to-roll ratio 0 and 0.1",
        "20,000 points",
        "critical thickness 5 nm, shear strength 1 MPa",
        "4 pairs of roughness lines, 1 revolution each; seed 20181109",
        "a simulated rig: one pair of rollers turns 4 revolutions at every operating point; below",
        "numpy 2",
    ):
        assert words in html


def test_several_pairs_and_their_drift_are_stated(study):
    rig = study.rig.model_copy(update={"pairs": 3, "drift": 0.3})
    html = facts(study.model_copy(update={"rig": rig}))
    assert "3 pairs of rollers turn 4 revolutions at every operating point" in html
    assert "renew 30 % of their roughness's variance each; below" in html


def test_unequal_rollers_many_levels_and_measured_records_are_stated(study):
    second = study.rollers.second.model_copy(update={"radius": 0.03})
    grid = study.operating_grid.model_copy(update={"force": tuple(map(float, range(1587, 1601)))})
    changes = {
        "rollers": study.rollers.model_copy(update={"second": second}),
        "operating_grid": grid,
        "experiment": study.experiment.model_copy(update={"manifest": "records.csv"}),
    }
    html = facts(study.model_copy(update=changes))
    assert "first radius 50 mm" in html and "second radius 30 mm" in html
    assert "14 levels from 1590 to 1600 N" in html
    assert "measured records; below 100 Ω" in html


@pytest.fixture
def results(study, datasets):
    """Film, contact and comparison of the study, with chosen values."""
    film, contact = datasets["film"].copy(deep=True), datasets["contact"].copy(deep=True)
    film["film_thickness"][:], film["lambda_ratio"][:] = 2.834e-7, 1.002
    film["in_validity_range"][:] = film["temperature"] + 0.0 * film["film_thickness"] == 40.0
    mean = 0.0 * contact["breakthrough_probability_mean"]
    mean.loc[{"force": 1600, "temperature": 80, "speed": 100, "film_formula": "paper"}] = 0.4321
    for name, values in (("mean", mean), ("lower", 0.5 * mean), ("upper", 2.0 * mean + 1e-4)):
        contact[f"breakthrough_probability_{name}"] = values
    # Two records of the point with contact, and one near no level.
    comparison = datasets["comparison"].isel(record=[0, 0, 0]).copy(deep=True)
    levels = {"force": 1600.0, "speed": 100.0, "temperature": [80.0, 80.0, np.nan]}
    for name, values in levels.items():
        comparison[f"{name}_level"][:] = values
    comparison["measured_share"][:] = [0.4421, 0.4321, 0.2]
    comparison["bias"][:], comparison["rms_difference"][:] = -0.012, 0.024
    comparison["overlap_share"][:], comparison["compared_records"][:] = 0.75, 3
    comparison["overlap_share_expected_lower"][:] = 0.6
    comparison["overlap_share_expected_upper"][:] = 1.0
    return film, contact, comparison


def test_the_answers_are_those_of_the_datasets(study, results):
    html = findings(study, *results)
    assert "at 1 of 8 operating points; at the other 7 none was seen" in html
    assert "<strong>43.2 %</strong> of the time, at 1600 N, 100 r/min, 80 °C" in html
    assert "4 of 8 operating points lie outside" in html
    assert "Against a simulated rig (3 records of 1 pair of rollers) the simulation is on" in html
    assert "average 1.2 percentage points too low; the rms difference is 2.4 points." in html
    assert "75 % of the records lie within their 95 % prediction intervals; with a correct" in html
    assert "model, 60 % to 100 % would." in html
    rows = [line for line in html.splitlines() if line.startswith("<tr><td>")]
    assert len(rows) == len(study.traces)
    contact = ("<strong>43.2 %</strong> (21.6 % to 86.4 %)", "43.2 % to 44.2 % (2 records)")
    cells = ["1600 N, 100 r/min, 80 °C", "0.283 µm", "1", *contact]
    assert rows[1] == f"<tr>{''.join(f'<td>{cell}</td>' for cell in cells)}</tr>"
    assert "<strong>0 %</strong> (0 % to 0.01 %)</td><td>–</td>" in rows[0]


def test_a_study_without_contact_and_records_says_so(study, results):
    film, contact, comparison = results
    comparison["bias"][:] = np.nan
    comparison["measured_share"][:] = np.nan
    film["in_validity_range"][:] = True
    html = findings(study, film, contact * 0.0, comparison)
    assert "No metal contact was seen at any of the 8 operating points." in html
    assert "rig the simulation" not in html and "<td>–</td>" in html
    assert "All operating points lie within" in html


def test_refused_records_and_remarks_are_listed_with_their_reasons():
    quiet = xr.Dataset(attrs={"refused": "", "remarks": ""})
    assert notes(quiet, quiet) == ""
    experiment = quiet.assign_attrs(refused="a.csv: line 3: <no> number\nb.csv: no such file")
    html = notes(experiment, quiet.assign_attrs(remarks="c and d contradict each other"))
    assert html.count("<li>") == 3
    assert "a.csv: line 3: &lt;no&gt; number" in html and "contradict each other" in html
