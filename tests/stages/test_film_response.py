"""Response of the film over the grid: a wave at a time, by the solver, and what studies change."""

import numpy as np
import pytest
from made import made

from lube.contact.rough_pair import drawn
from lube.ehl import line_contact
from lube.ehl.line_contact import ConvergenceError
from lube.ehl.response import WaveResponse, at_wavelengths
from lube.grid.films import FilmGroups
from lube.stages.film_response import film_responses, make

GRID = {
    "force": (400.0, 1600.0),
    "speed": (100.0,),
    "temperature": (60.0, 80.0),
    "slide_to_roll_ratio": (-1.0, 0.0, 1.0),
}


def study_with(busy_study, **changes):
    grid = busy_study.operating_grid.model_copy(update=GRID)
    return busy_study.model_copy(update={"operating_grid": grid, **changes})


@pytest.fixture(scope="module")
def slipping(busy_study):
    return study_with(busy_study)


@pytest.fixture(scope="module")
def files(slipping):
    return made(slipping, ("lubricant", "film", "film_response"))


@pytest.fixture(scope="module")
def found(files):
    return files["film_response"].isel(lubricant=0, speed=0)


def transfer(response):
    return response["response_real"] + 1j * response["response_imaginary"]


def profiles(study, files):
    film = files["film"]
    contact = film[["entrainment_speed", "contact_half_width"]]
    groups = FilmGroups.at(files["lubricant"], study.rollers, film["force"], contact)
    return groups.profiles.isel(lubricant=0, speed=0)


@pytest.mark.parametrize("roller", [1, 2])
@pytest.mark.parametrize("slip", [0.0, 1.0])
def test_it_is_the_response_of_each_points_film(slipping, files, found, roller, slip):
    at = {"temperature": 80.0, "force": 1600.0}
    profile = profiles(slipping, files).sel(**at).item()
    one = found.sel(**at, slide_to_roll_ratio=slip, roller=roller)
    half_width = one["contact_half_width"].item()
    positions, speed = one["film_position"].values, 1.0 + slip * (1.5 - roller)
    for number in (0, 5):
        wave = WaveResponse(profile, one["wavelength"].values[number] / half_width)
        expected = wave.transfer(speed, positions)
        np.testing.assert_allclose(transfer(one)[number], expected, rtol=1e-5, atol=1e-6)
        central = np.abs(wave.transfer(speed, np.zeros(1))).item()
        assert one["amplitude_ratio"].values[number] == pytest.approx(central, rel=1e-5)


def test_waves_reach_from_the_lines_longest_to_those_that_the_oil_does_not_change(slipping, found):
    wavelength = found["wavelength"].values
    assert wavelength[0] == slipping.line_spec.longest_wavelength
    assert np.all(np.diff(wavelength) < 0.0)
    light = transfer(found.sel(slide_to_roll_ratio=0.0, force=400.0)).isel(roller=0)
    changed = np.abs(light - 1.0).max("film_position")
    assert np.all(changed.isel(wavelength=0) > 0.1)
    assert np.all(changed.isel(wavelength=-1) < 0.5 * changed.isel(wavelength=0))


def test_rollers_change_places_with_the_slip_and_are_equal_without(found):
    response = transfer(found).transpose("slide_to_roll_ratio", "roller", ...).values
    np.testing.assert_array_equal(response[0, 0], response[2, 1])
    np.testing.assert_array_equal(response[0, 1], response[2, 0])
    np.testing.assert_array_equal(response[1, 0], response[1, 1])
    assert np.abs(response[0, 0] - response[0, 1]).max() > 0.1


@pytest.mark.parametrize("roller", [1, 2])
def test_the_error_of_interpolation_is_what_a_wave_between_shows(slipping, files, found, roller):
    at = {"temperature": 80.0, "force": 1600.0}
    profile = profiles(slipping, files).sel(**at).item()
    one = found.sel(**at, slide_to_roll_ratio=1.0, roller=roller)
    positions = one["film_position"].values
    scaled = one["wavelength"].values / one["contact_half_width"].item()
    inside = np.abs(positions) <= 1.0
    assert 0.0 < one["interpolation_error"] < 0.02
    for number in range(0, scaled.size - 1, 2):
        between = np.sqrt(scaled[number] * scaled[number + 1])
        estimated = at_wavelengths(np.array([between]), scaled, transfer(one).values, positions)
        exact = WaveResponse(profile, between).transfer(1.0 + (1.5 - roller), positions)
        error = np.sqrt(np.mean(np.abs(estimated[0] - exact)[inside] ** 2))
        assert error < 2.0 * one["interpolation_error"].item() + 1e-3


@pytest.mark.parametrize("slip", [0.0, 1.0])
def test_the_rms_of_the_deformation_is_that_of_drawn_lines_wave_by_wave(slipping, found, slip):
    one = found.sel(temperature=80.0, force=1600.0, slide_to_roll_ratio=slip)
    half_width = one["contact_half_width"].item()
    scaled = one["wavelength"].values / half_width
    inside = np.abs(one["film_position"].values) <= 1.0
    squares, spec = 0.0, slipping.line_spec
    for roller, line in zip((1, 2), drawn(slipping, 0), strict=True):
        waves = np.fft.rfft(line * spec.height_step, norm="forward")[1:-1]
        lengths = line.size * spec.spacing / np.arange(1, waves.size + 1)
        kept = (lengths <= 1.001 * spec.longest_wavelength) & (lengths >= 2.0 * np.pi / spec.q_max)
        response = transfer(one.sel(roller=roller)).values[:, inside]
        answered = at_wavelengths(
            lengths[kept] / half_width, scaled, response, one["film_position"].values[inside]
        )
        added = np.abs((answered - 1.0) * waves[kept, None]) ** 2
        squares += 2.0 * added.sum(axis=0).mean()
    assert one["rms_deformation"].item() == pytest.approx(np.sqrt(squares), rel=0.01)


def test_threads_change_nothing(slipping, files):
    again = make(slipping, files, threads=1)
    assert again.identical(files["film_response"])


def test_heating_thins_the_film_that_answers(busy_study, monkeypatch):
    study = study_with(busy_study, inlet_shear_heating="zhu-cheng-1988")
    files = made(study, ("lubricant", "film"))
    central, form = [], WaveResponse.__init__

    def noted(wave, profile, *arguments, **options):
        central.append(profile.central_film * study.rollers.reduced_radius)
        form(wave, profile, *arguments, **options)

    monkeypatch.setattr(WaveResponse, "__init__", noted)
    heated = make(study, files)
    cold = profiles(study, files)
    films = cold.copy(data=np.vectorize(lambda one: one.central_film)(cold.values))
    factor = files["film"]["inlet_shear_heating_factor"].isel(lubricant=0, speed=0)
    expected = factor * films.astype(float) * study.rollers.reduced_radius
    np.testing.assert_allclose(np.unique(central), np.unique(expected), rtol=1e-4)
    assert not heated["response_real"].isnull().any()


def test_a_film_that_is_not_found_has_no_response_and_is_named(
    slipping, files, monkeypatch, caplog
):
    settle = line_contact._settle

    def failing(contact, nodes, *state):
        if contact.load > 1.5e-5:  # of the greater force alone
            raise ConvergenceError(f"{contact.name} did not converge")
        return settle(contact, nodes, *state)

    monkeypatch.setattr(line_contact, "_settle", failing)
    film = files["film"].sel(temperature=[80.0], slide_to_roll_ratio=[0.0])
    oil = files["lubricant"].sel(temperature=[80.0])
    found = film_responses(oil, film, slipping.rough_rollers, slipping.line_spec)
    known = found["response_real"].notnull().all(["wavelength", "film_position", "roller"])
    assert known.squeeze().values.tolist() == [True, False]
    assert "the film at M =" in caplog.text
