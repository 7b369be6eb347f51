"""Lays fitted to maps of known ridges."""

from dataclasses import replace

import numpy as np
import pytest
import scipy
from ridges import stretched_map

from lube.surfaces.lay import unstretched
from lube.surfaces.measured_spectrum import line_spectrum
from lube.surfaces.topography import Preparation, Topography, prepare

LAY = Preparation("lay")


def lay_found(surface, settings=LAY):
    """Ratio and angle of the lay of a map."""
    spectrum = line_spectrum(prepare(surface, settings), settings)
    return spectrum.lay_ratio, spectrum.lay_angle


@pytest.mark.parametrize(("ratio", "angle"), [(1.0, 0.0), (2.0, 90.0), (5.0, 0.0), (10.0, -70.0)])
def test_length_and_direction_of_ridges_are_found_on_a_map(ratio, angle):
    for seed in range(3):
        surface, _ = stretched_map(ratio, angle, seed)
        found, direction = lay_found(surface)
        assert found == pytest.approx(ratio, rel=0.12)
        if ratio > 1.0:
            assert abs((direction - angle + 90.0) % 180.0 - 90.0) < 1.0


@pytest.mark.parametrize(
    ("ratio", "shortest"),
    [(20.0, 4), (20.0, 2), (10.0, 1), (5.0, 1), (4.0, 8), (4.0, 16), (20.0, 5)],
)
def test_ridges_are_found_where_the_surface_has_no_short_waves(ratio, shortest):
    """`shortest` is the shortest wave across the ridges, in points of the map.

    Some ridges are longer than the map. On some maps the shortest waves are but noise.
    """
    number = np.arange(2048)
    along, across = (np.minimum(number, 2048 - number) / 2048.0)[:, None], number[:1025] / 2048.0
    own = unstretched(along, across, ratio, 0.0)
    band = (own >= 1.0 / 200.0) & (own <= 1.0 / shortest)
    density = np.where(band, np.maximum(own, 1e-9) ** -3.4, 0.0)
    noise = np.random.default_rng(8).normal(size=(2048, 2048))
    heights = scipy.fft.irfft2(scipy.fft.rfft2(noise) * np.sqrt(density), noise.shape)
    surface = Topography(
        "ground.x3p", 0.2e-6 * heights[:1024, :1024] / np.std(heights), (1e-6,) * 2
    )
    assert lay_found(surface)[0] == pytest.approx(ratio, rel=0.15)


@pytest.mark.parametrize("ratio", [4.0, 8.0])
def test_filters_and_blur_do_not_shorten_ridges(ratio):
    """They take most from the waves across ridges, which are the shortest."""
    found = {"filtered": [], "blurred": []}
    for seed in range(4):
        surface, _ = stretched_map(ratio, 30.0, seed)
        short = replace(LAY, short_cutoff=8 * surface.spacing[0])
        found["filtered"].append(lay_found(surface, short)[0])
        heights = scipy.ndimage.gaussian_filter(surface.heights, 1.3)
        found["blurred"].append(lay_found(replace(surface, heights=heights))[0])
    for ratios in found.values():
        assert np.mean(ratios) == pytest.approx(ratio, rel=0.12)


def test_ridges_along_rolling_are_not_at_minus_zero_degrees():
    surface, _ = stretched_map(5.0, 0.0, seed=5)
    assert str(lay_found(surface)[1]) == "0.0"
