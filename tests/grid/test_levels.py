"""Which level a number or a name stands for."""

from lube.grid.levels import NEAR, SAME, level_index, level_near

SPEEDS = [60.0, 600.0 / 7.0, 100.0]


def test_a_number_stands_for_the_first_level_near_it():
    cases = [(100, 2), (86, 1), (85.7, 1), (100.5, 2), (100.6, None), (-60.0, None)]
    for wanted, index in cases:
        assert level_index(SPEEDS, wanted) == index
    assert level_index([100.0, 100.1], 100.05) == 0


def test_the_tolerance_is_relative_to_the_level():
    for within in (NEAR, SAME):
        for side in (-within, within):
            assert level_index([1e-9, 1e9], 1e9 * (1.0 + 0.99 * side), within) == 1
            assert level_index([1e-9, 1e9], 1e9 * (1.0 + 1.01 * side), within) is None


def test_names_match_letter_by_letter_and_never_a_number():
    assert level_index(["paper", "pan-hamrock"], "pan-hamrock") == 1
    assert level_index(["paper"], "pap") is None
    for wanted in ("800", None, float("nan")):
        assert level_index([800.0], wanted) is None


def test_a_measured_value_stands_for_the_nearest_level_within_its_tolerance():
    for value, level in [(80.0, 80.0), (81.0, 80.0), (79.0, 80.0), (81.001, None), (60.0, None)]:
        assert level_near([40.0, 80.0], value, 1.0) == level
    assert level_near([40.0, 41.0], 40.6, 5.0) == 41.0
    assert level_near([41.0, 40.0], 40.4, 5.0) == 40.0
