"""Contact share: the same however the record is divided, with intervals that cover the truth."""

from itertools import pairwise

import numpy as np
import pytest
import scipy.stats
from hypothesis import given
from hypothesis import strategies as st
from kernels.test_threshold import plain_contact

from lube.physics.electrical import divider_voltage
from lube.rig.contact_share import (
    BLOCKS,
    LEAST_BLOCKS,
    STRETCHES,
    ContactShare,
    folded_counts,
    record_counter,
    share_interval,
)
from lube.statistics.confidence import score_interval
from lube.study.rig_settings import Experiment, Rig

LIMITS = [1.0, 2.5, 4.0]
records = st.lists(st.integers(0, 6), max_size=400).map(lambda levels: np.array(levels, float))
cuts = st.lists(st.integers(0, 400), max_size=6).map(sorted)


def count(pieces, *options, **more):
    counter = ContactShare(*options, **more)
    for piece in pieces:
        counter.add(piece)
    return counter


# Counting


@given(records, cuts, st.integers(0, 4), st.sampled_from([None, [1.0, 3.0, 6.0]]))
def test_counts_do_not_depend_on_how_the_record_is_cut(values, places, hold, releases):
    whole = count([values], LIMITS, releases, hold)
    cut = count(np.split(values, places), LIMITS, releases, hold)
    np.testing.assert_array_equal(cut.below, whole.below)
    np.testing.assert_array_equal(cut.sizes, whole.sizes)


@given(records, st.integers(0, 4), st.sampled_from([None, [1.0, 3.0, 6.0]]))
def test_every_block_holds_exactly_its_samples(values, hold, releases):
    counter = count([values], LIMITS, releases, hold)
    assert counter.sizes.sum() == counter.samples == values.size
    edges = np.concatenate([[0], np.cumsum(counter.sizes)])
    for limit, release, row in zip(LIMITS, releases or LIMITS, counter.below, strict=True):
        contact = plain_contact(values, limit, release, hold)
        assert row.tolist() == [contact[a:b].sum() for a, b in pairwise(edges)]


def test_blocks_are_equal_and_as_many_as_fit_in_a_long_record():
    for size in (1, 63, 64, 65, 1000, 2**20, 2**20 + 1):
        values = np.random.default_rng(size).random(size)
        counter = count([values], [0.25])
        sizes = counter.sizes
        assert counter.below.shape == (1, sizes.size)
        assert counter.below.sum() == np.count_nonzero(values < 0.25)
        assert (sizes[:-1] == sizes[0]).all()
        assert 0 < sizes[-1] <= sizes[0]
        assert min(size, BLOCKS // 2) <= sizes.size <= BLOCKS
    assert count([np.array([])], LIMITS).below.shape == (3, 0)


def test_a_record_of_single_precision_is_counted_as_it_is():
    values = np.random.default_rng(3).random(10_000).astype(np.float32)
    expected = [np.count_nonzero(values.astype(float) < limit) for limit in (0.1, 0.7)]
    assert count([values], [0.1, 0.7]).below.sum(axis=1).tolist() == expected


# A study's thresholds

RESISTANCES = np.geomspace(1.0, 1e4, 997)


@pytest.mark.parametrize("release_ratio", [1, 2.5])
def test_a_voltage_is_counted_as_its_resistance(release_ratio):
    rig, experiment = Rig(), Experiment(release_ratio=release_ratio)
    falling_and_rising = np.concatenate([RESISTANCES[::-1], RESISTANCES])
    counts = []
    for quantity, record in (
        ("resistance", falling_and_rising),
        ("voltage", divider_voltage(falling_and_rising, rig)),
    ):
        counter = record_counter(experiment, rig, quantity, 1e-5)
        counter.add(record)
        counts.append(counter.below.sum(axis=1).tolist())
    assert counts[0] == counts[1]
    limits = np.array(experiment.thresholds)[:, None]
    below = [np.sum(edge > RESISTANCES, axis=1) for edge in (limits, release_ratio * limits)]
    assert counts[0] == sum(below).tolist()


def test_a_change_shorter_than_the_debounce_time_does_not_count():
    for debounce, expected in (("0 s", 3), ("30 us", 3), ("40 us", 0)):
        experiment = Experiment(debounce=debounce)
        counter = record_counter(experiment, Rig(), "resistance", 1e-5)
        counter.add(np.array([1e5, 1.0, 1.0, 1.0, 1e5, 1e5, 1e5, 1e5, 1e5]))
        assert counter.below.sum(axis=1).tolist() == [expected] * len(experiment.thresholds)


# Intervals


def markov_records(share, contact, gaps_and_contacts, records, seed):
    """Records of a two-state chain: lasting contacts of mean length `contact`, as booleans."""
    rng = np.random.default_rng(seed)
    gap = contact * (1.0 - share) / share
    samples = round((gap + contact) * gaps_and_contacts)
    for _ in range(records):
        # Begun far before the record, so that its first state is as likely as any.
        number = 4 * round(gaps_and_contacts) + 40
        lengths = np.empty(2 * number, np.int64)
        lengths[::2] = rng.geometric(1.0 / gap, number)
        lengths[1::2] = rng.geometric(1.0 / contact, number)
        record = np.repeat(np.tile([False, True], number), lengths)
        begin = round(20 * (gap + contact))
        yield record[begin : begin + samples]


def interval_of(record, windows):
    counter = count([np.where(record, 0.0, 9.0)], [1.0])
    return [limit.item() for limit in share_interval(counter.below, counter.sizes, windows)]


@pytest.mark.parametrize("contacts", [30, 100, pytest.param(1000, marks=pytest.mark.slow)])
@pytest.mark.parametrize("share", [0.02, 0.2, 0.5, 0.9])
def test_intervals_cover_the_truth_of_correlated_records(share, contacts):
    length = 20.0 * max(share / (1.0 - share), 1.0)
    # Forgotten after the shorter of a contact and a gap.
    windows = contacts / max(share, 1.0 - share)
    covered = []
    for record in markov_records(share, length, contacts, 300, seed=contacts):
        _, lower, upper = interval_of(record, windows)
        covered.append(lower <= share <= upper)
    print(f"share {share}, {contacts} contacts: covered {np.mean(covered):.3f}")
    assert 0.91 <= np.mean(covered) <= 0.99 + 1e-9


def test_independent_samples_have_the_interval_of_their_number():
    record = np.random.default_rng(4).random(2**17) < 0.3
    share, lower, upper = interval_of(record, 1e4)
    assert share == record.mean()
    usual = 1.96 * np.sqrt(0.3 * 0.7 / record.size)
    assert upper - lower == pytest.approx(2.0 * usual, rel=0.5)


def test_correlated_samples_have_a_wider_interval():
    stretches = np.repeat(np.random.default_rng(5).random(2**10) < 0.3, 100)
    _, lower, upper = interval_of(stretches, 1e4)
    shuffled = np.random.default_rng(5).permutation(stretches)
    _, naive_lower, naive_upper = interval_of(shuffled, 1e4)
    assert upper - lower > 5.0 * (naive_upper - naive_lower)


def test_contact_never_or_always_seen_is_bounded_by_the_windows():
    for windows in (1.0, 250.0):
        bound = 1.0 - 0.05 ** (1.0 / windows)
        assert interval_of(np.zeros(1000, bool), windows) == pytest.approx([0.0, 0.0, bound])
        assert interval_of(np.ones(1000, bool), windows) == pytest.approx([1.0, 1.0 - bound, 1.0])


def test_a_record_without_scatter_has_the_interval_of_its_windows():
    """One with too few blocks, or with equal ones."""
    expected = score_interval(0.3, 25.0, scipy.stats.norm.ppf(0.975))
    few = [[1, 2, 3, 4, 5, 3, 3]], [10] * (LEAST_BLOCKS - 1)
    for below, sizes in (([[3]], [10]), ([[3] * 40], [10] * 40), few):
        _, lower, upper = share_interval(below, sizes, 25.0)
        assert [lower.item(), upper.item()] == pytest.approx(expected)


def test_a_short_last_block_counts_for_its_length_only():
    below, sizes = np.array([[10, 20] * 20]), np.full(40, 100)
    short = share_interval(np.append(below, [[1]], axis=1), np.append(sizes, 1), 1e4)
    np.testing.assert_allclose(short, share_interval(below, sizes, 1e4), rtol=0.05)


# Records that repeat themselves


def repeated(turns, samples=1000, blocks=200, seed=7):
    """Counts of a record that shows the same correlated turn again and again."""
    rng = np.random.default_rng(seed)
    contact = np.repeat(rng.random(samples // 20) < 0.3, 20)
    counter = np.tile(contact, turns).reshape(turns * blocks, -1).sum(axis=1)
    return counter[None], np.full(turns * blocks, samples // blocks)


def width(below, sizes, folded=()):
    _, lower, upper = share_interval(below, sizes, 50.0, folded)
    return (upper - lower).item()


def test_more_revolutions_of_the_same_roughness_do_not_narrow_the_interval():
    few, many = repeated(4), repeated(64)
    folded = [folded_counts(*counts, 1.0, 200.0) for counts in (few, many)]
    assert width(*many, folded[1:]) == pytest.approx(width(*few, folded[:1]))
    assert width(*many) < 0.3 * width(*many, folded[1:])


def test_a_record_that_does_not_repeat_has_hardly_a_wider_interval_by_folding():
    """Wider by the few stretches of the circumference: of several estimates the largest counts."""
    ratios = []
    for seed in range(20):
        below = np.random.default_rng(seed).binomial(10, 0.3, (1, 12_800))
        sizes = np.full(12_800, 10)
        folded = folded_counts(below, sizes, 1.0, 200.0)
        ratios.append(width(below, sizes, [folded]) / width(below, sizes))
    assert 1.0 <= np.mean(ratios) < 1.5


def test_a_record_shorter_than_a_turn_of_the_slower_roller_keeps_its_scatter():
    below, sizes = repeated(1)
    around, lengths = folded_counts(below, sizes, 1.0, 250.0)  # a fifth of it was not seen
    assert (lengths > 0).all() and abs(lengths.size - 0.8 * STRETCHES) <= 1
    assert width(below, sizes, [(around, lengths)]) == pytest.approx(width(below, sizes), rel=0.6)


def test_what_changes_slowly_over_many_turns_is_not_folded_away():
    share = np.linspace(0.1, 0.9, 6400)
    below, sizes = np.rint(100 * share)[None], np.full(6400, 100)
    folded = folded_counts(below, sizes, 1.0, 100.0)
    assert width(below, sizes) > 0.2
    assert width(below, sizes, [folded]) == pytest.approx(width(below, sizes))


@given(st.integers(1, 500), st.floats(0.5, 400.0))
def test_folding_loses_no_sample(blocks, period):
    rng = np.random.default_rng(blocks)
    below, sizes = rng.integers(0, 9, (3, blocks)), np.full(blocks, 9)
    sizes[-1] = 8  # the last may be shorter
    around, lengths = folded_counts(below, sizes, 1.0, period)
    assert around.shape == (3, lengths.size) and lengths.size <= STRETCHES
    np.testing.assert_array_equal(around.sum(axis=1), below.sum(axis=1))
    assert lengths.sum() == sizes.sum()
