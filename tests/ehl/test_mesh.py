"""Nodes of the computed film: their ends, their order, their number."""

import numpy as np
import pytest
from paper_grid import contact_at

from lube.ehl.line_contact import solve
from lube.ehl.mesh import first_mesh, inlet_end


@pytest.mark.parametrize("film", [1e-3, 0.1, 3.0])
def test_first_mesh_rises_smoothly_from_the_inlet_through_the_contact(film):
    for end in (-4.0, -200.0, -1e5):
        nodes = first_mesh(film, end)
        steps = np.diff(nodes)
        assert nodes[0] == end and nodes[-1] > 1.0 and np.all(steps > 0.0)
        ratio = steps[2:] / steps[1:-1]  # the first cell ends where the oil begins
        assert ratio.max() < 1.0 + 1e-9 and ratio.min() > 1.0 / 1.12 - 1e-9
        assert steps[0] < 2.0 * steps[1]


@pytest.mark.parametrize("flooded", [10.0, 1e4])
def test_the_oil_begins_where_the_gap_has_the_height_asked_for(flooded):
    """To 10 %: the pressure about the inlet's end moves a low gap a little."""
    profile = solve(contact_at(400, 100, 60), flooded=flooded)
    gap = profile.film_at(profile.nodes[:1])[0] / profile.central_film
    assert gap == pytest.approx(flooded, rel=0.1)


def test_gap_at_the_inlet_end():
    for offset, gap in [(-0.5, 1.0), (0.0, 10.0), (100.0, 1e6)]:
        x = inlet_end(offset, gap)
        assert x < 0.0
        assert x**2 / 2 - np.log(-x) / 2 + offset == pytest.approx(gap, rel=1e-6)


def test_fitted_mesh_resolves_pressure_and_film():
    for point in [(100, 200, 40), (800, 100, 40), (1600, 600 / 7, 80)]:
        profile = solve(contact_at(*point))
        inside = slice(0, profile.end + 1)
        middle = 0.5 * (profile.nodes[1:] + profile.nodes[:-1])
        assert np.abs(np.diff(profile.pressure[inside])).max() < 0.05
        assert np.abs(np.diff(np.log(profile.scaled_gap(middle)[inside]))).max() < 0.15
        assert profile.nodes[-1] > profile.nodes[profile.end + 1]  # nodes beyond the film's end


def test_nodes_are_proportional_to_the_fineness():
    sizes = [solve(contact_at(800, 100, 40), fineness=each).nodes.size for each in (0.5, 1.0, 2.0)]
    np.testing.assert_allclose(np.diff(np.log2(sizes)), 1.0, atol=0.1)
