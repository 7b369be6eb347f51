"""Share of time in contact: the same however the record comes, and with honest intervals."""

from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from kernels.test_threshold import plain_contact

from lube.errors import RangeError
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


@pytest.mark.parametrize("size", [1, 31, 63, 64, 65, 128, 1000, 2**20, 2**20 + 1])
def test_blocks_are_equal_and_as_many_as_fit_in_a_long_record(size):
    values = np.random.default_rng(size).random(size)
    counter = count([values], [0.25])
    sizes = counter.sizes
    assert counter.below.shape == (1, sizes.size)
    assert counter.below.sum() == np.count_nonzero(values < 0.25)
    assert (sizes[:-1] == sizes[0]).all()
    assert 0 < sizes[-1] <= sizes[0]
    assert min(size, BLOCKS // 2) <= sizes.size <= BLOCKS


def test_a_record_of_single_precision_is_counted_as_it_is():
    values = np.random.default_rng(3).random(10_000).astype(np.float32)
    expected = [np.count_nonzero(values.astype(float) < limit) for limit in (0.1, 0.7)]
    assert count([values], [0.1, 0.7]).below.sum(axis=1).tolist() == expected


def test_a_change_that_outlasts_a_block_is_counted_from_its_first_sample():
    values = np.concatenate([np.full(100, 9.0), np.zeros(50), np.full(300, 9.0)])
    assert count([values], [1.0], hold=50).below.sum() == 50
    assert count([values], [1.0], hold=51).below.sum() == 0


def test_chatter_about_the_limit_is_one_contact_with_hysteresis():
    chatter = np.concatenate([[9.0], np.tile([0.9, 1.1], 20), [9.0]])
    assert count([chatter], [1.0]).below.sum() == 20
    assert count([chatter], [1.0], [2.0]).below.sum() == 40


def test_a_record_without_samples_has_no_blocks():
    counter = count([np.array([])], LIMITS)
    assert counter.below.shape == (3, 0)
    assert counter.sizes.shape == (0,)


@pytest.mark.parametrize(
    ("options", "told"),
    [
        (([],), "limits: got"),
        (([2.0, 1.0],), "finite and rising"),
        (([1.0, np.nan],), "finite and rising"),
        (([1.0, 2.0], [1.0]), "releases: got"),
        (([1.0, 2.0], [1.0, 1.5]), "no less than it"),
        (([1.0], None, -1), "hold: got -1"),
    ],
)
def test_impossible_limits_are_refused(options, told):
    with pytest.raises(RangeError, match=told):
        ContactShare(*options)


# A study's thresholds

RESISTANCES = np.geomspace(1.0, 1e4, 997)


@pytest.mark.parametrize("release_ratio", [1, 2.5])
def test_a_voltage_is_counted_as_the_resistance_that_it_tells_of(release_ratio):
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


@pytest.mark.parametrize(("debounce", "seen"), [("0 s", 3), ("30 us", 3), ("40 us", 0)])
def test_a_change_shorter_than_the_debounce_does_not_count(debounce, seen):
    experiment = Experiment(debounce=debounce)
    counter = record_counter(experiment, Rig(), "resistance", 1e-5)
    counter.add(np.array([1e5, 1.0, 1.0, 1.0, 1e5, 1e5, 1e5, 1e5, 1e5]))
    assert counter.below.sum(axis=1).tolist() == [seen] * len(experiment.thresholds)


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


@pytest.mark.parametrize("contacts", [30, 100, 1000])
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


def test_independent_samples_have_the_interval_of_so_many_looks():
    record = np.random.default_rng(4).random(2**17) < 0.3
    share, lower, upper = interval_of(record, 1e4)
    assert share == record.mean()
    usual = 1.96 * np.sqrt(0.3 * 0.7 / record.size)
    assert upper - lower == pytest.approx(2.0 * usual, rel=0.5)


def test_the_same_samples_in_long_stretches_are_worth_less():
    coins = np.random.default_rng(5).random(2**10) < 0.3
    _, lower, upper = interval_of(np.repeat(coins, 100), 1e4)
    _, naive_lower, naive_upper = interval_of(
        np.random.default_rng(5).permutation(np.repeat(coins, 100)), 1e4
    )
    assert upper - lower > 5.0 * (naive_upper - naive_lower)


@pytest.mark.parametrize("windows", [1.0, 250.0])
def test_contact_never_or_always_seen_leaves_the_windows_bound(windows):
    bound = 1.0 - 0.05 ** (1.0 / windows)
    assert interval_of(np.zeros(1000, bool), windows) == pytest.approx([0.0, 0.0, bound])
    assert interval_of(np.ones(1000, bool), windows) == pytest.approx([1.0, 1.0 - bound, 1.0])


@pytest.mark.parametrize("blocks", [1, LEAST_BLOCKS - 1])
def test_a_few_blocks_have_no_scatter_to_tell(blocks):
    found = share_interval(np.arange(blocks)[None] + 1, np.full(blocks, 100), 30.0)
    share = found[0].item()
    for limit in found[1:]:
        error = np.sqrt(limit * (1.0 - limit) / 30.0)
        bound = 1.0 - 0.05 ** (1.0 / 30.0)
        assert abs(limit - share) / error == pytest.approx(1.959964) or limit in (
            pytest.approx([bound]),
            pytest.approx([1.0 - bound]),
        )


def test_equal_blocks_leave_the_windows():
    even = share_interval(np.full((1, 40), 3), np.full(40, 10), 25.0)
    single = share_interval(np.array([[3]]), np.array([10]), 25.0)
    np.testing.assert_allclose(even, single)


def test_a_short_last_block_counts_for_its_length_only():
    below, sizes = np.array([[10, 20] * 20]), np.full(40, 100)
    short = np.append(below, [[1]], axis=1), np.append(sizes, 1)
    np.testing.assert_allclose(
        share_interval(*short, 1e4), share_interval(below, sizes, 1e4), rtol=0.05
    )


def test_limits_are_treated_one_by_one():
    rng = np.random.default_rng(6)
    below, sizes = rng.integers(0, 50, (4, 37)), np.full(37, 50)
    together = np.array(share_interval(below, sizes, 40.0))
    for k in range(4):
        alone = np.array(share_interval(below[k : k + 1], sizes, 40.0))
        np.testing.assert_allclose(together[:, k : k + 1], alone)


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


def test_turning_on_without_new_roughness_tells_no_more():
    few, many = repeated(4), repeated(64)
    folded = [folded_counts(*counts, 1.0, 200.0) for counts in (few, many)]
    assert width(*many, folded[1:]) == pytest.approx(width(*few, folded[:1]))
    assert width(*many) < 0.3 * width(*many, folded[1:])


def test_folded_or_not_a_record_of_one_turn_tells_the_same():
    one = repeated(1)
    assert width(*one, [folded_counts(*one, 1.0, 200.0)]) == pytest.approx(width(*one), rel=0.6)


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


def test_counts_are_folded_into_their_phase():
    below = np.tile(np.arange(STRETCHES), 3)[None]
    around, lengths = folded_counts(below, np.full(below.size, 99), 0.1, 0.1 * STRETCHES)
    np.testing.assert_array_equal(around, 3 * np.arange(STRETCHES)[None])
    np.testing.assert_array_equal(lengths, np.full(STRETCHES, 3 * 99))


@pytest.mark.parametrize(
    ("below", "sizes", "windows", "told"),
    [
        (np.empty((1, 0)), np.empty(0), 5.0, "without samples"),
        (np.ones((1, 9)), np.ones(9), 0.5, "windows: got 0.5"),
        (np.ones((1, 9)), np.ones(9), np.nan, "windows: got nan"),
    ],
)
def test_an_interval_needs_samples_and_a_window(below, sizes, windows, told):
    with pytest.raises(RangeError, match=told):
        share_interval(below, sizes, windows)
