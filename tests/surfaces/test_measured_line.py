"""Measured profiles as lines: exact for waves, then rms height, ends and refusals."""

import numpy as np
import pytest

from lube.errors import DataError
from lube.surfaces.measured_line import FADED, closed_line, repeated_line
from lube.surfaces.topography import Preparation, Topography, prepare

STEP = 1e-12


def turn_of(points, seed=1, waves=200):
    """A closed rough profile."""
    generator = np.random.default_rng(seed)
    spectrum = np.zeros(points // 2 + 1, complex)
    spectrum[1:waves] = generator.standard_normal((waves - 1, 2)) @ [1, 1j]
    heights = np.fft.irfft(spectrum, points)
    return 2e-7 * heights / np.std(heights)


def test_waves_around_the_roller_are_kept_exactly():
    place = np.arange(3000) / 3000
    heights = 1e-7 * np.cos(2 * np.pi * 40 * place + 0.3)
    finer = np.arange(10_000) / 10_000
    line = closed_line(Topography("t", heights, (1e-6,)), 10_000, 3e-7, 1e-5, STEP)
    assert line.dtype == np.int32
    expected = 1e-7 * np.cos(2 * np.pi * 40 * finer + 0.3)
    np.testing.assert_allclose(line * STEP, expected, atol=0.6 * STEP)


@pytest.mark.parametrize("points", [2500, 4096, 20_001])
def test_a_closed_profile_keeps_its_rms_height_and_has_no_step(points):
    heights = turn_of(4000)
    profile = Topography("t", heights, (1e-6,))
    line = closed_line(profile, points, 4e-3 / points, 1e-5, STEP) * STEP
    assert np.std(line) == pytest.approx(np.std(heights), rel=1e-6)
    neighbours = np.abs(np.diff(line))
    assert abs(line[0] - line[-1]) <= neighbours.max()


def test_drift_is_removed_and_a_length_a_little_wrong_is_made_right():
    heights = turn_of(4000)
    drifted = heights + 2e-6 * np.arange(4000) / 4000
    settings = Preparation("along rolling", closed=True, long_cutoff=4e-4)
    plain, found = (
        closed_line(prepare(Topography("t", each, (1.005e-6,)), settings), 4000, 1e-6, 1e-5, STEP)
        * STEP
        for each in (heights, drifted)
    )
    np.testing.assert_allclose(found, plain, atol=0.05 * np.std(heights))
    with pytest.raises(
        DataError, match=r"t: got a step of 2.* µm from the last point to the first"
    ):
        closed_line(Topography("t", drifted, (1e-6,)), 4000, 1e-6, 1e-5, STEP)


def test_waves_shorter_than_the_studys_are_left_out():
    place = np.arange(4000) / 4000
    heights = 1e-7 * (np.cos(2 * np.pi * 40 * place) + np.cos(2 * np.pi * 800 * place))
    line = closed_line(Topography("t", heights, (1e-6,)), 8000, 5e-7, 1e-5, STEP) * STEP
    assert np.std(line) == pytest.approx(1e-7 / np.sqrt(2.0), rel=1e-6)


def test_a_repeated_profile_keeps_its_rms_height_and_its_middle():
    heights = turn_of(8000, waves=400)[: round(4000 * (1 + FADED)) + 2]
    profile = Topography("t", heights, (1e-6,))
    line = repeated_line(profile, 4000, 1e-6, 2e-6, STEP) * STEP
    assert np.std(line) == pytest.approx(np.std(heights[:4000]), rel=1e-4)
    scale = np.polyfit(heights[200:3900], line[200:3900], 1)[0]
    assert scale == pytest.approx(1.0, abs=0.05)
    assert np.corrcoef(heights[200:3900], line[200:3900])[0, 1] > 0.9999
    curvature = np.abs(np.diff(line, 2, append=line[:2]))
    assert curvature[-3:].max() < 2 * curvature[:3900].max()


def test_a_short_profile_is_repeated_a_whole_number_of_times():
    profile = Topography("t", turn_of(1500)[:1400], (1e-6,))
    line = repeated_line(profile, 4005, 1e-6, 1e-5, STEP)
    for part in (line[1335:2670], line[2670:]):  # 4005 is three times 1335
        np.testing.assert_allclose(part, line[:1335], atol=1)


@pytest.mark.parametrize(
    ("function", "heights", "spacing", "message"),
    [
        (closed_line, np.zeros((80, 80)), (1e-6, 1e-6), "got a map, need a profile"),
        (closed_line, np.zeros(3900), (1e-6,), r"got a profile of 3\.9 mm, need the circumf"),
        (closed_line, np.zeros(400), (1e-5,), "down to 20 µm, need waves down to 10 µm"),
    ],
)
def test_profiles_that_do_not_suit_are_refused(function, heights, spacing, message):
    with pytest.raises(DataError, match=message) as error:
        function(Topography("p.csv", heights, spacing), 4000, 1e-6, 1e-5, STEP)
    assert str(error.value).startswith("p.csv: ")
