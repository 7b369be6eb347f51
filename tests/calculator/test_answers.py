"""Answers are datasets as before, and tables and plots as well."""

import pickle

import numpy as np
import pandas as pd
import pytest
import xarray as xr

import lube
from lube import Answer

GRID = {"force": ["100 N", "400 N"], "speed": "100 rpm"}
WARM = {"temperature": ([40, 60, 80], "degC")}
RUNS = {"realisations": 2, "seed": 2}


@pytest.fixture(scope="module")
def found(rollers, oil):
    return lube.contact_probability(rollers, oil, **GRID, **WARM, **RUNS)


@pytest.fixture(scope="module")
def cycle(rollers, oil):
    points = {
        "phase": ["low", "high"],
        "force": ["1600 N", "100 N"],
        "speed": ["60 rpm", "500 rpm"],
        "temperature": ["80 degC", "40 degC"],
    }
    return lube.duty(points, rollers, oil, **RUNS)


def test_the_table_has_a_row_for_each_point_and_units_in_its_header(found):
    table = found.table()
    assert len(table) == 6
    assert {"force [N]", "temperature [degC]", "film_thickness [um]"} <= set(table.columns)
    assert {"lambda_ratio", "tail_breakthrough_rate_lower [h-1]"} <= set(table.columns)
    assert not {"realisation", "breakthrough_probability"} & set(table.columns)
    row = table[(table["force [N]"] == 400.0) & (table["temperature [degC]"] == 60.0)]
    point = found.sel(force=400.0, temperature=60.0)
    for name in ("film_thickness", "breakthrough_probability_mean"):
        header = "film_thickness [um]" if name == "film_thickness" else name
        assert row[header].item() == point[name].item()


def test_a_single_value_is_a_table_of_one_row(found, rollers):
    assert len(found.isel(force=0, temperature=0).table()) == 1
    assert lube.required_film(rollers, "400 N", share=1e-6).table().shape == (1, 6)


def test_the_table_of_a_duty_cycle_has_its_labels(cycle, tmp_path):
    table = cycle.table()
    assert table["phase"].tolist() == ["low", "high"]
    assert not any(name.startswith("whole_") for name in table.columns)
    table.to_csv(tmp_path / "cycle.csv")


def test_an_answer_is_still_a_dataset_and_stays_an_answer(found, tmp_path):
    assert isinstance(found, xr.Dataset)
    again = pickle.loads(pickle.dumps(found))
    for kept in (found.sel(force=400.0), found.isel(force=[0]), found.copy(), again):
        assert isinstance(kept, Answer)
        assert kept.attrs == found.attrs
        assert kept["film_thickness"].attrs == found["film_thickness"].attrs
    assert again.identical(found)
    found.to_netcdf(tmp_path / "found.nc")
    loaded = xr.load_dataset(tmp_path / "found.nc")
    back = Answer(loaded.data_vars, loaded.coords, loaded.attrs)
    assert back.table()["film_thickness [um]"].equals(found.table()["film_thickness [um]"])
    found.plot.scatter(x="film_thickness", y="lambda_ratio")
    found["film_thickness"].plot()


def drawn(axes):
    """Data of all lines of an axes, but for caps of bars."""
    return [np.asarray(line.get_xydata(), float) for line in axes.lines if len(line.get_xdata())]


def test_probabilities_are_drawn_over_temperature_with_intervals_and_sampled_curves(found):
    axes = found.plot()
    assert axes.get_xlabel() == "Temperature of rollers and oil (°C)"
    assert axes.get_ylabel() == "Breakthrough probability"
    assert axes.get_yscale() == "log" and axes.get_ylim()[1] <= 1.0
    sampled = found["tail_breakthrough_probability"]
    for force in (100.0, 400.0):
        curve = np.transpose([[40.0, 60.0, 80.0], sampled.sel(force=force)])
        assert any(np.array_equal(line, curve) for line in drawn(axes))
    names = {text.get_text() for text in axes.figure.legends[0].texts}
    assert names == {"100 N", "400 N", "importance sampling"}
    # A zero that was counted is not drawn: the curve knows better.
    assert (found["breakthrough_probability_mean"] == 0.0).any()
    assert all((line[:, 1] > 0.0).all() for line in drawn(axes))


def test_one_may_choose_what_is_drawn(found):
    axes = found.plot(x="force", y="film_thickness")
    assert axes.get_xlabel() == "Normal force (N)"
    assert axes.get_ylabel() == "Film thickness (µm)"
    assert len(drawn(axes)) == 3


def test_frequent_contact_has_a_linear_axis_that_ends_at_one(found):
    axes = found.sel(temperature=[80.0]).plot()
    assert axes.get_yscale() == "linear"
    assert axes.get_ylim()[0] == 0.0 and axes.get_ylim()[1] <= 1.0


def test_without_sampling_an_unseen_contact_has_the_arrow_of_its_limit(found):
    counted = found.copy()
    counted["tail_breakthrough_probability"] = found["tail_breakthrough_probability"] * np.nan
    axes = counted.sel(force=100.0).plot()
    limit = counted["breakthrough_probability_upper"].sel(force=100.0).values[0]
    assert any(np.isclose(line[:, 1], limit).any() for line in drawn(axes))


def test_a_duty_cycle_is_drawn_along_its_points(cycle):
    axes = cycle.plot()
    assert [text.get_text() for text in axes.get_xticklabels()] == ["low", "high"]
    assert axes.get_xlabel() == "phase"
    whole = cycle["whole_tail_probability"].item()
    assert any((line[:, 1] == whole).all() for line in drawn(axes))
    numbered = cycle.drop_vars("phase").plot()
    assert [text.get_text() for text in numbered.get_xticklabels()] == ["1", "2"]


def test_a_profile_shows_pressure_and_film(rollers, oil):
    axes = lube.profile(rollers, oil, "400 N", "100 rpm", "60 degC").plot()
    labels = [one.get_ylabel() for one in axes.figure.axes]
    assert labels == ["Pressure (MPa)", "Film (µm)"]
    assert axes.get_xlabel() == "Position from the line of centres (µm)"


def test_a_trace_and_an_oil_are_drawn_too(rollers, oil):
    axes = lube.trace(rollers, oil, "400 N", "100 rpm", "60 degC").plot()
    assert (axes.get_xlabel(), axes.get_ylabel()) == ("Time (ms)", "Contact length (µm)")
    axes = oil.properties(["40 degC", "60 degC"]).plot(y="dynamic_viscosity")
    assert axes.get_xlabel() == "Temperature of rollers and oil (°C)"


@pytest.mark.parametrize(
    ("choice", "message"),
    [
        ({"x": "pint"}, "plot: got x='pint', did you mean 'point'"),
        ({"y": "film_thicknes"}, "plot: got y='film_thicknes', did you mean 'film_thickness'"),
        ({"y": "whole_probability"}, "plot: got a single value of whole_probability, need several"),
    ],
)
def test_what_cannot_be_drawn_is_refused_in_one_line(cycle, choice, message):
    with pytest.raises(lube.LubeError, match=message):
        cycle.plot(**choice)
    with pytest.raises(lube.LubeError, match="plot: got a single value"):
        cycle.isel(point=0).plot()


def test_what_is_shown_has_units_intervals_and_remarks(found, monkeypatch):
    monkeypatch.setenv("COLUMNS", "200")
    point = found.sel(force=400.0, temperature=60.0)
    lines = repr(point.assign_attrs(remarks="the contact\nis & stays narrow")).splitlines()
    assert lines[0] == "<Answer: realisation 2>" and lines[-2:] == [
        "the contact",
        "is & stays narrow",
    ]
    shown = {line.split("  ")[0]: line.split("  ")[-1].strip() for line in lines[1:-2]}
    assert shown["film_thickness [um]"] == f"{point.film_thickness.item():.4g}"
    name = "tail_breakthrough_probability"
    limits = [point[f"{name}{end}"].item() for end in ("", "_lower", "_upper")]
    assert shown[name] == "{:.4g} ({:.4g} to {:.4g})".format(*limits)
    assert "breakthrough_probability_mean" in shown and f"{name}_lower" not in shown
    page = point.assign_attrs(remarks="is & stays narrow")._repr_html_()
    assert shown[name] in page and "<p>is &amp; stays narrow</p>" in page


def test_first_and_last_points_are_shown(found, cycle, rollers, oil, monkeypatch):
    monkeypatch.setenv("COLUMNS", "400")
    forces = [line.split()[2:] for line in repr(found).splitlines() if line.startswith("force")]
    assert forces == [["100", "400"] * 3]
    trace = lube.trace(rollers, oil, "400 N", "100 rpm", "60 degC")
    (time,) = (line.split()[2:] for line in repr(trace).splitlines() if line.startswith("time"))
    assert len(time) == 7 and time[0] == "0" and time[3] == "..."
    assert "\nwhole_tail_rate [h-1] " in repr(cycle)
    others = lube.Answer(), found.isel(force=[]), found[["breakthrough_probability"]]
    for plain in (*others, lube.Answer({3: ("x", [1.0])})):
        assert repr(plain).startswith("<xarray.Answer>") or 3 in plain
        assert "xarray.Answer" in plain._repr_html_()


def test_what_is_made_of_answers_is_shown_too(found, cycle):
    both = repr(xr.concat([cycle, cycle], pd.Index(["a", "b"], name="oil")))
    assert "\nwhole_tail_probability " in both and "\noil " in both
    # A single realisation has no interval.
    single = repr(found.isel(realisation=0, force=0, temperature=0)).splitlines()
    (own,) = (line for line in single if line.startswith("breakthrough_probability "))
    (mean,) = (line for line in single if line.startswith("breakthrough_probability_mean "))
    assert " to " in mean and " to " not in own


def test_conditions_are_shown_as_they_were_given(rollers, oil):
    shown = repr(lube.film(rollers, oil, ["12345 N", "12346.5 N"], "100 rpm", "60.125 degC"))
    assert {"12345", "12346.5", "60.125"} <= set(shown.split())
