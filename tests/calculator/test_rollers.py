"""Rollers made of numbers are those of a study."""

import pickle

import numpy as np
import pint
import pytest
from studies import CONFIG

import lube
from lube import LubeError, Rollers


def test_the_defaults_are_the_papers_rollers(study):
    rollers = Rollers("50 mm", "0.2 um")
    assert rollers.pair == study.rollers
    assert rollers.layer == study.boundary_layer
    assert rollers.resistivity == study.resistivity
    assert rollers.lines.points == (1_000_000, 1_000_000)


def test_rollers_have_the_lines_of_a_study_with_the_same_wavelengths(rollers, busy):
    given, wanted = rollers.lines, busy.study.line_spec
    assert (given.spacing, given.height_step) == (wanted.spacing, wanted.height_step)
    for line, same in zip(given.lines, wanted.lines, strict=True):
        one, other = (each.model_dump(exclude_none=True) for each in (line, same))
        assert one == pytest.approx(other, rel=1e-14)


def test_the_second_roller_differs_in_what_is_said():
    pair = Rollers("50 mm", "0.2 um", second={"radius": "30 mm", "young_modulus": "310 GPa"}).pair
    assert (pair.second.radius, pair.second.young_modulus) == (0.03, 310e9)
    assert pair.second.rms_roughness == pair.first.rms_roughness


def test_rollers_take_a_measured_surface_and_have_the_rms_height_of_its_lines():
    example = {"file": str(CONFIG / "surfaces/example.x3p"), "texture": "isotropic"}
    band = {"longest_wavelength": "0.2 mm", "shortest_wavelength": "6.25 um"}
    surface = {"topography": example | {"holes": "interpolate"}}
    both = Rollers("50 mm", **surface, **band)
    assert both.pair.rms_heights == both.lines.rms_height
    assert both.pair.first.rms_roughness == pytest.approx(0.19e-6, rel=0.01)
    one = Rollers("50 mm", "0.1 um", second=surface, **band)
    assert one.pair.rms_heights == (0.1e-6, both.lines.rms_height[1])
    with pytest.raises(LubeError, match="Rollers: topography: got one together with rms_roughness"):
        Rollers("50 mm", "0.1 um", **surface, **band)


def test_rollers_take_ra_a_composite_or_a_roughness_of_each():
    ra = Rollers("50 mm", ra_roughness="0.16 um", second={"rms_roughness": "0.1 um"}).pair
    assert ra.rms_heights == pytest.approx((0.16e-6 * np.sqrt(np.pi / 2.0), 0.1e-6))
    both = Rollers("50 mm", composite_rms_roughness="0.3 um").pair
    assert both.composite_rms_roughness == pytest.approx(0.3e-6)
    worn = Rollers(
        "50 mm",
        "0.2 um",
        second={"roughness": {"hurst_exponent": 0.8}},
        roll_off_wavelength="0.1 mm",
        skewness=-1.0,
        kurtosis=5.0,
    ).lines
    assert [line.hurst_exponent for line in worn.lines] == [0.7, 0.8]
    for line in worn.lines:
        assert (line.skewness, line.kurtosis) == (-1.0, 5.0)
        assert 2.0 * np.pi / line.q_roll_off == pytest.approx(1e-4)


def test_rollers_take_the_roughness_and_the_layer_of_a_study(study):
    """As they stand in a study, in place of the short arguments on them."""
    parts = {"roughness": study.roughness, "boundary_layer": study.boundary_layer}
    radius, rms = "50 mm", "0.2 um"
    with pytest.raises(LubeError, match=r"^Rollers: roughness.longest_wavelength: got 'contact"):
        Rollers(radius, rms, **parts)
    fixed = study.roughness.model_copy(update={"longest_wavelength": 5e-4})
    found = Rollers(radius, rms, roughness=fixed, boundary_layer=study.boundary_layer)
    points = study.roughness.points
    shortest = f"{2.0 * np.pi / found.lines.q_max!r} m"
    lengths = {"longest_wavelength": "0.5 mm", "shortest_wavelength": shortest}
    short = Rollers(radius, rms, **lengths, points=points)
    assert found.lines.points == short.lines.points == (points, points)
    for name in ("q_min", "q_max", "spacing"):
        assert getattr(found.lines, name) == pytest.approx(getattr(short.lines, name), rel=1e-12)
    assert found.layer == study.boundary_layer
    for name, value in (("skewness", -1.0), ("shear_strength", "2 MPa"), ("points", 5000)):
        with pytest.raises(LubeError, match=f"^Rollers: {name}: got .* together with `"):
            Rollers(radius, rms, **(parts | {name: value}))


def test_a_height_measured_within_cutoffs_is_that_of_the_waves_within_them():
    whole = Rollers("50 mm", "0.2 um")
    same = Rollers("50 mm", "0.2 um", long_cutoff="0.8 mm")
    assert same.lines.rms_height == whole.lines.rms_height
    part = Rollers("50 mm", "0.2 um", longest_wavelength="0.2 mm", long_cutoff="0.8 mm")
    assert part.pair.composite_rms_roughness < 0.4 * whole.pair.composite_rms_roughness
    assert part.pair.rms_heights == part.lines.rms_height
    assert part.band == "waves 200 µm to 3.14 µm, heights stated for 800 µm to 3.14 µm"
    own = Rollers("50 mm", "0.2 um", second={"roughness": {"short_cutoff": "8 um"}})
    assert own.pair.rms_heights[0] == 2e-7 < own.pair.rms_heights[1]


def test_quantities_are_texts_pairs_or_of_pint():
    unit, second = pint.UnitRegistry(), {"radius": "30 mm", "rms_roughness": "0.1 um"}
    texts = Rollers("50 mm", "0.2 um", young_modulus="200 GPa", second=second)
    others = Rollers(
        (50, "mm"),
        0.2 * unit.um,
        young_modulus=200 * unit.GPa,
        second={"radius": 3 * unit.cm, "rms_roughness": (np.float64(100.0), "nm")},
    )
    assert repr(others) == repr(texts)
    assert others.pair.reduced_modulus == pytest.approx(texts.pair.reduced_modulus, rel=1e-12)


def test_they_show_themselves_and_travel_between_processes():
    rollers = Rollers("50 mm", "0.2 um")
    assert repr(rollers) == (
        "<Rollers: radii 50 and 50 mm, rms roughness 0.2 and 0.2 um, 10 mm long, "
        "waves 800 µm to 3.14 µm>"
    )
    assert pickle.loads(pickle.dumps(rollers)).lines == rollers.lines


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda: Rollers("50", "0.2 um"), "Rollers: radius: got '50', need a number with its unit"),
        (
            lambda: Rollers("50 mm", "0.2 um", shortest_wavelength="10 points"),
            "shortest_wavelength: got '10 points', need a length",
        ),
        (
            lambda: Rollers("0.2 um", "50 mm"),
            "Rollers: radius: got 0.2 µm with waves down to 3.14 µm, 4 grid points around",
        ),
        (
            lambda: Rollers("50 m", "0.2 um"),
            "Rollers: radius: got 50 m with waves down to 3.14 µm, 1e+09 grid points around",
        ),
        (
            lambda: Rollers("50 mm", "0.2 um", second={"radius": "1 km"}),
            "rollers.second.radius: got 1 km, 2e+10 grid points around the roller, need 64",
        ),
        (lambda: Rollers("50 mm", "0.2 um", "1"), "length: got '1', need a number with its unit"),
        (
            lambda: Rollers("50 mm", "0.2 um", second={"raduis": "3 mm"}),
            "Rollers: second: raduis: unknown key, did you mean 'radius'?",
        ),
        (
            lambda: Rollers("50 mm", "0.2 um", second="30 mm"),
            "Rollers: second: got '30 mm', need a dict of the values that differ",
        ),
        (
            lambda: Rollers("50 mm", "0.2 um", second={"rms_roughness": "20 um"}),
            "rollers.second.rms_roughness: got 20 µm, need an rms height of 1 nm to 10 µm",
        ),
        (
            lambda: Rollers("50 mm", "0.2 um", longest_wavelength="contact width"),
            "longest_wavelength: got 'contact width', need a number with its unit",
        ),
        (
            lambda: Rollers("50 mm", "0.2 um", hurst_exponent=1.5),
            "Rollers: hurst_exponent: got 1.5, need a value above 0 and below 1",
        ),
        (
            lambda: Rollers("50 mm", roughness="0.2 um"),
            "need a lube.stages.Roughness; did you mean rms_roughness",
        ),
        (
            lambda: Rollers("50 mm", "0.2 um", longest_wavelenght="1 mm"),
            "Rollers: longest_wavelenght: unknown argument, did you mean 'longest_wavelength'?",
        ),
        (
            lambda: lube.trace(None, None, bands=True),
            "trace: bands: unknown argument, only contact_probability, duty, plan and the",
        ),
        (
            lambda: Rollers("50 mm", "0.2 um", lay_angle="0 deg"),
            "roughness.lay_angle: got 0 deg without a lay_ratio, need how many times longer",
        ),
        (lambda: Rollers(rms_roughness="1 um"), "Rollers: missing a required argument: 'radius'"),
    ],
)
def test_a_mistake_is_one_line(make, message):
    with pytest.raises(LubeError) as error:
        make()
    assert message in str(error.value)
