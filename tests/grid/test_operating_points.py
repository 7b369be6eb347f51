"""Operating points of a film table, each with its own film, in the order of the levels."""

import numpy as np
import pytest

from lube.grid.operating_points import operating_points
from lube.schema import EXPERIMENT_DIMS


@pytest.fixture
def table(film):
    return film.isel(film_formula=1)


def test_every_point_has_the_values_of_its_levels(table):
    points = operating_points(table, 0.1)
    assert len(points) == len(set(points)) == table["film_thickness"].size
    for point in points:
        assert list(point.levels) == list(EXPERIMENT_DIMS)
        assert point.levels["slide_to_roll_ratio"] == point.slide_to_roll_ratio == 0.1
        here = table.sel({name: point.levels[name] for name in EXPERIMENT_DIMS[1:]})
        for name in ("film_thickness", "contact_half_width", "entrainment_speed"):
            assert getattr(point, name) == here[name].item()
        assert point.reduced_modulus == table["reduced_modulus"].item()


def test_points_come_with_the_force_changing_fastest(table):
    forces = [point.force for point in operating_points(table, 0.0)]
    assert forces == table["force"].values.tolist() * (len(forces) // table.sizes["force"])


def test_the_order_of_the_tables_dimensions_changes_nothing(table):
    turned = table.transpose("force", "lubricant", "speed", "temperature")
    assert operating_points(turned, 0.0) == operating_points(table, 0.0)


@pytest.mark.parametrize("slip", [-0.3, 0.0, 0.3])
def test_the_surface_speeds_have_their_mean_and_their_slip(table, slip):
    point = operating_points(table, slip)[0]
    faster, slower, mean = point.faster_speed, point.slower_speed, point.entrainment_speed
    assert (faster + slower) / 2.0 == pytest.approx(mean)
    np.testing.assert_allclose((faster - slower) / mean, abs(slip), atol=1e-15)
