"""The indicators stage, and the same from the calculator."""

import numpy as np
import pytest
from made import made

import lube
from lube.physics.indicators import AIHARA_PRESSURE, LOAD_SHARES
from lube.schema import OPERATING_DIMS, POINT_DIMS

GRID = {"force": (100.0, 800.0, 1600.0), "speed": (100.0,), "temperature": (40.0, 80.0)}


@pytest.fixture(scope="module")
def files(study):
    """The smoke study, with fewer operating points."""
    grid = study.operating_grid.model_copy(update=GRID)
    few = study.model_copy(update={"operating_grid": grid})
    return made(few, ("lubricant", "film", "film_profile", "indicators"))


def test_each_load_share_is_for_its_own_lambda_ratio_and_pressures(files, study):
    film, found = files["film"], files["indicators"]["asperity_load_share"]
    assert found.dims == ("load_share_curve", *OPERATING_DIMS)
    composite, mean_ra = study.rollers.composite_rms_roughness, study.rollers.mean_ra_roughness
    assert mean_ra == pytest.approx(composite / np.sqrt(np.pi))
    for name, curve in LOAD_SHARES.items():
        roughness = mean_ra if curve.roughness == "mean_ra_roughness" else composite
        expected = curve.share(film["film_thickness"] / roughness)
        if name == "aihara-1987":
            expected = expected.where(film["hertz_pressure"] <= AIHARA_PRESSURE)
            assert expected.isnull().any() and expected.notnull().any()
        expected = expected.transpose(*OPERATING_DIMS)
        np.testing.assert_allclose(found.sel(load_share_curve=name), expected, rtol=1e-12)


def test_the_film_of_gears_is_thinner_where_the_oil_is_warm_and_the_load_high(files):
    ratio = files["indicators"]["micropitting_film_ratio"]
    assert ratio.dims == POINT_DIMS
    assert (ratio.diff("temperature") < 0.0).all() and (ratio.diff("force") < 0.0).all()


def test_the_calculator_answers_the_same(files):
    rollers = lube.Rollers(radius="50 mm", rms_roughness="0.2 um")
    oil = lube.Oil("mobilgear-shc-xmp-320")
    point = {"force": 800.0, "speed": 100.0, "temperature": 80.0}
    answer = lube.indicators(
        rollers, oil, "800 N", "100 rpm", "80 degC", film_formula="paper", pitch_diameter="200 mm"
    )
    here = files["indicators"].sel(point | {"film_formula": "paper"}).squeeze()
    assert answer["micropitting_film_ratio"].item() == pytest.approx(
        here["micropitting_film_ratio"].item()
    )
    for name in ("computed", "pan-hamrock"):
        own = answer[f"rolling_resistance_{name.replace('-', '_')}"]
        there = here["rolling_resistance"].sel(resistance_formula=name).item()
        assert own.item() == pytest.approx(there, rel=1e-4)
        assert own.attrs["units"] == "N"
    share = here["asperity_load_share"].sel(load_share_curve="aihara-1987").item()
    assert answer["asperity_load_share_aihara_1987"].item() == pytest.approx(share)
    assert "load_share_curve" not in answer.dims and len(answer.table()) == 1
    assert answer["viscosity_ratio"] == pytest.approx(1.248, abs=0.001)


def test_a_bearing_needs_its_pitch_diameter_with_a_unit():
    rollers = lube.Rollers(radius="50 mm", rms_roughness="0.2 um")
    point = lube.Oil("mobilgear-shc-xmp-320"), "800 N", "100 rpm", "80 degC"
    assert "viscosity_ratio" not in lube.indicators(rollers, *point)
    for given, message in (("65", "need a number with its unit"), ("65 mm", "above 0.1 m")):
        with pytest.raises(lube.LubeError, match=f"^pitch_diameter: .*{message}"):
            lube.indicators(rollers, *point, pitch_diameter=given)
