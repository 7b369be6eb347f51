"""What the figures share: labels from attributes, units, honest bars, the same bytes."""

import matplotlib
import numpy as np
import pytest
import xarray as xr
from PIL import Image

from lube import plots
from lube.errors import DataError
from lube.storage.provenance import global_attributes
from lube.workflow.stamps import stamp

matplotlib.use("Agg")
plt = plots.plt


def quantity(value, units, name="film thickness"):
    return xr.DataArray(value, attrs={"units": units, "long_name": name})


def test_units_of_the_files_are_converted_and_named():
    for units, wanted, factor in (
        *(("m", "um", 1e6), ("m2 s-1", "mm2 s-1", 1e6), ("Pa-1", "GPa-1", 1e9)),
        *(("ohm", "kohm", 1e-3), ("m", "m", 1.0)),
    ):
        converted = plots.in_units(quantity([1.0, 2.0], units), wanted)
        np.testing.assert_allclose(converted, [factor, 2.0 * factor], rtol=1e-12)
        assert converted.attrs == {"units": wanted, "long_name": "film thickness"}


def test_axis_labels_come_from_the_attributes():
    assert plots.axis_label(quantity(1.0, "um"), "$h_0$") == "Film thickness $h_0$ (µm)"
    assert plots.axis_label(quantity(1.0, "1", "lambda ratio")) == "Lambda ratio"


def test_every_level_has_a_colour_and_a_marker_of_its_own():
    levels = [100.0, 200.0, 400.0, 800.0, 1600.0]
    assert len({tuple(colour) for colour in plots.level_colours(levels).values()}) == 5
    assert len(set(plots.level_markers(levels).values())) == 5


def drawn(scale):
    figure, axes = plt.subplots()
    axes.set_yscale(scale)
    mean, lower, upper = np.array([0.0, 0.1]), np.array([0.0, 0.05]), np.array([1e-3, 0.2])
    plots.interval_bars(axes, np.array([1.0, 2.0]), mean, lower, upper, color="black", marker="o")
    points, limits = (container[0] for container in axes.containers)
    plt.close(figure)
    return points.get_ydata(), limits.get_ydata()


def test_a_probability_never_seen_is_zero_or_on_a_logarithmic_scale_an_arrow_from_its_limit():
    points, limits = drawn("log")
    np.testing.assert_array_equal(points, [np.nan, 0.1])
    assert limits.tolist() == [1e-3]
    points, limits = drawn("linear")
    assert points.tolist() == [0.0, 0.1] and limits.size == 0


@pytest.fixture
def records():
    """Three records of two pairs of rollers, the last near no level of force."""
    columns = {
        "force": [1603.0, 800.0, 1205.0],
        "speed": [100.0, 100.0, 93.0],
        "temperature": [80.0, 80.0, 71.3],
        "force_level": [1600.0, 800.0, np.nan],
        "pair": ["A", "A", "B"],
    }
    coords = {name: ("record", values) for name, values in columns.items()}
    names = ["run1.nc (list.csv: line 2)", "b", "in-a-folder-of-a-long-name.csv (list.csv: line 4)"]
    coords |= {"record": names, "origin": "measured"}
    return xr.Dataset({"pairs": 2, "drift": 0.0}, coords)


def test_the_rig_behind_records_is_named(records):
    assert plots.rig_name(records) == "measured rig, 2 pairs of rollers"
    one = records.assign(pairs=1, drift=0.3).assign_coords(origin="simulated")
    assert plots.rig_name(one) == "simulated rig, 1 pair of rollers, drift 0.3 a revolution"


def test_a_measured_record_has_its_name_and_a_simulated_one_its_conditions(records):
    first, last = records.isel(record=0), records.isel(record=2)
    conditions = "1603 N, 100 r/min, 80 °C"
    assert plots.record_name(first) == f"run1.nc (list.csv: line 2)\n{conditions}"
    assert plots.record_name(last).splitlines()[0] == "…ong-name.csv (list.csv: line 4)"
    assert plots.record_name(first, pairs=2).splitlines()[0].endswith("line 2), pair A")
    simulated = first.assign_coords(origin="simulated")
    assert plots.record_name(simulated) == conditions
    assert plots.record_name(simulated, pairs=2) == f"pair A\n{conditions}"


def test_records_are_grouped_by_the_levels_they_are_near(records):
    groups = plots.level_groups(records, "force")
    assert [name for name, *_ in groups] == ["800 N", "1600 N", "near no level"]
    assert [here.force.values.tolist() for *_, here in groups] == [[800.0], [1603.0], [1205.0]]
    assert len(plots.level_groups(records.isel(record=[0]), "force")) == 1


def test_panels_are_lettered_before_their_titles():
    plots.use_style()
    figure, panels = plt.subplots(1, 2)
    panels[1].set_title("slow")
    plots.panel_letters(panels)
    assert [panel.get_title(loc="left") for panel in panels] == ["(a)", "(b) slow"]
    plt.close(figure)


@pytest.fixture(scope="module")
def shown(study):
    """An empty dataset with the origin of a film table."""
    return xr.Dataset(attrs=global_attributes(study, "film"))


def test_a_figure_is_saved_as_the_same_bytes_each_time(tmp_path, shown):
    plots.use_style()
    with pytest.raises(DataError, match="a figure needs the datasets that it shows"):
        plots.save_figure(plt.figure(), tmp_path / "figure")
    assert not list(tmp_path.iterdir())
    for name in ("one", "two"):
        figure, axes = plt.subplots()
        axes.plot([1, 2], [1, 4])
        plots.save_figure(figure, tmp_path / name, shown)
        plt.close(figure)
    for suffix in ("png", "pdf"):
        one, two = ((tmp_path / f"{name}.{suffix}").read_bytes() for name in ("one", "two"))
        assert one == two


def test_a_figure_bears_the_stamp_of_what_it_shows_below_everything_else(tmp_path, shown):
    plots.use_style()
    figure, axes = plt.subplots()
    axes.set_xlabel("Force (N)")
    plots.save_figure(figure, tmp_path / "figure", shown)
    (written,) = figure.texts
    assert written.get_text() == stamp([shown])
    figure.canvas.draw()
    label, line = axes.xaxis.label.get_window_extent(), written.get_window_extent()
    assert line.y1 <= label.y0
    assert line.y0 >= 0
    plt.close(figure)
    with Image.open(tmp_path / "figure.png") as picture:
        assert picture.text["Description"] == stamp([shown])


def test_a_figure_without_a_place_is_stamped_and_written_nowhere(tmp_path, shown, monkeypatch):
    monkeypatch.chdir(tmp_path)
    figure, _ = plt.subplots()
    plots.save_figure(figure, None, shown)
    assert [written.get_text() for written in figure.texts] == [stamp([shown])]
    assert plt.fignum_exists(figure.number)  # for Jupyter to show
    plt.close(figure)
    assert not list(tmp_path.iterdir())


def test_a_figure_that_cannot_be_written_is_told_and_leaves_the_old_one(
    tmp_path, shown, monkeypatch
):
    figure, _ = plt.subplots()
    plots.save_figure(figure, tmp_path / "figure", shown)
    before = (tmp_path / "figure.png").read_bytes()

    def fail(*arguments):
        raise OSError(28, "No space left on device")

    monkeypatch.setattr("os.replace", fail)
    with pytest.raises(DataError, match=r"figure.png: cannot be written: No space left"):
        plots.save_figure(figure, tmp_path / "figure", shown)
    plt.close(figure)
    assert (tmp_path / "figure.png").read_bytes() == before
    assert len(list(tmp_path.iterdir())) == 2


@pytest.mark.parametrize(
    ("limits", "labels"),
    [
        ((15.0, 120.0), ["20", "50", "100"]),
        ((0.7, 1.4), ["0.8", "1", "1.2", "1.4"]),
        ((1.02, 1.07), ["1.02", "1.03", "1.04", "1.05", "1.06", "1.07"]),
    ],
)
def test_a_logarithmic_axis_has_plain_labels_however_short_it_is(limits, labels):
    figure, axes = plt.subplots()
    axes.set(yscale="log", ylim=limits)
    plots.plain_log_ticks(axes.yaxis)
    figure.canvas.draw()
    low, high = (limit * (1.0 + side * 1e-9) for limit, side in zip(limits, (-1, 1), strict=True))
    ticks = zip(axes.get_yticks(), axes.get_yticklabels(), strict=True)
    assert [label.get_text() for place, label in ticks if low <= place <= high] == labels
    plt.close(figure)
