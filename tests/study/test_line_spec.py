"""The lines of rollers: each its own band and heights, and what does not fit the grid."""

import math
from functools import partial

import pytest
from refusals import NEEDED, one_line
from studies import PAPER

from lube.errors import LubeError
from lube.study.study import load_study

refusal = partial(one_line, LubeError, load_study)


@pytest.fixture
def study_with(paper_with):
    return lambda *changes: load_study(paper_with(*changes))


def test_a_roller_without_values_of_its_own_has_the_studys(study_with):
    own = {
        "hurst_exponent": 0.9,
        "longest_wavelength": "0.2 mm",
        "shortest_wavelength": "20 points",
        "roll_off_wavelength": "0.1 mm",
        "skewness": -0.5,
        "kurtosis": 4,
    }
    first, second = study_with(("rollers.second.roughness", own)).line_spec.lines
    assert first == load_study(PAPER).line_spec.lines[0]
    assert second.hurst_exponent == 0.9
    lengths = [2.0 * math.pi / q for q in (second.q_min, second.q_max, second.q_roll_off)]
    assert lengths == pytest.approx([2e-4, 20 * 2.0 * math.pi * 0.05 / 1e6, 1e-4])
    assert (second.skewness, second.kurtosis) == (-0.5, 4.0)
    assert first.is_gaussian and not second.is_gaussian
    assert first.q_roll_off == first.q_min


def test_the_longest_wavelength_of_both_is_that_of_the_pair(study_with):
    spec = study_with(("rollers.first.roughness", {"longest_wavelength": "0.2 mm"})).line_spec
    assert spec.q_min == spec.lines[1].q_min < spec.lines[0].q_min
    assert not study_with(("roughness.skewness", -0.1)).line_spec.is_gaussian


def test_a_rollers_own_roughness_is_an_input_of_its_lines_but_not_of_the_film(study_with):
    before, after = load_study(PAPER), study_with(("rollers.first.roughness", {"kurtosis": 4}))
    assert before.stage_inputs("film") == after.stage_inputs("film")
    assert before.stage_inputs("roughness") != after.stage_inputs("roughness")


# Mistakes

OWN = "rollers.second.roughness"
REFUSED = [
    ("roughness.roll_off_wavelength", "1 mm", "roughness.roll_off_wavelength: got 1 mm, need"),
    ("roughness.roll_off_wavelength", "3 um", "from the shortest to the longest wavelength, 3.14"),
    (OWN, {"roll_off_wavelength": "1 mm"}, f"{OWN}.roll_off_wavelength: got 1 mm, need one"),
    (OWN, {"longest_wavelength": "3 um"}, "got 10 points, need less than the longest, 3e-06 m"),
    (OWN, {"shortest_wavelength": "1 mm"}, f"{OWN}.shortest_wavelength: got 1 mm, need less"),
    (OWN, {"shortest_wavelength": "0.1 um"}, "too coarse a grid: its spacing is 3.14e-07 m"),
    (OWN, {"longest_wavelength": "1 m"}, "rollers.second.radius: the perimeter, 0.314 m, is too"),
    (OWN, {"kurtosis": 1.2}, f"{OWN}.kurtosis: got 1.2 with a skewness of 0, need at least 1.5"),
    (
        "roughness.skewness",
        -1.5,
        "roughness.kurtosis: got 3 with a skewness of -1.5, need at least",
    ),
    ("roughness.skewness", -1.5, "none is below 3.25, the skewness squared plus one, and close"),
]


@pytest.mark.parametrize(("key", "value", "needed"), REFUSED)
def test_a_mistake_is_refused_in_one_line(paper_with, key, value, needed):
    message = refusal(paper_with((key, value)))
    assert needed in message
    assert NEEDED.search(message)


def test_a_drift_of_lines_that_are_not_gaussian_is_refused(paper_with):
    message = refusal(paper_with(("rig.drift", 0.1), ("roughness.kurtosis", 4)))
    assert "rig.drift: got 0.1, need 0 for a simulated rig with roughness that is" in message
