"""The share of the load that asperities carry, as theory has it and as counted."""

import numpy as np
import pytest
import xarray as xr
from scipy.integrate import quad
from scipy.stats import norm

from lube.grid.plausibility import expected_load_share
from lube.physics.excursions import mean_overlap
from lube.stages import contact_statistics, roughness_lines


@pytest.mark.parametrize("level", [0.0, 0.3, 2.0, 5.0])
def test_the_mean_overlap_is_that_of_a_quadrature(level):
    expected, _ = quad(lambda z: (z - level) * norm.pdf(z, scale=1.4), level, np.inf, epsabs=1e-13)
    assert mean_overlap(level, 1.4) == pytest.approx(expected, rel=1e-9)


def test_the_contact_model_finds_the_expected_share_of_the_load(study, film, make_spec):
    spec = make_spec(100_000)
    counted = contact_statistics(roughness_lines(spec, 1, range(24)), film, study.boundary_layer)
    counted = counted["contact_load_share"].isel(slide_to_roll_ratio=0)
    # The grid's windows are a little narrower than the contact.
    half_width = film["contact_half_width"]
    window = (2.0 * np.floor(half_width / spec.spacing) + 1.0) * spec.spacing
    expected = expected_load_share(film, study.rollers) * window / (2.0 * half_width)
    counted, expected = xr.align(counted, expected, join="exact")
    error = counted.std("realisation", ddof=1) / 24**0.5
    frequent = (expected > 1e-3).transpose(*error.dims).values
    assert frequent.sum() > 10
    distance = ((counted.mean("realisation") - expected) / error).values[frequent]
    assert np.abs(distance).max() < 4.0
