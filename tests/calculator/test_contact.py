"""Answers have the workflow's probabilities, to the last bit for the same lines."""

import numpy as np
import pytest
import xarray as xr

import lube
from lube import LubeError
from lube.calculator.choices import FORMULA
from lube.contact.surface_strip import SURFACES
from lube.stages import areal, film_table, tail
from lube.statistics.one_pair import quantile
from lube.study.oil_properties import lubricant_table

GRID = {
    "force": ([100.0, 400.0, 1600.0], "N"),
    "speed": ([60.0, 100.0], "rpm"),
    "temperature": ([60.0, 80.0], "degC"),
}
POINT = {"force": "400 N", "speed": "100 rpm", "temperature": "60 degC"}


def test_probabilities_and_intervals_are_those_of_the_workflow(rollers, oil, busy):
    values = {"film_formula": ["paper", "pan-hamrock"], "realisations": 32, "seed": busy.study.seed}
    found = lube.contact_probability(rollers, oil, **GRID, **values)
    expected = busy.contact.isel(lubricant=0, slide_to_roll_ratio=0)
    for name in ("breakthrough_probability", "geometric_contact_probability"):
        for ending in ("", "_mean", "_lower", "_upper"):
            variable = found[f"{name}{ending}"]
            of_stage = expected[f"{name}{ending}"].transpose(*variable.dims)
            np.testing.assert_array_equal(variable, of_stage)
    assert 0.0 < found["breakthrough_probability_mean"].min() < 0.5


def test_rare_contact_is_that_of_the_tail_stage(rollers, oil, busy):
    values = {"realisations": 1, "seed": busy.study.seed}
    formulas = ["paper", "pan-hamrock"]
    found = lube.contact_probability(rollers, oil, **GRID, **values, film_formula=formulas)
    expected = tail.make(busy.study, {"film": busy.film}).isel(lubricant=0, slide_to_roll_ratio=0)
    for name, factor in (
        ("breakthrough_probability", 1.0),
        ("geometric_contact_probability", 1.0),
        ("breakthrough_rate", 3600.0),
    ):
        for ending in ("", "_lower", "_upper"):
            variable = found[f"tail_{name}{ending}"]
            of_stage = factor * expected[f"{name}{ending}"].transpose(*variable.dims)
            # Of the other film formulas the stage has fewer pairs of lines.
            assert variable.dims == found["film_thickness"].dims
            np.testing.assert_array_equal(variable[0], of_stage[0])
            np.testing.assert_allclose(variable[1], of_stage[1], rtol=0.3)
    point = {"force": 400.0, "speed": 100.0, "temperature": 60.0, "film_formula": "paper"}
    one = lube.contact_probability(rollers, oil, **POINT, **values, film_formula="paper")
    there = found["tail_breakthrough_rate"].sel(point)
    assert one["tail_breakthrough_rate"] == there
    assert "importance sampling" not in one.attrs["remarks"]
    assert one["tail_breakthrough_rate"].attrs == {
        "long_name": "breakthroughs per time, by importance sampling",
        "units": "h-1",
    }


def test_contact_of_the_surface_is_that_of_the_areal_stage(rollers, oil, busy):
    one = {name: ([levels[-1]], units) for name, (levels, units) in GRID.items()}
    choices = {"film_formula": ["paper"], "seed": busy.study.seed, "contact_model": "surface"}
    found = lube.contact_probability(rollers, oil, **one, **choices)
    film = busy.film.isel(force=[-1], speed=[-1], temperature=[-1])
    areas = areal.make(busy.study, {"film": film})
    expected = areas.isel(lubricant=0, slide_to_roll_ratio=0)
    for name in ("passage_width", "breakthrough_width"):
        expected[name] = 1e6 * expected[name]
    for name, values in expected.drop_vars("length").items():
        np.testing.assert_array_equal(found[f"surface_{name}"], values)
    assert found["surface_passage_width"].attrs["units"] == "um"
    assert found["surface_contacts"].attrs["long_name"].endswith("on the surface")
    study = busy.study.model_copy(update={"contact_model": ("surface",)})
    inputs = {"film": film.isel(film_formula=[0]), "areal": areas}
    expected = tail.make(study, inputs).isel(lubricant=0, slide_to_roll_ratio=0, contact_model=0)
    for name, factor in {"breakthrough_rate": 3600.0, "breakthrough_duration": 1e3}.items():
        np.testing.assert_array_equal(found[f"surface_{name}"], factor * expected[name])
    assert found["surface_breakthrough_rate_upper"].attrs["units"] == "h-1"
    assert "breakthrough_probability" not in found


def test_one_pair_of_surfaces_differs_from_the_mean_as_its_deviation_says(rollers, oil):
    found = lube.contact_probability(rollers, oil, **POINT, contact_model="surface")
    name = "surface_breakthrough_probability"
    lower, upper = (found[f"{name}_pair_{end}"].item() for end in ("lower", "upper"))
    assert lower <= found[f"{name}_lower"] and found[f"{name}_upper"] <= upper
    sampled = 0.25 * (found[f"{name}_upper"] - found[f"{name}_lower"])
    half = quantile(SURFACES) * np.hypot(found["surface_pair_deviation"], sampled)
    assert lower == pytest.approx(max(found[name].item() - half.item(), 0.0), rel=1e-9)
    assert "on the surface" in found[f"{name}_pair_upper"].attrs["long_name"]


def test_one_pair_of_surfaces_with_slip_meets_in_more_alignments(rollers, oil):
    """Its share lies nearer to the mean, but not where one surface is at rest."""
    name, widths = "surface_breakthrough_probability_pair", []
    for slip in (0.0, 0.5, 2.0):
        choices = {"contact_model": "surface", "slide_to_roll_ratio": slip}
        found = lube.contact_probability(rollers, oil, **POINT | {"speed": "200 rpm"}, **choices)
        widths.append(found[f"{name}_upper"].item() - found[f"{name}_lower"].item())
    assert widths[1] < 0.95 * widths[0] and widths[2] > 1.2 * widths[0]


def test_surface_and_line_are_answered_together(rollers, oil):
    models = {"contact_model": ["line", "surface"], "realisations": 2}
    found = lube.contact_probability(rollers, oil, **POINT, **models)
    assert found["surface_contacts"] > 1.0
    assert 0.0 < found["surface_load_share"] < 1.0
    name = "breakthrough_probability"
    assert found[f"tail_{name}_upper"] < found[f"surface_{name}_lower"]
    assert {"tail_" + name, name + "_mean"} <= set(found)


def test_ground_rollers_touch_by_their_surfaces_alone(oil):
    bent = {"longest_wavelength": "0.2 mm", "shortest_wavelength": "20 um", "points": 40_000}
    lay = {"lay_ratio": 4.0, "lay_angle": "0 deg"}
    ground = lube.Rollers("20 mm", "0.07 um", **bent, **lay)
    cold = POINT | {"temperature": "40 degC"}
    choices = {"film_formula": "paper", "contact_model": "surface", "seed": 3}
    found = lube.contact_probability(ground, oil, **cold, **choices)
    other = lube.contact_probability(
        lube.Rollers("20 mm", "0.1 um", **bent), oil, **cold, **choices
    )
    name = "surface_geometric_contact_probability"
    assert 0.0 < found[name] < 0.9 * other[name]
    assert 0.0 < found["surface_expected_breakthroughs"] < found["surface_expected_contacts"]
    refused = r"^lay_angle: got ridges 4 times longer than wide"
    for answer in (lube.contact_probability, lube.trace):
        with pytest.raises(lube.LubeError, match=refused):
            answer(ground, oil, **POINT)
    with pytest.raises(lube.LubeError, match=refused):
        lube.required_film(ground, POINT["force"])


def test_asperities_that_carry_a_share_of_the_load_leave_a_thicker_film(rollers, oil, busy):
    hot = POINT | {"temperature": "80 degC"}
    whole = lube.contact_probability(rollers, oil, **hot, realisations=2)
    found = lube.contact_probability(rollers, oil, **hot, realisations=2, load_sharing="iterated")
    properties = lubricant_table(busy.study.lubricants, [80.0])
    levels = [400.0], [100.0], [FORMULA]
    sharing = {"rough_surfaces": rollers.lines, "load_sharing": "iterated"}
    film = film_table(properties, rollers.pair, *levels, **sharing).squeeze()
    assert found["film_thickness"] == pytest.approx(1e6 * film["film_thickness"].item())
    assert found["surface_load_share"] == pytest.approx(film["surface_load_share"].item())
    assert 1.001 * whole["film_thickness"] < found["film_thickness"]
    name = "tail_breakthrough_probability"
    assert found[name] < whole[name]


def test_the_most_complete_model_is_asked_for_by_name(rollers, oil):
    found = lube.contact_probability(rollers, oil, **POINT, **lube.COMPLETE)
    drawn = lube.COMPLETE | {"roughness_deformation": "none"}
    other = lube.contact_probability(rollers, oil, **POINT, **drawn)
    assert found["film_thickness"] == other["film_thickness"]
    assert found["surface_contacts_upper"] < other["surface_contacts_lower"]
    assert found["surface_expected_contacts"] < other["surface_expected_contacts"]
    assert 0.0 < found["surface_expected_breakthroughs"] < found["surface_expected_contacts"]


def test_what_cannot_touch_is_refused_before_films_are_computed(oil, monkeypatch):
    monkeypatch.setattr("lube.calculator.film.film_with_oil", None)
    fine = lube.Rollers("10 mm", "0.1 um", shortest_wavelength="1 um")
    for answer, *given in (
        (lube.contact_probability, fine, oil, *POINT.values()),
        (lube.duty, [POINT], fine, oil),
        (lube.required_speed, fine, oil, "400 N", "60 degC"),
    ):
        with pytest.raises(LubeError, match="got a shortest wavelength of 1 µm, too short for a"):
            answer(*given, **lube.COMPLETE)
    heavy = POINT | {"force": "1 GN"}
    with pytest.raises(LubeError, match="force: the contact"):
        lube.contact_probability(fine, oil, **heavy, film_shape="computed")


def test_contact_that_no_realisation_sees_has_a_probability(rollers, oil):
    cold = POINT | {"force": "100 N", "speed": "300 rpm", "temperature": "40 degC"}
    found = lube.contact_probability(rollers, oil, **cold, realisations=2)
    assert found["breakthrough_probability_mean"] == 0.0
    lower, upper = (found[f"tail_breakthrough_probability_{end}"] for end in ("lower", "upper"))
    assert 0.0 < lower < upper < found["breakthrough_probability_upper"]


@pytest.fixture(scope="module")
def worn():
    """Rollers whose heights are not Gaussian."""
    heights = {"skewness": -1.0, "kurtosis": 5.0}
    return lube.Rollers("50 mm", "0.2 um", points=50_000, shortest_wavelength="60 um", **heights)


@pytest.mark.parametrize("deformation", ["none", "computed"])
def test_heights_that_are_not_gaussian_have_no_tail(worn, oil, deformation):
    choices = {"realisations": 1, "roughness_deformation": deformation}
    found = lube.contact_probability(worn, oil, **POINT, **choices)
    assert np.isnan(found["tail_breakthrough_probability"])
    remark, *_ = found.attrs["remarks"].splitlines()
    assert remark.startswith("contact is counted in realisations, not sampled: roughness: got a")
    assert remark.endswith("importance sampling is for Gaussian lines")


@pytest.mark.parametrize("answer", [lube.contact_probability, lube.trace])
def test_heights_that_are_not_gaussian_share_no_load(worn, oil, answer):
    with pytest.raises(LubeError) as error:
        answer(worn, oil, **POINT, load_sharing="iterated")
    assert str(error.value) == (
        "load_sharing: got iterated, need none: roughness: got a skewness of -1 and a kurtosis of "
        "5, need 0 and 3: the surfaces that lines stand for are Gaussian"
    )


def test_one_point_is_a_point_of_the_grid(rollers, oil, busy):
    values = {"film_formula": "paper", "realisations": 32, "seed": busy.study.seed}
    found = lube.contact_probability(rollers, oil, **POINT, **values)
    expected = busy.contact.sel(force=400.0, speed=100.0, temperature=60.0, film_formula="paper")
    assert found["breakthrough_probability_mean"].dims == ()
    assert found["breakthrough_probability_mean"] == expected["breakthrough_probability_mean"]


def test_threads_leave_the_options_of_xarray_as_they_were(rollers, oil):
    """They are the whole process's: set by several threads at once, they would stay changed."""
    before = dict(xr.get_options())
    lube.contact_probability(
        rollers, oil, "400 N", "100 rpm", "60 degC", film_shape="computed", realisations=8
    )
    assert dict(xr.get_options()) == before


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"force": "400"}, "force: got '400', need a number with its unit, such as '1 N'"),
        ({"speed": "3 kg"}, "speed: got '3 kg', need rotation speeds, such as '100 rpm', or"),
        ({"speed": ["3 rpm", "1 m/s"]}, "speed: got ['3 rpm', '1 m/s'], need rotation speeds,"),
        ({"speed": "0 rpm"}, "speed: got 0 rpm, need a value above 0 rpm"),
        ({"speed": "0 m/s"}, "speed: got 0 m/s, need a value above 0 m/s"),
        ({"temperature": "300 K"}, "got 26.85 degC, need 40 to 100 degC"),
        ({"film_formula": "moe"}, "unknown film formula 'moe', did you mean 'moes'?"),
        ({"film_formula": []}, "film_formula: got [], need a name, or a list of them"),
        ({"film_formula": ["paper"] * 2}, "film_formula: got paper repeatedly, need it once"),
        ({"contact_model": ["line"] * 2}, "contact_model: got line repeatedly, need it once"),
        ({"force": ["800 N", "0.8 kN"]}, "force: got 800 N repeatedly, need it once"),
        ({"speed": ["1 m/s", "1 m/s"]}, "speed: got 1 m/s repeatedly, need it once"),
        ({"temperature": ([60, 80, 60], "degC")}, "got 60 degC repeatedly, need it once"),
        ({"film_formula": 3}, "film_formula: got 3, need a name, or a list of them"),
        ({"oil": "water"}, "oil: got 'water', need lube.Oil(...)"),
        ({"rollers": None}, "rollers: got None, need lube.Rollers(...)"),
        ({"force": "1e12 N"}, "force: the contact is"),
        ({"realisations": 10**9}, "realisations: got 1000000000, need at most 1000000"),
        ({"realisations": 0}, "realisations: got 0, need a whole number, at least 1"),
        ({"seed": 1.5}, "seed: got 1.5, need a whole number, at least 0"),
        ({"load_sharing": "all"}, "load_sharing: got 'all', need one of none, iterated"),
        ({"contact_model": "strip"}, "contact_model: got 'strip', need one of line, surface"),
        ({"contact_model": []}, "contact_model: got [], need one of line, surface"),
        (
            {"contact_model": "surface", "roughness_deformation": "venner-1997"},
            "roughness_deformation: got venner-1997, need none or computed for contact",
        ),
        ({"slide_to_roll_ratio": 3}, "slide_to_roll_ratio: got 3, need a value"),
        ({"slide_to_roll_ratio": [0, 0.3]}, "slide_to_roll_ratio: got [0, 0.3], need one number"),
        (
            {"slide_to_roll_ratio": -0.1, "roughness_deformation": "venner-1997"},
            "roughness_deformation: got venner-1997 with a slide-to-roll ratio of -0.1, need none",
        ),
    ],
)
def test_a_mistake_is_one_line_that_names_the_argument(rollers, oil, change, message):
    with pytest.raises(LubeError) as error:
        lube.contact_probability(**{"rollers": rollers, "oil": oil} | POINT | change)
    assert message in str(error.value)
