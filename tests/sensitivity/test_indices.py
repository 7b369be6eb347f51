import numpy as np
import pytest

from lube.sensitivity.indices import morris, sobol

NAMES = ["first", "second", "third"]


def ishigami(unit):
    """The function of Ishigami and Homma, whose indices are known, and a linear one."""
    one, two, three = (2.0 * np.pi * unit - np.pi).T
    wavy = np.sin(one) + 7.0 * np.sin(two) ** 2 + 0.1 * three**4 * np.sin(one)
    return np.stack([wavy, unit @ [3.0, 2.0, 0.0]], axis=1)


def test_indices_of_ishigamis_function_and_of_a_linear_one():
    variance = [0.5 * (1 + 0.1 * np.pi**4 / 5) ** 2, 49.0 / 8.0, 0.0]
    together = 0.01 * np.pi**8 * (1 / 18 - 1 / 50)
    whole = sum(variance) + together
    found, values = sobol(NAMES, ishigami, seed=1)
    wavy = {name: each[:, 0] for name, each in found.items()}
    np.testing.assert_allclose(wavy["first_order"], np.array(variance) / whole, atol=0.03)
    expected = np.array([variance[0] + together, variance[1], together]) / whole
    np.testing.assert_allclose(wavy["total_effect"], expected, atol=0.03)
    error = wavy["total_effect_upper"] - wavy["total_effect"]
    assert (np.abs(wavy["total_effect"] - expected) < 1.5 * error).all()
    assert values.shape == (2048, 2)
    assert values[:, 0].var() == pytest.approx(whole, rel=0.05)
    linear = np.array([9.0, 4.0, 0.0]) / 13.0
    np.testing.assert_allclose(found["first_order"][:, 1], linear, atol=0.01)
    np.testing.assert_allclose(found["total_effect"][:, 1], linear, atol=0.01)


def test_a_group_has_the_effects_of_its_factors_together():
    found, _ = sobol(NAMES, ishigami, seed=1, groups=["one", "other", "one"])
    np.testing.assert_allclose(found["first_order"].sum(axis=0), 1.0, atol=0.03)
    np.testing.assert_allclose(found["total_effect"], found["first_order"], atol=0.06)
    np.testing.assert_allclose(found["first_order"][:, 1], np.array([9.0, 4.0]) / 13.0, atol=0.02)


def test_the_elementary_effects_of_a_linear_function_are_its_slopes():
    found = morris(NAMES, ishigami, 1, {})
    np.testing.assert_allclose(found["elementary_effect"][:, 1], [3.0, 2.0, 0.0], atol=1e-9)
    np.testing.assert_allclose(found["elementary_effect_deviation"][:, 1], 0.0, atol=1e-9)
    assert (found["elementary_effect_deviation"][[0, 2], 0] > 1.0).all()


def test_a_choice_changes_the_function_by_what_lies_between():
    def predict(unit):
        return np.column_stack([5.0 * (unit[:, 0] >= 0.5) + unit[:, 1]])

    found = morris(NAMES[:2], predict, seed=1, choices={"first": 2})
    np.testing.assert_allclose(found["elementary_effect"][:, 0], [5.0, 1.0])
    # Of a choice between two 5/2, of a uniform number 1/12^0.5.
    np.testing.assert_allclose(found["screened_deviation"][:, 0], [2.5, 12**-0.5], rtol=0.05)


def test_a_choice_among_several_goes_from_any_to_any():
    def predict(unit):
        return np.column_stack([np.floor(6.0 * unit[:, 0]) + unit[:, 1]])

    found = morris(NAMES[:2], predict, seed=1, choices={"first": 6})
    whole = np.std(np.arange(6.0))
    np.testing.assert_allclose(found["screened_deviation"][:, 0], [whole, 12**-0.5], rtol=0.05)


def test_screened_deviations_are_those_of_the_total_effects():
    found = morris(NAMES, ishigami, 1, {})["screened_deviation"]
    exact = [0.5 * (1 + 0.1 * np.pi**4 / 5) ** 2, 49.0 / 8.0, 0.0]
    together = 0.01 * np.pi**8 * (1 / 18 - 1 / 50)
    wavy = np.sqrt(np.add(exact, [together, 0.0, together]))
    np.testing.assert_allclose(found[:, 0], wavy, rtol=0.05)
    linear = np.array([3.0, 2.0, 0.0]) / np.sqrt(12.0)
    np.testing.assert_allclose(found[:, 1], linear, rtol=0.02, atol=1e-9)


def test_a_point_without_a_value_or_without_a_change_has_no_indices():
    def predict(unit):
        first = np.where(np.arange(len(unit)) == 0, np.nan, unit[:, 0])
        return np.stack([first, np.zeros(len(unit))], axis=1)

    found, _ = sobol(NAMES, predict, seed=1)
    assert all(np.isnan(each).all() for each in found.values())
    assert np.isnan(morris(NAMES, predict, 1, {})["elementary_effect"][:, 0]).all()


def test_intervals_are_the_same_each_time_for_any_seed():
    for seed in (0, 1, 2**40):
        one, other = (sobol(NAMES, ishigami, seed)[0] for _ in range(2))
        np.testing.assert_array_equal(one["total_effect_upper"], other["total_effect_upper"])
        first, second = (
            morris(NAMES, ishigami, seed, {})["elementary_effect_upper"] for _ in range(2)
        )
        np.testing.assert_array_equal(first, second)
