import numpy as np
import xarray as xr
from example_sensitivity import dataset
from studies import PAPER, ROOT

from lube.report.markdown import escaped
from lube.report.sensitivity import rests_on, values_taken
from lube.study.study import load_study
from lube.study.uncertainty import Uncertainty, spoken

STUDY = load_study(PAPER)


def test_what_matters_most_comes_first_with_its_range_and_source():
    lines = rests_on(STUDY, dataset()).strip().splitlines()
    rows = [line for line in lines if line.startswith("|")]
    assert [row.split(" | ")[0] for row in rows[2:]] == [
        "| contact model",
        "| temperature",
        "| resistivity",
        "| probability, 5 to 95 % of the samples",
    ]
    assert rows[2] == "| contact model | line | line, surface | the model | 40 | 30 | 20 |"
    assert rows[3] == "| temperature | 40 °C to 80 °C | -1 K to 1 K | assumed | 4 | 3 | 2 |"
    assert rows[4].endswith("more alloy conduct less | – | – | – |")
    assert rows[5].endswith("| 0.01 to 0.2 | 0.0001 to 0.002 | 1e-06 to 2e-05 |")
    assert rows[0].endswith(
        "| 400 N, 85.71 r/min, 40 °C | 200 N, 85.71 r/min, 40 °C | 100 N, 85.71 r/min, 40 °C |"
    )


def test_points_without_a_film_are_left_out():
    found = dataset()
    unknown = found["elementary_effect"].where(found["force"] < 300.0)
    rows = rests_on(STUDY, found.assign(elementary_effect=unknown)).splitlines()
    assert "400 N" not in "".join(rows) and "200 N" in "".join(rows)
    # The table has a column for each of the two points, and none twice.
    assert sum(row.count("| 100 N, 85.71") for row in rows) == 1
    nothing = found.assign(elementary_effect=xr.full_like(unknown, np.nan))
    assert rests_on(STUDY, nothing) == ""


def test_what_to_measure_first_is_said_with_what_it_gains():
    *_, last = rests_on(STUDY, dataset()).partition("Measure first")
    assert "- at 400 N, 85.71 r/min, 40 °C the temperature, by 26.4 %" in last
    assert "- at 100 N, 85.71 r/min, 40 °C the temperature, by 8.95 %" in last
    assert "contact model" not in last


def test_noise_is_no_finding():
    found = dataset()
    for name in ("elementary_effect", "first_order"):
        is_noise = (found["force"] < 300.0) & (found["factor"] == "temperature")
        found[f"{name}_lower"] = found[f"{name}_lower"].where(~is_noise, 0.0)
    lines = rests_on(STUDY, found).strip().splitlines()
    assert "| temperature | 40 °C to 80 °C | -1 K to 1 K | assumed | 4 | – | – |" in lines
    assert lines[-1] == "- at 400 N, 85.71 r/min, 40 °C the temperature, by 26.4 %"
    assert lines[-2] == ""  # no other point


def test_each_contact_model_and_records_without_interval_are_said():
    records = xr.Dataset(
        {
            "band_needed": (("contact_model", "record"), [["mean", "pair"], ["none", ""]]),
            "measured_share_lower": ("record", [0.1, np.nan]),
        },
        {"contact_model": ["line", "surface"], "origin": "measured"},
    )
    lines = rests_on(STUDY, dataset(), records).strip().splitlines()
    assert lines[-5].startswith(
        "Of 2 measured records by contact of the line: 1 within the interval"
    )
    assert "the surface: 1 in none of the bands; 1 not judged" in lines[-3]
    assert lines[-1] == "1 of them have no interval: they are taken as exact."


def test_a_study_has_a_value_of_each_factor():
    words = values_taken(STUDY)
    assert words.keys() == Uncertainty.model_fields.keys()
    assert words["viscosity"] == "335 mm²/s to 68.5 mm²/s"
    assert (words["critical_thickness"], words["film_formula"]) == ("5 nm", "paper")
    unlike = STUDY.rollers.second.model_copy(update={"young_modulus": 3e11})
    rollers = STUDY.rollers.model_copy(update={"second": unlike})
    taken = values_taken(STUDY.model_copy(update={"rollers": rollers}))
    assert taken["young_modulus"] == "210 GPa and 300 GPa"


def test_the_documentation_has_the_papers_values_and_ranges():
    page, taken = (ROOT / "docs/assumptions.md").read_text("utf-8"), values_taken(STUDY)
    rows = page.partition("<!-- effects -->")[2]
    factors = STUDY.uncertainty.factors()
    for factor in factors:
        given, source = factor.given.in_words, escaped(factor.given.source)
        cells = spoken(factor.name), taken[factor.name], given, source
        assert f"| {' | '.join(cells)} | " in rows, "run docs/tools/result_tables.py"
    assert "| resistivity | 200 nΩ m | -20 % to 100 % | " in rows
    assert rows.count("\n| ") == len(factors) + 4  # head, its rule, the resistivity, and the band
