"""Plans of measurements, asked for in a notebook."""

import numpy as np
import pytest

import lube
from lube import LubeError

POINT = {"force": ["400 N", "1600 N"], "speed": "100 rpm", "temperature": "70 degC"}


@pytest.fixture(scope="module")
def found(rollers, oil):
    return lube.plan(rollers, oil, **POINT, realisations=16)


def test_a_plan_has_an_interval_of_each_quantity_at_each_point(found):
    assert found.half_width.dims == ("quantity", "force")
    film = found.half_width.sel(quantity="film thickness")
    oil = found.half_width.sel(quantity="pressure-viscosity coefficient")
    assert ((film > 0.0) & (film < oil)).all()
    # By Pan and Hamrock the film rises with the coefficient to the power of 0.47.
    np.testing.assert_allclose(film / oil, 0.47, rtol=0.01)
    assert found.table().shape[0] == 6


def test_a_short_record_and_a_slow_rig_tell_less(rollers, oil, found):
    short = lube.plan(rollers, oil, **POINT, realisations=16, turns=0.2)
    slow = lube.plan(rollers, oil, **POINT, realisations=16, rig="mtm-ecr-10-kohm")
    film = {"quantity": "film thickness"}
    np.testing.assert_allclose(
        short.half_width.sel(film), np.sqrt(5.0) * found.half_width.sel(film), rtol=1e-6
    )
    assert (slow.reading_error > 0.0).all()
    assert (slow.half_width.sel(film) > found.half_width.sel(film)).all()


def test_durations_and_thresholds_are_compared_in_one_plan(rollers, oil, found):
    several = {"turns": [0.2, 1.0], "threshold": ["100 ohm", "1 ohm"], "rig": "threshold-counter"}
    plan = lube.plan(rollers, oil, **POINT, realisations=16, **several)
    assert plan.half_width.dims == ("quantity", "turns", "threshold", "force")
    assert plan.reading_error.dims == ("threshold", "force")
    np.testing.assert_array_equal(plan.threshold, [100.0, 1.0])
    for turns in several["turns"]:
        one = several | {"turns": turns, "threshold": "1 ohm"}
        alone = lube.plan(rollers, oil, **POINT, realisations=16, **one)
        here = plan.sel(turns=turns, threshold=1.0)
        np.testing.assert_array_equal(here.half_width, alone.half_width)
        np.testing.assert_array_equal(here.reading_error, alone.reading_error)
    exact = lube.plan(rollers, oil, **POINT, realisations=16, turns=[0.2, 1.0])
    np.testing.assert_array_equal(exact.half_width.sel(turns=1.0), found.half_width)


def test_an_ecr_meter_shows_the_mean_voltage_whatever_the_threshold(rollers, oil):
    thresholds = {"threshold": ["100 ohm", "1 ohm"], "realisations": 4}
    plan = lube.plan(rollers, oil, **POINT, rig="mtm-ecr", **thresholds)
    first, second = plan.reading_error.transpose("threshold", ...).values
    np.testing.assert_array_equal(first, second)


@pytest.mark.parametrize(
    ("argument", "value", "said"),
    [
        ("rig", "mtm", "rig: got 'mtm', "),
        ("rig", 3, "rig: got 3, need one of mtm-ecr, "),
        ("film_shape", True, "film_shape: got True, need one of flat, computed"),
        ("threshold", "5 m", "threshold: wrong dimension or unit 'm'"),
        ("turns", 0, "turns: got 0, need a value above 0"),
        ("turns", [1, -2], "turns: got -2, need a value above 0"),
        ("film_formula", ["paper", "moes"], "film_formula: got ['paper', 'moes'], need one name"),
        ("roughness_deformation", "venner-1997", "roughness_deformation: got venner-1997, need"),
        ("contact_model", "surface", "plan: contact_model: unknown argument"),
    ],
)
def test_what_does_not_suit_is_refused_in_one_line(rollers, oil, argument, value, said):
    given = {"rig": "mtm-ecr"} | {argument: value}
    with pytest.raises(LubeError) as caught:
        lube.plan(rollers, oil, **POINT, **given)
    assert str(caught.value).startswith(said) and "\n" not in str(caught.value)


def test_a_threshold_is_checked_without_a_rig_too(rollers, oil):
    with pytest.raises(LubeError, match=r"^threshold: got 'nonsense'"):
        lube.plan(rollers, oil, **POINT, threshold="nonsense")


def test_rollers_that_do_not_conduct_have_no_rig(oil):
    glass = lube.Rollers(radius="50 mm", rms_roughness="0.2 um", resistivity="insulator")
    with pytest.raises(LubeError, match=r"^rig: got 'mtm-ecr' with rollers that do not conduct"):
        lube.plan(glass, oil, **POINT, realisations=2, rig="mtm-ecr")
