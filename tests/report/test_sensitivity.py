import numpy as np
import xarray as xr

from lube.report.sensitivity import rests_on

FIRST = [[0.19, 0.36, 0.51], [0.7, 0.5, 0.4], [0.0, 0.0, 0.0]]


def dataset(**changes):
    forces = [100.0, 200.0, 400.0]
    probability = np.array([1e-5, 1e-3, 0.1])
    shape = {"lubricant": ["oil"], "temperature": [40.0], "speed": [600 / 7], "force": forces}
    dims = tuple(shape)
    effects = np.log([[2.0, 3.0, 4.0], [20.0, 30.0, 40.0], [1.01, 1.01, 1.01]])
    table = {
        "elementary_effect": (("factor", *dims), effects.reshape(3, 1, 1, 1, 3)),
        "first_order": (("factor", *dims), np.reshape(FIRST, (3, 1, 1, 1, 3))),
        "group_of_factor": ("factor", ["conditions", "contact model", "seed"]),
        "range_of_factor": ("factor", ["-1 K to 1 K", "line, surface", "any"]),
        "source_of_factor": ("factor", ["assumed", "the model", "the study's seed"]),
    }
    for name in ("elementary_effect", "first_order"):
        dims_, values = table[name]
        table |= {f"{name}_lower": (dims_, values - 0.01), f"{name}_upper": (dims_, values + 0.01)}
    for end, times in (("median", 1.0), ("lower", 0.1), ("upper", 2.0)):
        values = (probability * times).reshape(1, 1, 1, 3)
        table[f"breakthrough_probability_{end}"] = dims, values
    coordinates = shape | {"factor": ["temperature", "contact_model", "seed"]}
    return xr.Dataset(table, coordinates).assign(changes)


def test_what_matters_most_comes_first_with_its_range_and_source():
    lines = rests_on(dataset()).strip().splitlines()
    rows = [line for line in lines if line.startswith("|")]
    assert [row.split(" | ")[0] for row in rows[2:]] == [
        *("| contact model", "| temperature", "| probability, 5 to 95 % of the samples")
    ]
    assert rows[2] == "| contact model | line, surface | the model | 40 | 30 | 20 |"
    assert rows[3] == "| temperature | -1 K to 1 K | assumed | 4 | 3 | 2 |"
    assert rows[4].endswith("| 0.01 to 0.2 | 0.0001 to 0.002 | 1e-06 to 2e-05 |")
    assert rows[0].endswith(
        "| 400 N, 85.71 r/min, 40 °C | 200 N, 85.71 r/min, 40 °C | 100 N, 85.71 r/min, 40 °C |"
    )


def test_points_without_a_film_are_left_out():
    found = dataset()
    unknown = found["elementary_effect"].where(found["force"] < 300.0)
    rows = rests_on(found.assign(elementary_effect=unknown)).splitlines()
    assert "400 N" not in "".join(rows) and "200 N" in "".join(rows)
    nothing = found.assign(elementary_effect=xr.full_like(unknown, np.nan))
    assert rests_on(nothing) == ""


def test_what_to_measure_first_is_said_with_what_it_gains():
    last = rests_on(dataset()).strip().splitlines()[-1]
    assert "the temperature at 400 N, 85.71 r/min, 40 °C, by 26.4 %" in last
    assert "the temperature at 100 N, 85.71 r/min, 40 °C, by 8.95 %" in last
    assert "contact model" not in last


def test_noise_is_no_finding():
    found = dataset()
    for name in ("elementary_effect", "first_order"):
        is_noise = (found["force"] < 300.0) & (found["factor"] == "temperature")
        found[f"{name}_lower"] = found[f"{name}_lower"].where(~is_noise, 0.0)
    lines = rests_on(found).strip().splitlines()
    assert "| temperature | -1 K to 1 K | assumed | 4 | – | – |" in lines
    assert lines[-1].endswith("the temperature at 400 N, 85.71 r/min, 40 °C, by 26.4 %.")


def test_each_contact_model_and_records_without_interval_are_said():
    records = xr.Dataset(
        {
            "band_needed": (("contact_model", "record"), [["mean", "pair"], ["none", ""]]),
            "measured_share_lower": ("record", [0.1, np.nan]),
        },
        {"contact_model": ["line", "surface"], "origin": "measured"},
    )
    lines = rests_on(dataset(), records).strip().splitlines()
    assert lines[-5].startswith(
        "Of 2 measured records by contact of the line: 1 within the interval"
    )
    assert "the surface: 1 in none of the bands; 1 not judged" in lines[-3]
    assert lines[-1] == "1 of them have no interval: they are taken as exact."
