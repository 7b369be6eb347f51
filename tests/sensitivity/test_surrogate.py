import numpy as np
import pytest
import scipy.special

from lube.sensitivity.surrogate import Surrogate, held_out, interpolant


def points(count, variables=3):
    rng = np.random.default_rng(count)
    return rng.uniform([[0.5]] * variables, [[4.0]] * variables, (variables, count))


def smooth(variables):
    one, two, three = variables
    return np.stack([np.sin(one) * two - three, two**2 - three], axis=1)


def test_a_smooth_function_is_met_between_its_points():
    known, new = points(800), points(50)
    found = interpolant(known, smooth(known), 10.0)(new)
    np.testing.assert_allclose(found, smooth(new), atol=0.05)
    np.testing.assert_allclose(
        interpolant(known, smooth(known), 1e3)(known), smooth(known), atol=1e-4
    )


def test_a_linear_function_is_met_everywhere():
    known, new = points(20), 10.0 * points(50)
    found = interpolant(known, (known[:1] - 2.0 * known[1:2]).T)(new)
    np.testing.assert_allclose(found, (new[:1] - 2.0 * new[1:2]).T, rtol=1e-8)


def test_a_variable_that_does_not_vary_is_left_out_and_a_repeated_one_does_no_harm():
    known, new = points(300), points(50)

    def more(variables):
        constant = np.full((1, variables.shape[1]), 7.0)
        return np.concatenate([variables, constant, variables[:1] * 2.0])

    found = interpolant(more(known), smooth(known), 10.0)
    np.testing.assert_allclose(found(more(new)), smooth(new), atol=0.2)
    new = more(new)
    elsewhere = np.concatenate([new[:3], new[3:4] + 1.0, new[4:]])
    np.testing.assert_array_equal(found(elsewhere), found(new))


def test_equal_points_count_once():
    known = points(100)
    twice = np.concatenate([known, known], axis=1)
    values = smooth(twice)
    values[100:] += 5.0
    found = interpolant(twice, values, 1e3)(known)
    np.testing.assert_allclose(found, smooth(known), atol=1e-4)


def quantile(variables):
    return -1.2 * variables[0] + 0.1 * variables[0] * variables[1] + 0.3


def test_a_probability_is_found_again_at_any_rarity():
    known = points(400, 2) * [[2.0], [1.0]]
    probability = scipy.special.ndtr(quantile(known))[:, None] * [1.0, 1.05]
    probability[::50, 0] = np.nan  # whose film is not known
    found = Surrogate.of(known, probability, (), False)
    logarithm = found.log_probability(known)
    expected = scipy.special.log_ndtr(quantile(known))
    np.testing.assert_allclose(logarithm[:, 0], expected, rtol=2e-3, atol=0.03)
    np.testing.assert_allclose(logarithm[:, 1], expected + np.log(1.05), rtol=2e-3, atol=0.03)
    missed = found.missed[np.isfinite(found.missed)]
    assert missed.size == held_out(392) == 98
    assert np.median(np.abs(missed)) < 0.01 and np.abs(missed).max() < 0.5
    assert np.isnan(found.missed[::50]).all()


def test_another_choice_needs_fewer_runs_beside_the_first():
    known = points(400, 2)
    first = Surrogate.of(known, scipy.special.ndtr(quantile(known))[:, None], (), False)
    some = points(12, 3)
    shifted = quantile(some) + 0.2 * some[2] - 0.1
    probability = scipy.special.ndtr(shifted)[:, None]
    second = Surrogate.of(some, probability, first.parts, False)
    new = points(50, 3)
    expected = scipy.special.log_ndtr(quantile(new) + 0.2 * new[2] - 0.1)
    np.testing.assert_allclose(second.log_probability(new)[:, 0], expected, rtol=0.01, atol=0.01)
    assert np.isfinite(second.missed).tolist() == [False] * 9 + [True] * 3
    assert second.missed[-3:] == pytest.approx(0.0, abs=0.05)


def test_runs_of_a_sum_only_show_its_error():
    known = points(400, 2)
    first = Surrogate.of(known, scipy.special.ndtr(quantile(known))[:, None], (), False)
    some = points(12, 2)
    found = Surrogate.of(some, 1.1 * scipy.special.ndtr(quantile(some))[:, None], first.parts, True)
    assert found.parts == first.parts
    assert found.missed == pytest.approx(-np.log(1.1), abs=0.05)


def test_where_contact_is_certain_the_quantile_counts_for_nothing():
    known = points(400, 2)
    certain = known[0] < 1.0
    probability = np.where(certain, 1.0, scipy.special.ndtr(quantile(known)))[:, None]
    found = Surrogate.of(known, probability, (), False).log_probability(known)[~certain, 0]
    np.testing.assert_allclose(found, np.log(probability[~certain, 0]), rtol=0.01, atol=0.02)
