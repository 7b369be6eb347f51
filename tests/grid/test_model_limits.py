"""Points at which the model cannot hold, on small tables."""

import numpy as np
import pytest
import xarray as xr
from scipy.linalg import hadamard

from lube.grid.model_limits import deformed, merged, overloaded, rubbing


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
