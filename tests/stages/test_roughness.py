"""Roughness lines as datasets: the same lines in any batch, labelled with their moments."""

import numpy as np
import pytest

from lube.contact.rough_pair import PADDING, roughness_batch
from lube.grid.discretise import line_pair
from lube.stages import roughness_lines
from lube.surfaces.spectra import line_moments, spectrum_moments
from lube.surfaces.synthetic import draw_realisation

SEED = 20181109


@pytest.fixture(scope="module")
def unequal(make_spec):
    """Rollers of other radius and other roughness."""
    return make_spec(50_000, second_radius=0.037, second_roughness=0.31e-6)


def test_both_datasets_hold_the_lines_drawn(unequal):
    lines = roughness_lines(unequal, SEED, [4, 2])
    batch = roughness_batch(unequal, SEED, [4, 2])
    assert batch.attrs["height_step"] == unequal.height_step
    for realisation in (4, 2):
        drawn = draw_realisation(unequal, SEED, realisation)
        for dataset in (lines, batch):
            for line, expected in zip(line_pair(dataset, realisation), drawn, strict=True):
                assert line.dtype == np.int32
                np.testing.assert_array_equal(line, expected)


def test_moments_are_those_of_each_line_and_of_the_spectrum(unequal):
    dataset = roughness_lines(unequal, SEED, [0, 7])
    for number, realisation in enumerate((0, 7)):
        for roller, line in enumerate(draw_realisation(unequal, SEED, realisation)):
            moments = line_moments(line * unequal.height_step, unequal.spacing)
            for name, value in moments.items():
                assert dataset[name][number, roller] == pytest.approx(value)
            for name, value in spectrum_moments(unequal, roller).items():
                assert dataset[f"spectrum_{name}"][roller] == pytest.approx(value)


def test_shorter_line_is_padded_and_marked(unequal):
    assert unequal.points == (50_000, 37_000)
    lines = roughness_lines(unequal, SEED, [0])["height"].values[0]
    batch = roughness_batch(unequal, SEED, [0])["height"].values[0]
    assert not np.isnan(lines[0]).any()
    assert np.isnan(lines[1, 37_000:]).all() and not np.isnan(lines[1, :37_000]).any()
    assert (batch[1, 37_000:] == PADDING).all() and (batch[1, :37_000] != PADDING).all()
    np.testing.assert_allclose(lines[1, :37_000], batch[1, :37_000] * unequal.height_step, 1e-15)
