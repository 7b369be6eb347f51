"""What means a level, and what does not."""

import pytest

from lube.grid.levels import NEAR, SAME, level_index, level_near, levels_told

SPEEDS = [60.0, 600.0 / 7.0, 100.0]


@pytest.mark.parametrize(
    ("wanted", "index"), [(100, 2), (86, 1), (85.7, 1), (100.5, 2), (100.6, None), (-60.0, None)]
)
def test_what_people_write_means_the_level_near_it(wanted, index):
    assert level_index(SPEEDS, wanted) == index


@pytest.mark.parametrize("within", [NEAR, SAME])
@pytest.mark.parametrize("side", [-1.0, 1.0])
def test_the_distance_is_relative_to_the_level(within, side):
    assert level_index([1e-9, 1e9], 1e9 * (1.0 + 0.99 * side * within), within) == 1
    assert level_index([1e-9, 1e9], 1e9 * (1.0 + 1.01 * side * within), within) is None


def test_names_are_met_letter_by_letter():
    assert level_index(["paper", "pan-hamrock"], "pan-hamrock") == 1
    assert level_index(["paper"], "pap") is None


@pytest.mark.parametrize("wanted", ["800", None, float("nan")])
def test_what_is_no_number_means_no_number(wanted):
    assert level_index([800.0], wanted) is None


def test_of_two_levels_as_near_the_first_is_meant():
    assert level_index([100.0, 100.1], 100.05) == 0


@pytest.mark.parametrize(
    ("value", "level"),
    [(80.0, 80.0), (81.0, 80.0), (79.0, 80.0), (81.001, None), (39.5, 40.0), (60.0, None)],
)
def test_a_measured_value_means_the_level_within_its_tolerance(value, level):
    assert level_near([40.0, 80.0], value, 1.0) == level


def test_a_value_between_two_levels_means_the_nearer():
    assert level_near([40.0, 41.0], 40.6, 5.0) == 41.0
    assert level_near([41.0, 40.0], 40.4, 5.0) == 40.0


def test_levels_are_told_in_a_line():
    assert levels_told(SPEEDS) == "60, 85.7143, 100"
    assert levels_told(["paper", "pan-hamrock"]) == "paper, pan-hamrock"
