"""Intervals of probabilities: limits and identities, then whether they cover the truth."""

import numpy as np
import pytest
import scipy.stats
from hypothesis import example, given
from hypothesis import strategies as st

from lube.kernels.layer import layer_factor
from lube.kernels.strips import strip_statistics
from lube.statistics.confidence import probability_interval
from lube.surfaces.synthetic import draw_realisation

# Multiples of one time step in a million, as simulated shares of time are.
SHARES = st.one_of(st.integers(0, 10**6), st.sampled_from([0, 1, 10**6 - 1, 10**6])).map(
    lambda steps: steps / 1e6
)


@given(st.lists(SHARES, min_size=1, max_size=20), st.floats(1.0, 1e4))
@example([0.1, 0.1, 0.1], 374.0)
def test_interval_encloses_the_mean_within_0_and_1_and_is_never_a_point(shares, windows):
    mean, lower, upper = probability_interval(np.array(shares), windows)
    assert mean == pytest.approx(np.mean(shares))
    assert 0.0 <= lower <= mean + 1e-12
    assert mean - 1e-12 <= upper <= 1.0
    # No interval is narrower than that of contact never (or always) seen.
    never_seen = 1.0 - 0.05 ** (1.0 / (windows * len(shares)))
    assert upper >= never_seen * (1.0 - 1e-9)
    assert lower <= 1.0 - never_seen * (1.0 - 1e-9)
    mirrored = probability_interval(1.0 - np.array(shares), windows)
    np.testing.assert_allclose([1.0 - mean, 1.0 - upper, 1.0 - lower], mirrored, atol=1e-9)


def test_interval_in_mid_range_is_students():
    for realisations in (5, 16, 64):
        noise = 0.01 * np.random.default_rng(realisations).standard_normal(realisations)
        quantile = scipy.stats.t.ppf(0.975, realisations - 1)
        half = quantile * np.std(noise, ddof=1) / np.sqrt(realisations)
        for centre in (0.3, 0.5, 0.8):
            mean, lower, upper = probability_interval(centre + noise, 374.0)
            assert mean - lower == pytest.approx(half, rel=0.03)
            assert upper - mean == pytest.approx(half, rel=0.03)


@pytest.mark.parametrize(("realisations", "windows"), [(1, 1.0), (1, 374.0), (64, 374.0)])
def test_contact_never_seen_has_the_exact_one_sided_limit(realisations, windows):
    mean, lower, upper = probability_interval(np.zeros(realisations), windows)
    assert (mean, lower) == (0.0, 0.0)
    # With probability `upper` in each window, no window shows contact once in twenty times.
    missed = scipy.stats.binom.pmf(0, round(realisations * windows), upper)
    assert missed == pytest.approx(0.05, rel=1e-9)


def test_without_scatter_windows_are_counted():
    """A single realisation, or equal probabilities by chance."""
    for share in (0.003, 0.2, 0.97):
        mean, lower, upper = probability_interval(np.array([share]), 374.0)
        assert lower < mean == share < upper
        for limit in (lower, upper):  # Wilson: the limits are where the mean is 1.96 errors off
            error = np.sqrt(limit * (1.0 - limit) / 374.0)
            assert abs(limit - share) / error == pytest.approx(1.959964, rel=1e-5)
    same = probability_interval(np.full(3, 0.1), 100.0)
    np.testing.assert_allclose(same, probability_interval(np.array([0.1]), 300.0))


def test_short_contacts_in_every_realisation_do_not_bound_the_long_ones():
    """A little evenly spread contact must not give a tighter limit than none at all."""
    little = 1e-6 * np.array([1.0, 1.1, 0.9, 1.05, 0.95, 1.0, 1.02, 0.98])
    _, _, never = probability_interval(np.zeros(8), 374.0)
    _, _, upper = probability_interval(little, 374.0)
    assert upper >= never


@pytest.mark.parametrize("shape", [(1,), (7,), (40, 1), (1, 40), (3, 4, 5)], ids=str)
def test_a_column_alone_has_the_bits_that_it_has_among_others(shape):
    layouts = (
        np.ascontiguousarray,
        np.asfortranarray,
        lambda values: np.repeat(values, 2, axis=-1)[..., ::2],
        lambda values: np.moveaxis(np.moveaxis(values, 0, -1).copy(), -1, 0),
    )
    windows = np.linspace(10.0, 400.0, shape[-1])
    for realisations in (1, 2, 5, 8, 129, 1000):
        rng = np.random.default_rng(realisations)
        shares = np.rint(1e6 * rng.beta(0.5, 3.0, (realisations, *shape))) / 1e6
        alone = [
            probability_interval(shares[:, *index].copy(), windows[index[-1]])
            for index in np.ndindex(shape)
        ]
        for layout in layouts:
            together = np.stack(probability_interval(layout(shares), windows), axis=-1)
            np.testing.assert_array_equal(together.reshape(-1, 3), alone)


# Coverage


def coverage(shares, size, windows, truth):
    """Share of groups of so many realisations whose interval contains the true value."""
    groups = shares[: shares.size // size * size].reshape(-1, size).T
    _, lower, upper = probability_interval(groups, windows)
    return np.mean((lower <= truth) & (truth <= upper))


@pytest.mark.parametrize("size", [8, 16, 64])
@pytest.mark.parametrize("probability", [0.5, 0.1, 0.01, 0.99])
def test_intervals_cover_the_mean_of_beta_scatter(probability, size):
    sample_size = 200.0  # of one realisation
    rng = np.random.default_rng(round(1000 * probability) + size)
    shares = rng.beta(sample_size * probability, sample_size * (1.0 - probability), 2000 * size)
    assert coverage(shares, size, sample_size, probability) >= 0.93


@pytest.mark.parametrize("size", [8, 16, 64])
@pytest.mark.parametrize("probability", [1e-1, 1e-2, 1e-3, 1e-4])
def test_intervals_cover_the_mean_of_rare_episodes(probability, size):
    """Contact comes in episodes of about the passage of the window, 1/748 of a revolution."""
    rng = np.random.default_rng(size)
    passage = 1.0 / 748.0
    episodes = rng.poisson(probability / passage, 2000 * size)
    lengths = rng.gamma(4.0, passage / 4.0, episodes.sum())
    owner = np.repeat(np.arange(episodes.size), episodes)
    shares = np.minimum(np.bincount(owner, lengths, minlength=episodes.size), 1.0)
    assert coverage(shares, size, 374.0, probability) >= 0.92


@pytest.mark.slow
def test_intervals_cover_the_mean_of_real_lines(make_spec, film):
    """Probabilities of 1600 realisations of short lines, at seven films from rare to frequent."""
    films = np.array([300_000, 600_000, 800_000, 950_000, 1_050_000, 1_150_000, 1_200_000])
    spec = make_spec(100_000)
    half_width = film["contact_half_width"].sel(force=1600.0).item()
    half_windows = np.full(films.size, int(half_width / spec.spacing))
    modulus = film["reduced_modulus"].item()
    factor = layer_factor(modulus, 5e-9, 1e6, spec.spacing, spec.height_step)
    shares = []
    for realisation in range(1600):
        pair = draw_realisation(spec, 5, realisation)
        counts = strip_statistics(pair, (1.0, 1.0), 100_000, films, half_windows, factor)
        shares.append(counts[:, :2] / 1e5)
    windows = 1e5 * spec.spacing / (2.0 * half_width + 2.0 * np.pi / spec.q_min)
    for column in np.array(shares).reshape(1600, -1).T:
        for size in (8, 16):
            assert coverage(column, size, windows, column.mean()) >= 0.90
