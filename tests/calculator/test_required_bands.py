"""Bands of what is enough, over what is not known exactly."""

import numpy as np
import pytest
import xarray as xr
from made import on_few_surfaces

import lube
from lube import LubeError, Rollers
from lube.calculator import bands, film_search, required
from lube.calculator.bands import Assumptions
from lube.calculator.choices import Choices

pytestmark = pytest.mark.usefixtures("few_samples")

RUNS = {"realisations": 32, "seed": 2}
ONE = {"realisations": 1, "seed": 2}
POINT = {"force": "400 N", "speed": "100 rpm", "temperature": "60 degC"}
SURFACE = {"contact_model": "surface", "seed": 2}
LIMITS = ("lower", "upper")


def without(name):
    return {key: value for key, value in POINT.items() if key != name}


def assumed(found, name):
    return [found[f"assumed_{name}_{end}"].item() for end in LIMITS]


def uncertain(name, ends):
    return {name: {"range": ends, "source": "assumed"}}


@pytest.mark.parametrize("share", [1e-6, 0.05])
def test_what_is_nearly_known_has_a_narrow_band_around_the_answer(rollers, oil, share, monkeypatch):
    monkeypatch.setitem(bands.SAMPLES, "line", 4)  # which hardly differ
    for inverse, name, given in (
        (lube.required_film, "film_thickness", ["400 N"]),
        (lube.required_speed, "speed", [oil, "400 N", "60 degC"]),
        (lube.required_roughness, "roughness_factor", [oil, *POINT.values()]),
    ):
        ranges = uncertain("force", "+- 0.001 %")
        found = inverse(rollers, *given, share=share, **RUNS, bands=ranges)
        lower, upper = assumed(found, name)
        assert lower <= upper <= 1.001 * lower
        assert lower == pytest.approx(found[name].item(), rel=0.02)
        without = inverse(rollers, *given, share=share, **RUNS)
        assert without.equals(found.drop_vars([each for each in found if "assumed" in each]))


def test_the_band_of_a_viscosity_at_a_heated_inlet_is_around_the_answer(rollers, oil, monkeypatch):
    """The heating changes with the viscosity otherwise than with the speed."""
    monkeypatch.setitem(bands.SAMPLES, "line", 4)
    monkeypatch.setattr(required, "FACTORS", np.geomspace(1e-2, 1e2, 81))
    ranges = uncertain("force", "+- 0.001 %")
    given = POINT | {"speed": "10 m/s", "temperature": "100 degC"}
    heated = {"inlet_shear_heating": "computed", "bands": ranges, "share": 1e-6}
    found = lube.required_viscosity(rollers, oil, **given, **heated, **ONE)
    for limit in assumed(found, "dynamic_viscosity"):
        assert limit == pytest.approx(found["dynamic_viscosity"].item(), rel=0.02)


@pytest.mark.parametrize(
    ("inverse", "name", "changed", "ranges", "ends"),
    [
        (lube.required_speed, "speed", "temperature", "+- 2 K", ["58.2 degC", "61.8 degC"]),
        (
            lube.required_roughness,
            "composite_rms_roughness",
            "temperature",
            "+- 2 K",
            ["58.2 degC", "61.8 degC"],
        ),
        (lube.required_viscosity, "dynamic_viscosity", "speed", "+- 20 %", ["82 rpm", "118 rpm"]),
        (lube.required_temperature, "temperature", "speed", "+- 20 %", ["82 rpm", "118 rpm"]),
    ],
)
def test_the_band_is_what_the_ends_of_a_range_need(
    rollers, oil, inverse, name, changed, ranges, ends
):
    """5 and 95 % of a uniform range."""
    given = without(name) | {"share": 0.02, **ONE}
    found = inverse(rollers, oil, **given, bands=uncertain(changed, ranges))
    needed = [inverse(rollers, oil, **given | {changed: end})[name].item() for end in ends]
    assert assumed(found, name) == pytest.approx(sorted(needed), rel=0.01)
    assert found[f"assumed_{name}_lower"].attrs["units"] == found[name].attrs["units"]


def test_the_band_of_the_film_is_what_the_ends_of_the_layer_need(rollers):
    given = {"share": 1e-3, **ONE}
    thinner = uncertain("critical_thickness", "-80 % to 0 %")
    found = lube.required_film(rollers, "400 N", **given, bands=thinner)
    layer, roughness = rollers.layer, rollers.roughness
    needed = []
    for part in (0.24, 0.96):
        own = layer.model_copy(update={"critical_thickness": part * layer.critical_thickness})
        other = Rollers("50 mm", "0.2 um", roughness=roughness, boundary_layer=own)
        needed.append(lube.required_film(other, "400 N", **given)["film_thickness"].item())
    assert assumed(found, "film_thickness") == pytest.approx(sorted(needed), rel=0.01)
    assert needed[0] != pytest.approx(needed[1], rel=0.02)


def test_the_band_is_that_of_what_each_sample_needs(rollers, oil):
    """Written out: the speed that each sample needs, and its quantiles."""
    share = 0.02
    found = lube.required_speed(rollers, oil, **without("speed"), share=share, **ONE, bands=True)
    speeds = found["speed"].item() * np.geomspace(0.3, 3.0, 15)
    sought = Assumptions(True, rollers, oil, Choices(), ONE["seed"], ["speed"])
    samples = sought.probabilities(
        {"force": 400.0, "speed": xr.DataArray(speeds, dims="speed")} | {"temperature": 60.0}
    )
    needed = [np.interp(-np.log(share), -np.log(each), np.log(speeds)) for each in samples.values]
    expected = np.quantile(np.exp(needed), [0.05, 0.95])
    lower, upper = assumed(found, "speed")
    assert [lower, upper] == pytest.approx(expected.tolist(), rel=0.02)
    assert lower < found["speed_lower"] and found["speed_upper"] < upper


def test_limits_beyond_the_films_tried_are_infinite_or_zero(rollers, oil, monkeypatch):
    monkeypatch.setitem(bands.SAMPLES, "line", 8)
    much, little = (uncertain("viscosity", ends) for ends in ("0 % to 1000 %", "-95 % to 10 %"))
    given = POINT | {"share": 0.02, **ONE}
    for ranges, beyond, factor in ((much, 0, [0.0, np.inf]), (little, 1, [np.inf, 0.0])):
        of_speed = without("speed") | {"share": 0.02, **ONE, "bands": ranges}
        speeds = assumed(lube.required_speed(rollers, oil, **of_speed), "speed")
        assert speeds[beyond] == factor[0] and np.isfinite(speeds[1 - beyond])
        rough = lube.required_roughness(rollers, oil, **given, bands=ranges)
        factors = assumed(rough, "roughness_factor")
        assert factors[1 - beyond] == factor[1] and 0.0 < factors[beyond] < np.inf
    with pytest.raises(
        LubeError, match=r"^bands: got viscosity, need an uncertain quantity or choice on"
    ):
        lube.required_viscosity(rollers, oil, **given, bands=much)
    with pytest.raises(
        LubeError, match=r"^bands: got viscosity, need an uncertain quantity or choice on"
    ):
        lube.required_film(rollers, "400 N", bands=much)


@pytest.mark.slow
def test_bands_of_a_roughness_under_a_film_with_a_shape(rollers, oil):
    """Rollers of another roughness have this band of the probability."""
    kelvin = uncertain("temperature", "+- 2 K")
    choices = {"film_shape": "computed", **ONE, "bands": kelvin}
    found = lube.required_roughness(rollers, oil, **POINT, share=0.02, **choices)
    needed = [
        lube.required_roughness(
            rollers, oil, **POINT | {"temperature": end}, share=0.02, film_shape="computed", **ONE
        )["roughness_factor"].item()
        for end in ("61.8 degC", "58.2 degC")
    ]
    assert assumed(found, "roughness_factor") == pytest.approx(needed, rel=0.01)


def test_the_band_on_the_surface_is_around_the_answer(rollers, oil, monkeypatch):
    monkeypatch.setitem(bands.SAMPLES, "surface", 2)
    for name in ("AROUND", "BROAD"):
        monkeypatch.setattr(film_search, name, getattr(film_search, name)[::2])
    speed = uncertain("speed", "+- 20 %")
    with on_few_surfaces(16):
        found = lube.required_roughness(rollers, oil, **POINT, **SURFACE, share=0.2, bands=speed)
    lower, upper = assumed(found, "roughness_factor")
    assert lower < found["roughness_factor"] < upper < 1.5 * lower
