"""Answers have the workflow's films, to the last bit."""

import re

import numpy as np
import pytest

import lube
from lube import LubeError
from lube.calculator.choices import FORMULA
from lube.physics.inlet_heating import INLET_HEATING
from lube.stages import film_table
from lube.study.oil_properties import lubricant_table

THINNING = "inlet_shear_heating_factor", "starvation_factor"
GRID = {
    "force": ([100.0, 400.0, 1600.0], "N"),
    "speed": ([60.0, 100.0], "rpm"),
    "temperature": ([60.0, 80.0], "degC"),
}
POINT = {"force": "400 N", "speed": "100 rpm", "temperature": "60 degC"}


def test_films_are_those_of_the_film_stage(rollers, oil, busy):
    found = lube.film(rollers, oil, **GRID, film_formula=["paper", "pan-hamrock"])
    expected = busy.film.isel(lubricant=0)
    for name, factor in (("film_thickness", 1e6), ("lambda_ratio", 1.0)):
        assert found[name].dims == ("film_formula", "temperature", "speed", "force")
        np.testing.assert_array_equal(
            found[name], factor * expected[name].transpose(*found[name].dims)
        )


@pytest.mark.parametrize("model", INLET_HEATING[1:])
def test_heated_and_starved_films_are_those_of_the_film_stage(rollers, oil, busy, model):
    inlet = {"inlet_shear_heating": model, "inlet_meniscus": 0.6e-3}
    properties = lubricant_table(busy.study.lubricants, [60.0, 80.0])
    levels = rollers.pair, [100.0, 400.0, 1600.0], [600.0, 1000.0], [FORMULA]
    expected = film_table(properties, *levels, slide_to_roll_ratio=[0.3], **inlet).squeeze()
    grid = GRID | {"speed": ([600.0, 1000.0], "rpm")}
    inlet |= {"inlet_meniscus": "0.6 mm", "slide_to_roll_ratio": 0.3}
    found = lube.film(rollers, oil, **grid, **inlet)
    for name, factor in (("film_thickness", 1e6), *((name, 1.0) for name in THINNING)):
        of_stage = factor * expected[name].transpose(*found[name].dims)
        np.testing.assert_array_equal(found[name], of_stage)
    assert (found[THINNING[0]] < 0.99).all() and (found[THINNING[1]] < 0.99).any()
    for answer in (lube.contact_probability, lube.plan, lube.indicators):
        few = {} if answer is lube.indicators else {"realisations": 2}
        other = answer(rollers, oil, **grid, **inlet, **few)
        np.testing.assert_array_equal(other["lambda_ratio"], found["lambda_ratio"])


def test_a_trace_and_a_duty_point_have_heated_and_starved_films(rollers, oil):
    inlet = {"inlet_shear_heating": "computed", "inlet_meniscus": "0.6 mm"}
    slip, point = 0.3, POINT | {"speed": "600 rpm"}
    film = lube.film(rollers, oil, **point, **inlet, slide_to_roll_ratio=slip)
    traced = lube.trace(rollers, oil, **point, **inlet, slide_to_roll_ratio=slip)
    assert traced["film_thickness"] == pytest.approx(film["film_thickness"].item(), rel=1e-12)
    mean = film["entrainment_speed"].item()
    speeds = {"surface_speed": 1.0 + 0.5 * slip, "second_surface_speed": 1.0 - 0.5 * slip}
    del point["speed"]
    point |= {name: f"{mean * part!r} m/s" for name, part in speeds.items()}
    cycle = lube.duty([point], rollers, oil, realisations=2, **inlet)
    assert cycle["film_thickness"].item() == pytest.approx(film["film_thickness"].item(), rel=1e-9)


def test_heating_needs_a_conductivity_and_a_strong_one_has_a_remark(rollers, oil):
    unknown = lube.Oil("mobilgear-shc-xmp-320")
    unknown.record = unknown.record.model_copy(update={"thermal_conductivity": None})
    needed = "inlet_shear_heating: got computed, need none, or an oil with thermal_conductivity"
    with pytest.raises(LubeError, match=f"^{needed}$"):
        lube.contact_probability(rollers, unknown, **POINT, inlet_shear_heating="computed")
    assert lube.film(rollers, unknown, **POINT)["film_thickness"] > 0.0
    fast = POINT | {"speed": "50 m/s"}
    found = lube.film(rollers, oil, **fast, inlet_shear_heating="computed")
    assert "at 1 operating points the film is less than half as thick" in found.remarks


def test_a_meniscus_in_the_contact_is_refused(rollers, oil):
    with pytest.raises(
        LubeError, match=r"^inlet_meniscus: got 50 µm, need more than 105 µm, the ha"
    ):
        lube.film(rollers, oil, **POINT, inlet_meniscus="50 um")


@pytest.mark.parametrize(
    ("changes", "expected"),
    [
        ({"young_modulus": "310 MPa"}, r"Young's modulus: 310 MPa; plastics have 1 GPa"),
        ({"rms_roughness": "3 um"}, "load share: at 1 of 1 .* at 1 more than all of it"),
    ],
)
def test_what_is_unlikely_to_be_meant_is_remarked_as_by_lube_check(oil, changes, expected):
    usual = {"radius": "50 mm", "rms_roughness": "0.1 um", "longest_wavelength": "0.2 mm"}
    assert lube.film(lube.Rollers(**usual), oil, **POINT).attrs["remarks"] == ""
    odd = lube.Rollers(**usual | changes)
    remarks = lube.film(odd, oil, **POINT).attrs["remarks"]
    assert re.search(f"^{expected}", remarks, re.MULTILINE)
    found = lube.contact_probability(odd, oil, **POINT, realisations=1)
    assert found.attrs["remarks"] == remarks
    assert lube.film(odd, oil, **GRID, film_formula=["paper"]).attrs["remarks"]


def test_each_formula_outside_its_range_is_remarked(rollers, oil):
    """Rollers that hardly deform: M is below 1."""
    light = POINT | {"force": ["2 N", "800 N"]}
    found = lube.film(rollers, oil, **light, film_formula=["pan-hamrock", "computed"])
    assert found.in_validity_range.values.tolist() == [[False, True], [True, True]]
    assert found.attrs["remarks"].splitlines()[-1] == (
        "film_formula: at 1 of 2 operating points `pan-hamrock` is outside its range of validity; "
        "`computed` solves Reynolds' equation instead"
    )


def test_a_viscosity_in_a_wrong_unit_is_refused_or_seen_from_the_film(rollers):
    with pytest.raises(LubeError, match=r"kinematic_viscosity: got 68 m\^2/s, need"):
        lube.Oil(viscosity={"40 degC": "68 m^2/s", "100 degC": "9 m^2/s"})
    thick = lube.Oil(viscosity={"40 degC": "0.068 m^2/s", "100 degC": "0.009 m^2/s"})
    assert "most are from 10 nm to 10 µm" in lube.film(rollers, thick, **POINT).attrs["remarks"]


def test_the_speed_may_be_the_entrainment_speed(rollers, oil):
    by_turns = lube.film(rollers, oil, **POINT)
    metres = f"{by_turns.entrainment_speed.item()!r} m/s"
    by_entrainment = lube.film(rollers, oil, **POINT | {"speed": metres})
    np.testing.assert_allclose(by_entrainment["speed"], 100.0, rtol=1e-12)
    np.testing.assert_allclose(by_entrainment["film_thickness"], by_turns["film_thickness"])
    several = lube.film(rollers, oil, **POINT | {"speed": ["0.5 m/s", "1 m/s"]})
    assert several["film_thickness"].sizes == {"speed": 2}
    np.testing.assert_allclose(several["entrainment_speed"], [0.5, 1.0])
