"""Positions of computed films, and six digits."""

import numpy as np
import pytest
import xarray as xr
from hypothesis import given
from hypothesis import strategies as st

from lube.digits import six_digits
from lube.ehl import line_contact
from lube.ehl.line_contact import FilmProfile, profiles_of
from lube.grid.film_profiles import film_positions, over_positions

GROUPS = (1.387e-5, 2.574e-11, 3693.0, 0.2835, 2.308e11)  # the paper's at 800 N, 40 degC


def contact_of(half_width=1.5e-4, radius=0.025, roughness=0.28e-6):
    lengths = {"contact_half_width": half_width, "reduced_radius": radius}
    return xr.Dataset(lengths | {"composite_rms_roughness": roughness})


@given(st.floats(2e-5, 1e-3), st.floats(5e-3, 0.5), st.floats(1e-8, 2e-6))
def test_positions_reach_to_a_gap_that_no_line_fills(half_width, radius, roughness):
    positions = film_positions(contact_of(half_width, radius, roughness))
    np.testing.assert_array_equal(positions, -positions[::-1])
    assert np.all(np.diff(positions) > 0.0)
    assert {-1.0, 0.0, 1.0} <= set(positions.tolist())
    outside = (positions[-1] - 1.0) * half_width
    assert outside**2 / (2.0 * radius) >= 11.99 * roughness


def test_positions_reach_as_far_as_the_contact_of_least_gap_needs():
    """Contacts may differ in radius: the widest need not be the one whose gap opens last."""
    half_widths, radii = np.array([9e-6, 1.1e-5, 8e-6]), np.array([0.05, 0.001, 0.002])
    several = contact_of(("point", half_widths), ("point", radii))
    each = [film_positions(contact_of(*one)) for one in zip(half_widths, radii, strict=True)]
    np.testing.assert_array_equal(film_positions(several), max(each, key=np.size))


def test_a_film_that_does_not_converge_is_missing_and_named(monkeypatch, caplog):
    monkeypatch.setattr(line_contact, "_MOST_STEPS", 3)
    speeds = np.array([1.0, 1.01]) * GROUPS[1]
    profiles = profiles_of(GROUPS[0], speeds, *GROUPS[2:])
    assert profiles.tolist() == [None, None]
    assert "M = 1.93, L = 9.89 did not converge" in caplog.text
    solved = xr.DataArray(profiles, dims="speed")
    assert np.isnan(over_positions(solved, FilmProfile.film_at, film_positions(contact_of()))).all()


def test_profiles_are_those_of_the_solver_with_six_digits():
    solved = xr.DataArray(profiles_of(*np.array(GROUPS)[:, None]), dims="speed")
    found = over_positions(solved, FilmProfile.film_at, film_positions(contact_of()))
    positions = found["film_position"].values
    exact = line_contact.solve(line_contact.LineContact(*GROUPS)).film_at(positions)
    assert found.dims == ("speed", "film_position")
    assert found.values[0] == pytest.approx(exact, rel=1e-5)
    assert found.values[0].tolist() == six_digits(exact).tolist()
