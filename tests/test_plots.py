"""What the figures share: labels from attributes, units, interval bars, the same bytes."""

import warnings

import matplotlib
import numpy as np
import pytest
import xarray as xr
from matplotlib.markers import CARETDOWN, CARETLEFT, CARETRIGHT, CARETUP
from PIL import Image

from lube import plots
from lube.pipeline.stamps import stamp
from lube.storage.provenance import global_attributes
from lube.units import with_unit

matplotlib.use("Agg")
plt = plots.plt


@pytest.fixture(autouse=True)
def own_style():
    """Every test starts from Matplotlib's defaults and leaves no figure open."""
    with matplotlib.rc_context():
        yield
    plt.close("all")


def quantity(value, units, name="film thickness"):
    return xr.DataArray(value, attrs={"units": units, "long_name": name})


def test_units_are_converted_and_named():
    cases = [("m", "um", 1e6), ("m2 s-1", "mm2 s-1", 1e6), ("Pa-1", "GPa-1", 1e9), ("m", "m", 1.0)]
    for units, wanted, factor in cases:
        converted = plots.in_units(quantity([1.0, 2.0], units), wanted)
        np.testing.assert_allclose(converted, [factor, 2.0 * factor], rtol=1e-12)
        assert converted.attrs == {"units": wanted, "long_name": "film thickness"}


def test_axis_labels_come_from_the_attributes():
    assert plots.axis_label(quantity(1.0, "um"), "$h_0$") == "Film thickness $h_0$ (µm)"
    assert plots.axis_label(quantity(1.0, "1", "lambda ratio")) == "Lambda ratio"
    assert plots.axis_label(quantity(1.0, "h-1", "rate")) == "Rate (1/h)"


def test_every_level_has_a_colour_and_a_marker_of_its_own():
    levels = [100.0, 200.0, 400.0, 800.0, 1600.0]
    assert len({tuple(colour) for colour in plots.level_colours(levels).values()}) == 5
    assert len(set(plots.level_markers(levels).values())) == 5


def test_the_style_leaves_the_users_other_settings():
    plt.rcParams.update({"image.cmap": "magma", "font.size": 20})
    plots.use_style()
    assert plt.rcParams["image.cmap"] == "magma"
    assert plt.rcParams["font.size"] == 9


def test_a_probability_of_zero_hangs_from_its_limit_on_a_logarithmic_scale():
    """Unless its limit is zero too: one below the smallest number there is."""
    x, mean = np.array([1.0, 2.0, 3.0]), np.array([0.0, 0.1, 0.0])
    lower, upper = np.array([0.0, 0.05, 0.0]), np.array([1e-3, 0.2, 0.0])
    shown = {"log": ([np.nan, 0.1, np.nan], [1e-3]), "linear": ([0.0, 0.1, 0.0], [])}
    for scale, (drawn, limits) in shown.items():
        _, axes = plt.subplots()
        axes.set_yscale(scale)
        plots.interval_bars(axes, x, mean, lower, upper, color="black", marker="o")
        points, arrows = (container[0] for container in axes.containers)
        np.testing.assert_array_equal(points.get_ydata(), drawn)
        assert arrows.get_ydata().tolist() == limits


def test_points_outside_a_panel_are_marked_at_its_edge_in_their_colour():
    _, axes = plt.subplots()
    axes.errorbar([0, 1, 2, 3], [0.5, 9.0, -1.0, 0.5], yerr=0.1, capsize=2, fmt="o", color="red")
    axes.set(xlim=(0.5, 2.5), ylim=(0, 1))
    before = len(axes.lines)
    plots.mark_outside(axes)
    marks = {line.get_marker(): line for line in axes.lines[before:]}
    places = {marker: line.get_xydata().tolist() for marker, line in marks.items()}
    assert places == {
        CARETUP: [[1.0, 1.0]],
        CARETDOWN: [[2.0, 0.0]],
        CARETRIGHT: [[2.5, 0.5]],
        CARETLEFT: [[0.5, 0.5]],
    }
    assert {line.get_color() for line in marks.values()} == {"red"}


def test_marks_around_points_outside_a_panel_move_to_its_edge_with_them():
    _, axes = plt.subplots()
    axes.plot([1, 2], [0.5, 9.0], "o", color="red")
    axes.plot([1, 2], [0.5, 9.0], **plots.around("s"))
    axes.set(xlim=(0.5, 2.5), ylim=(0, 1))
    plots.mark_outside(axes)
    _, around, mark = axes.lines
    assert around.get_xydata().tolist() == [[1.0, 0.5], [2.0, 1.0]] and not around.get_clip_on()
    assert mark.get_xydata().tolist() == [[2.0, 1.0]]


def test_an_edge_cuts_no_marker_of_points_within_it():
    _, axes = plt.subplots()
    (within,), (outside,) = axes.plot([1, 2], [0, 1], "o"), axes.plot([1, 2], [0, 3], "o")
    axes.set_ylim(0, 1)
    plots.mark_outside(axes)
    assert (within.get_clip_on(), outside.get_clip_on()) == (False, True)


@pytest.mark.parametrize(
    ("values", "scale", "least", "top"),
    [([0.2, 0.98], "linear", 0.0, 1.0), ([0.2, 0.4], "linear", 0.0, 0.42), ([], "linear", 0.0, 1.0),
     ([0.01, 0.8], "log", 1e-3, 1.0), ([0.01, 0.1], "log", 1e-3, 0.15)],
)  # fmt: skip
def test_axes_of_probabilities_end_at_one_or_above_the_data_and_cut_no_marker(
    values, scale, least, top
):
    _, axes = plt.subplots()
    axes.set_yscale(scale)
    (points,) = axes.plot(range(len(values)), values, "o")
    (below,) = axes.plot([0.0], [least - 0.1], "o")
    plots.probability_limits(axes, least=least)
    np.testing.assert_allclose(axes.get_ylim(), (least, top))
    assert not points.get_clip_on() and below.get_clip_on()


def test_a_logarithmic_panel_of_zeros_alone_has_limits_without_a_warning():
    _, axes = plt.subplots()
    axes.set_yscale("log")
    axes.plot([40.0, 60.0], [0.0, 0.0], "o")
    with warnings.catch_warnings(action="error"):
        plots.probability_limits(axes, least=1e-3)
    assert axes.get_ylim() == (1e-3, 1.0)


def test_units_are_spelt_alike_in_figures_and_text():
    for unit in ("rpm", "degC", "ohm"):
        assert plots.level_name(2.0, unit) == with_unit(2.0, unit)


@pytest.mark.parametrize(
    ("value", "words"),
    [
        (600 / 7, "86 N"),
        (112.5, "112.5 N"),
        (80.2, "80.2 N"),
        (71.34, "71.34 N"),
        (1600.0, "1600 N"),
    ],
)
def test_levels_are_named_by_their_digits_if_these_are_few(value, words):
    assert plots.level_name(value, "N") == words


@pytest.fixture
def records():
    """Three records of two pairs of rollers, the last not at a level of force."""
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


def test_rig_and_records_are_named(records):
    assert plots.rig_name(records) == "measured rig, 2 pairs of rollers"
    one = records.assign(pairs=1, drift=0.3).assign_coords(origin="simulated")
    assert plots.rig_name(one) == "simulated rig, 1 pair of rollers, drift 0.3 per revolution"
    first, last = records.isel(record=0), records.isel(record=2)
    conditions = "1603 N, 100 r/min, 80 °C"
    assert plots.record_name(first) == f"run1.nc (list.csv: line 2)\n{conditions}"
    whole = "in-a-folder-of-a-long-name.csv (list.csv: line 4)"
    assert plots.record_name(last).splitlines()[0] == whole
    assert plots.record_name(first, pairs=2).splitlines()[0].endswith("line 2), pair A")
    simulated = first.assign_coords(origin="simulated")
    assert plots.record_name(simulated) == conditions
    assert plots.record_name(simulated, pairs=2) == f"pair A\n{conditions}"


def test_operating_points_are_named_by_what_else_differs():
    coords = {
        "lubricant": ("operating_point", ["n-dodecane", "squalane"]),
        "film_formula": ("operating_point", ["paper", "moes"]),
        "slide_to_roll_ratio": ("operating_point", [0.0, 0.0]),
    }
    points = xr.Dataset(coords=coords)
    assert plots.other_names(points) == [
        "n-dodecane, film formula paper",
        "squalane, film formula moes",
    ]
    assert plots.other_names(points.isel(operating_point=[0, 0])) == ["", ""]


def test_records_are_grouped_by_their_levels(records):
    groups = plots.level_groups(records, "force")
    assert [name for name, *_ in groups] == ["800 N", "1600 N", "not at a level"]
    assert [here.force.values.tolist() for *_, here in groups] == [[800.0], [1603.0], [1205.0]]
    assert len(plots.level_groups(records.isel(record=[0]), "force")) == 1


def test_panels_are_lettered_before_their_titles():
    plots.use_style()
    _, panels = plt.subplots(1, 2)
    panels[1].set_title("slow")
    plots.panel_letters(panels)
    assert [panel.get_title(loc="left") for panel in panels] == ["(a)", "(b) slow"]


def test_a_logarithmic_axis_has_plain_labels_however_short_it_is():
    cases = {
        (15.0, 120.0): ["20", "50", "100"],
        (0.5, 1500.0): ["1", "10", "100", "1000"],
        (0.7, 1.4): ["0.8", "1", "1.2", "1.4"],
        (1.02, 1.07): ["1.02", "1.03", "1.04", "1.05", "1.06", "1.07"],
    }
    for (low, high), labels in cases.items():
        figure, axes = plt.subplots()
        axes.set(yscale="log", ylim=(low, high))
        plots.plain_log_ticks(axes.yaxis)
        figure.canvas.draw()
        ticks = zip(axes.get_yticks(), axes.get_yticklabels(), strict=True)
        shown = [text for at, text in ticks if low * (1 - 1e-9) <= at <= high * (1 + 1e-9)]
        assert [text.get_text() for text in shown] == labels


def test_plain_labels_along_a_narrow_panel_are_those_that_fit():
    for number, labels in ((1, 6), (4, 2)):
        canvas = plt.figure(figsize=(7.2, 3.0)).subfigures()
        panel = np.ravel(canvas.subplots(1, number))[0]
        panel.set(xscale="log", xlim=(0.0018, 0.13))
        plots.plain_log_ticks(panel.xaxis)
        ticks = panel.get_xticks()
        assert np.count_nonzero((ticks > 0.0018) & (ticks < 0.13)) == labels


# Saving


@pytest.fixture(scope="module")
def shown(study):
    """An empty dataset with the origin of a film table."""
    return xr.Dataset(attrs=global_attributes(study, "film"))


def test_a_footnote_names_all_that_several_datasets_hold():
    figure, _ = plt.subplots()
    one = xr.Dataset(coords={"lubricant": "squalane", "slide_to_roll_ratio": 0.1})
    plots.footnote(figure, one, one.assign_coords(slide_to_roll_ratio=[0.0, 0.1]))
    assert figure.get_supxlabel().strip() == "squalane · slide-to-roll ratio 0, 0.1"


def test_stamp_and_footnote_stand_below_everything_else(tmp_path, shown):
    plots.use_style()
    for footnote in (False, True):
        figure, axes = plt.subplots()
        axes.set_xlabel("Force (N)")
        if footnote:
            plots.footnote(figure, shown.assign_coords(slide_to_roll_ratio=[0.0, 0.1]))
            assert figure.get_supxlabel().strip() == "slide-to-roll ratio 0, 0.1"
        plots.save_figure(figure, tmp_path / "figure", shown)
        figure.canvas.draw()
        bottom = axes.xaxis.label.get_window_extent().y0
        if footnote:
            words = figure._supxlabel.get_window_extent()
            assert words.y1 <= bottom
            bottom = words.y0 + words.height / 2  # it ends in an empty line
        (line,) = (text for text in figure.texts if text.get_text() == stamp([shown]))
        assert line.get_window_extent().y0 >= 0
        assert line.get_window_extent().y1 <= bottom
    with Image.open(tmp_path / "figure.png") as picture:
        assert picture.text["Description"] == stamp([shown])


def test_a_long_label_is_folded_to_its_panel_and_keeps_numbers_with_their_units(study):
    plots.use_style()
    canvas, axes = plt.subplots(figsize=(2.2, 2.2))
    axes.set_title("(a) 1600 N, 100 r/min, 40 °C: in contact", loc="left")
    plots.save_figure(canvas, None, xr.Dataset(attrs=global_attributes(study, "film")))
    canvas.draw_without_rendering()
    words = axes.get_title(loc="left")
    assert words.replace("\n", " ") == "(a) 1600 N, 100 r/min, 40 °C: in contact"
    assert all(f"{number}\n" not in words for number in ("(a)", "1600", "100", "40"))
    title = axes.set_title(words, loc="left")
    assert title.get_window_extent().width <= axes.get_window_extent().width


def test_a_label_folded_twice_is_folded_from_its_own_lines(study):
    plots.use_style()
    canvas, panels = plt.subplots(1, 3, figsize=(7.2, 2.8))
    for panel, label in zip(
        panels, ("Bandwidth (Hz)", "Contact share below 100 Ω", ""), strict=True
    ):
        panel.set_xlabel(label)
        panel.set_ylabel("Simulated rig's share /\ntrue share")
    panels[0].set_title("(a) 800 N, 200 r/min, 90 °C", loc="left")
    record = "(c) run1.csv (recs.csv: line 3), pair A\n400 N, 200 r/min, 90.3 °C"
    panels[2].set_title(record, loc="left")
    plots.save_figure(canvas, None, xr.Dataset(attrs=global_attributes(study, "film")))
    words = panels[2].get_title(loc="left")
    assert "(recs.csv: line 3)," in words.splitlines()
    assert words.replace("\n", " ") == record.replace("\n", " ")


def test_the_legend_names_each_label_once_and_fits_the_figure():
    plots.use_style()
    canvas, panels = plt.subplots(1, 2, figsize=(4, 2))
    for panel, levels in zip(panels, (range(5), range(3, 12)), strict=True):
        for level in levels:
            panel.plot([0, 1], [0, level], label=f"{level} newtons")
    plots.legend_above(canvas, panels, "Force")
    (legend,) = canvas.legends
    assert [text.get_text() for text in legend.get_texts()] == [f"{n} newtons" for n in range(12)]
    assert legend.get_window_extent().width <= canvas.bbox.width


def test_a_logarithmic_axis_of_few_decades_has_plain_numbers():
    for high, ticks in ((30.0, ["1", "2", "5", "10", "20"]), (1e6, None)):
        _, axes = plt.subplots()
        axes.set(xscale="log", xlim=(1.0, high))
        plots.log_ticks(axes.xaxis)
        labels = [text.get_text() for text in axes.get_xticklabels() if text.get_text()]
        assert ticks is None or set(ticks) <= set(labels)
        assert ticks is not None or all("10^" in label for label in labels)


@pytest.mark.parametrize("limits", [(0.145, 0.48), (0.29, 0.46), (0.6, 4.0)])
def test_a_logarithmic_axis_within_a_decade_has_labels(limits):
    plots.use_style()
    _, panels = plt.subplots(1, 3, figsize=(7.2, 3.2))
    panels[1].set(xscale="log", xlim=limits)
    plots.log_ticks(panels[1].xaxis)
    low, high = limits
    assert sum(low <= tick <= high for tick in panels[1].xaxis.get_majorticklocs()) >= 2
