"""What is found to be enough is enough: put in again, it gives the share asked for."""

import numpy as np
import pytest

import lube
from lube import LubeError, Rollers

RUNS = {"realisations": 32, "seed": 2}
SHARE = 0.05
POINT = {"force": "400 N", "speed": "100 rpm", "temperature": "60 degC"}


def without(name):
    return {key: value for key, value in POINT.items() if key != name}


def probability(rollers, oil, **changes):
    found = lube.contact_probability(rollers, oil, **POINT | changes, **RUNS)
    return found["breakthrough_probability_mean"].item()


@pytest.fixture(scope="module")
def needed(rollers):
    return lube.required_film(rollers, "400 N", share=SHARE, **RUNS)


def test_the_film_has_the_share(rollers, oil, needed):
    """At the speed that gives this film, by brute force."""
    speeds = ([20.0, 2000.0], "rpm")
    films = lube.film(rollers, oil, **POINT | {"speed": speeds})["film_thickness"].values
    exponent = np.log(films[1] / films[0]) / np.log(100.0)
    speed = 20.0 * (needed["film_thickness"].item() / films[0]) ** (1.0 / exponent)
    found = probability(rollers, oil, speed=(speed, "rpm"))
    assert found == pytest.approx(SHARE, rel=0.03)
    limits = [needed[f"film_thickness{limit}"].item() for limit in ("_lower", "", "_upper")]
    assert limits == sorted(limits) and limits[2] / limits[0] < 1.3


@pytest.mark.parametrize(
    ("inverse", "name", "unit"),
    [
        (lube.required_speed, "speed", "rpm"),
        (lube.required_temperature, "temperature", "degC"),
    ],
)
def test_speed_and_temperature_give_that_film(rollers, oil, needed, inverse, name, unit):
    found = inverse(rollers, oil, **without(name), share=SHARE, **RUNS)
    for limit, of_film in zip(("", "_lower", "_upper"), ("", "_upper", "_lower"), strict=True):
        of_film = of_film if name == "temperature" else limit
        back = lube.film(rollers, oil, **POINT | {name: (found[f"{name}{limit}"].item(), unit)})
        expected = needed[f"film_thickness{of_film}"]
        np.testing.assert_allclose(back["film_thickness"], expected, rtol=1e-4)


def test_the_viscosity_gives_that_film(rollers, oil, needed):
    """The film depends on viscosity times speed, at a given pressure-viscosity coefficient."""
    found = lube.required_viscosity(rollers, oil, **POINT, share=SHARE, **RUNS)
    ratio = found["dynamic_viscosity"] / oil.properties("60 degC")["dynamic_viscosity"]
    back = lube.film(rollers, oil, **POINT | {"speed": (100.0 * ratio.item(), "rpm")})
    np.testing.assert_allclose(back["film_thickness"], needed["film_thickness"], rtol=1e-4)
    density = oil.properties("60 degC")["density"].item()
    kinematic = found["kinematic_viscosity"].item() * 1e-6 * density * 1e3
    assert kinematic == pytest.approx(found["dynamic_viscosity"].item())


def test_the_roughness_has_the_share(rollers, oil, busy):
    """Rollers of that roughness, drawn anew, have the share asked for."""
    found = lube.required_roughness(rollers, oil, **POINT, share=0.02, **RUNS)
    assert found["roughness_factor"].attrs["units"] == "1"
    rms = f"{0.2 * found['roughness_factor'].item()!r} um"
    spec = busy.study.line_spec
    lengths = {
        "longest_wavelength": f"{2.0 * np.pi / spec.q_min!r} m",
        "shortest_wavelength": f"{10.0 * spec.spacing!r} m",
    }
    smoother = Rollers("50 mm", rms, points=50_000, shear_strength="0.2 MPa", **lengths)
    assert probability(smoother, oil) == pytest.approx(0.02, rel=0.05)
    assert probability(rollers, oil) > 0.04


@pytest.mark.parametrize(
    ("ask", "message"),
    [
        (
            lambda rollers, oil: lube.required_film(rollers, "400 N", share=1e-9),
            "share: got 1e-09, need at least 3.1e-05: 64 realisations show no rarer contact",
        ),
        (
            lambda rollers, oil: lube.required_film(rollers, "400 N", share="often"),
            "share: got 'often', need a finite number",
        ),
        (
            lambda rollers, oil: lube.required_film(rollers, "400 N", share=1.5),
            "share: got 1.5, need a value above 0 and below 1",
        ),
        (
            lambda rollers, oil: lube.required_film(rollers, "400 N", share=0.9999, **RUNS),
            "share: got 0.9999, which no lambda ratio from 0.5 to 8 has",
        ),
        (
            lambda rollers, oil: lube.required_temperature(
                rollers, oil, "400 N", "1 rpm", share=0.01, **RUNS
            ),
            "share: got 0.01, no film keeps contact below it with this oil: at 40 degC it is 0.",
        ),
        (
            lambda rollers, oil: lube.required_viscosity(
                rollers, oil, "400 N", "0.0001 rpm", "60 degC", share=0.01, **RUNS
            ),
            "no viscosity within a factor of 1000 of the oil's gives the film of",
        ),
        (
            lambda rollers, oil: lube.required_speed(
                rollers, oil, ["1 N", "2 N"], "60 degC", share=0.01
            ),
            "force: got 2 values, need one",
        ),
        (
            lambda rollers, oil: lube.required_speed(
                rollers, oil, "400 N", "60 degC", film_formula=["paper", "moes"]
            ),
            "film_formula: got ['paper', 'moes'], need one name",
        ),
    ],
)
def test_the_impossible_is_refused_in_one_line(rollers, oil, ask, message):
    with pytest.raises(LubeError) as error:
        ask(rollers, oil)
    assert message in str(error.value)
