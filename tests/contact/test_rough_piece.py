"""A piece of two lines: where it is, its heights as it passes, and what the oil makes of them."""

import numpy as np
import pytest
from paper_grid import RADIUS, contact_at

from lube.contact.rough_piece import RoughPiece
from lube.ehl.line_contact import solve
from lube.ehl.response import WaveResponse
from lube.grid.discretise import LineGrid, speed_ratios
from lube.kernels.motion import surface_position
from lube.surfaces.synthetic import draw_realisation

SLIPS = pytest.mark.parametrize("slip", [0.0, 0.5, -1.0])


@pytest.fixture(scope="module")
def spec(make_spec):
    return make_spec(40_000, second_radius=0.04)


@pytest.fixture(scope="module")
def profile():
    return solve(contact_at(1600.0, 100.0, 80.0))


def piece_of(spec, profile, slip=0.0):
    half_width = profile.contact.half_width * RADIUS
    return RoughPiece(draw_realisation(spec, 11, 0), spec, half_width, slip)


def at_step(pair, step, slip, point=0):
    """Heights of both lines together at a point of the window, as the kernels have them."""
    places = (surface_position(step, ratio) + point for ratio in speed_ratios(slip))
    return sum(int(line[at % line.size]) for line, at in zip(pair, places, strict=True))


@SLIPS
def test_the_lines_are_highest_in_the_middle_of_the_piece(spec, profile, slip):
    piece = piece_of(spec, profile, slip)
    highest = at_step(piece.pair, piece.middle_step, slip)
    assert highest >= max(at_step(piece.pair, step, slip) for step in range(0, 40_000, 7))
    assert at_step(piece.lines, piece.middle_step, slip) == highest


@SLIPS
def test_heights_as_waves_are_those_of_the_lines_in_the_window(spec, profile, slip):
    piece = piece_of(spec, profile, slip)
    first, count = piece.steps(-0.5, 0.5)
    width = piece.half_width / spec.spacing
    points = np.arange(-3, 4)
    for step in (first, piece.middle_step, first + count - 1):
        travel = (step - piece.middle_step) / width / max(piece.speeds)
        # Surfaces move from the last point of a window to the first.
        found = piece.heights(-points / width, np.array([travel]))[:, 0] / spec.height_step
        expected = [at_step(piece.lines, step, slip, point) for point in points]
        # Between two points the slower line is rounded to one of them.
        tolerance = 0.02 if slip == 0.0 else 0.3
        rms = np.hypot(*(np.std(line) for line in piece.pair))
        np.testing.assert_allclose(found, expected, atol=tolerance * rms)


def test_a_single_wave_is_answered_by_its_transfer_function(spec, profile):
    half_width = profile.contact.half_width * RADIUS
    width = half_width / spec.spacing
    wavelength = 40_000 / width / round(40_000 / width / 0.8)  # a whole number around the roller
    line = np.rint(1e5 * np.cos(2 * np.pi * np.arange(40_000) / (wavelength * width)))
    grid = LineGrid(spec.spacing, spec.height_step, spec.q_max)
    pair = line.astype(np.int32), np.zeros(40_000, np.int32)
    piece = RoughPiece(pair, grid, half_width, 0.0)
    position = np.linspace(-0.8, 0.8, 9)
    # Away from the ends of the piece it is a wave without end.
    travel = np.array([0.0, 0.1])
    found = piece.heights(position, travel, profile) / grid.height_step / 1e5
    transfer = WaveResponse(profile, wavelength).transfer(1.0, position)
    wavenumber = 2.0 * np.pi / wavelength
    middle = 2.0 * np.pi * piece.middle_step / (wavelength * width)
    phase = wavenumber * (position[:, None] - travel) - middle
    np.testing.assert_allclose(found, (transfer[:, None] * np.exp(1j * phase)).real, atol=0.06)
