"""Operating points of a film table, and the speeds of their surfaces."""

import pytest

from lube.grid.discretise import speed_ratios
from lube.grid.operating_points import levels_at, operating_points, surface_speeds
from lube.schema import EXPERIMENT_DIMS


def test_every_point_has_the_values_of_its_levels_in_any_order_of_dimensions(film):
    table = film.isel(film_formula=1)
    points = operating_points(table, 0.1)
    count = points.sizes["operating_point"]
    each = [levels_at(points, number) for number in range(count)]
    assert count == len({tuple(one.values()) for one in each}) == table["film_thickness"].size
    for number, levels in enumerate(each):
        assert list(levels) == list(EXPERIMENT_DIMS)
        assert levels["slide_to_roll_ratio"] == 0.1
        here = table.sel({name: levels[name] for name in EXPERIMENT_DIMS[1:]})
        point = points.isel(operating_point=number)
        for name in ("film_thickness", "contact_half_width", "entrainment_speed"):
            assert point[name].item() == here[name].item()
        assert point["reduced_modulus"].item() == table["reduced_modulus"].item()
    turned = table.transpose("force", "lubricant", "speed", "temperature", ...)
    assert operating_points(turned, 0.1).identical(points)
    forces = table["force"].values.tolist()  # which change fastest
    assert points["force"].values.tolist() == forces * (count // len(forces))


def test_surface_speeds_have_their_mean_and_their_slip():
    for slip in (-2.0, -0.3, 0.0, 0.3, 2.0):
        first, second = surface_speeds(0.7, slip)
        assert (first + second) / 2.0 == pytest.approx(0.7)
        assert (first - second) / 0.7 == pytest.approx(slip, abs=1e-15)
        faster = max(first, second)
        assert speed_ratios(slip) == pytest.approx((first / faster, second / faster))
        assert max(speed_ratios(slip)) == 1.0
