"""Rms heights and covariances in windows that the oil answers, against sums over every wave."""

import numpy as np
import pytest
from plain_answers import PlainAnswer

from lube.contact.answered_windows import answered_windows, rms_along
from lube.contact.waves import answers_at
from lube.stages import film_table, lubricant_table
from lube.surfaces.synthetic import wave_amplitudes


# Unequal rollers, and equal ones, for which one roller's statistics serve both.
@pytest.fixture(scope="module", params=[0.04, None], ids=["unequal", "equal"])
def spec(request, make_spec):
    return make_spec(30_000, request.param)


@pytest.fixture(scope="module", params=[0.0, 1.0])
def point(request, study, spec):
    """A film that answers, in rolling and with slip."""
    oil = lubricant_table(study.lubricants, [80.0])
    levels = [1600.0], [100.0], ["computed"], True, [request.param]
    return film_table(oil, study.rollers, *levels, answered_lines=spec).squeeze()


def composite(spec):
    return np.hypot(*spec.rms_height) / spec.height_step


@pytest.fixture
def window(point, spec):
    half_width = point["contact_half_width"].item()
    film = np.full(int(2 * half_width / spec.spacing), composite(spec))
    before = film.size // 2
    answers = tuple(answers_at(point, False).values)
    return answered_windows(spec, film.size, before, answers)(film), before


def changed_waves(spec, roller, point, positions):
    """Square amplitudes, wavenumbers and responses of each wave at positions."""
    first, amplitudes = wave_amplitudes(spec, roller)
    points, numbers = spec.points[roller], first + np.arange(amplitudes.size)
    plain = PlainAnswer(points, spec.spacing, point.isel(roller=roller), positions)
    count = plain.numbers[-1] - first + 1
    change = plain.change[:, first - 1 :][:, : amplitudes.size]
    response = np.ones((positions.size, amplitudes.size), complex)
    response[:, : change.shape[1]] += change
    assert count > 10
    power = 0.5 * (amplitudes / spec.height_step) ** 2
    return power, 2.0 * np.pi * numbers / points, response


def test_rms_heights_along_the_window_are_those_of_the_waves(window, point, spec):
    found, before = window
    points = np.arange(0, found.film.size, 25)
    square = 0.0
    for roller in range(2):
        power, _, response = changed_waves(spec, roller, point, points - before)
        square = square + np.abs(response) ** 2 @ power
    expected = np.sqrt(square) / composite(spec)
    np.testing.assert_allclose(found.rms[points], expected, rtol=0.02)
    assert np.ptp(found.rms) > 0.05


@pytest.mark.parametrize("is_moving", [False, True])
def test_added_covariances_are_those_of_the_waves(is_moving, window, point, spec):
    """At one moment, and of the same point of the line on its way."""
    found, before = window
    nodes = np.arange(0, found.film.size, 1 << found.shift)[::9]
    for roller in range(2):
        power, by_point, response = changed_waves(spec, roller, point, nodes - before)
        at = np.zeros((nodes.size, 1)) if is_moving else nodes[:, None]
        here = np.exp(1j * by_point * at)
        expected = (response * here * power) @ (response * here).conj().T
        expected = (expected - (here * power) @ here.conj().T).real / composite(spec) ** 2
        shapes = found.shapes[roller][::9][: nodes.size]
        both = np.hstack([np.ones((nodes.size, 1)), shapes])
        table = found.covariances[roller, :, : both.shape[1], : both.shape[1]]
        lags = (at - at.T).astype(int) >> found.shift
        table = table[lags + len(table) // 2]
        some = np.einsum("pa,ptab,tb->pt", both, table, both)
        np.testing.assert_allclose(some, expected, atol=0.01)
        assert np.abs(expected).max() > 0.03


def test_a_wave_without_height_has_no_effect_in_a_window_so_wide_that_it_is_a_band(
    make_spec, study
):
    spec = make_spec(30_000, lay_ratio=5.0, lay_angle=90.0)
    assert wave_amplitudes(spec, 0)[1][0] == 0.0
    levels = [1600.0], [100.0], ["computed"]
    oil = lubricant_table(study.lubricants, [80.0])
    point = film_table(oil, study.rollers, *levels, answered_lines=spec).squeeze()
    answers = tuple(answers_at(point, False).values)
    narrow, wide = (rms_along(spec, 2 * half, half, answers) for half in (30, 2000))
    np.testing.assert_allclose(wide[1970:2030], narrow, rtol=0.01)
