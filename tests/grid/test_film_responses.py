"""Responses of films to waves at any angle: those of lines at no angle, and symmetries."""

from dataclasses import replace

import numpy as np
import pytest
import xarray as xr

from lube.ehl.line_contact import LineContact, solve
from lube.ehl.response import WaveResponse
from lube.grid.film_responses import (
    ANGLES,
    SURFACE_VARIABLES,
    _deformation,
    changed_waves,
    line_heights,
    surface_heights,
)
from lube.grid.films import FilmGroups, film_at, hertz_contact
from lube.study.oil_properties import lubricant_table
from lube.surfaces.rough_surface import rough_surface

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
    for name in SURFACE_VARIABLES[:2]:
        across = film[name].sel(wave_angle=0.0, drop=True)
        np.testing.assert_array_equal(across, film[name.removeprefix("surface_")])


def test_each_wave_is_solved_for(responses):
    film, profile, slip = responses
    assert film["wave_angle"].values.tolist() == ANGLES.tolist()
    one = film.isel(wavelength=3).sel(wave_angle=60.0)
    one = one.isel(response_position=film["response_position"] < profile.spike - 0.25)
    scaled = one["wavelength"] / one["contact_half_width"]
    wave = WaveResponse(profile, scaled.item(), angle=60.0)
    for roller, speed in ((1, 1.0 + slip / 2.0), (2, 1.0 - slip / 2.0)):
        expected = wave.transfer(speed, one["response_position"].values)
        parts = (one[name].sel(roller=roller) for name in SURFACE_VARIABLES[:2])
        for part, other in zip(parts, (expected.real, expected.imag), strict=True):
            np.testing.assert_allclose(part, other, rtol=1e-5, atol=1e-9)


def test_at_the_spike_it_is_that_of_a_film_whose_spike_is_shifted():
    # Under a scattering load the film follows a change of load, on average, by its covariance with
    # the load. Long ridges along rolling change the load of each cross section.
    speed = 0.5 * 0.005**4
    contact = LineContact(3.0 * np.sqrt(2.0 * speed), speed, 4000.0, 0.1, 2.3e11)  # M 3, L 20
    position, deviation = np.linspace(-1.0, 1.0, 101), np.linspace(-2.0, 2.0, 13)
    followed = 0.0
    for each, weight in zip(deviation, deviation * np.exp(-0.5 * deviation**2), strict=True):
        other = replace(contact, load=contact.load * (1.0 + 0.2 * each))
        place = position * contact.half_width / other.half_width
        followed = followed + weight * solve(other).film_at(place)
    profile = solve(contact)
    mean = changed_waves(profile, np.array([100.0]), [1.0], position, 90.0)[0, 0].real
    linear = WaveResponse(profile, 100.0, angle=90.0).transfer(1.0, position).real
    errors = []
    for response in mean, linear:
        scale = np.sum(followed * response) / np.sum(response**2)
        errors.append(np.abs(scale * response - followed).max() / np.ptp(followed))
    assert errors[0] < 0.06
    assert errors[1] > 0.5


def test_without_slip_both_surfaces_have_the_same_response(responses):
    film, _, slip = responses
    first, second = (film[SURFACE_VARIABLES[0]].sel(roller=roller) for roller in (1, 2))
    assert np.array_equal(first, second) == (slip == 0.0)


def test_waves_of_an_isotropic_surface_change_as_those_of_its_line_if_alike_at_all_angles(
    make_spec,
):
    spec = make_spec(20_000, second_roughness=1e-7)
    wavelengths = np.geomspace(spec.longest_wavelength, 2e-5, 20)
    lines = line_heights(spec, wavelengths)[:, 0]
    surfaces = surface_heights(spec, wavelengths)
    np.testing.assert_allclose(surfaces.sum(axis=1), lines, rtol=0.01, atol=1e-3 * lines.max())
    np.testing.assert_allclose(lines.sum(axis=1), np.square(spec.rms_height), rtol=1e-6)
    # As many waves run at any angle; at the ends are half as many nearest.
    shares = surfaces.sum(axis=2) / lines.sum(axis=1)[:, None]
    np.testing.assert_allclose(shares, [np.r_[0.5, np.ones(5), 0.5] / 6.0] * 2, rtol=0.01)


@pytest.mark.parametrize("lay_angle", [0.0, 30.0, 90.0])
def test_waves_of_a_surface_with_a_lay_are_those_of_the_surface_drawn(make_spec, lay_angle):
    lay = {"lay_ratio": 3.0, "lay_angle": lay_angle}
    spec = make_spec(20_000, **lay)
    wavelengths = np.geomspace(spec.longest_wavelength, 2e-5, 20)
    weights = surface_heights(spec, wavelengths)[0]
    surface = rough_surface(spec, waves=12)
    units = [2.0 * np.pi / side for side in surface.sides]
    down = units[0] * np.fft.fftfreq(surface.coarse[0], 1.0 / surface.coarse[0])[:, None]
    along = units[1] * np.arange(surface.coarse[1] // 2 + 1)
    power = surface.variances * surface.first_part * np.where(along > 0.0, 2.0, 1.0)
    power *= spec.height_step**2
    length = 2.0 * np.pi / np.maximum(np.hypot(along, down), units[0])
    angle = np.degrees(np.arctan2(np.abs(down), along))
    known = np.sum(power * (1.0 + np.cos(np.radians(2.0 * angle))))
    at_nodes = 1.0 + np.cos(np.radians(2.0 * ANGLES))
    assert np.sum(weights * at_nodes[:, None]) == pytest.approx(known, rel=0.03)
    expected = np.sum(power * np.log(length)) / np.sum(power)
    found = np.sum(weights * np.log(wavelengths)) / np.sum(weights)
    assert found == pytest.approx(expected, abs=0.05)


def test_waves_too_short_to_be_solved_for_count_as_changed_as_the_shortest_that_was():
    dims = "point", "roller", "wave_angle", "wavelength", "response_position"
    changes = np.array([[0.5, 0.3, 0.2, 0.0, 0.0], [0.5, 0.4, 0.3, 0.2, 0.1]])
    levels = {"response_position": [0.0]}
    response = xr.DataArray(1.0 + 1j * changes[:, None, None, :, None], levels, dims)
    heights = np.array([1.0, 2.0, 3.0, 4.0, 5.0])
    changes[0, 3:] = 0.2
    expected = np.sqrt(changes**2 @ heights)
    np.testing.assert_allclose(_deformation(response, heights[None, None]), expected, rtol=1e-5)


def test_the_deformation_is_that_of_all_waves_together(responses, make_spec):
    film, _, _ = responses
    change = film[SURFACE_VARIABLES[0]] + 1j * film[SURFACE_VARIABLES[1]] - 1.0
    change = change.where(abs(film["response_position"]) <= 1.0, drop=True)
    square = np.mean(abs(change) ** 2, axis=change.dims.index("response_position"))
    square = square.transpose("roller", "wave_angle", "wavelength")
    heights = surface_heights(make_spec(20_000), film["wavelength"].values)
    found = film["surface_rms_deformation"].item()
    assert found == pytest.approx(np.sqrt(np.sum(square.values * heights)), rel=1e-5)
    assert 0.2 < found / film["rms_deformation"].item() < 5.0
