"""Trace and profile are the workflow's, and of one operating point."""

import numpy as np
import pytest
from made import made, on_few_surfaces

import lube
from lube import LubeError
from lube.stages.film_profile import film_profile_table
from lube.study.oil_properties import lubricant_table

POINT = {"force": "400 N", "speed": "100 rpm", "temperature": "60 degC"}


def test_the_trace_is_that_of_the_first_realisation(rollers, oil):
    values = {"film_formula": "paper", "seed": 3}
    found = lube.trace(rollers, oil, **POINT, **values)
    share = lube.contact_probability(rollers, oil, **POINT, **values, realisations=1)
    touching = np.isfinite(found["contact_resistance"])
    assert touching.mean().item() == share["breakthrough_probability"].item()
    assert 0.0 < touching.mean() < 1.0
    np.testing.assert_allclose(found["time"][-1] / 600.0, 1.0, rtol=1e-3)  # ms in a revolution


def test_a_profile_is_that_of_the_film_profile_stage(rollers, oil, busy):
    found = lube.profile(rollers, oil, **POINT)
    table = lubricant_table([oil.record], [60.0])
    stage = film_profile_table(table, rollers.pair, [400.0], [100.0])
    stage = stage.squeeze()
    for name, of_stage, factor, units in (
        ("film", "film", 1e6, "um"),
        ("pressure", "pressure", 1e-6, "MPa"),
        ("minimum_film", "minimum_film", 1e6, "um"),
        ("hertz_pressure", "hertz_pressure", 1e-6, "MPa"),
    ):
        np.testing.assert_allclose(found[name], factor * stage[of_stage], rtol=1e-12)
        assert found[name].attrs["units"] == units
    place = found["position"]
    np.testing.assert_allclose(place, 1e6 * stage.film_position * stage.contact_half_width)
    # It carries the load, and the film is thinnest before the end of the contact.
    assert load_of(found, rollers) == pytest.approx(400.0, rel=6e-3)
    thinnest = place[np.argmin(found["film"].values)].item()
    assert 0.0 < thinnest < 1.2 * found["contact_half_width"].item()


def load_of(profile, rollers):
    """In N, from MPa and um."""
    return np.trapezoid(profile["pressure"], profile["position"]) * rollers.pair.length


def test_the_pressure_of_a_profile_carries_a_light_load_between_smooth_rollers(oil):
    """It reaches far into the inlet, where no roughness touches."""
    smooth, rough = (lube.Rollers("50 mm", rms) for rms in ("0.02 um", "0.8 um"))
    light = POINT | {"force": "20 N"}
    found, same = (lube.profile(each, oil, **light) for each in (smooth, rough))
    assert load_of(found, smooth) == pytest.approx(20.0, rel=6e-3)
    np.testing.assert_array_equal(found["pressure"], same["pressure"])


def test_a_profile_is_of_one_point(rollers, oil):
    with pytest.raises(LubeError, match="force: got 2 values, need one"):
        lube.profile(rollers, oil, **POINT | {"force": ["1 N", "2 N"]})


@pytest.mark.parametrize("deformation", ["none", "venner-1997", "computed"])
def test_a_trace_has_the_shape_and_deformation_of_the_probability(rollers, oil, deformation):
    hot = POINT | {"temperature": "80 degC"}
    choices = {"film_shape": "computed", "roughness_deformation": deformation, "seed": 4}
    choices |= {"slide_to_roll_ratio": 0.0 if deformation == "venner-1997" else 0.4}
    length = lube.trace(rollers, oil, **hot, **choices)["contact_length"]
    counted = lube.contact_probability(rollers, oil, **hot, **choices, realisations=1)
    probability = counted["breakthrough_probability_mean"].item()
    # Under uneven films contact is counted at some of the time steps.
    assert np.mean(length.values > 0.0) == pytest.approx(probability, rel=0.1)


def test_the_trace_of_surfaces_is_that_of_the_surface_trace_stage(rollers, oil, busy):
    study = busy.study.model_copy(update={"seed": 5, "contact_model": ("surface",)})
    levels = {"force": 400.0, "speed": 100.0, "temperature": 60.0, "slide_to_roll_ratio": 0.0}
    point = study.traces[0].model_copy(update=levels | {"lubricant": None, "film_formula": None})
    study = study.model_copy(update={"traces": (point,), "film_formulas": ("paper",)})
    stage = made(study, ("lubricant", "film", "surface_trace"))["surface_trace"].squeeze()
    choices = {"film_formula": "paper", "contact_model": "surface", "seed": 5}
    found = lube.trace(rollers, oil, **POINT, **choices)
    for name, factor in (("contacts", 1.0), ("contact_length", 1e6), ("contact_length_at", 1e6)):
        np.testing.assert_allclose(found[name], factor * stage[name], rtol=1e-12)
    np.testing.assert_array_equal(found["contact_resistance"], stage["contact_resistance"])
    np.testing.assert_allclose(found["time"], 1e3 * stage["time"], rtol=1e-12)
    assert found["contacts"].sum() > found["breakthroughs"].sum() > 0.0


def test_the_trace_of_an_insulator_has_no_resistance(oil):
    insulator = lube.Rollers("2 mm", "0.2 um", resistivity="insulator")
    point = {"force": "5 N", "speed": "100 rpm", "temperature": "60 degC"}
    found = lube.trace(insulator, oil, **point)
    assert np.isnan(found["contact_resistance"]).all() and (found["contact_length"] > 0.0).any()
    assert np.isnan(insulator.resistivity)


def test_a_trace_is_of_one_point(rollers, oil):
    with pytest.raises(LubeError, match="speed: got 2 values, need one"):
        lube.trace(rollers, oil, **POINT | {"speed": ["1 rpm", "2 rpm"]})
    with pytest.raises(LubeError, match="force: got a list of one value, need no list"):
        lube.trace(rollers, oil, **POINT | {"force": ([800], "N")})


def test_a_trace_needs_a_contact_that_the_grid_resolves(rollers, oil):
    with pytest.raises(LubeError, match=r"force: the contact is .* need at least two grid spac"):
        lube.trace(rollers, oil, **POINT | {"force": "1e-6 N"})


@pytest.mark.parametrize("model", ["line", "surface"])
def test_a_trace_has_the_remarks_of_the_probability(oil, model):
    rough = lube.Rollers("5 mm", "3 um", length="1 mm", points=20_000)
    point, choices = POINT | {"force": "40 N"}, {"contact_model": model, "seed": 4}
    found = lube.trace(rough, oil, **point, **choices).attrs["remarks"]
    assert f"the {model}" in found and "asperities carry more than a tenth" in found
    assert model == "line" or "line" not in found
    with on_few_surfaces(4):
        same = lube.contact_probability(rough, oil, **point, **choices, realisations=1)
    assert found == same.attrs["remarks"]


def test_a_trace_says_where_the_oils_response_is_not_linear(rollers, oil):
    cool = POINT | {"temperature": "40 degC", "roughness_deformation": "computed"}
    assert "kept apart by the oil" in lube.trace(rollers, oil, **cool).attrs["remarks"]
