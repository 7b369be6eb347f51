"""Rough lines passing through the contact: small roughness is answered linearly, high is not."""

import numpy as np
import pytest
from made import made

from lube.stages import passage as stage
from lube.stages.passage import ANSWERS


@pytest.fixture(scope="module")
def passed(busy_study):
    """What passes on lines so coarse that a passage has some tens of steps, and two waves."""
    waves = {
        "surface_speed": (1.0,),
        "relative_wavelength": (1.0,),
        "relative_amplitude": (0.1, 1.0),
    }
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(stage, "WAVES", waves)
        patch.setattr(stage, "LAMBDA_RATIOS", (1.0, 9.0))
        return made(busy_study, ("lubricant", "film_profile", "passage"))["passage"]


def test_the_points_are_the_nearest_to_the_lambda_ratios(passed):
    low, high = passed["lambda_ratio"].values
    assert low == pytest.approx(1.0, rel=0.4) and high > 2.0


def test_where_lines_overlap_the_oil_keeps_the_surfaces_apart(passed):
    gaps = passed["least_gap"].transpose("answer", "operating_point", "passage_step")
    crossing = gaps.where(abs(passed["travel"]) <= 1.0).min("passage_step").isel(operating_point=0)
    drawn, linear, nonlinear = crossing.values
    assert drawn < linear < 0.0 < nonlinear
    assert passed["oil_load_share"].min() > 0.99


def test_shares_are_those_of_the_gaps(passed):
    crossing = abs(passed["travel"]) <= 1.0
    below = (passed["least_gap"] < passed["critical_thickness"]).where(crossing)
    shares = below.mean("passage_step").transpose("operating_point", "answer")
    found = passed["share_below_layer"].transpose(*shares.dims)
    known = found.notnull()  # NaN if a time step did not converge
    assert known.sel(answer=list(ANSWERS[:2])).all() and known.isel(operating_point=1).all()
    np.testing.assert_allclose(found.where(known), shares.where(known))
    model = passed["breakthrough_share"]
    assert np.isnan(model.sel(answer="nonlinear")).all()
    # A layer cannot break where the lines do not overlap.
    for answer in ANSWERS[:2]:
        free = passed["share_below_layer"].sel(answer=answer) == 0.0
        assert (model.sel(answer=answer).where(free, 0.0) == 0.0).all()


def test_a_wave_of_a_tenth_of_the_film_is_answered_linearly_and_a_high_one_is_not(passed):
    small, high = passed["wave_difference"].isel(operating_point=0).squeeze().values
    assert small < 0.02 < high
    least = passed["wave_least_gap"].isel(operating_point=0, relative_amplitude=1).squeeze()
    assert least.sel(answer="linear") < least.sel(answer="nonlinear")
