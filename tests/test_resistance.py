"""Electrical resistance of spots in parallel (paper, Eq. 1)."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from lube import contact_resistance

lengths = st.lists(st.floats(1e-9, 1e-3), min_size=1, max_size=6)
resistivities = st.floats(1e-8, 1e-3)


@given(lengths, resistivities)
def test_spots_conduct_in_parallel(spots, resistivity):
    each = contact_resistance(np.array(spots), resistivity)
    together = contact_resistance(np.sum(spots), resistivity)
    assert 1.0 / together == pytest.approx(np.sum(1.0 / each))


def test_no_contact_is_an_open_circuit_without_a_warning(recwarn):
    resistance = contact_resistance(np.array([0.0, 4e-6, 0.0]), 0.2e-6)
    assert resistance.tolist() == [np.inf, pytest.approx(0.05), np.inf]
    assert not recwarn.list


def test_papers_threshold_is_less_than_one_grid_point_in_contact():
    # physics.md, section 6: 100 ohm with 0.2 uohm m is L_con = 2 nm.
    spacing = 2.0 * np.pi * 0.05 / 1e6
    assert contact_resistance(2e-9, 0.2e-6) == pytest.approx(100.0)
    assert contact_resistance(spacing, 0.2e-6) < 100.0
