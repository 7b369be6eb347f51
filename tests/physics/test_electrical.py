"""Electrical resistance of spots in parallel (paper, Eq. 1)."""

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st
from scipy.integrate import quad
from scipy.special import ndtr

from lube.physics.electrical import (
    divider_voltage,
    film_capacitance,
    mean_inverse_gap,
    read_impedance,
    resistance_from_voltage,
    surrounding_capacitance,
)
from lube.physics.hertz import hertz_gap
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


LAYER = 5e-9


@given(st.floats(1e-9, 1e-4))
def test_smooth_surfaces_are_plates_exactly(film):
    assert mean_inverse_gap(film, 0.0, 1e-9) == 1.0 / film


def by_quadrature(film, rms, layer):
    """The mean of 1 / max(g, layer) over a Gaussian gap, by adaptive quadrature."""
    height, least = film / rms, layer / rms
    places = [height + shift for shift in (-4.0, -1.0, 0.0, 1.0, 4.0)] + [2.0 * least, 9.0 * least]
    top = max(height, 0.0) + 12.0 + least
    places = [one for one in places if least < one < top]
    outside, _ = quad(
        lambda gap: np.exp(-0.5 * (gap - height) ** 2) / np.sqrt(2.0 * np.pi) / gap,
        *(least, top),
        points=sorted(places),
        limit=2000,
        epsabs=0.0,
        epsrel=1e-12,
    )
    return (ndtr(least - height) / least + outside) / rms


@pytest.mark.parametrize("ratio", [0.0, 0.3, 1.0, 2.0, 3.8, 8.6, 20.0])
@pytest.mark.parametrize("rms", [1e-8, 2.8e-7, 1e-6])
def test_the_mean_of_one_over_a_rough_gap_is_that_of_quadrature(ratio, rms):
    found = mean_inverse_gap(ratio * rms, rms, LAYER)
    assert found == pytest.approx(by_quadrature(ratio * rms, rms, LAYER), rel=1e-9)


def test_a_rough_gap_has_more_capacitance_than_its_mean_and_tends_to_it():
    films = np.geomspace(1e-6, 1e-4, 9)
    more = mean_inverse_gap(films, 0.28e-6, LAYER) * films
    assert (np.diff(more) < 0.0).all() and (more > 1.0).all()
    # To second order in the roughness.
    assert more[-1] - 1.0 == pytest.approx((0.28e-6 / 1e-4) ** 2, rel=1e-3)


def test_surfaces_far_smoother_than_the_layer_are_plates():
    rms = np.array([1e-13, 1e-12, 1e-11])
    np.testing.assert_allclose(mean_inverse_gap(1e-6, rms, LAYER), 1e6, rtol=1e-9)
    np.testing.assert_allclose(mean_inverse_gap(0.5 * LAYER, rms, LAYER), 1.0 / LAYER, rtol=1e-9)


def test_a_drawn_line_has_this_mean():
    heights = np.random.default_rng(1).standard_normal(1_000_000) * 0.28e-6
    gap = np.maximum(1e-6 - heights, LAYER)
    found = np.mean(1.0 / gap)
    assert found == pytest.approx(mean_inverse_gap(1e-6, 0.28e-6, LAYER), rel=0.005)


@pytest.mark.parametrize("film", [5e-8, 1e-6])
def test_the_gap_beside_the_contact_is_integrated_on_both_sides(film):
    half_width, radius = 0.21e-3, 0.025
    # With X = 1 + y^2 the integrand is smooth at the edge.
    scale = half_width**2 / radius
    inside, _ = quad(
        lambda y: 2.0 * y * half_width / (film + hertz_gap(1.0 + y * y) * scale),
        0.0,
        1e3,
        limit=900,
    )
    expected = 8.8541878188e-12 * 3.2 * 0.01 * inside
    found = surrounding_capacitance(film, half_width, radius, 0.01, 2.2)
    assert found == pytest.approx(expected, rel=1e-4)


def test_an_impedance_is_that_of_the_mean_current():
    series, closed, capacitance, frequency, share = 100.0, 0.5, 2e-10, 1e5, 0.02
    omega = 2.0 * np.pi * frequency
    # Ten thousand contacts, each seen at one volt.
    is_closed = np.arange(10_000) < share * 10_000
    gap = np.where(is_closed, closed, 1.0 / (1j * omega * capacitance))
    expected = 1.0 / np.mean(1.0 / (series + gap)) - series
    found = read_impedance(share, closed, capacitance, frequency, series)
    assert found == pytest.approx(expected, rel=1e-9)
    phases = np.angle(
        read_impedance(np.array([0.0, 1e-4, 1.0]), closed, capacitance, frequency, series), deg=True
    )
    assert phases[0] == pytest.approx(-90.0)
    assert -90.0 < phases[1] < -45.0
    assert phases[2] == pytest.approx(0.0, abs=1e-6)
