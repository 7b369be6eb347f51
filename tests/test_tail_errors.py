"""Are the stated errors of importance sampling those that it has?

A short version of `benchmarks/bench_tail.py`, on coarse lines whose layer is weak.
"""

import bench_tail as bench
import numpy as np
import pytest

from lube.schema import OPERATING_DIMS

SEEDS, REALISATIONS = 10, 150


@pytest.fixture(scope="module")
def first(busy):
    return busy.film.isel(film_formula=[0], speed=[0]).transpose(*OPERATING_DIMS, ...)


@pytest.fixture(scope="module")
def pairs(busy, first):
    return bench.pairs_of_lines(busy.study, first, range(SEEDS))


def test_stated_errors_are_the_scatter_over_seeds(pairs):
    errors = np.std(pairs, axis=1, ddof=1) / np.sqrt(bench.PAIRS)
    ratios = bench.scatter_ratios(pairs.mean(axis=1), errors)
    # The ratio of one point is within 0.4 and 1.7 with a probability of 99.8 %.
    assert np.all((ratios > 0.35) & (ratios < 1.8))
    assert 0.6 < np.sqrt(np.mean(ratios**2)) < 1.5


def test_an_ensemble_differs_by_no_more_than_both_errors(busy, first, pairs):
    counted = bench.ensemble(busy.study, first, REALISATIONS)
    everyone = pairs.reshape(-1, *pairs.shape[2:])
    for row in range(2):
        often = everyone[:, row].mean(axis=0) > bench.LEAST
        assert often.sum() >= 3
        samples = [each[:, row][:, often] for each in (everyone, counted)]
        found = bench.hold_against(*((each.mean(axis=0), each, len(each)) for each in samples))
        for _, directions, larger in (found["all"], found["main"]):
            assert directions > 0 and larger > 1e-3


def test_the_comparison_finds_a_difference_that_is_there_and_none_that_is_not():
    rng = np.random.default_rng(1)
    mixing = np.tri(8)  # neighbours are strongly correlated
    sampled, counted = (rng.standard_normal((number, 8)) @ mixing for number in (400, 200))

    def held(shift):
        means = sampled.mean(axis=0) + shift, counted.mean(axis=0)
        return bench.hold_against((means[0], sampled, 400), (means[1], counted, 200))

    assert held(0.0)["all"][2] > 1e-3
    moved = held(1.0)
    assert moved["all"][1] == 8 and moved["all"][2] < 1e-6
