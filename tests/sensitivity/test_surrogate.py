import numpy as np
import pytest
import scipy.special

from lube.sensitivity.surrogate import Polynomial, Surrogate, held_out

RNG = np.random.default_rng(3)


def points(count, variables=3):
    return RNG.uniform([[0.5]] * variables, [[4.0]] * variables, (variables, count))


def cubic(variables):
    one, two, three = variables
    return np.stack([one * two * three - 2.0 * one**3 + 1.0, two**2 - three], axis=1)


def test_a_polynomial_is_found_again():
    fitted = Polynomial.fitted(3, points(200), cubic(known := points(200)))
    assert len(fitted.powers) == 20
    fitted = Polynomial.fitted(3, known, cubic(known))
    new = points(50)
    np.testing.assert_allclose(fitted(new), cubic(new), rtol=1e-9, atol=1e-9)


def test_a_variable_that_does_not_vary_is_left_out_and_a_repeated_one_does_no_harm():
    known = points(100)
    wanted = cubic(known)[:, 1:]
    more = np.concatenate([known, np.full((1, 100), 7.0), known[:1] * 2.0])
    fitted = Polynomial.fitted(2, more, wanted)
    assert all(3 not in power for power in fitted.powers)
    new = points(50)
    more = np.concatenate([new, np.full((1, 50), 7.0), new[:1] * 2.0])
    np.testing.assert_allclose(fitted(more), cubic(new)[:, 1:], atol=1e-8)


def quantile(variables):
    return -1.2 * variables[0] + 0.1 * variables[0] * variables[1] + 0.3


def test_a_probability_is_found_again_at_any_rarity():
    known = points(400, 2) * [[2.0], [1.0]]
    probability = scipy.special.ndtr(quantile(known))[:, None] * [1.0, 1.05]
    probability[::50, 0] = np.nan  # whose film is not known
    found = Surrogate.of(4, known, probability)
    logarithm = found.log_probability(known)
    expected = scipy.special.log_ndtr(quantile(known))
    np.testing.assert_allclose(logarithm[:, 0], expected, atol=1e-6)
    np.testing.assert_allclose(logarithm[:, 1], expected + np.log(1.05), atol=5e-3)
    missed = found.missed[np.isfinite(found.missed)]
    assert missed.size == held_out(392) == 98
    assert np.abs(missed).max() < 5e-3
    assert np.isnan(found.missed[::50]).all()


def test_another_choice_needs_fewer_runs_beside_the_first():
    known = points(400, 2)
    first = Surrogate.of(4, known, scipy.special.ndtr(quantile(known))[:, None])
    some = points(12, 3)
    shifted = quantile(some) + 0.2 * some[2] - 0.1
    second = Surrogate.of(1, some, scipy.special.ndtr(shifted)[:, None], first.parts)
    new = points(50, 3)
    expected = scipy.special.log_ndtr(quantile(new) + 0.2 * new[2] - 0.1)
    np.testing.assert_allclose(second.log_probability(new)[:, 0], expected, atol=1e-6)
    assert second.missed[-3:] == pytest.approx(0.0, abs=1e-4)


def test_where_contact_is_certain_the_quantile_counts_for_nothing():
    known = points(300, 2) * [[1.0], [1.0]]
    certain = known[0] < 1.0
    probability = np.where(certain, 1.0, scipy.special.ndtr(quantile(known)))[:, None]
    found = Surrogate.of(4, known, probability).log_probability(known)[~certain, 0]
    np.testing.assert_allclose(found, np.log(probability[~certain, 0]), atol=0.01)
