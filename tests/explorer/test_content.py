"""The explorer's content is the datasets': bit by bit, at the study's own levels."""

import json

import numpy as np
import pytest
import xarray as xr

from lube.explorer.content import (
    CHOICES,
    SHOWN,
    TRACE_PIECES,
    TRACES,
    level_names,
    page_content,
    page_name,
)
from lube.storage.netcdf import load

EXPLORED = ("lubricant", "film", "contact", "tail", "master", "trace", "comparison")


@pytest.fixture(scope="module")
def explored(files, with_assumptions):
    """The datasets that the page is made of, as saved and loaded."""
    return with_assumptions({kind: load(files / f"{kind}.nc", kind).load() for kind in EXPLORED})


def read_back(datasets):
    """The content as the page's JavaScript reads it."""
    return json.loads(json.dumps(page_content(datasets), allow_nan=False))


def test_every_value_is_the_datasets_bit_by_bit(explored):
    content = read_back(explored)
    levels = {name: content["levels"][name]["values"] for name in CHOICES}
    for kind, names in SHOWN.items():
        for name in names:
            shown, array = content["variables"][page_name(kind, name)], explored[kind][name]
            assert array.dims == tuple(shown["dims"])
            for dim in array.dims:
                assert levels[dim] == array[dim].values.tolist()
            values = [None if one != one else one for one in array.values.ravel().tolist()]  # NaN
            assert shown["values"] == values
            assert (shown["file"], shown["units"]) == (f"{kind}.nc", array.attrs.get("units", ""))
    master = content["master"]
    assert master["lambda_ratio"] == explored["master"]["lambda_ratio"].values.tolist()
    mean = explored["master"]["breakthrough_probability_mean"]
    assert master["mean"] == mean.transpose("contact_width", "lambda_ratio").values.tolist()


def test_without_importance_sampling_its_values_are_none_and_the_page_knows(explored):
    assert read_back(explored)["sampled"]
    none = xr.full_like(explored["tail"], np.nan).assign_attrs(remarks="roughness: not Gaussian")
    content = read_back(explored | {"tail": none})
    assert not content["sampled"]
    assert set(content["variables"]["tail.breakthrough_probability"]["values"]) == {None}


def test_levels_have_names_with_units(explored):
    names = {name: levels["names"] for name, levels in read_back(explored)["levels"].items()}
    assert names["lubricant"] == ["mobilgear-shc-xmp-320"]
    assert names["speed"] == ["85.71 r/min", "100 r/min"]
    assert names["temperature"] == ["40 °C", "80 °C"]
    assert level_names("force", [12345.0]) == ["12345 N"]
    assert level_names("lubricant", ["a", "b"]) == ["a", "b"]


def test_of_neighbouring_steps_of_a_trace_the_extremes_stay(explored):
    trace = explored["trace"].copy(deep=True)
    trace["contact_length"][:] = 0.0
    trace["contact_resistance"][:] = np.inf
    trace["contact_length"][0, 7003], trace["contact_resistance"][0, 7003] = 2e-6, 0.5
    trace["contact_length"][0, 7004], trace["contact_resistance"][0, 7004] = 1e-6, 0.7
    kept = read_back(explored | {"trace": trace})["traces"]
    point, (time, step) = trace.isel(operating_point=0), trace.time.values[[7003, 1]]
    whole, close = kept[0]["whole"], kept[0]["close"]
    assert kept[0]["share"] == 2 / trace.sizes["time"]
    for part in (whole, close):
        assert len(part["time"]) <= TRACE_PIECES
        assert {len(part[name]) for name in TRACES} == {len(part["time"])}
        peak = part["contact_length"].index(2e-6)
        assert 0.0 <= time - part["time"][peak] < part["steps"] * step
        assert part["contact_resistance"][peak] == 0.5
        assert None in part["contact_resistance"]
    assert close["steps"] < whole["steps"]
    levels = page_content(explored)["levels"]
    for name in CHOICES:
        assert levels[name]["values"][kept[0]["at"][name]] == point[name].item()


def test_records_without_a_share_are_left_out_and_conditions_near_no_level_are_none(explored):
    comparison = explored["comparison"].copy(deep=True)
    comparison["measured_share"][0] = np.nan
    comparison["force_level"][1] = np.nan
    rows = read_back(explored | {"comparison": comparison})["records"]["rows"]
    assert len(rows) == comparison.sizes["record"] - 1
    one = comparison.isel(record=1)
    assert rows[0]["force_level"] is None and rows[0]["force"] == one["force"].item()
    assert rows[0]["measured_share"] == one["measured_share"].item()
    assert rows[0]["lambda_ratio"] == one["lambda_ratio"].values.tolist()


def test_of_rollers_without_a_line_the_contacts_of_surfaces_are_traced(explored, files):
    traces = load(files / "surface_trace.nc", "surface_trace").load()
    shown = {kind: explored[kind] for kind in ("lubricant", "film")}
    shown |= {"tail": explored["tail"].expand_dims(contact_model=["surface"])}
    content = read_back(shown | {"surface_trace": traces})
    assert content["levels"]["contact_model"]["values"] == ["surface"]
    assert len(content["traces"]) == traces.sizes["operating_point"]
    for row, trace in enumerate(content["traces"]):
        point = traces.isel(operating_point=row)
        assert trace["at"]["contact_model"] == 0 and trace["close"] is None
        assert trace["contacts"] == point["contacts"].values.mean()
        assert trace["whole"]["contact_length"] == point["contact_length"].values.tolist()
        way = point["time"].diff("time").sum() * (1.0 + 1.0 / (point.sizes["time"] - 1))
        assert trace["way"] == pytest.approx(way.item() * point["entrainment_speed"].item())
    assert content["marks"].keys() == {"deformed", "rubbing"}


def test_of_both_contact_models_lines_and_surfaces_are_traced(explored, files):
    traces = load(files / "surface_trace.nc", "surface_trace").load()
    tail = xr.concat(
        [explored["tail"]] * 2, xr.DataArray(["line", "surface"], dims="contact_model")
    )
    tail = tail.assign_coords(contact_model=["line", "surface"])
    content = read_back(explored | {"tail": tail, "surface_trace": traces})
    models = [trace["at"]["contact_model"] for trace in content["traces"]]
    numbers = [each.sizes["operating_point"] for each in (explored["trace"], traces)]
    assert models == [0] * numbers[0] + [1] * numbers[1]


def test_points_outside_the_model_are_marked_and_the_load_share_is_there(explored):
    contact = explored["contact"]
    heavy = contact.assign(contact_load_share=2.0 * xr.ones_like(contact["contact_load_share"]))
    content = read_back(explored | {"contact": heavy})
    marked = content["marks"]["overloaded"]
    assert set(marked["dims"]) == set(CHOICES) and all(marked["values"])
    assert set(content["variables"]["contact_load_share"]["values"]) == {2.0}
    assert not any(read_back(explored)["marks"]["overloaded"]["values"])


def test_points_whose_roughness_is_not_answered_linearly_are_marked(explored):
    film = explored["film"]
    changed = film.assign(rms_deformation=0.5 * film["film_thickness"].isel(film_formula=0))
    marked = read_back(explored | {"film": changed})["marks"]["deformed"]
    assert any(marked["values"])
    assert not any(read_back(explored)["marks"]["deformed"]["values"])


def test_points_whose_surfaces_carry_much_of_the_load_are_marked(explored):
    film = explored["film"]
    changed = film.assign(surface_load_share=0.5 * xr.ones_like(film["film_thickness"]))
    assert all(read_back(explored | {"film": changed})["marks"]["rubbing"]["values"])
    assert not any(read_back(explored)["marks"]["rubbing"]["values"])


def test_points_where_the_oil_may_keep_lines_apart_are_marked(explored):
    film = explored["film"].copy(deep=True)
    film["lambda_ratio"].loc[{"temperature": 40}] = 3.0
    film["lambda_ratio"].loc[{"temperature": 80}] = 2.0
    assert not any(read_back(explored | {"film": film})["marks"]["separated"]["values"])
    film["rms_deformation"] = 0.0 * film["film_thickness"].isel(film_formula=0)
    marked = read_back(explored | {"film": film})["marks"]["separated"]
    temperatures = film["temperature"].broadcast_like(film["lambda_ratio"])
    assert marked["values"] == (temperatures == 40.0).values.ravel().tolist()


def test_one_pair_of_surfaces_has_limits_in_pure_rolling(explored):
    assert "surface_pair_lower" not in read_back(explored)["variables"]
    tail = explored["tail"].expand_dims(contact_model=["surface"])
    for end, value in (("", 0.3), ("_lower", 0.299), ("_upper", 0.301)):
        tail[f"breakthrough_probability{end}"] = 0.0 * tail["breakthrough_rate"].fillna(0.0) + value
    one = tail["breakthrough_probability"].isel(slide_to_roll_ratio=0, contact_model=0, drop=True)
    tail["surface_pair_deviation"] = 0.0 * one + 0.05
    variables = read_back(explored | {"tail": tail})["variables"]
    lower, upper = (variables[f"surface_pair_{end}"] for end in ("lower", "upper"))
    assert "contact_model" not in lower["dims"] and lower["file"] == "tail.nc"
    slips = tail["slide_to_roll_ratio"].broadcast_like(
        tail.isel(contact_model=0, drop=True)["breakthrough_probability"]
    )
    found = zip(
        slips.transpose(*lower["dims"]).values.ravel(),
        lower["values"],
        upper["values"],
        strict=True,
    )
    for slip, least, most in found:
        assert (
            (least is None and most is None) if slip else 0.15 < least < 0.25 < 0.35 < most < 0.45
        )
