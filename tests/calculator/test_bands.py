"""The bands of an answer: of one pair, and over what is not known exactly."""

import numpy as np
import pytest
from studies import CONFIG

import lube
from lube import LubeError
from lube.calculator.bands import RANGES, Assumptions
from lube.calculator.choices import Choices
from lube.study.uncertainty import BAND

POINTS = {"force": "400 N", "speed": "100 rpm", "temperature": ["60 degC", "80 degC"]}
KELVIN = {"temperature": {"range": "+- 2 K", "source": "thermocouple"}}


pytestmark = pytest.mark.usefixtures("few_samples")


def test_the_study_of_the_answer_has_the_rollers_lines(rollers, oil):
    levels = {name: np.array([1.0]) for name in ("force", "speed", "temperature")}
    cut = lube.Rollers(radius="50 mm", rms_roughness="0.2 um", long_cutoff="0.25 mm")
    for each in (rollers, cut):
        study = Assumptions(KELVIN, each, oil, Choices("paper"), 1).study(levels)
        assert study.line_spec == each.lines


def test_ranges_on_which_an_answer_does_not_depend_are_left_out(rollers, oil):
    levels = {name: np.array([1.0]) for name in ("force", "speed", "temperature")}
    some = Assumptions(True, rollers, oil, Choices("paper"), 1, ["oil", "speed"])
    left = {factor.name for factor in some.study(levels).uncertainty.factors()}
    assert RANGES.keys() - left == {"viscosity", "pressure_viscosity_coefficient", "speed"}
    with pytest.raises(
        LubeError, match=r"^bands: got temperature, need an uncertain quantity or choice on"
    ):
        Assumptions(KELVIN, rollers, oil, Choices("paper"), 1, ["temperature"])


def test_measured_rollers_have_usual_ranges_but_of_their_band(oil):
    surface = {"file": str(CONFIG / "surfaces/example.x3p"), "texture": "isotropic"}
    surface = {"topography": surface | {"holes": "interpolate"}}
    band = {"longest_wavelength": "0.2 mm", "shortest_wavelength": "6.25 um"}
    measured = lube.Rollers("50 mm", "0.1 um", second=surface, **band)
    levels = {"force": [400.0], "speed": [100.0], "temperature": [60.0]}
    some = Assumptions(True, measured, oil, Choices("paper"), 1)
    some.check({name: np.array(values) for name, values in levels.items()})
    left = {factor.name for factor in some.study(levels).uncertainty.factors()}
    assert RANGES.keys() - left == set(BAND)


def test_the_bands_enclose_the_answer_and_what_is_less_certain_has_a_wider_one(rollers, oil):
    found = lube.contact_probability(rollers, oil, **POINTS, realisations=8, bands=KELVIN)
    wide = lube.contact_probability(rollers, oil, **POINTS, realisations=8, bands=True)
    sampled = found.tail_breakthrough_probability
    for answer in (found, wide):
        lower, upper = (
            answer[f"assumed_breakthrough_probability_{end}"] for end in ("lower", "upper")
        )
        assert lower.dims == ("temperature",)
        assert ((lower < sampled) & (sampled < upper)).all()
        assert lower.attrs["long_name"].startswith("breakthrough probability, 5 to 95 %")
    name = "assumed_breakthrough_probability_lower"
    assert (wide[name] < found[name]).all()


def test_contact_all_the_time_has_no_band_beyond_it(oil):
    weak = {"shear_strength": "0.02 MPa", "longest_wavelength": "0.05 mm", "points": 20_000}
    rough = lube.Rollers("8 mm", "0.2 um", shortest_wavelength="10 um", **weak)
    points = POINTS | {"force": ["200 N", "400 N", "800 N"]}
    found = lube.contact_probability(rough, oil, **points, realisations=2, bands=KELVIN)
    upper = found.assumed_breakthrough_probability_upper
    assert (upper > 0.99).all() and (upper <= 1.0).all()


def test_a_range_of_the_temperature_is_what_two_temperatures_say(rollers, oil):
    found = lube.contact_probability(
        rollers, oil, "400 N", "100 rpm", "70 degC", realisations=2, bands=KELVIN
    )
    # 5 and 95 % of a uniform distribution.
    ends = lube.contact_probability(
        rollers, oil, "400 N", "100 rpm", ["68.2 degC", "71.8 degC"], realisations=2
    )
    for end, expected in zip(
        ("lower", "upper"), ends.tail_breakthrough_probability.values, strict=True
    ):
        seen = found[f"assumed_breakthrough_probability_{end}"].item()
        assert seen == pytest.approx(expected, rel=0.1)


def test_one_pair_differs_more_from_the_mean_than_the_mean_is_uncertain(rollers, oil):
    found = lube.contact_probability(rollers, oil, **POINTS, realisations=16)
    name = "breakthrough_probability"
    assert (found[f"{name}_pair_lower"] < found[f"{name}_lower"]).all()
    assert (found[f"{name}_pair_upper"] > found[f"{name}_upper"]).all()
    assert "assumed_breakthrough_probability_lower" not in found


def test_choices_of_the_model_belong_to_the_band(rollers, oil):
    choice = {"film_formula": {"choices": ["paper", "moes"], "source": "both are in use"}}
    found = lube.contact_probability(
        rollers, oil, "400 N", "100 rpm", "60 degC", realisations=2, bands=choice
    )
    by_formula = [
        lube.contact_probability(
            rollers, oil, "400 N", "100 rpm", "60 degC", realisations=2, film_formula=formula
        ).tail_breakthrough_probability.item()
        for formula in ("paper", "moes")
    ]
    ends = [found[f"assumed_breakthrough_probability_{end}"].item() for end in ("lower", "upper")]
    np.testing.assert_allclose(sorted(by_formula), ends, rtol=0.1)


@pytest.mark.parametrize(
    ("given", "said"),
    [
        ("yes", "bands: got 'yes', need True, False or a dict of ranges"),
        ({}, "bands: got none, need an uncertain quantity or choice"),
        ({"force": {"range": "+- 1 %"}}, "bands: force.source: missing"),
        (
            {"force": {"range": "2 % to 1 %", "source": "x"}},
            "bands: force.range: got '2 % to 1 %', need the lower end first",
        ),
        ({"colour": {}}, "bands: colour: unknown key"),
        (
            {"resistivity": {"range": "+- 9 %", "source": "x"}, "speed": None},
            "bands: resistivity: got a range, on which no probability depends, need none",
        ),
    ],
)
def test_bad_ranges_are_refused_in_one_line(rollers, oil, given, said):
    with pytest.raises(LubeError) as caught:
        lube.contact_probability(rollers, oil, **POINTS, realisations=2, bands=given)
    assert str(caught.value).startswith(said) and "\n" not in str(caught.value)


@pytest.mark.parametrize("verb", ["contact_probability", "duty"])
def test_ranges_without_an_answer_are_refused_before_any_film(rollers, oil, monkeypatch, verb):
    def film_of_oil(*_, **__):
        raise AssertionError("a film was found")

    # First where it is imported, so that the first import of this module finds the original.
    monkeypatch.setattr("lube.calculator.duty_cycle.film_of_oil", film_of_oil)
    monkeypatch.setattr("lube.calculator.film.film_of_oil", film_of_oil)
    point = {"force": "400 N", "speed": "100 rpm", "temperature": "60 degC"}
    given = {"points": [point]} if verb == "duty" else point
    with pytest.raises(LubeError, match="bands: load_sharing: got iterated, need none"):
        getattr(lube, verb)(
            rollers=rollers, oil=oil, **given, load_sharing="iterated", bands=KELVIN
        )


def test_lines_that_a_formula_flattens_have_no_band(rollers, oil):
    with pytest.raises(LubeError, match="roughness_deformation: got venner-1997, need"):
        lube.contact_probability(
            *(rollers, oil, "400 N", "100 rpm", "60 degC"),
            realisations=2,
            roughness_deformation="venner-1997",
            bands=KELVIN,
        )


def test_no_line_stands_for_ground_rollers_in_a_band_either(oil):
    ground = lube.Rollers("50 mm", "0.2 um", lay_ratio=5, lay_angle="0 deg")
    choices = {"contact_model": {"choices": ["line", "surface"], "source": "both"}}
    with pytest.raises(LubeError, match="bands: lay_angle: got ridges 5 times longer"):
        lube.contact_probability(
            *(ground, oil, "400 N", "100 rpm", "60 degC"), contact_model="surface", bands=choices
        )
