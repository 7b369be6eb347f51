"""What is found to be enough is enough: put in again, it gives the share asked for."""

import re

import numpy as np
import pytest
import xarray as xr
from made import on_few_surfaces
from put_in_again import (
    CHOICES,
    FEW,
    POINT,
    RUNS,
    SURFACE,
    assert_has_the_share,
    of_roughness,
    probability,
    without,
)

import lube
from lube import LubeError, Rollers
from lube.calculator import film_search, required
from lube.calculator.choices import FORMULA
from lube.calculator.contact import ensemble
from lube.grid.films import film_at
from lube.grid.gap import PLAIN

ONE = {"realisations": 1, "seed": 2}
SHARE = 0.05


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


def test_what_is_found_for_an_inlet_that_slip_heats_has_the_share(rollers, oil, busy):
    """Put in again; without the slip there is less contact."""
    slip, heated = {"slide_to_roll_ratio": 1.0}, {"inlet_shear_heating": "wilson-sheu-1983"}
    given = {"share": 0.02, **RUNS, **heated, **slip}
    speed = lube.required_speed(rollers, oil, **without("speed"), **given)["speed"].item()
    level = lube.required_temperature(rollers, oil, **without("temperature"), **given)
    factor = lube.required_roughness(rollers, oil, **POINT, **given)["roughness_factor"].item()
    smoother = of_roughness(f"{0.2 * factor!r} um", busy.study.line_spec)
    for surfaces, changes in (
        (rollers, {"speed": (speed, "rpm")}),
        (rollers, {"temperature": (level["temperature"].item(), "degC")}),
        (smoother, {}),
    ):
        found = probability(surfaces, oil, **changes, **heated, **slip)
        assert found == pytest.approx(0.02, rel=0.2)
        assert probability(surfaces, oil, **changes, **heated) < 0.018


def test_asperities_that_carry_load_leave_the_oil_a_thicker_film(rollers, oil):
    """Put in again, it has the share, and a trace has its film."""
    sharing, given = {"load_sharing": "iterated"}, without("speed") | RUNS
    found, whole = (
        lube.required_speed(rollers, oil, share=0.3, **given, **more) for more in (sharing, {})
    )
    assert found["speed"] < 0.99 * whole["speed"]
    point = POINT | {"speed": (found["speed"].item(), "rpm")} | sharing
    back = lube.contact_probability(rollers, oil, **point, **RUNS)
    assert back["breakthrough_probability_mean"].item() == pytest.approx(0.3, rel=0.05)
    assert lube.trace(rollers, oil, **point)["film_thickness"] == back["film_thickness"]
    assert lube.plan(rollers, oil, **point, **RUNS)["film_thickness"] == back["film_thickness"]
    with pytest.raises(LubeError, match=r"^bands: load_sharing: got iterated, need none: "):
        lube.required_speed(rollers, oil, share=0.3, bands=True, **given, **sharing)


def test_speed_and_viscosity_give_the_film_of_a_heated_and_starved_inlet(rollers, oil, monkeypatch):
    """Beyond some speed heating makes the film thinner again: the answer lies below."""
    monkeypatch.setattr(required, "FACTORS", np.geomspace(1e-3, 1e3, 151))
    inlet = {"inlet_shear_heating": "computed", "inlet_meniscus": "0.5 mm"}
    given = inlet | FEW | {"share": SHARE}
    found = lube.required_speed(rollers, oil, **without("speed"), **given)
    speeds = found["speed"].item() * np.array([1.0, 1.2, 1e3]), "rpm"
    films = lube.film(rollers, oil, **without("speed"), speed=speeds, **inlet)["film_thickness"]
    assert films[0].item() == pytest.approx(found["film_thickness"].item(), rel=3e-3)
    assert films[0] < films[1] and films[2] < films[1]
    found = lube.required_viscosity(rollers, oil, **POINT, **given)
    viscosity = 1e-3 * found["dynamic_viscosity"].item()
    properties = oil.at(xr.DataArray(60.0)).assign(dynamic_viscosity=viscosity)
    levels = xr.DataArray(400.0), xr.DataArray(100.0), [FORMULA]
    inlet["inlet_meniscus"] = 0.5e-3
    film = film_at(properties, rollers.pair, *levels, **inlet)["film_thickness"].item()
    assert 1e6 * film == pytest.approx(found["film_thickness"].item(), rel=3e-3)


@pytest.mark.parametrize("share", [1e-6, 1e-12, 1e-25])
def test_a_share_may_be_as_rare_as_one_likes(rollers, oil, share):
    """Put in again, it is the probability by importance sampling."""
    found = lube.required_speed(rollers, oil, "400 N", "60 degC", share=share, **RUNS)
    speed = (found["speed"].item(), "rpm")
    back = lube.contact_probability(
        rollers, oil, **POINT | {"speed": speed}, realisations=1, seed=2
    )
    assert back["tail_breakthrough_probability"].item() == pytest.approx(share, rel=0.05)
    limits = [found[f"film_thickness{limit}"].item() for limit in ("_lower", "", "_upper")]
    assert limits == sorted(limits) and limits[2] / limits[0] < 1.02


@pytest.mark.parametrize(
    ("inverse", "name", "unit", "chosen"),
    [
        (lube.required_speed, "speed", "rpm", ["film_shape"]),
        (lube.required_viscosity, "speed", "rpm", ["roughness_deformation"]),
        (lube.required_temperature, "temperature", "degC", list(CHOICES)),
    ],
)
def test_under_any_film_what_is_found_has_the_share(rollers, oil, inverse, name, unit, chosen):
    """Put in again: its own shape and flattening are those of the condition found."""
    choices = {one: CHOICES[one] for one in chosen} | (FEW if "film_shape" in chosen else RUNS)
    if inverse is lube.required_viscosity:
        found = inverse(rollers, oil, **POINT, share=0.02, **choices)
        ratio = found["dynamic_viscosity"] / oil.properties("60 degC")["dynamic_viscosity"]
        level = 100.0 * ratio.item()
    else:
        found = inverse(rollers, oil, **without(name), share=0.02, **choices)
        level = found[name].item()
    back = lube.contact_probability(rollers, oil, **POINT | {name: (level, unit)}, **choices)
    assert back["breakthrough_probability_mean"].item() == pytest.approx(0.02, rel=0.05)
    assert found["lambda_ratio"].item() == pytest.approx(back["lambda_ratio"].item(), rel=1e-3)


@pytest.mark.usefixtures("few_pairs")
def test_a_rare_share_under_a_shape_is_sampled_and_on_flattened_lines_refused(rollers, oil):
    given = without("speed") | {"share": 1e-9}
    found = lube.required_speed(rollers, oil, **given, film_shape="computed", **ONE)
    speed = (found["speed"].item(), "rpm")
    back = lube.contact_probability(
        rollers, oil, **POINT | {"speed": speed}, film_shape="computed", **ONE
    )
    assert back["tail_breakthrough_probability"].item() == pytest.approx(1e-9, rel=0.05)
    with pytest.raises(LubeError, match=r"^share: got 1e-09, need .* no formula flattens$"):
        lube.required_speed(rollers, oil, **given, roughness_deformation="venner-1997", **ONE)


@pytest.mark.usefixtures("few_pairs")
def test_a_rare_share_of_lines_that_the_oil_answers(rollers, oil, monkeypatch):
    """Put in again with the slip, which the answer depends on, and without."""
    monkeypatch.setattr(film_search, "AROUND", film_search.AROUND[::2])
    gap = {"film_shape": "computed", "roughness_deformation": "computed"} | ONE
    slip = {"slide_to_roll_ratio": 1.0}
    found = lube.required_speed(rollers, oil, **without("speed"), share=1e-4, **gap, **slip)
    point = POINT | {"speed": (found["speed"].item(), "rpm")}
    back = lube.contact_probability(rollers, oil, **point, **gap, **slip)
    probability = back["tail_breakthrough_probability"].item()
    assert probability == pytest.approx(1e-4, rel=0.1)
    rolling = lube.contact_probability(rollers, oil, **point, **gap)
    assert abs(np.log(rolling["tail_breakthrough_probability"].item() / probability)) > 0.02


@pytest.mark.parametrize(
    "more",
    [
        {},
        {"film_shape": "computed"},
        pytest.param(lube.COMPLETE, marks=pytest.mark.slow),
    ],
    ids=["flat", "shaped", "complete"],
)
def test_a_share_on_the_surface_needs_more_speed_than_on_the_line(rollers, oil, more):
    choices = SURFACE | more
    with on_few_surfaces(10):
        found = lube.required_speed(rollers, oil, **without("speed"), share=0.2, **choices)
        point = POINT | {"speed": (found["speed"].item(), "rpm")}
        assert_has_the_share(lube.contact_probability(rollers, oil, **point, **choices), 0.2)
    line = lube.required_speed(rollers, oil, **without("speed"), share=0.2, **ONE)
    assert found["speed_lower"] > 1.3 * line["speed"]


@pytest.mark.parametrize("off", [0.5, 2.0])
def test_on_the_surface_films_are_searched_until_their_limits_enclose_the_share(
    rollers, oil, monkeypatch, off
):
    choices = SURFACE | {"film_shape": "computed"}
    with on_few_surfaces(10):
        usual = lube.required_speed(rollers, oil, **without("speed"), share=0.2, **choices)
        monkeypatch.setattr(film_search, "CLOSE", off * film_search.CLOSE)
        found = lube.required_speed(rollers, oil, **without("speed"), share=0.2, **choices)
    assert found["speed"] == pytest.approx(usual["speed"].item(), rel=0.01)
    assert found["speed_lower"] < usual["speed"] < found["speed_upper"]


def test_a_choice_that_no_study_has_is_refused(rollers, oil):
    for name in CHOICES:
        with pytest.raises(LubeError, match=f"^{name}: got 'curved', "):
            lube.required_speed(rollers, oil, **without("speed"), **{name: "curved"})


def test_counting_and_sampling_agree_where_both_see(rollers, oil, monkeypatch):
    for share in (0.003, 0.05, 0.3):
        ends = {}
        for name, often in (("counted", 0.0), ("sampled", np.inf)):
            monkeypatch.setattr(film_search, "OFTEN", often)
            film = lube.required_film(rollers, "400 N", share=share, **RUNS)
            rough = lube.required_roughness(rollers, oil, **POINT, share=share, **RUNS)
            ends[name] = [
                (each["lambda_ratio_lower"].item(), each["lambda_ratio_upper"].item())
                for each in (film, rough)
            ]
        for counted, sampled in zip(ends["counted"], ends["sampled"], strict=True):
            assert counted != sampled and 0.0 < counted[0] < np.inf
            assert counted[0] < sampled[1] and sampled[0] < counted[1]


@pytest.mark.parametrize("rms", ["0.01 um", "0.011 um"])
def test_rollers_so_smooth_that_the_layer_mostly_holds_have_a_film(rms):
    """The largest share that they have is hardly above the one asked for."""
    found = lube.required_film(Rollers("8 mm", rms), "2 kN", share=0.01)
    limits = [found[f"lambda_ratio{limit}"].item() for limit in ("_lower", "", "_upper")]
    assert 1.0 < limits[0] < limits[1] < limits[2] < 1.5


@pytest.fixture(scope="module")
def merging():
    """Rollers whose contact falls as the film thins where it is frequent."""
    waves = {"longest_wavelength": "0.2 mm", "shortest_wavelength": "10.48 um"}
    return Rollers("50 mm", "0.2 um", points=300_000, **waves)


def test_of_two_films_of_a_share_the_thicker_is_named(merging):
    with pytest.raises(LubeError, match=r"share: got 0\.99, which no film has") as error:
        lube.required_film(merging, "400 N", share=0.99, **FEW)
    words = re.search(r"is (0\.\d+), at a lambda ratio of (.*)", f"{error.value}")
    largest, peak = map(float, words.groups())
    sigma = merging.pair.composite_rms_roughness
    assert peak > 0.2
    for share in (0.998 * largest, 0.8 * largest):
        found = lube.required_film(merging, "400 N", share=share, **FEW)
        ratio = found["lambda_ratio"].item()
        assert ratio > peak
        films = xr.Dataset(
            {
                "film_thickness": ("film", sigma * np.array([0.1, peak, ratio, 1.3 * ratio])),
                "contact_half_width": merging.pair.contact_half_width(400.0),
                "reduced_modulus": merging.pair.reduced_modulus,
            }
        )
        pair = merging.rough_pair(FEW["seed"], PLAIN)
        contact = ensemble(pair, films, FEW["realisations"], 0.0)
        thin, most, there, beyond = contact["breakthrough_probability_mean"].values
        assert beyond < share < most
        assert thin < 0.995 * largest
        assert there == pytest.approx(share, rel=0.01)


def test_lines_that_are_not_gaussian_are_counted_only(oil):
    worn = Rollers(
        "50 mm", "0.2 um", points=50_000, shortest_wavelength="60 um", skewness=-1.0, kurtosis=5.0
    )
    found = lube.required_film(worn, "400 N", share=0.02, realisations=2)
    assert 0.0 < found["film_thickness"] < 5.0
    with pytest.raises(LubeError, match=r"share: got 1e-09, need at least .*: 2 realisations show"):
        lube.required_film(worn, "400 N", share=1e-9, realisations=2)


@pytest.mark.parametrize(
    ("ask", "message"),
    [
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
            "share: got 0.9999, which no film has: the largest share is 0.3",
        ),
        (
            lambda rollers, oil: lube.required_temperature(
                rollers, oil, "400 N", "1 rpm", share=0.01, **RUNS
            ),
            "needs a film of 0.825 um, and no temperature of this oil gives more than 0.0",
        ),
        (
            lambda rollers, oil: lube.required_viscosity(
                rollers, oil, "400 N", "0.0001 rpm", "60 degC", share=0.01, **RUNS
            ),
            "share: this share needs a film of 0.825 um, and no viscosity within a factor of 1000",
        ),
        (
            lambda rollers, oil: lube.required_speed(
                rollers, oil, ["400 N", "800 N"], "60 degC", share=0.01
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


@pytest.mark.parametrize("share", [0.05, 1e-9])
def test_beyond_the_films_of_the_oil_one_line_says_so(rollers, oil, busy, share):
    """With a shape no film beyond those is searched."""
    given = {"share": share, "film_shape": "computed"} | FEW
    smooth = of_roughness("0.02 um", busy.study.line_spec)
    found = lube.required_temperature(smooth, oil, "400 N", "500 rpm", **given)
    assert found["temperature"] == np.inf and found["film_thickness"] == 0.0
    with pytest.raises(LubeError, match=r"^share: this share needs a thicker film, and no temp"):
        lube.required_temperature(rollers, oil, "400 N", "1 rpm", **given)


def test_on_the_surface_thinner_films_are_searched_where_layers_hold(oil, busy):
    """Breakthrough is far rarer there than contact; it takes rollers this rough, drawn anew."""
    spec = busy.study.line_spec

    def holding(rms):
        lengths = {"longest_wavelength": f"{2.0 * np.pi / spec.q_min!r} m", "points": 50_000}
        lengths["shortest_wavelength"] = f"{10.0 * spec.spacing!r} m"
        return Rollers("50 mm", f"{rms!r} um", shear_strength="2 MPa", **lengths)

    with on_few_surfaces(4):
        found = lube.required_roughness(holding(0.2), oil, **POINT, share=0.3, **SURFACE)
        rms = 0.2 * found["roughness_factor"].item()
        more, less = (
            lube.contact_probability(holding(rms * by), oil, **POINT, **SURFACE)
            for by in (1.1, 1.0 / 1.1)
        )
    assert found["lambda_ratio"] < 1.0
    name = "surface_breakthrough_probability"
    assert less[name] < 0.3 < more[name]


@pytest.fixture
def few_factors(monkeypatch):
    """Few viscosities and speeds are tried: a film from Reynolds' equation takes long."""
    monkeypatch.setattr(required, "FACTORS", required.FACTORS[::5])


def of_viscosity(value):
    points = {"40 degC": f"{value!r} mPa*s", "100 degC": f"{0.2 * value!r} mPa*s"}
    return lube.Oil(viscosity=points, pressure_viscosity="18 1/GPa")


@pytest.mark.usefixtures("few_factors")
@pytest.mark.parametrize("name", ["film_formula", "film_shape"])
def test_an_oil_of_the_viscosity_has_the_share_under_the_computed_film(rollers, name):
    """Under pressure it becomes more viscous in another way than the oil given."""
    point = POINT | {"temperature": "40 degC", name: "computed"} | FEW
    found = lube.required_viscosity(rollers, of_viscosity(3.0), **point, share=0.02)
    viscosity = found["dynamic_viscosity"].item()
    assert viscosity > 30.0
    back = lube.contact_probability(rollers, of_viscosity(viscosity), **point)
    assert back["film_thickness"].item() == pytest.approx(found["film_thickness"].item(), rel=1e-3)
    assert back["breakthrough_probability_mean"].item() == pytest.approx(0.02, rel=0.05)


def test_films_that_do_not_converge_are_left_out(rollers, monkeypatch):
    """Those at the lowest speeds, of which few are tried here: each takes many steps."""
    tried = required.FACTORS
    monkeypatch.setattr(required, "FACTORS", np.append(tried[:250:100], tried[250:500:5]))
    given = rollers, of_viscosity(3.0), "3 kN"
    slowest = lube.film(*given, "0.001 m/s", "40 degC", film_formula="computed")
    assert np.isnan(slowest["film_thickness"])
    found = lube.required_speed(*given, "40 degC", share=0.02, film_formula="computed", **FEW)
    speed = (found["speed"].item(), "rpm")
    back = lube.film(*given, speed, "40 degC", film_formula="computed")
    np.testing.assert_allclose(back["film_thickness"], found["film_thickness"], rtol=1e-3)


def test_conditions_without_a_known_film_are_refused_in_one_line(rollers, monkeypatch):
    monkeypatch.setattr(required, "TEMPERATURES", 2)
    given = rollers, of_viscosity(3.0), "3 kN", "0.001 m/s"
    for choice in ("film_formula", "film_shape"):
        with pytest.raises(LubeError, match=r"^the film did not converge at the conditions tried"):
            lube.required_roughness(*given, "40 degC", **{choice: "computed"}, **FEW)
    with pytest.raises(LubeError, match=r"^the film did not converge at the conditions tried"):
        lube.required_temperature(*given, film_formula="computed", **FEW)


def test_remarks_on_a_temperature_are_on_the_film_found(rollers, oil, monkeypatch):
    tables = []
    monkeypatch.setattr(required, "labelled", lambda found, film, *_: tables.append((found, film)))
    lube.required_temperature(rollers, oil, **without("temperature"), **FEW)
    [(found, film)] = tables
    assert film["lambda_ratio"].item() == pytest.approx(found["lambda_ratio"][0], rel=1e-3)


@pytest.mark.parametrize("model", ["line", "surface"])
def test_answers_have_the_remarks_of_the_probability_at_the_film_found(oil, model):
    light, choices = POINT | {"force": "10 N"}, {"contact_model": model, **ONE}
    waves = {"shortest_wavelength": "20 um", "points": 200_000, "shear_strength": "0.2 MPa"}
    rough = Rollers("50 mm", "1 um", **waves)

    def remarks(rollers=rough, **changes):
        found = lube.contact_probability(rollers, oil, **light | changes, **choices)
        return found.attrs["remarks"]

    with on_few_surfaces(10):
        asked = choices | {"share": {"line": 0.1, "surface": 0.9999}[model]}
        film = lube.required_film(rough, light["force"], **asked)
        speed = lube.required_speed(rough, oil, **without("speed") | {"force": "10 N"}, **asked)
        viscosity = lube.required_viscosity(rough, oil, **light, **asked)
        rougher = lube.required_roughness(rough, oil, **light, **asked)
        expected = remarks(speed=(speed["speed"].item(), "rpm"))
        height = f"{rougher['roughness_factor'].item()!r} um"
        of_height = remarks(Rollers("50 mm", height, **waves))
    assert f"the {model}" in expected and "asperities carry more than a tenth" in expected
    for found in (speed, viscosity):
        assert found.attrs["remarks"] == expected
    *of_film, of_formula = expected.splitlines()
    assert film.attrs["remarks"].splitlines() == of_film
    assert of_formula.startswith("film_formula: at 1 of 1 operating points `pan-hamrock` is out")
    assert rougher.attrs["remarks"] == of_height
