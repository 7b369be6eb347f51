"""Batches of realisations joined, and the intervals of their probabilities."""

import numpy as np
import pytest

from lube.contact.ensemble import PROBABILITIES, windows_by_force
from lube.errors import DataError
from lube.stages import contact_statistics, gather, roughness_lines, with_intervals
from lube.statistics.confidence import probability_interval


@pytest.fixture(scope="module")
def few(film):
    return film.isel(temperature=[2, 3], speed=[0], force=[1, 4])


@pytest.fixture(scope="module")
def batches(make_spec, few, study):
    spec = make_spec(20_000)

    def batch(realisations, film=few, seed=1, layer=study.boundary_layer):
        return contact_statistics(roughness_lines(spec, seed, realisations), film, layer)

    return batch


def test_gathered_batches_are_one_run_whatever_their_order_and_commits(batches, few):
    whole = gather([batches(range(4))], few)
    parts = [batches([2, 3]), batches([0, 1]).assign_attrs(code_commit="another")]
    assert gather(parts, few).identical(whole)
    assert whole["realisation"].values.tolist() == [0, 1, 2, 3]
    part = with_intervals(whole.isel(realisation=[0, 1]), few)
    assert part.equals(gather([batches(range(2))], few))


def test_interval_of_every_point_is_that_of_its_realisations(batches, few):
    contact = gather([batches(range(5))], few)
    windows = windows_by_force(contact, few)
    for force, temperature in np.ndindex(2, 2):
        point = {"force": force, "temperature": temperature, "film_formula": 1}
        here = contact.isel(point).squeeze()
        for name in PROBABILITIES:
            interval = probability_interval(here[name].values, windows.isel(force=force).item())
            for suffix, value in zip(("mean", "lower", "upper"), interval, strict=True):
                assert here[f"{name}_{suffix}"].item() == pytest.approx(value)


def test_independent_windows_are_a_longest_wavelength_apart_on_the_slower_surface(batches, few):
    rolling, ratios = batches([0]), [0.0, 1.0, -1.0, 2.0]
    slipping = rolling.isel(slide_to_roll_ratio=[0] * 4).assign_coords(slide_to_roll_ratio=ratios)
    windows = windows_by_force(slipping, few)
    longest = 2.0 * few["contact_half_width"].sel(force=1600.0).item()
    for force in (200.0, 1600.0):
        width = 2.0 * few["contact_half_width"].sel(force=force).item()
        expected = 2.0 * np.pi * 0.05 / (width + longest)
        found = windows.sel(force=force).values
        np.testing.assert_allclose(found, [expected, expected / 3.0, expected / 3.0, 1.0])


def test_missing_and_repeated_realisations_are_refused(batches, few):
    for realisations in ([[0, 1], [3]], [[1, 2]], [[0, 1], [1, 2]], [[0, 1], [0, 1]]):
        with pytest.raises(DataError, match=r"realisations: got \[.*\], need each of 0 to \d+ "):
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
