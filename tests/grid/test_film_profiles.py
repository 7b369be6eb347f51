"""Positions of computed films, and six digits."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from lube.ehl import line_contact
from lube.ehl.line_contact import FilmProfile, profiles_of
from lube.grid.film_profiles import film_positions, sampled, six_digits

CONTACT = (1.387e-5, 2.574e-11, 3693.0, 0.2835, 2.308e11)  # the paper's at 800 N, 40 degC


@given(st.floats(2e-5, 1e-3), st.floats(5e-3, 0.5), st.floats(1e-8, 2e-6))
def test_positions_reach_to_a_gap_that_no_line_fills(half_width, radius, roughness):
    positions = film_positions(half_width, radius, roughness)
    np.testing.assert_array_equal(positions, -positions[::-1])
    assert np.all(np.diff(positions) > 0.0)
    assert {-1.0, 0.0, 1.0} <= set(positions.tolist())
    outside = (positions[-1] - 1.0) * half_width
    assert outside**2 / (2.0 * radius) >= 11.99 * roughness


def test_a_film_that_does_not_converge_is_missing_and_named(monkeypatch, caplog):
    monkeypatch.setattr(line_contact, "_MOST_STEPS", 3)
    speeds = np.array([1.0, 1.01]) * CONTACT[1]
    profiles = profiles_of(CONTACT[0], speeds, *CONTACT[2:])
    assert profiles.tolist() == [None, None]
    assert "M = 1.93, L = 9.89 did not converge" in caplog.text
    assert np.isnan(sampled(profiles, FilmProfile.film_at, np.zeros(4))).all()


def test_profiles_are_those_of_the_solver_with_six_digits():
    profiles = profiles_of(*np.array(CONTACT)[:, None])
    positions = np.linspace(-2.0, 2.0, 9)
    exact = line_contact.solve(line_contact.LineContact(*CONTACT)).film_at(positions)
    found = sampled(profiles, FilmProfile.film_at, positions)
    assert found.shape == (1, 9)
    assert found[0] == pytest.approx(exact, rel=1e-5)
    assert found[0].tolist() == six_digits(exact).tolist()


@given(st.floats(1e-300, 1e300))
def test_six_digits_are_the_nearest(value):
    assert six_digits(np.array([value]))[0] == pytest.approx(value, rel=5.0001e-6)
    assert f"{six_digits(np.array([value]))[0]:.6g}" == f"{value:.6g}"
