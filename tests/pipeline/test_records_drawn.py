"""Figures show records at their own conditions, bare limits, and one temperature alone."""

import numpy as np
import pytest
import xarray as xr
from figure_checks import draw
from matplotlib.markers import CARETDOWNBASE
from repository import ROOT

from lube.plots import NOT_POINTS


@pytest.fixture
def beside(files, tmp_path):
    """Records of several forces, beside the levels of temperature."""
    experiment = xr.load_dataset(files / "experiment.nc")
    experiment["temperature"] = experiment.temperature + np.linspace(
        -0.6, 0.6, experiment.sizes["record"]
    )
    experiment.to_netcdf(tmp_path / "experiment.nc")
    return tmp_path / "experiment.nc"


def test_figure_14_draws_each_record_at_its_own_temperature(beside):
    with xr.open_dataset(beside) as experiment:
        temperatures = experiment.temperature.values
        assert np.unique(experiment.force_level).size > 1
    figure = draw(ROOT / "notebooks/fig14_experiment.ipynb", {"experiment": beside})
    lines = [line for axes in figure.axes for line in axes.lines]
    drawn = [line.get_xdata() for line in lines if line.get_marker() not in NOT_POINTS]
    drawn = np.concatenate([np.asarray(x, float) for x in drawn])
    assert drawn.size
    assert np.abs(drawn[:, None] - temperatures).min(axis=1).max() < 1e-9


def test_figure_18_says_why_records_are_not_folded(files, tmp_path):
    experiment = xr.load_dataset(files / "experiment.nc")
    experiment["repeatability"][:3] = np.nan
    experiment["contact_share"][:3] = np.array([0.3, 0.3, 0.0])[:, None]
    experiment["duration"][:3] = experiment.revolution_period[:3] * [0.9, 3.0, 3.0]
    experiment["turns"][:3] = [1.2, 3.0, 3.0]  # of the second roller, if it is the faster one
    experiment.to_netcdf(tmp_path / "experiment.nc")
    inputs = {"experiment": tmp_path / "experiment.nc"}
    figure = draw(ROOT / "notebooks/fig18_folding.ipynb", inputs)
    (title,) = [name for axes in figure.axes if "folded" in (name := axes.get_title("left"))]
    assert "1 no longer than one revolution,\n2 never or always" in title  # one of them was there
    assert "1 sampled too rarely" in title


def test_figure_18_draws_measured_records_that_do_not_repeat(files, tmp_path):
    experiment = xr.load_dataset(files / "experiment.nc").assign_coords(origin="measured")
    experiment["speed_ratio"][:] = np.nan
    experiment.to_netcdf(tmp_path / "experiment.nc")
    inputs = {"experiment": tmp_path / "experiment.nc"}
    labels = [
        axes.get_ylabel() for axes in draw(ROOT / "notebooks/fig18_folding.ipynb", inputs).axes
    ]
    assert "Repeatability" in labels and "Speed ratio" not in labels


@pytest.mark.parametrize("resistances", [(5.0, np.inf), (0.0, 1e6)])
def test_figure_13_draws_contact_below_the_threshold_alone(files, tmp_path, resistances):
    experiment = xr.load_dataset(files / "experiment.nc").assign_coords(origin="measured")
    for first, resistance in enumerate(resistances):
        experiment["trace_resistance"][:, first::2] = resistance
    experiment.to_netcdf(tmp_path / "experiment.nc")
    inputs = {name: files / f"{name}.nc" for name in ("trace", "rig")}
    inputs["experiment"] = tmp_path / "experiment.nc"
    figure = draw(ROOT / "notebooks/fig13_resistance.ipynb", inputs)
    below = [axes.lines for axes in figure.axes if axes.get_yscale() == "log"]
    for trace, threshold in below:
        level, drawn = threshold.get_ydata()[0], trace.get_ydata()
        assert (drawn[0::2] < level).all() and (drawn[1::2] > level).all()


def test_one_temperature_alone_has_markers_where_others_have_curves(files, tmp_path):
    paths = {name: tmp_path / f"{name}.nc" for name in ("film", "contact", "tail")}
    for path in paths.values():
        xr.load_dataset(files / path.name).isel(temperature=[0]).to_netcdf(path)
    for number, marker in (("fig02_film", "s"), ("fig07_probability", "_")):
        figure = draw(ROOT / f"notebooks/{number}.ipynb", paths)
        assert marker in {line.get_marker() for axes in figure.axes for line in axes.lines}


def test_figure_17_draws_limits_of_a_film_that_has_no_value(files, tmp_path):
    gauge = xr.load_dataset(files / "gauge.nc")
    for end, value in (("", np.nan), ("_lower", 0.5), ("_upper", 2.5)):
        gauge[f"gauged_lambda_ratio{end}"][0] = value
    gauge.to_netcdf(tmp_path / "gauge.nc")
    paths = {name: files / f"{name}.nc" for name in ("film", "comparison")}
    paths["gauge"] = tmp_path / "gauge.nc"
    figure = draw(ROOT / "notebooks/fig17_gauge.ipynb", paths)
    bars = [bar.tolist() for lines in figure.axes[0].collections for bar in lines.get_segments()]
    place = gauge.lambda_ratio[0, 0].item()
    assert [[place, 0.5], [place, 2.5]] in bars


def test_figure_38_draws_upper_limits_where_no_layer_breaks(files, tmp_path):
    film = xr.load_dataset(files / "film.nc")
    film["surface_load_share"] = 0.0 * film.lambda_ratio
    film.to_netcdf(tmp_path / "film.nc")
    tail = xr.load_dataset(files / "tail.nc")
    tail["breakthrough_probability"][:] = tail["breakthrough_probability_lower"][:] = 0.0
    tail["breakthrough_probability_upper"][:] = 1e-3
    lines = [name for name in tail if "asymptote" not in name]
    tail = tail.assign(tail[lines].expand_dims(contact_model=["surface"]))
    tail.to_netcdf(tmp_path / "tail.nc")
    paths = {name: tmp_path / f"{name}.nc" for name in ("film", "tail")}
    axes = draw(ROOT / "notebooks/fig38_surfaces_alone.ipynb", paths).axes[0]
    arrows = [line.get_ydata() for line in axes.lines if line.get_marker() == CARETDOWNBASE]
    least, most = axes.get_ylim()
    assert arrows and 0.0 < least < 0.5e-3 and most > 1e-3


def test_figure_16_cuts_no_mark_at_the_edge(files, tmp_path):
    comparison = xr.load_dataset(files / "comparison.nc")
    comparison["simulated_probability"][:] = 1.0
    comparison["rms_deformation"] = comparison.film_thickness[0].drop_vars("film_formula")
    comparison.to_netcdf(tmp_path / "comparison.nc")
    paths = {"comparison": tmp_path / "comparison.nc", "film": files / "film.nc"}
    axes = draw(ROOT / "notebooks/fig16_comparison.ipynb", paths).axes[0]
    (marks,) = [line for line in axes.lines if line.get_label() == "oil's response not linear"]
    assert marks.get_xdata().size and not marks.get_clip_on()
