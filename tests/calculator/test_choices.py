"""Choices of the model reach the answers of all functions that take them."""

import pytest

import lube

POINT = {"force": "400 N", "speed": "1 m/s", "temperature": "80 degC"}
RUNS = {"realisations": 2, "seed": 2}


def duty(rollers, oil, slide_to_roll_ratio=0.0, **choices):
    """Answer for a cycle of one point, whose slip is that of its surface speeds."""
    point = {"force": POINT["force"], "temperature": POINT["temperature"]}
    for name, sign in (("surface_speed", 0.5), ("second_surface_speed", -0.5)):
        point[name] = f"{1.0 + sign * slide_to_roll_ratio!r} m/s"
    return lube.duty([point], rollers, oil, **choices, **RUNS).isel(point=0)


def plan(rollers, oil, **choices):
    return lube.plan(rollers, oil, **POINT, **choices, **RUNS)


def trace(rollers, oil, **choices):
    return lube.trace(rollers, oil, **POINT, **choices, seed=2)


HEATED = {"inlet_shear_heating": "zhu-cheng-1988"}
FILMS = {
    "heating": ({}, HEATED),
    "slip": (HEATED, {"slide_to_roll_ratio": 0.5}),
    "meniscus": ({}, {"inlet_meniscus": "0.4 mm"}),
    "load": ({}, {"load_sharing": "iterated"}),
}


@pytest.mark.usefixtures("few_pairs")
@pytest.mark.parametrize(("others", "choice"), FILMS.values(), ids=FILMS)
@pytest.mark.parametrize("function", [duty, plan, trace])
def test_each_choice_reaches_the_film(rollers, oil, function, others, choice):
    expected = lube.contact_probability(rollers, oil, **POINT, **others, **choice, **RUNS)
    found = function(rollers, oil, **others, **choice).film_thickness.item()
    assert found == pytest.approx(expected.film_thickness.item(), rel=1e-9)
    without = function(rollers, oil, **others).film_thickness.item()
    assert found != pytest.approx(without, rel=1e-3)


@pytest.mark.usefixtures("few_pairs")
@pytest.mark.parametrize("choice", ["film_shape", "roughness_deformation"])
@pytest.mark.parametrize(
    ("function", "name"),
    [(duty, "tail_breakthrough_probability"), (plan, "breakthrough_probability")],
)
def test_each_choice_reaches_the_gap(rollers, oil, function, name, choice):
    choices = {choice: "computed"}
    known = lube.contact_probability(rollers, oil, **POINT, **choices, **RUNS)
    found, without = (function(rollers, oil, **each)[name].item() for each in (choices, {}))
    assert found == pytest.approx(known.tail_breakthrough_probability.item(), rel=1e-3)
    assert found != pytest.approx(without, rel=0.05)
