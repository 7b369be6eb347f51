"""Records folded by the revolution: known periods, known shares of what repeats."""

import numpy as np
import pytest

from lube.statistics.folding import CLEAR, PHASES, fold, refined_period

INTERVAL = 1e-3


def periodic(period, turns, noise=0.0, seed=1, blocks=16):
    """A record that repeats itself, and noise that does not, of given shares of the variance."""
    rng = np.random.default_rng(seed)
    levels = rng.normal(size=blocks)
    time = (np.arange(int(turns * period / INTERVAL)) + 0.5) * INTERVAL
    repeated = levels[(time / period % 1.0 * blocks).astype(int)]
    repeated = (repeated - repeated.mean()) / repeated.std()
    return np.sqrt(1.0 - noise) * repeated + np.sqrt(noise) * rng.normal(size=time.size)


def test_a_period_that_is_not_quite_the_nominal_one_is_found():
    period = 0.4003
    for noise in (0.0, 0.3):
        record = periodic(period, 30.5, noise)
        for off in (-0.01, 0.0, 0.01, 0.04):
            found = refined_period(record, INTERVAL, period * (1.0 + off))
            assert found == pytest.approx(period, rel=1e-4)


def test_the_longer_the_record_the_better_is_its_period_known():
    period = 0.40037
    errors = [
        abs(
            fold(periodic(period, turns, 0.1), INTERVAL, 0.99 * period).revolution_period / period
            - 1.0
        )
        for turns in (2.5, 200.5)
    ]
    assert errors[1] < 1e-5 < errors[0] < 5e-3


def test_a_period_far_from_the_nominal_one_is_not_taken():
    folded = fold(periodic(0.4, 20), INTERVAL, 0.48)
    assert folded.repeatability < CLEAR
    assert folded.revolution_period == 0.48


def test_several_repetitions_in_a_turn_leave_the_nominal_period():
    for waves in (2, 7, 60):
        record = np.where(np.arange(12_000) * waves // 300 % 2, 1.0, 0.0)  # a turn is 600 long
        assert fold(record, INTERVAL, 0.6).revolution_period == pytest.approx(0.6, rel=1e-3)


def test_a_record_that_repeats_itself_exactly_does_so_wholly():
    folded = fold(periodic(0.4, 10), INTERVAL, 0.4)
    assert folded.repeatability == pytest.approx(1.0, abs=1e-9)
    assert folded.share_error == pytest.approx(0.0, abs=1e-12)
    assert folded.revolution_period == pytest.approx(0.4, rel=1e-4)


def test_the_repeatability_is_the_share_of_the_variance_that_repeats():
    for noise in (0.2, 0.4):
        folded = fold(periodic(0.4, 50, noise), INTERVAL, 0.4)
        assert folded.repeatability == pytest.approx(1.0 - noise, abs=0.02)


def test_independent_revolutions_have_nothing_in_common():
    record = np.random.default_rng(2).random(4000)
    folded = fold(record, INTERVAL, 0.4)
    assert folded.repeatability == pytest.approx(0.0, abs=0.05)
    assert folded.revolution_period == 0.4
    # Of the nominal turns, and not of the period at which chance repeats best.
    turns = (record - record.mean()).reshape(10, 400)
    couples = [np.mean(turns[i] * turns[j]) for i in range(10) for j in range(i)]
    assert folded.repeatability == pytest.approx(np.mean(couples) / np.mean(turns**2))


def test_the_profile_is_the_known_one_and_the_deviation_that_between_turns():
    shape = np.random.default_rng(3).random(PHASES)
    turns = np.array([0.0, 0.1, 0.2])
    folded = fold((shape + turns[:, None]).ravel(), 1.0, float(PHASES))
    np.testing.assert_allclose(folded.folded_share, shape + 0.1, rtol=1e-12)
    np.testing.assert_allclose(folded.folded_deviation, 0.1, rtol=1e-9)


def test_few_blocks_in_a_turn_fill_all_phases_in_their_order():
    for blocks in (1, 2, 4, 7, 8, 16):
        shape = np.arange(blocks) ** 2.0
        folded = fold(np.tile(shape, 12), 1.0, float(blocks))
        assert folded.revolution_period == pytest.approx(blocks, rel=0.03)
        assert np.isnan(folded.repeatability) == (blocks < 8)
        np.testing.assert_allclose(folded.folded_share, shape[np.arange(PHASES) * blocks // PHASES])


def test_a_record_shorter_than_a_turn_shows_no_repetition():
    for turns in (0.3, 0.99):
        folded = fold(periodic(0.4, turns), INTERVAL, 0.4)
        assert np.isnan(folded.repeatability)
        assert (folded.revolution_period, folded.share_error) == (0.4, 0.0)
        assert np.isfinite(folded.folded_share).mean() == pytest.approx(turns, abs=0.01)
        assert np.isnan(folded.folded_deviation).all()


def test_a_constant_record_has_no_period_of_its_own():
    for share in (0.0, 0.3, 1.0):
        folded = fold(np.full(4000, share), INTERVAL, 0.4)
        assert np.isnan(folded.repeatability)
        assert (folded.revolution_period, folded.share_error) == (0.4, 0.0)
        np.testing.assert_allclose(folded.folded_share, share)


def test_the_error_of_the_share_is_the_scatter_of_whole_turns():
    record = np.random.default_rng(4).random(1030)  # ten turns and a rest
    turns = record[:1000].reshape(10, 100).mean(axis=1)
    expected = turns.std(ddof=1) / np.sqrt(10.0)
    assert fold(record, 1.0, 100.0).share_error == pytest.approx(expected)
    # One whole turn has no scatter.
    assert fold(np.random.default_rng(5).random(199), 1.0, 100.0).share_error == 0.0


def test_samples_further_apart_than_a_turn_scatter_as_the_turns_that_they_fall_in():
    record = np.random.default_rng(6).random(50)
    assert fold(record, 1.0, 0.6).share_error == pytest.approx(record.std(ddof=1) / np.sqrt(50.0))
