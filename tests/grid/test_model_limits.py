"""Points at which the model cannot hold, on small tables."""

import numpy as np
import pytest
import xarray as xr
from scipy.linalg import hadamard

from lube.grid.model_limits import (
    deformed,
    doubts,
    merged,
    overloaded,
    rubbing,
    separated,
    with_load_share,
)


def table(mean, geometric, error=0.005, film=(3.0, 2.0, 1.0), realisations=8):
    """Contact at one speed and one force, the film the thinner the hotter.

    The realisations scatter independently at each point, and their means have a standard error.
    """
    signs = hadamard(8)[:, 1:4] * (8 - 1) ** 0.5
    dims = ("temperature", "speed", "force")
    levels = {"temperature": [40.0, 60.0, 80.0], "speed": [100.0], "force": [800.0]}
    columns = {
        "breakthrough_probability": (mean + error * signs)[:realisations, :, None, None],
        "geometric_contact_probability_mean": np.array(geometric)[:, None, None],
    }
    contact = xr.Dataset(
        {
            name: (("realisation", *dims)[-values.ndim :], values)
            for name, values in columns.items()
        },
        levels,
    )
    films = xr.Dataset({"film_thickness": (dims, np.reshape(film, (3, 1, 1)))}, levels)
    return contact, films


@pytest.mark.parametrize(
    ("mean", "geometric", "error", "expected"),
    [
        ([0.87, 0.84, 0.80], [0.90, 0.95, 0.99], 0.005, [False, True, True]),
        ([0.87, 0.86, 0.80], [1.0, 1.0, 1.0], 0.005, [False, False, True]),
        ([0.87, 0.86, 0.85], [0.90, 0.95, 0.99], 0.005, [False, False, False]),
        ([0.87, 0.84, 0.80], [0.90, 0.87, 0.82], 0.005, [False, False, False]),
        ([0.50, 0.60, 0.70], [0.60, 0.70, 0.80], 0.005, [False, False, False]),
    ],
    ids=["falls", "only the last by more than the scatter", "within the scatter",
         "less geometric contact", "rises"],
)  # fmt: skip
def test_merged_segments_are_found_where_contact_falls_as_the_film_thins(
    mean, geometric, error, expected
):
    found = merged(*table(mean, geometric, error))
    assert found.dims == ("temperature", "speed", "force")
    assert found.values.ravel().tolist() == expected


def test_one_realisation_shows_no_scatter_and_so_no_fall():
    assert not merged(*table([0.87, 0.84, 0.80], [0.90, 0.95, 0.99], realisations=1)).any()


def test_unknown_films_are_compared_with_none():
    found = merged(*table([0.87, 0.84, 0.8], [0.9, 0.9, 0.9], film=(np.nan, 2.0, 1.0)))
    assert found.values.ravel().tolist() == [False, False, True]


def test_contact_widths_formulas_and_slips_are_not_compared_with_each_other():
    contact, film = table([0.87, 0.84, 0.80], [0.90, 0.95, 0.99])
    turned = contact.rename(temperature="force", force="temperature")
    turned = turned.transpose(..., "temperature", "speed", "force")
    films = film.rename(temperature="force", force="temperature")
    assert not merged(turned, films.transpose("temperature", "speed", "force")).any()
    slips = contact.expand_dims(slide_to_roll_ratio=[0.0, 0.1])  # the film has no such dimension
    assert merged(slips, film).sum().item() == 4
    assert merged(slips, film).dims == ("slide_to_roll_ratio", "temperature", "speed", "force")


def test_points_are_overloaded_where_the_mean_share_is_above_one():
    share = xr.DataArray([[0.9, 1.2, 1.0], [1.0, 0.9, 1.0]], dims=("realisation", "force"))
    found = overloaded(xr.Dataset({"contact_load_share": share}))
    assert found.values.tolist() == [False, True, False]


def test_the_oil_deforms_roughness_strongly_where_it_adds_more_than_a_tenth_of_the_film():
    film = xr.Dataset({"film_thickness": ("force", [1e-6, 1e-6, np.nan])})
    assert not deformed(film).any()  # lines as drawn
    film["rms_deformation"] = "force", [0.09e-6, 0.11e-6, np.nan]
    assert deformed(film).values.tolist() == [False, True, False]
    tail = xr.Dataset({"surface_rms_deformation": ("force", [0.11e-6, 0.09e-6, np.nan])})
    assert deformed(film, tail).values.tolist() == [True, False, False]
    assert not deformed(film, xr.Dataset()).any()  # surfaces as drawn


def test_asperities_rub_where_they_carry_more_than_a_tenth_of_the_load():
    film = xr.Dataset({"film_thickness": ("force", [1e-6, 1e-6, np.nan])})
    assert not rubbing(film).any()  # not asked for
    film["surface_load_share"] = "force", [0.09, 0.11, np.nan]
    assert rubbing(film).values.tolist() == [False, True, False]


def test_the_oil_may_separate_lines_that_it_answers_from_a_lambda_ratio_of_two_and_a_half_on():
    film = xr.Dataset({"lambda_ratio": ("force", [2.4, 2.5, 4.0, np.nan])})
    assert not separated(film).any()  # lines as drawn
    film["rms_deformation"] = "force", [1e-9, 1e-9, 1e-9, np.nan]
    assert separated(film).values.tolist() == [False, True, True, False]


def test_figures_mark_only_what_some_point_has_and_the_oil_separates_no_surfaces():
    films = {"film_thickness": ("force", [1e-6, 1e-6]), "lambda_ratio": ("force", [2.0, 3.0])}
    film = xr.Dataset(films)
    assert not doubts(film)
    film["rms_deformation"] = "force", [0.0, 0.2e-6]
    found = doubts(film)
    assert [marker for marker, _ in found.values()] == ["s", "*"]
    assert all(where.values.tolist() == [False, True] for _, where in found.values())
    assert [marker for marker, _ in doubts(film, model="surface").values()] == ["s"]
    film["surface_load_share"] = "force", [0.2, 0.0]
    assert [marker for marker, _ in doubts(film, xr.Dataset(), "surface").values()] == ["D"]


def test_records_have_the_load_share_at_the_levels_that_they_are_near():
    names = "slide_to_roll_ratio", "lubricant", "film_formula", "temperature", "speed", "force"
    levels = {"slide_to_roll_ratio": [0.0, 0.5], "lubricant": ["a", "b"], "film_formula": ["f"]}
    levels |= {"temperature": [40.0], "speed": [100.0], "force": [400.0, 800.0]}
    share = xr.DataArray(np.arange(8.0).reshape(2, 2, 1, 1, 1, 2), levels, names)
    film = xr.Dataset({"surface_load_share": share})
    records = xr.Dataset({"lubricant": ("record", ["b", "a", "a"])}, {"film_formula": "f"})
    records["slide_to_roll_ratio"] = "record", [0.5, 0.0, 0.0]
    for name, values in (("force", [800.0, 400.0, np.nan]), ("speed", [100.0] * 3)):
        records[f"{name}_level"] = "record", values
    records["temperature_level"] = "record", [40.0] * 3
    records = records.assign_coords(force=("record", [799.0, 401.0, 600.0]))
    found = with_load_share(records, film)["surface_load_share"]
    np.testing.assert_array_equal(found, [7.0, 0.0, np.nan])
    own = records.assign(surface_load_share=0.2)
    assert with_load_share(own, film) is own and with_load_share(records, xr.Dataset()) is records
    rolling = film.isel(slide_to_roll_ratio=0, drop=True)
    np.testing.assert_array_equal(
        with_load_share(records, rolling)["surface_load_share"], [3.0, 0.0, np.nan]
    )
