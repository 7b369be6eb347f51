"""Plans of measurements, asked for in a notebook."""

import numpy as np
import pytest

import lube
from lube import LubeError
from lube.contact.surface_strip import SURFACES
from lube.schema import LIMITS
from lube.statistics.confidence import error_of_limits
from lube.statistics.one_pair import quantile

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


def test_a_rig_reads_each_point_as_by_itself(rollers, oil):
    several = lube.plan(rollers, oil, **POINT, realisations=4, rig="mtm-ecr").reading_error
    assert several.dims == ("force",) and several.size > 1
    for force in several["force"].values:
        given = POINT | {"force": (float(force), "N")}
        alone = lube.plan(rollers, oil, **given, realisations=4, rig="mtm-ecr").reading_error
        assert alone.item() == several.sel(force=force).item() > 0.0


def test_an_ecr_meter_shows_the_mean_voltage_whatever_the_threshold(rollers, oil):
    thresholds = {"threshold": ["100 ohm", "1 ohm"], "realisations": 4}
    plan = lube.plan(rollers, oil, **POINT, rig="mtm-ecr", **thresholds)
    first, second = plan.reading_error.transpose("threshold", ...).values
    np.testing.assert_array_equal(first, second)


def test_surfaces_are_planned_by_the_scatter_of_one_pair(rollers, oil):
    one = POINT | {"force": "400 N", "speed": "250 rpm", "temperature": "60 degC"}
    surface = {"contact_model": "surface", "turns": [0.25, 1.0, 7.0]}
    known = lube.contact_probability(rollers, oil, **one, contact_model="surface")
    found = lube.plan(rollers, oil, **one, **surface)
    share = known.surface_breakthrough_probability
    assert found.breakthrough_probability == share and 0.01 < share < 0.95
    film, coefficient, _ = found.half_width
    np.testing.assert_allclose(film / coefficient, 0.47, rtol=0.01)
    # By the slope between films that are 20 % apart, on other surfaces.
    ends = []
    for seed, speed in ((2, "220 rpm"), (3, "284 rpm")):
        end = one | {"speed": speed, "contact_model": "surface", "seed": seed}
        ends.append(lube.contact_probability(rollers, oil, **end))
    each = zip(
        *[(one.film_thickness, one.surface_breakthrough_probability) for one in ends], strict=True
    )
    thickness, shares = (np.log(second / first) for first, second in each)
    limits = [known[f"surface_breakthrough_probability{end}"].values for end in LIMITS]
    curve = error_of_limits(limits)
    errors = np.hypot(np.array([2.0, 1.0, 1.0]) * known.surface_pair_deviation.item(), curve)
    expected = quantile(SURFACES) * errors / (share * abs(shares / thickness)).item()
    np.testing.assert_allclose(film, expected, rtol=0.1)
    assert film.sel(turns=1.0) == film.sel(turns=7.0) < 0.8 * film.sel(turns=0.25)


def test_a_rig_reads_surfaces_as_well_as_lines_or_better(rollers, oil):
    rig = {"rig": "threshold-counter", "realisations": 2}
    line = lube.plan(rollers, oil, **POINT, **rig)
    surface = lube.plan(rollers, oil, **POINT, **rig, contact_model="surface")
    assert (surface.reading_error <= line.reading_error).all()
    assert (surface.breakthrough_probability > line.breakthrough_probability).all()


@pytest.mark.parametrize(
    ("argument", "value", "said"),
    [
        ("rig", "mtm", "rig: got 'mtm', "),
        ("rig", 3, "rig: got 3, need one of mtm-ecr, "),
        ("film_shape", True, "film_shape: got True, need one of flat, computed"),
        ("threshold", "5 m", "threshold: wrong dimension or unit 'm'"),
        ("turns", 0, "turns: got 0, need a value above 0"),
        ("turns", [], "turns: got [], need one number, or a list of them"),
        ("turns", [1, 2, 1], "turns: got 1 repeatedly, need it once"),
        ("threshold", ["1 ohm"] * 2, "threshold: got 1 ohm repeatedly, need it once"),
        ("turns", [1, -2], "turns: got -2, need a value above 0"),
        ("film_formula", ["paper", "moes"], "film_formula: got ['paper', 'moes'], need one name"),
        ("roughness_deformation", "venner-1997", "roughness_deformation: got venner-1997, need"),
        ("contact_model", "strip", "contact_model: got 'strip', need one of line, surface"),
        ("contact_model", ["line"], "contact_model: got ['line'], need one name"),
    ],
)
def test_what_does_not_suit_is_refused_in_one_line(rollers, oil, argument, value, said):
    given = {"rig": "mtm-ecr"} | {argument: value}
    with pytest.raises(LubeError) as caught:
        lube.plan(rollers, oil, **POINT, **given)
    assert str(caught.value).startswith(said) and "\n" not in str(caught.value)


def test_a_threshold_needs_a_rig(rollers, oil):
    with pytest.raises(LubeError, match=r"^threshold: got '10 ohm' without a rig, need rig, too"):
        lube.plan(rollers, oil, **POINT, threshold="10 ohm")


def test_rollers_that_do_not_conduct_have_no_rig(oil):
    glass = lube.Rollers(radius="50 mm", rms_roughness="0.2 um", resistivity="insulator")
    with pytest.raises(LubeError, match=r"^rig: got 'mtm-ecr' with rollers that do not conduct"):
        lube.plan(glass, oil, **POINT, realisations=2, rig="mtm-ecr")


def test_rollers_for_which_no_line_stands_have_no_rig(oil):
    ground = lube.Rollers("50 mm", "0.2 um", lay_ratio=5, lay_angle="0 deg")
    with pytest.raises(LubeError, match=r"^rig: got 'mtm-ecr' with ridges for which no line"):
        lube.plan(ground, oil, **POINT, contact_model="surface", rig="mtm-ecr")


@pytest.mark.usefixtures("few_samples")
def test_what_is_uncertain_widens_the_intervals_of_what_depends_on_it(rollers, oil, found):
    kelvin = {"temperature": {"range": "+- 6 K", "source": "thermocouple"}}
    some = lube.plan(rollers, oil, **POINT, realisations=16, turns=[0.2, 1.0], bands=kelvin)
    assert some.half_width_assumed.dims == some.half_width.dims == ("quantity", "turns", "force")
    np.testing.assert_array_equal(some.half_width.sel(turns=1.0), found.half_width)
    ratio = some.half_width_assumed / some.half_width
    # The film is inferred from the share, whatever the temperature.
    np.testing.assert_array_equal(ratio.sel(quantity="film thickness"), 1.0)
    # By the change of the probability over the range, and its scatter between pairs.
    around = POINT | {"temperature": ["64 degC", "70 degC", "76 degC"]}
    shares = lube.contact_probability(rollers, oil, **around, realisations=16)
    cold, _, hot = np.log(shares.tail_breakthrough_probability).transpose("temperature", ...)
    counted = shares.breakthrough_probability.sel(temperature=70.0)
    error = counted.std("realisation", ddof=1) / counted.mean("realisation")
    expected = (hot - cold) / np.sqrt(12.0) / error
    widened = ratio.sel(turns=1.0, quantity="pressure-viscosity coefficient")
    np.testing.assert_allclose(np.sqrt(widened**2 - 1.0), expected, rtol=0.2)


@pytest.mark.parametrize(
    ("bands", "choices", "said"),
    [
        ("all", {}, "bands: got 'all', need True, False or a dict of ranges"),
        (True, {"load_sharing": "iterated"}, "bands: "),
        (
            {"film_formula": {"choices": ["paper", "moes"], "source": "assumed"}},
            {},
            "bands: got film_formula, need an uncertain quantity or choice on which",
        ),
        ({"lambda_ratio": {"range": "+- 2 %"}}, {}, "bands: lambda_ratio"),
    ],
)
def test_bands_that_a_plan_cannot_have_are_refused_in_one_line(rollers, oil, bands, choices, said):
    with pytest.raises(LubeError) as caught:
        lube.plan(rollers, oil, **POINT, **choices, bands=bands)
    assert str(caught.value).startswith(said) and "\n" not in str(caught.value)
