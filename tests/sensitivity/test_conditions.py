import numpy as np
import pytest
import xarray as xr
from repository import ROOT

from lube.physics.pressure_viscosity import roelands_slope
from lube.sensitivity.conditions import OIL, Deviating
from lube.stages import film_table, lubricant_table
from lube.study.study import load_study
from lube.study.uncertainty import Uncertainty
from lube.surfaces.spectra import pair_moments

PAPER = ROOT / "workflow/config/paper.yaml"
POINT = {"lubricant": "mobilgear-shc-xmp-320", "temperature": 60.0, "speed": 120.0, "force": 400.0}
CHANGED = {
    "rollers": {
        roller: {"young_modulus": "214.2 GPa", "rms_roughness": f"{rms} um"}
        for roller, rms in (("first", 0.22), ("second", 0.18))
    },
    "roughness": {
        "hurst_exponent": 0.65,
        "longest_wavelength": "0.6 mm",
        "shortest_wavelength": "4 um",
    },
}

HEIGHTS = {"skewness": -0.1, "kurtosis": 3.4}


@pytest.fixture(scope="module")
def study():
    return load_study(PAPER)


@pytest.fixture(scope="module")
def deviating(study):
    return Deviating.of(study)


def one(values):
    return {name: xr.DataArray([value], dims="run") for name, value in values.items()}


def films(deviating, values, at=None, **shape):
    at = points() if at is None else at
    ((_, found),) = deviating.films(one(values), at, **shape)
    return found


def points():
    return xr.Dataset({name: ("point", [value]) for name, value in POINT.items()})


@pytest.mark.parametrize("formula", ["paper", "dowson-toyoda", "computed"])
@pytest.mark.parametrize("heating", ["none", "wilson-sheu-1983"])
def test_deviating_films_are_those_of_a_study_with_these_values(study, deviating, formula, heating):
    uncertain = study.uncertainty
    deviations = {
        **{"viscosity": 0.08, "pressure_viscosity_coefficient": -0.1, "temperature": 0.7},
        **{"force": 0.01, "speed": -0.02, "young_modulus": 0.02},
        **{"first_rms_roughness": 0.1, "second_rms_roughness": -0.1},
        "film_formula": uncertain.film_formula.choices.index(formula),
        "inlet_shear_heating": uncertain.inlet_shear_heating.choices.index(heating),
    }
    found = films(deviating, deviations, with_shape=False).squeeze()
    oil = lubricant_table(study.lubricants, [60.7])
    oil["dynamic_viscosity"] *= 1.08
    oil["pressure_viscosity_coefficient"] *= 0.9
    rollers = load_study(PAPER, {"name": "changed", **CHANGED}).rough_rollers
    levels = [400.0 * 1.01], [120.0 * 0.98], [formula]
    expected = film_table(oil, rollers, *levels, inlet_shear_heating=heating).squeeze()
    for name in ("film_thickness", "lambda_ratio", "contact_half_width", "moes_load"):
        assert found[name].item() == pytest.approx(expected[name].item(), rel=1e-5), name


@pytest.mark.parametrize("definition", ["slope-at-atmospheric", "secant"])
def test_a_coefficient_by_another_definition_is_converted(study, deviating, definition):
    number = study.uncertainty.pressure_viscosity_definition.choices.index(definition)
    found = films(deviating, {"pressure_viscosity_definition": number}).squeeze()
    oil = lubricant_table(study.lubricants, [60.0])
    alpha, viscosity = (oil[name].item() for name in OIL[1::-1])
    span = 200e6 if definition == "secant" else None
    oil[OIL[1]] = oil[OIL[1]] * roelands_slope(alpha, viscosity, definition, span) / alpha
    expected = film_table(oil, study.rollers, [400.0], [120.0], ["paper"]).squeeze()
    assert found["film_thickness"].item() == pytest.approx(expected["film_thickness"].item(), 1e-5)


def test_heights_that_are_not_gaussian_touch_under_another_film(study, deviating):
    """In a sample as in many, and not at all if the heights are known."""
    ratio = xr.DataArray([2.0, 4.0], dims="run")
    samples = {name: xr.DataArray([value] * 2, dims="run") for name, value in HEIGHTS.items()}
    found = deviating.equivalent(ratio, samples)
    expected = deviating.heights(ratio.values, np.full(2, -0.1), np.full(2, 3.4))
    np.testing.assert_array_equal(found, expected)
    assert found[1] < 4.0 and expected[0] == pytest.approx(2.0, rel=0.02)
    np.testing.assert_array_equal(deviating.equivalent(ratio, HEIGHTS), expected)
    known = study.model_copy(update={"uncertainty": Uncertainty(force=study.uncertainty.force)})
    assert Deviating.of(known).equivalent(ratio, samples) is ratio


def test_without_deviations_films_are_those_of_the_study(study, deviating):
    found = films(deviating, {"force": 0.0}).squeeze()
    oil = lubricant_table(study.lubricants, [60.0])
    expected = film_table(oil, study.rollers, [400.0], [120.0], ["paper"]).squeeze()
    assert found["film_thickness"].item() == pytest.approx(expected["film_thickness"].item(), 1e-6)


def test_films_of_records_beyond_the_studys_temperatures_have_the_oils_properties(study):
    at = points().assign(temperature=("point", [95.0]))
    found = films(Deviating.of(study, temperatures=[95.0]), {"force": 0.0}, at).squeeze()
    oil = lubricant_table(study.lubricants, [95.0])
    expected = film_table(oil, study.rollers, [400.0], [120.0], ["paper"]).squeeze()
    assert found["film_thickness"].item() == pytest.approx(expected["film_thickness"].item(), 1e-5)


def test_deviating_lines_are_those_of_a_study_with_these_values(study, deviating):
    own = study.line_spec
    deviations = {
        **{"first_rms_roughness": 0.1, "second_rms_roughness": -0.1, "hurst_exponent": 0.65},
        "longest_wavelength": 0.6e-3 / own.longest_wavelength - 1.0,
        "shortest_wavelength": 4e-6 / own.lines[0].shortest_wavelength - 1.0,
    }
    found = deviating.lines(deviations)
    expected = load_study(PAPER, {"name": "changed", **CHANGED}).line_spec
    assert found.spacing == expected.spacing
    assert found.points[0] < expected.points[0]  # shorter, so that runs are fast
    assert found.rms_height == pytest.approx(expected.rms_height)
    for name in ("q_min", "q_max", "longest_wavelength"):
        assert getattr(found, name) == pytest.approx(getattr(expected, name))
    # Fewer waves make up the same spectrum.
    np.testing.assert_allclose(pair_moments(found), pair_moments(expected), rtol=0.03)


CUTOFFS = {"longest_wavelength": "0.4 mm", "long_cutoff": "0.8 mm", "short_cutoff": "2.5 um"}


@pytest.mark.parametrize("own", [{}, {"roll_off_wavelength": "0.2 mm"}])
@pytest.mark.parametrize(
    ("key", "deviation", "by_hand"),
    [
        ("longest_wavelength", 0.5, "0.6 mm"),
        ("shortest_wavelength", 1.0, "20 points"),
        ("hurst_exponent", 0.8, 0.8),
    ],
)
def test_a_height_stated_within_cutoffs_is_still_that_of_these_waves(own, key, deviation, by_hand):
    """More waves are higher waves, and the roll-off stays where it is."""
    studies = [
        load_study(PAPER, {"name": "cut", "roughness": CUTOFFS | own | changed})
        for changed in ({}, {key: by_hand})
    ]
    deviating, expected = Deviating.of(studies[0]), studies[1].line_spec
    found = deviating.lines({key: deviation})
    assert found.rms_height == pytest.approx(expected.rms_height)
    rms = deviating.rms_roughness(one({key: deviation}))
    assert rms == pytest.approx(studies[1].rough_rollers.composite_rms_roughness)
    for name in ("q_min", "q_max", "q_roll_off", "hurst_exponent"):
        values = [getattr(spec.lines[1], name) for spec in (found, expected)]
        assert values[0] == pytest.approx(values[1])


def test_layers_deviate(study, deviating):
    found = deviating.layer({"critical_thickness": -0.5, "shear_strength": 0.5})
    assert found.critical_thickness == pytest.approx(2.5e-9)
    assert found.shear_strength == pytest.approx(1.5e6)


def test_a_little_beyond_the_data_the_viscosity_goes_on(deviating):
    colder = points().assign(temperature=("point", [40.0]))
    found = [
        films(deviating, {"temperature": shift}, colder)["film_thickness"].item()
        for shift in (-1.0, 0.0, 1.0)
    ]
    steps = np.diff(np.log(found))
    assert steps[0] == pytest.approx(steps[1], rel=0.05) and steps[0] < 0.0


def test_heights_of_both_rollers_alike_are_those_of_each(deviating):
    together = {"rms_roughness": 0.2, "second_rms_roughness": 0.1}
    apart = {"first_rms_roughness": 0.2, "second_rms_roughness": 1.2 * 1.1 - 1.0}
    one, other = (deviating.lines(values) for values in (together, apart))
    assert one.rms_height == pytest.approx(other.rms_height)
    rms = [deviating.rms_roughness(values) for values in (together, apart)]
    assert rms[0] == pytest.approx(rms[1])
    assert rms[0] == pytest.approx(np.hypot(*one.rms_height))
