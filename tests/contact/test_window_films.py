"""Films with a shape at the points of the window: limits and exact scaling."""

import numpy as np
import pytest
import xarray as xr

from lube.contact.window_films import WindowFilm, film_on_points, window_films
from lube.contact.windows import ContactWindows
from lube.errors import DataError
from lube.grid.discretise import LineGrid
from lube.grid.film_profiles import shaped_films
from lube.grid.gap import Gap
from lube.physics.hertz import hertz_gap
from lube.study.rollers import BoundaryLayer

POSITION = np.linspace(-3.0, 3.0, 601).round(6)
GRID = LineGrid(spacing=1e-6, height_step=1e-12)
WIDTHS = [50e-6, 100e-6]


def film_table(thickness=((1e-6, 2e-6), (3e-6, 4e-6), (5e-6, 6e-6))):
    """Three formulas at two forces; the film is a parabola, thinnest behind the centre."""
    gap = 1e-6 * (1.0 + 0.5 * (POSITION - 0.5) ** 2)
    profile = np.array([1.0, 2.0])[:, None] * gap
    return xr.Dataset(
        {
            "film_thickness": (("film_formula", "force"), np.array(thickness)),
            "film_profile": (("force", "film_position"), profile),
            "contact_half_width": ("force", WIDTHS),
            "reduced_radius": 0.025,
            "formula_place": ("film_formula", ["central", "minimum", "mean"]),
        },
        {
            "film_formula": ["one", "two", "three"],
            "force": [1.0, 2.0],
            "film_position": POSITION,
        },
    )


def test_the_shape_has_the_formulas_film_where_the_formula_refers_to():
    table = film_table()
    shaped = shaped_films(table)
    assert shaped.dims == ("film_formula", "force", "film_position")
    central = shaped.sel(film_formula="one", film_position=0.0)
    minimum = shaped.sel(film_formula="two").min("film_position")
    inside = shaped.sel(film_formula="three", film_position=slice(-1.0, 1.0))
    found = [central, minimum, inside.integrate("film_position") / 2.0]
    np.testing.assert_allclose(found, table["film_thickness"], rtol=1e-12)


def test_the_dry_gap_outside_the_contact_is_not_scaled():
    """Nor is a film that has the formula's thickness already."""
    table = film_table().isel(film_formula=[0])
    same = table.assign(
        film_thickness=table["film_profile"].sel(film_position=0.0).expand_dims("film_formula")
    )
    np.testing.assert_allclose(shaped_films(same)[0], table["film_profile"], rtol=1e-12)
    half = shaped_films(same.assign(film_thickness=0.5 * same["film_thickness"]))[0]
    gap = hertz_gap(POSITION) * np.array(WIDTHS)[:, None] ** 2 / 0.025
    np.testing.assert_allclose(half - gap, 0.5 * (table["film_profile"] - gap), rtol=1e-9)


def test_films_at_the_points_follow_the_profile():
    table = film_table()
    films = window_films(table, GRID)
    shaped = shaped_films(table).stack(point=["film_formula", "force"])
    for number, (one, width) in enumerate(zip(films, WIDTHS * 3, strict=True)):
        points = np.arange(one.film.size) - one.before
        assert points[0] == round(-3.0 * width / 1e-6)
        exact = np.interp(-points * 1e-6 / width, POSITION, shaped.isel(point=number))
        np.testing.assert_allclose(one.film * 1e-12, exact, rtol=1e-4)
        assert one.film[one.before] == pytest.approx(exact[one.before] / 1e-12, abs=1)


def test_a_film_that_is_not_known_is_none():
    table = film_table()
    table["film_profile"][1] = np.nan
    films = window_films(table, GRID)
    assert [one is None for one in films] == [False, True] * 3


def test_a_spline_through_a_parabola_is_exact():
    profile = POSITION, film_table()["film_profile"].values[0]
    points = np.arange(-100, 101)
    position = -points * 1e-6 / 50e-6
    expected = np.rint((1.0 + 0.5 * (position - 0.5) ** 2) * 1e6)
    np.testing.assert_allclose(film_on_points(*profile, 50e-6, points, GRID), expected, atol=1)


def test_only_points_within_reach_are_kept():
    one = WindowFilm(np.array([9, 5, 3, 4, 8]), 2)
    reached = one.below(5)
    assert (reached.film.tolist(), reached.before) == ([3, 4], 0)
    assert one.below(2).film.tolist() == [3]  # one point at least
    with pytest.raises(DataError, match="need more than the height of the lines, 9, from a longer"):
        one.below(9)


def test_an_asperity_runs_with_the_oil_from_the_centre_to_the_thin_outlet():
    """It is higher than the film from 0.18 to 0.82 half-widths behind the centre only."""
    table = film_table().isel(film_formula=0, force=0)
    table["film_thickness"] = table["film_profile"].sel(film_position=0.0)
    table = table.assign(reduced_modulus=115e9, moes_load=1.0, moes_material=1.0)
    pair = np.zeros((2, 2000), np.int32)
    pair[0, 1000] = 1.05e6
    weak = BoundaryLayer(critical_thickness="5 nm", shear_strength="1 Pa")
    windows = ContactWindows(GRID, table, weak, Gap("computed"))
    touching = np.flatnonzero(windows.trace(tuple(pair))[0])
    behind = (touching - 1000) * 1e-6 / WIDTHS[0]
    assert (behind[0], behind[-1]) == pytest.approx((0.5 - 0.1**0.5, 0.5 + 0.1**0.5), abs=0.02)
