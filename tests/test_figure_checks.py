"""The checker of figures finds each fault, and nothing in a figure without one."""

import matplotlib
import numpy as np
import pytest
from figure_checks import faults

from lube import plots

matplotlib.use("Agg")
plt = plots.plt


@pytest.fixture(autouse=True)
def own_style():
    with matplotlib.rc_context():
        plots.use_style()
        yield
    plt.close("all")


@pytest.fixture
def panels():
    """Two lettered panels with some points each."""
    _, panels = plt.subplots(1, 2, figsize=(7, 3))
    for panel in panels:
        panel.plot([1, 2, 3], [0.2, 0.5, 0.9], "o", label="points")
        panel.set(xlabel="Temperature (°C)", ylabel="Probability")
    plots.panel_letters(panels)
    return panels


def faults_of(panels):
    return "\n".join(faults(panels[0].figure))


def test_a_good_figure_has_no_faults(panels):
    panels[0].legend(loc="upper left")
    panels[1].axhline(0.87)
    panels[1].legend(loc="upper left")
    plots.footnote(panels[0].figure, plots.xr.Dataset(coords={"film_formula": "paper"}))
    assert faults_of(panels) == ""


def test_text_must_not_collide_or_be_cut(panels):
    panels[0].text(1, 0.5, "one word")
    panels[0].text(1.1, 0.5, "another", rotation=30)
    assert faults_of(panels) == "text 'one word' overlaps 'another'"
    panels[0].texts[1].set_position((2.5, 0.2))
    assert faults_of(panels) == ""
    panels[0].figure.text(0.9, 0.005, "the end of a long line")
    assert "text 'the end of a long line' is cut by the figure's edge" in faults_of(panels)


def test_words_must_not_cover_points(panels):
    panels[0].text(1.8, 0.49, "a result")
    assert faults_of(panels) == "text 'a result' covers points"


def test_labels_must_be_shorter_than_their_panels(panels):
    panels[1].set_ylabel("A label that is longer than the panel is high, with its unit (m)")
    panels[0].set_title("(a) A title that is longer than its panel is wide, as well", loc="left")
    found = faults_of(panels)
    assert "label 'A label that is longer than the panel is high, with its unit (m)' is" in found
    assert "label '(a) A title that" in found


@pytest.mark.parametrize(
    "draw",
    [
        lambda axes: axes.plot([1, 3], [0.2, 1.0]),
        lambda axes: axes.plot([2.9], [0.95], "o"),
        lambda axes: axes.scatter([2.9], [0.95]),
        lambda axes: axes.errorbar([2.9], [0.2], yerr=[[0], [0.78]], linestyle="none"),
        lambda axes: axes.fill_between([1, 3], [1.0, 1.0]),
        lambda axes: axes.bar([2.9], [0.97]),
    ],
)
def test_a_legend_must_not_cover_data(draw):
    _, axes = plt.subplots()
    axes.set(xlim=(0.5, 3.2), ylim=(0, 1))
    axes.axhline(0.95, label="threshold")
    axes.legend(loc="upper right")
    assert faults(axes.figure) == []
    draw(axes)
    assert faults(axes.figure) == ["the legend ['threshold'] covers data"]


def test_a_line_with_a_gap_is_not_covered_by_a_legend_in_the_gap():
    _, axes = plt.subplots()
    axes.plot([0, 1, 2, 3, 4], [1, 1, np.nan, 1, 1], label="line")
    axes.set_ylim(0, 2)
    axes.legend(loc="center")
    assert faults(axes.figure) == []


def test_points_outside_need_a_mark(panels):
    panels[1].plot([0.5, 2, 9], [0.5, -3, 7], "s")
    panels[1].set(xlim=(1, 4), ylim=(0, 1))
    assert "3 points lie outside panel '(b)', without a mark at its edge" in faults_of(panels)
    plots.mark_outside(panels[1])
    assert faults_of(panels) == ""


def test_points_at_an_edge_must_not_be_cut(panels):
    panels[1].set_ylim(0, 0.9)
    assert faults_of(panels) == "1 points are cut by the edge of panel '(b)'"
    panels[1].lines[0].set_clip_on(False)
    assert faults_of(panels) == ""


def test_a_zero_has_no_place_on_a_logarithmic_axis():
    _, axes = plt.subplots()
    axes.plot([1, 2], [0.0, 1.0], "o")
    axes.set_yscale("log")
    assert len(faults(axes.figure)) == 1


def test_panels_need_letters_and_content_and_legends_words(panels):
    panels[1].set_title("fast", loc="left")
    panels[0].legend([], [])
    found = faults_of(panels)
    assert "panel 'fast' has no letter" in found
    assert "a legend is empty" in found
    panels[0].clear()
    panels[0].set_title("(a)", loc="left")
    assert "panel '(a)' is empty" in faults_of(panels)
