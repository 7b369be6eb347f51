"""Intervals of probabilities: limits and identities, then whether they cover the truth."""

import numpy as np
import pytest
import scipy.stats
from hypothesis import example, given
from hypothesis import strategies as st

from lube import contact_statistics, gather, roughness_lines, with_intervals
from lube.errors import DataError
from lube.kernels.layer import layer_factor
from lube.kernels.strips import strip_statistics
from lube.stages.ensemble import PROBABILITIES, independent_windows
from lube.statistics.confidence import effective_sample_size, probability_interval
from lube.surfaces.synthetic import draw_realisation

# Whole numbers of a million time steps, as real shares of time are.
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
    # At the least, the chance of never having seen what is there (or always) is left open.
    never_seen = 1.0 - 0.05 ** (1.0 / (windows * len(shares)))
    assert upper >= never_seen * (1.0 - 1e-9)
    assert lower <= 1.0 - never_seen * (1.0 - 1e-9)


@given(st.lists(SHARES, min_size=1, max_size=20), st.floats(1.0, 1e4))
def test_contact_and_no_contact_mirror_each_other(shares, windows):
    mean, lower, upper = probability_interval(np.array(shares), windows)
    mirrored = probability_interval(1.0 - np.array(shares), windows)
    np.testing.assert_allclose([1.0 - mean, 1.0 - upper, 1.0 - lower], mirrored, atol=1e-9)


@pytest.mark.parametrize("realisations", [5, 16, 64])
@pytest.mark.parametrize("centre", [0.3, 0.5, 0.8])
def test_interval_in_mid_range_is_students(realisations, centre):
    shares = centre + 0.01 * np.random.default_rng(realisations).standard_normal(realisations)
    half = (
        scipy.stats.t.ppf(0.975, realisations - 1) * np.std(shares, ddof=1) / np.sqrt(realisations)
    )
    mean, lower, upper = probability_interval(shares, 374.0)
    assert mean - lower == pytest.approx(half, rel=0.03)
    assert upper - mean == pytest.approx(half, rel=0.03)


@pytest.mark.parametrize(("realisations", "windows"), [(1, 1.0), (1, 374.0), (64, 374.0)])
def test_contact_never_seen_has_the_exact_one_sided_limit(realisations, windows):
    mean, lower, upper = probability_interval(np.zeros(realisations), windows)
    assert (mean, lower) == (0.0, 0.0)
    # Of so many windows with probability `upper` each, none shows contact once in twenty times.
    missed = scipy.stats.binom.pmf(0, round(realisations * windows), upper)
    assert missed == pytest.approx(0.05, rel=1e-9)


def test_contact_always_seen_is_its_mirror_image():
    _, _, never = probability_interval(np.zeros(8), 100.0)
    mean, lower, upper = probability_interval(np.ones(8), 100.0)
    assert (mean, upper) == (1.0, 1.0)
    assert lower == pytest.approx(1.0 - never)


@pytest.mark.parametrize("share", [0.003, 0.2, 0.97])
def test_single_realisation_counts_its_windows(share):
    windows = 374.0
    mean, lower, upper = probability_interval(np.array([share]), windows)
    assert mean == share
    for limit in (lower, upper):  # Wilson: the limits are where the mean is 1.96 errors off
        error = np.sqrt(limit * (1.0 - limit) / windows)
        assert abs(limit - share) / error == pytest.approx(1.959964, rel=1e-5)
    assert lower < share < upper


def test_interval_without_scatter_counts_windows_too():
    """Equal probabilities by chance are no proof of exactness."""
    same = probability_interval(np.full(3, 0.1), 100.0)
    np.testing.assert_allclose(same, probability_interval(np.array([0.1]), 300.0))


def test_short_contacts_in_every_realisation_do_not_bound_the_long_ones():
    """A hair of evenly spread contact must not give a tighter limit than none at all."""
    hair = 1e-6 * np.array([1.0, 1.1, 0.9, 1.05, 0.95, 1.0, 1.02, 0.98])
    _, _, never = probability_interval(np.zeros(8), 374.0)
    _, _, upper = probability_interval(hair, 374.0)
    assert upper >= never
    _, always, _ = probability_interval(np.ones(8), 374.0)
    _, lower, _ = probability_interval(1.0 - hair, 374.0)
    assert lower <= always


def test_effective_sample_size_of_coins_are_the_coins():
    coins, realisations = 50, 20_000
    shares = np.random.default_rng(1).binomial(coins, 0.2, realisations) / coins
    assert effective_sample_size(shares) == pytest.approx(coins * realisations, rel=0.05)


SHAPES = [(1,), (7,), (40, 1), (1, 40), (3, 4, 5), (2, 1, 1, 5, 5, 5)]


@pytest.mark.parametrize("realisations", [1, 2, 5, 8, 64, 129, 1000])
@pytest.mark.parametrize("shape", SHAPES, ids=str)
@pytest.mark.parametrize("layout", ["C", "F", "strided", "last"])
def test_a_column_alone_has_the_bits_that_it_has_among_others(realisations, shape, layout):
    rng = np.random.default_rng(realisations)
    shares = np.rint(1e6 * rng.beta(0.5, 3.0, (realisations, *shape))) / 1e6
    windows = np.linspace(10.0, 400.0, shape[-1])
    laid = {
        "C": np.ascontiguousarray,
        "F": np.asfortranarray,
        "strided": lambda values: np.repeat(values, 2, axis=-1)[..., ::2],
        "last": lambda values: np.moveaxis(np.moveaxis(values, 0, -1).copy(), -1, 0),
    }[layout](shares)
    together = probability_interval(laid, windows)
    for place in np.ndindex(shape):
        alone = probability_interval(shares[:, *place].copy(), windows[place[-1]])
        assert [each[place] for each in together] == [each.item() for each in alone]


def coverage(shares, size, windows, truth):
    """Share of groups of so many realisations whose interval holds the truth."""
    groups = shares[: shares.size // size * size].reshape(-1, size).T
    _, lower, upper = probability_interval(groups, windows)
    return np.mean((lower <= truth) & (truth <= upper))


@pytest.mark.parametrize("size", [8, 16, 64])
@pytest.mark.parametrize("probability", [0.5, 0.1, 0.01, 0.99])
def test_intervals_cover_the_mean_of_beta_scatter(probability, size):
    looks = 200.0  # what one realisation is worth
    rng = np.random.default_rng(round(1000 * probability) + size)
    shares = rng.beta(looks * probability, looks * (1.0 - probability), 2000 * size)
    assert coverage(shares, size, looks, probability) >= 0.93


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


FILMS = np.array([300_000, 600_000, 800_000, 950_000, 1_050_000, 1_150_000, 1_200_000])


@pytest.fixture(scope="module")
def population(make_spec, film):
    """Probabilities of many realisations of short lines, and windows in one of them."""
    spec = make_spec(100_000)
    half_width = film["contact_half_width"].sel(force=1600.0).item()
    half_window = int(half_width / spec.spacing)
    half_windows = np.full(FILMS.size, half_window)
    modulus = film["reduced_modulus"].item()
    factor = layer_factor(modulus, 5e-9, 1e6, spec.spacing, spec.height_step)
    shares = []
    for realisation in range(1600):
        pair = draw_realisation(spec, 5, realisation)
        counts = strip_statistics(*pair, (1.0, 1.0), 100_000, FILMS, half_windows, factor)
        shares.append(counts[:, :2] / 1e5)
    windows = 1e5 * spec.spacing / (2.0 * half_width + 2.0 * np.pi / spec.q_min)
    return np.array(shares), windows


@pytest.mark.parametrize("size", [8, 16])
@pytest.mark.parametrize("which", [0, 1], ids=["geometric", "breakthrough"])
@pytest.mark.parametrize("row", range(FILMS.size), ids=[f"{film / 1e6} um" for film in FILMS])
def test_intervals_cover_the_mean_of_real_lines(population, row, which, size):
    shares, windows = population
    shares = shares[:, row, which]
    found = coverage(shares, size, windows, shares.mean())
    print(f"P {shares.mean():.2e}, {size} realisations: covered {found:.3f}")
    assert found >= 0.90


# Gathering batches.


@pytest.fixture(scope="module")
def few(film):
    return film.isel(temperature=[2, 3], speed=[0], force=[1, 4])


@pytest.fixture(scope="module")
def batches(make_spec, few, study):
    spec = make_spec(20_000)

    def batch(realisations, film=few, seed=1, layer=study.boundary_layer):
        return contact_statistics(roughness_lines(spec, seed, realisations), film, layer)

    return batch


def test_gathered_batches_are_one_run(batches, few):
    whole = gather([batches(range(4))], few)
    assert gather([batches([2, 3]), batches([0, 1])], few).identical(whole)
    assert whole["realisation"].values.tolist() == [0, 1, 2, 3]


def test_batches_made_at_different_commits_are_joined(batches, few):
    parts = [batches([0]).assign_attrs(code_commit="a"), batches([1]).assign_attrs(code_commit="b")]
    assert gather(parts, few).equals(gather([batches(range(2))], few))


def test_interval_of_every_point_is_that_of_its_realisations(batches, few):
    contact = gather([batches(range(5))], few)
    windows = independent_windows(contact, few)
    for name in PROBABILITIES:
        for force in (0, 1):
            for temperature in (0, 1):
                place = {"force": force, "temperature": temperature, "film_formula": 1}
                here = contact.isel(place).squeeze()
                limits = probability_interval(here[name].values, windows.isel(force=force).item())
                for suffix, limit in zip(("mean", "lower", "upper"), limits, strict=True):
                    assert here[f"{name}_{suffix}"].item() == pytest.approx(limit)


def test_windows_that_share_no_roughness(batches, few):
    contact = batches([0])
    perimeter = 2.0 * np.pi * 0.05
    longest = 2.0 * few["contact_half_width"].sel(force=1600.0).item()
    for force in (200.0, 1600.0):
        width = 2.0 * few["contact_half_width"].sel(force=force).item()
        windows = independent_windows(contact, few).sel(force=force).item()
        assert windows == pytest.approx(perimeter / (width + longest))


def test_windows_under_slip_are_as_many_as_the_slower_surface_passes(batches, few):
    rolling = batches([0])
    ratios = [0.0, 1.0, -1.0, 2.0]
    slipping = rolling.isel(slide_to_roll_ratio=[0] * 4).assign_coords(slide_to_roll_ratio=ratios)
    windows = independent_windows(slipping, few).sel(force=1600.0)
    still = windows.sel(slide_to_roll_ratio=0.0)
    for ratio in (1.0, -1.0):
        assert windows.sel(slide_to_roll_ratio=ratio) == pytest.approx(still / 3.0)
    assert windows.sel(slide_to_roll_ratio=2.0) == 1.0


def test_intervals_of_a_selection_of_realisations(batches, few):
    contact = gather([batches(range(4))], few)
    part = with_intervals(contact.isel(realisation=[0, 1]), few)
    assert part.equals(gather([batches(range(2))], few))


@pytest.mark.parametrize(
    "realisations", [[[0, 1], [3]], [[1, 2]], [[0, 1], [1, 2]], [[0, 1], [0, 1]], [[0, 1], [1, 3]]]
)
def test_missing_and_repeated_realisations_are_refused(batches, few, realisations):
    with pytest.raises(DataError, match="each once"):
        gather([batches(numbers) for numbers in realisations], few)


def test_batches_of_different_studies_are_refused(batches, few, study):
    other_grid = few.assign_coords(temperature=few["temperature"] + 1e-9)
    stronger = study.boundary_layer.model_copy(update={"shear_strength": 2e6})
    for other in (
        batches([1], film=other_grid),
        batches([1], film=few.isel(force=[0])),
        batches([1], layer=stronger),
        batches([1]).assign_attrs(longest_wavelength=1.0),
    ):
        with pytest.raises(DataError, match="different studies"):
            gather([batches([0]), other], few)


def test_film_table_of_another_grid_is_refused(batches, few):
    with pytest.raises(DataError, match=r"200\.0, 1600\.0.*200\.0"):
        gather([batches([0])], few.isel(force=[0]))
