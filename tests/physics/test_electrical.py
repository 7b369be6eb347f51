"""Electrical resistance of spots in parallel (paper, Eq. 1)."""

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from lube.physics.electrical import divider_voltage, film_capacitance, resistance_from_voltage
from lube.stages import contact_resistance
from lube.study.rig_settings import Rig

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


RIG = Rig()
resistances = st.floats(1e-3, 1e6)


@given(resistances, resistances)
def test_voltage_rises_with_resistance_which_follows_from_it(one, other):
    assume(one < other * (1.0 - 1e-9))
    assert divider_voltage(one, RIG) < divider_voltage(other, RIG)
    found = resistance_from_voltage(divider_voltage(one, RIG), RIG)
    assert found == pytest.approx(one, rel=1e-6, abs=1e-6)


def test_an_open_circuit_shows_the_bias_voltage_and_a_short_that_of_the_leads():
    assert divider_voltage(np.inf, RIG) == RIG.bias_voltage
    assert divider_voltage(0.0, RIG) == pytest.approx(RIG.bias_voltage * 0.2 / 100.2)
    assert resistance_from_voltage(RIG.bias_voltage, RIG) == np.inf
    assert resistance_from_voltage(2.0 * RIG.bias_voltage, RIG) == np.inf
    assert resistance_from_voltage(0.0, RIG) == pytest.approx(-0.2)


def test_a_film_is_a_plate_capacitor():
    # 0.42 mm by 10 mm of vacuum, 1 um thick.
    assert film_capacitance(1e-6, 0.21e-3, 0.01, 1.0) == pytest.approx(37.19e-12, rel=1e-3)
    assert film_capacitance(0.5e-6, 0.21e-3, 0.01, 2.0) == pytest.approx(4 * 37.19e-12, rel=1e-3)
