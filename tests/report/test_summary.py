"""What the report says of a study first, and that it says what the datasets say."""

import numpy as np
import pytest
import xarray as xr

from lube.report.summary import facts, findings, notes


def test_the_numbers_of_the_study_are_told(study):
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


def test_several_pairs_and_their_drift_are_told(study):
    rig = study.rig.model_copy(update={"pairs": 3, "drift": 0.3})
    html = facts(study.model_copy(update={"rig": rig}))
    assert "3 pairs of rollers turn 4 revolutions at every operating point" in html
    assert "renew 30 % of their roughness's variance each; below" in html


def test_unequal_rollers_many_levels_and_measured_records_are_told(study):
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
def datasets(study):
    """Film, contact and comparison of the study, with probabilities of ours."""
    grid = study.operating_grid
    coords = {
        "slide_to_roll_ratio": list(study.slips),
        "lubricant": [record.name for record in study.lubricants],
        "film_formula": list(study.film_formulas),
        "temperature": list(grid.temperature),
        "speed": list(grid.speed),
        "force": list(grid.force),
    }
    filled = xr.DataArray(0.0, coords, list(coords))
    mean = filled.copy()
    mean.loc[{"force": 1600, "temperature": 80, "speed": 100, "film_formula": "paper"}] = 0.4321
    contact = xr.Dataset(
        {
            "breakthrough_probability_mean": mean,
            "breakthrough_probability_lower": 0.5 * mean,
            "breakthrough_probability_upper": 2.0 * mean + 1e-4,
        }
    )
    filled = filled.isel(slide_to_roll_ratio=0, drop=True)
    film = xr.Dataset(
        {
            "film_thickness": filled + 2.834e-7,
            "lambda_ratio": filled + 1.002,
            "in_validity_range": filled.temperature + filled == 40.0,
        }
    )
    # Two records of the point with contact, one near no level.
    records = {
        "force": [1600.0] * 3,
        "speed": [100.0] * 3,
        "temperature": [80.0, 80.0, np.nan],
    }
    agreement = xr.DataArray(
        np.full((2, 3), -0.012), {"film_formula": coords["film_formula"],
                                  "threshold": list(study.experiment.thresholds)}
    )  # fmt: skip
    comparison = xr.Dataset(
        {
            **{f"{name}_level": ("record", levels) for name, levels in records.items()},
            "lubricant": ("record", coords["lubricant"] * 3),
            "slide_to_roll_ratio": ("record", [0.0] * 3),
            "measured_share": ("record", [0.4421, 0.4321, 0.2]),
            "bias": agreement,
            "rms_difference": -2.0 * agreement,
            "overlap_share": agreement + 0.762,
            "overlap_share_expected_lower": ("film_formula", [0.6, 0.6]),
            "overlap_share_expected_upper": ("film_formula", [1.0, 1.0]),
            "compared_records": 3 + 0 * agreement.astype(int),
            "pairs": 1,
            "comparison_threshold": study.experiment.threshold,
        },
        {"origin": "simulated"},
    )
    return film, contact, comparison  # fmt: skip


def test_the_answers_are_those_of_the_datasets(study, datasets):
    html = findings(study, *datasets)
    assert "at 1 of 8 operating points; at the other 7 it was never seen" in html
    assert "<strong>43.2 %</strong> of the time, at 1600 N, 100 r/min, 80 °C" in html
    assert "4 of 8 operating points lie outside" in html
    assert "Against a simulated rig (3 records of 1 pair of rollers) the simulation is on" in html
    assert "average 1.2 percentage points too low; the rms difference is 2.4 points." in html
    assert "75 % of the records lie where 95 % of single pairs should; a right model" in html
    assert "would have 60 % to 100 % of them there." in html
    rows = [line for line in html.splitlines() if line.startswith("<tr><td>")]
    assert len(rows) == len(study.traces)
    contact = ("<strong>43.2 %</strong> (21.6 % to 86.4 %)", "43.2 % to 44.2 % (2 records)")
    cells = ["1600 N, 100 r/min, 80 °C", "0.283 µm", "1", *contact]
    assert rows[1] == f"<tr>{''.join(f'<td>{cell}</td>' for cell in cells)}</tr>"
    assert "<strong>0 %</strong> (0 % to 0.01 %)</td><td>–</td>" in rows[0]


def test_a_study_without_contact_and_records_says_so(study, datasets):
    film, contact, comparison = datasets
    comparison["bias"][:] = np.nan
    comparison["measured_share"][:] = np.nan
    film["in_validity_range"][:] = True
    html = findings(study, film, contact * 0.0, comparison)
    assert "Metal touched metal at none of 8 operating points." in html
    assert "rig the simulation" not in html and "<td>–</td>" in html
    assert "All operating points lie within" in html


def test_refused_records_and_remarks_are_listed_with_their_reasons():
    quiet = xr.Dataset(attrs={"refused": "", "remarks": ""})
    assert notes(quiet, quiet) == ""
    experiment = quiet.assign_attrs(refused="a.csv: line 3: <no> number\nb.csv: no such file")
    html = notes(experiment, quiet.assign_attrs(remarks="c and d contradict each other"))
    assert html.count("<li>") == 3
    assert "a.csv: line 3: &lt;no&gt; number" in html and "contradict each other" in html
