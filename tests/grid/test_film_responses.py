"""Responses of films to waves at any angle: those of lines at no angle, and symmetries."""

import numpy as np
import pytest
import xarray as xr

from lube.ehl.response import WaveResponse
from lube.grid.film_responses import ANGLES, SURFACE_VARIABLES
from lube.grid.films import FilmGroups, film_at, hertz_contact
from lube.study.oil_properties import lubricant_table

FORCE, SPEED = 1600.0, 100.0


@pytest.fixture(scope="module", params=[0.0, 0.4])
def responses(request, study, make_spec):
    """Film at one operating point, with the responses to lines and to surfaces."""
    oil = lubricant_table(study.lubricants, [80.0]).isel(lubricant=0, temperature=0)
    point = xr.DataArray(FORCE), xr.DataArray(SPEED)
    spec = make_spec(20_000)
    answered = {"answered_lines": spec, "answered_surfaces": spec}
    slip = request.param
    film = film_at(oil, study.rollers, *point, ["paper"], slide_to_roll_ratio=slip, **answered)
    contact = hertz_contact(study.rollers, *point)
    profile = FilmGroups.at(oil, study.rollers, point[0], contact).profiles.item()
    return film, profile, slip


def test_waves_across_rolling_have_the_response_of_lines(responses):
    film, _, _ = responses
    for name in SURFACE_VARIABLES:
        across = film[name].sel(wave_angle=0.0, drop=True)
        np.testing.assert_array_equal(across, film[name.removeprefix("surface_")])


def test_each_wave_is_solved_for(responses):
    film, profile, slip = responses
    assert film["wave_angle"].values.tolist() == ANGLES.tolist()
    one = film.isel(wavelength=3).sel(wave_angle=60.0)
    scaled = one["wavelength"] / one["contact_half_width"]
    wave = WaveResponse.of(profile, scaled.item(), angle=60.0)
    for roller, speed in ((1, 1.0 + slip / 2.0), (2, 1.0 - slip / 2.0)):
        expected = wave.transfer(speed, film["response_position"].values)
        parts = (one[name].sel(roller=roller) for name in SURFACE_VARIABLES)
        for part, other in zip(parts, (expected.real, expected.imag), strict=True):
            np.testing.assert_allclose(part, other, rtol=1e-5, atol=1e-9)


def test_without_slip_both_surfaces_have_the_same_response(responses):
    film, _, slip = responses
    first, second = (film[SURFACE_VARIABLES[0]].sel(roller=roller) for roller in (1, 2))
    assert np.array_equal(first, second) == (slip == 0.0)
