"""Answers of the oil to rough lines: few functions and coarse grids against every single wave."""

import numpy as np
import pytest
from plain_answers import PlainAnswer

from lube.contact import waves
from lube.contact.waves import Answer, Waves, answers_at, lifted
from lube.grid.discretise import line_pair
from lube.grid.operating_points import at_slip
from lube.kernels.motion import surface_position
from lube.stages import film_table, lubricant_table, roughness_lines

SLIPS = (0.0, 1.0)


@pytest.fixture(scope="module")
def spec(make_spec):
    return make_spec(30_000, 0.04)


@pytest.fixture(scope="module")
def film(study, spec):
    """Films that answer, at frequent and at rare contact."""
    oil = lubricant_table(study.lubricants, [60.0, 80.0])
    levels = [400.0, 1600.0], [100.0], ["computed"], True, SLIPS
    return film_table(oil, study.rollers, *levels, answered_lines=spec).squeeze()


@pytest.fixture(scope="module")
def pair(spec):
    return line_pair(roughness_lines(spec, 11, [0]), 0)


@pytest.fixture(params=SLIPS)
def point(request, film):
    return at_slip(film, request.param).isel(temperature=1, force=1)


def composite(spec):
    return np.hypot(*spec.rms_height) / spec.height_step


# The expansion


def test_a_response_of_two_factors_takes_one_function_of_each():
    position, wavelength = np.linspace(-1.0, 1.0, 41), np.geomspace(4e-4, 2e-5, 17)
    of_place = np.cos(position)
    of_wave = (0.3 + 0.2j) * np.linspace(1.0, 0.0, 17) ** 2
    response = 1.0 + of_wave[:, None] * of_place
    answer = Answer.of(response, (wavelength, position), 1e-4, np.ones(41))
    assert answer.shapes.shape == (41, 1)
    found = answer.filters @ answer.at(position).T
    np.testing.assert_allclose(found[:: waves.FINER], response[:-1] - 1.0, atol=1e-5)


def test_an_oil_that_changes_nothing_takes_no_function(pair, spec):
    position, wavelength = np.linspace(-1.0, 1.0, 41), np.geomspace(4e-4, 2e-5, 17)
    answer = Answer.of(np.ones((17, 41), complex), (wavelength, position), 1e-4, np.ones(41))
    assert answer.shapes.shape == (41, 0)
    assert Waves(pair[0], spec).filtered(answer).shape[1] == 0


def test_both_rollers_share_an_answer_in_pure_rolling_only(film):
    for slip, alike in zip(SLIPS, (True, False), strict=True):
        both = answers_at(at_slip(film, slip), True).isel(force=1, temperature=0).values
        assert (both[0] is both[1]) == alike


@pytest.mark.parametrize("has_shape", [False, True])
def test_answers_to_lines_are_those_to_every_wave(has_shape, point, pair, spec):
    answers = answers_at(point, has_shape).values
    half = int(point["contact_half_width"].item() / spec.spacing)
    window = np.arange(-half, half + 1)
    plain = [
        PlainAnswer(line.size, spec.spacing, point.isel(roller=roller), window)
        for roller, line in enumerate(pair)
    ]
    square = []
    for place in range(17, 12_000, 1000):
        ratios = 1.0, 0.37
        places = [surface_position(place, ratio) for ratio in ratios]
        found = lifted(pair, spec, answers, ratios, place, window)
        square.append(
            [(found[i] - plain[i].lift(pair[i], places[i])) ** 2 for i in range(2)],
        )
        total = sum(one.lift(*at) for one, *at in zip(plain, pair, places, strict=True))
        assert np.std(total) > 0.1 * composite(spec)
    rms = np.sqrt(np.mean(square, axis=0).sum(axis=0))
    assert rms.mean() < waves.PRECISION * composite(spec)
    assert rms.max() < 2.0 * waves.PRECISION * composite(spec)
