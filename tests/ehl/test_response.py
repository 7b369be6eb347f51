"""What the oil does to waves: Reynolds' equation itself, limits, print, and other codes."""

from functools import cache
from unittest import mock

import numpy as np
import pytest
from paper_grid import contact_at, contact_by

from lube.ehl.line_contact import on_nodes, solve
from lube.ehl.response import POINTS_A_WAVE, WaveResponse, at_wavelengths
from lube.ehl.reynolds import DiscreteContact

HEAVY, FIG_5, LIGHT = (1600, 100, 80), (800, 100, 40), (100, 100, 80)
MIDDLE = np.array([0.0])
INSIDE = np.linspace(-0.8, 0.4, 25)


@cache
def profile_at(point):
    return solve(contact_at(*point))


@cache
def film_by(moes_load, moes_material, fineness=1.0):
    return solve(contact_by(moes_load, moes_material), fineness=fineness)


def on_finer_nodes(fineness, *arguments):
    with mock.patch("lube.ehl.response.POINTS_A_WAVE", fineness * POINTS_A_WAVE):
        return WaveResponse(*arguments)


def at_centre(profile, wavelength, speed=1.0, fineness=1.0, fixed_load=True):
    wave = on_finer_nodes(fineness, profile, wavelength)
    return abs(wave.transfer(speed, MIDDLE, fixed_load).item())


# Reynolds' equation


@pytest.mark.parametrize("point", [HEAVY, LIGHT])
@pytest.mark.parametrize("wavelength", [0.3, 2.0])
def test_a_wave_at_rest_changes_the_steady_film_as_the_solver_says(monkeypatch, point, wavelength):
    wave = WaveResponse(profile_at(point), wavelength)
    smooth, wavenumber = wave.profile, 2.0 * np.pi / wavelength
    position = 0.5 * (smooth.nodes[1:] + smooth.nodes[:-1])
    position = position[np.abs(position) < 1.5]
    flat, gaps = DiscreteContact.gap, []
    for amplitude in (0.01 * smooth.central_gap, -0.01 * smooth.central_gap):

        def wavy(discrete, *state, amplitude=amplitude):
            return flat(discrete, *state) + amplitude * np.cos(wavenumber * discrete.middle)

        monkeypatch.setattr(DiscreteContact, "gap", wavy)
        gaps.append(on_nodes(smooth, smooth.nodes).scaled_gap(position))
    change = (gaps[0] - gaps[1]) / (0.02 * smooth.central_gap)
    found = wave.transfer(0.0, position) * np.exp(1j * wavenumber * position)
    np.testing.assert_allclose(change + np.cos(wavenumber * position), found.real, atol=0.02)


def literal(wave, speed, position):
    """As `WaveResponse.transfer`, as the equation reads: derivatives by differences, the squeeze
    term by the trapezoidal rule, the wave as it is at every node."""
    profile, wavenumber = wave.profile, 2.0 * np.pi / wave.wavelength
    discrete, state = DiscreteContact(profile.contact, profile.nodes), profile.pressure
    film, step = np.flatnonzero(state[1:-1] > 0.0) + 1, 1e-7

    def flux_and_mass(pressure, offset, added=0.0):
        flow = discrete.flow(pressure, offset)
        density = profile.contact.density(0.5 * (pressure[1:] + pressure[:-1]))[0]
        return flow.flux + flow.by_gap * added, density * (flow.gap + added)

    def residual(change):
        flux, mass = change
        weight = 0.5 * discrete.weight[1:-1]
        return (np.diff(flux) - 1j * wavenumber * speed * weight * (mass[1:] + mass[:-1]))[film - 1]

    def difference(pressure, offset, added=0.0):
        above = flux_and_mass(state + pressure, profile.offset + offset, added)
        below = flux_and_mass(state - pressure, profile.offset - offset, -added)
        return residual([(a - b) / 2.0 for a, b in zip(above, below, strict=True)])

    columns = [difference(step * np.eye(state.size)[node], 0.0) / step for node in film]
    columns.append(difference(0.0 * state, step) / step)
    matrix = np.vstack([np.transpose(columns), np.append(discrete.weight[film], 0.0)])
    right = difference(0.0 * state, 0.0, np.exp(1j * wavenumber * discrete.middle))
    pressure = np.zeros(state.size, complex)
    *pressure[film], shift = np.linalg.solve(matrix, np.append(-right, 0.0))
    deflection = np.interp(position, discrete.middle, discrete.deflection @ pressure)
    return 1.0 + (shift + deflection) * np.exp(-1j * wavenumber * position)


@pytest.mark.parametrize("speed", [1.0, 1.5, 0.5])
def test_it_is_what_a_literal_solution_on_finer_nodes_finds(speed):
    position = np.array([-0.5, 0.0, 0.5, 0.8])
    found = WaveResponse(profile_at(HEAVY), 1.0).transfer(speed, position)
    fine = on_finer_nodes(4.0, profile_at(HEAVY), 1.0)
    np.testing.assert_allclose(found, literal(fine, speed, position), atol=0.02)


# Limits


@pytest.mark.parametrize("point", [HEAVY, FIG_5])
@pytest.mark.parametrize("speed", [1.0, 1.5])
def test_short_waves_stay_as_they_are(point, speed):
    position = np.linspace(-1.0, 1.0, 101)
    short, long = (
        np.abs(WaveResponse(profile_at(point), wavelength).transfer(speed, position) - 1.0).max()
        for wavelength in (0.05, 4.0)
    )
    assert short < 0.03 < long


@pytest.mark.parametrize("numbers", [(8.0, 18.0), (20.0, 20.0), (8.0, 22.0), (5.0, 30.0)])
def test_in_almost_solid_oil_it_is_smooth_and_the_same_on_finer_nodes(numbers):
    films = (film_by(*numbers, fineness) for fineness in (1.0, 2.0))
    usual, fine = (np.abs(WaveResponse(film, 2.0).transfer(1.0, INSIDE)) for film in films)
    np.testing.assert_allclose(usual, fine, rtol=0.01)
    # Without damping it ranged from 0.5 to 5 over the contact at M = 8 and L = 22.
    assert np.ptp(usual) < 0.05


def test_the_response_is_the_same_on_finer_nodes():
    for point in (HEAVY, FIG_5):
        for wavelength, speed in ((4.0, 1.0), (1.0, 1.0), (0.25, 1.0), (1.0, 1.5), (0.5, 0.5)):
            coarse, fine = (
                at_centre(profile_at(point), wavelength, speed, fineness) for fineness in (1, 2)
            )
            assert coarse == pytest.approx(fine, rel=0.02)


# Numbers of others


@pytest.mark.parametrize(
    ("wavelength", "printed"),
    [(4.0, 0.030), (2.0, 0.073), (1.0, 0.183), (0.5, 0.394), (0.25, 0.660), (0.125, 0.839)],
)
def test_it_is_near_the_printed_nonlinear_solution(wavelength, printed):
    """Venner, Couhier, Lubrecht and Greenwood (1996), Table 1, amplitude 0.1 of the film; read in
    transcription."""
    assert at_centre(film_by(100.0, 11.0), wavelength) == pytest.approx(printed, rel=0.08)


# Another code's, on the same equations: the study's design notes, physics beyond the paper, § 15.


@pytest.mark.parametrize(
    ("speed", "wavelength", "expected"),
    [
        (1.0, 1.0, 0.845),
        (1.0, 2.0, 0.501),
        (1.0, 4.0, 0.258),
        (1.1, 1.0, 0.764),
        (1.1, 0.5, 0.922),
        (1.5, 1.0, 0.341),
        (1.5, 0.25, 0.830),
        (0.5, 1.0, 0.704),
        (0.5, 0.5, 0.047),
    ],
)
def test_another_code_finds_the_same_in_the_middle(speed, wavelength, expected):
    found = at_centre(profile_at(HEAVY), wavelength, speed)
    assert found == pytest.approx(expected, rel=0.005, abs=0.001)


def test_another_code_finds_the_same_across_the_contact_and_at_a_fixed_gap():
    position = np.array([-0.5, 0.0, 0.5, 0.8, 0.9])
    found = np.abs(WaveResponse(profile_at(HEAVY), 2.0).transfer(1.0, position))
    np.testing.assert_allclose(found, [0.505, 0.501, 0.496, 0.251, 0.370], atol=0.0015)
    for wavelength, expected in ((1.0, 0.853), (2.0, 0.533), (4.0, 0.220)):
        found = at_centre(profile_at(HEAVY), wavelength, fixed_load=False)
        assert found == pytest.approx(expected, abs=0.001)


# Waves at an angle


def at_angle(point, wavelength, angle, speed=1.0, fineness=1.0):
    wave = on_finer_nodes(fineness, profile_at(point), wavelength, angle)
    return wave.transfer(speed, MIDDLE).item()


@pytest.mark.parametrize(
    ("point", "wavelength", "expected"),
    [
        (HEAVY, 2.0, [0.501, 0.472, 0.379, 0.330, 0.323]),
        (HEAVY, 1.0, [0.845, 0.813, 0.733, 0.696, 0.691]),
        (HEAVY, 0.5, [1.018, 1.007, 0.980, 0.968, 0.966]),
        ((800, 100, 60), 1.0, [1.021, 1.016, 0.987, 0.969, 0.966]),
    ],
)
def test_another_code_finds_the_same_at_an_angle(point, wavelength, expected):
    """The same source as above."""
    found = [abs(at_angle(point, wavelength, angle)) for angle in (0.0, 30.0, 60.0, 80.0, 90.0)]
    np.testing.assert_allclose(found, expected, atol=0.0015)


@pytest.mark.parametrize(
    ("point", "expected"),
    [(HEAVY, [0.323, 0.133, 0.060, 0.033]), ((800, 100, 60), [0.776, 0.450, 0.231, 0.133])],
)
def test_ridges_along_rolling_flatten_the_more_the_farther_they_are_apart(point, expected):
    """The same source, at 90 degrees; such waves do not move, so the response is real."""
    found = np.array([at_angle(point, wavelength, 90.0) for wavelength in (2.0, 4.0, 8.0, 16.0)])
    np.testing.assert_allclose(np.abs(found), expected, atol=0.0015)
    np.testing.assert_allclose(found.imag, 0.0, atol=1e-9)


@pytest.mark.parametrize("speed", [1.0, 1.3])
def test_the_response_at_an_angle_is_the_same_on_finer_nodes_and_one_for_short_waves(speed):
    for angle in (30.0, 75.0):
        coarse, fine = (at_angle(HEAVY, 0.5, angle, speed, each) for each in (1.0, 2.0))
        assert abs(coarse - fine) < 0.01
        assert abs(at_angle(HEAVY, 0.05, angle, speed) - 1.0) < 0.03


def test_a_small_angle_changes_little():
    """The limit is that of a fixed load, and is approached as the logarithm of the angle."""
    straight, *near = (at_angle(HEAVY, 2.0, angle) for angle in (0.0, 1e-3, 1e-6, 1e-9))
    away = np.abs(np.array(near) - straight)
    assert 0.01 > away[0] > away[1] > away[2]


# Between the wavelengths


def test_between_wavelengths_it_is_interpolated_and_beyond_it_is_the_last_or_one():
    position, profile = np.linspace(-1.3, 1.3, 53), profile_at(HEAVY)
    wavelengths = 2.0 * 1.2 ** -np.arange(8.0)
    known = np.stack([WaveResponse(profile, one).transfer(1.0, position) for one in wavelengths])
    np.testing.assert_allclose(at_wavelengths(wavelengths, wavelengths, known, position), known)
    between = WaveResponse(profile, 1.1).transfer(1.0, position)
    found = at_wavelengths(np.array([1.1, 3.0, 0.1]), wavelengths, known, position)
    np.testing.assert_allclose(found[0], between, atol=0.01)
    inside = np.abs(position) <= 1.0
    np.testing.assert_allclose(found[1, inside], known[0, inside])
    np.testing.assert_array_equal(found[2], 1.0)
