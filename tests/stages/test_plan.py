"""The plan of a small study, with and without what is not known exactly."""

import numpy as np
import pytest
import xarray as xr
from made import made, on_few_surfaces
from studies import CONFIG

from lube.report.plan import tables
from lube.schema import LIMITS, POINT_DIMS
from lube.stages import plan
from lube.statistics.confidence import error_of_limits
from lube.statistics.one_pair import quantile
from lube.study.study import load_study
from lube.study.uncertainty import Uncertainty

RANGES = {
    "viscosity": {"range": "+- 10 %", "source": "x"},
    "first_rms_roughness": {"range": "-29 % to 25 %", "source": "x"},
    "film_formula": {"choices": ["paper", "moes"], "source": "x"},
}


@pytest.fixture(scope="module")
def study():
    own = load_study(CONFIG / "smoke.yaml")
    roughness = own.roughness.model_copy(update={"points": 200_000})
    update = {"roughness": roughness, "realisations": 8}
    return own.model_copy(update=update | {"uncertainty": Uncertainty.model_validate(RANGES)})


@pytest.fixture(scope="module")
def files(study):
    return made(study, ("lubricant", "film", "contact", "electrical"))


@pytest.fixture(scope="module")
def sensitivity(files):
    """Indices as of `sensitivity.nc`: a quarter is the oil's, half the surface's."""
    film = files["film"]
    levels = {name: film[name].values for name in POINT_DIMS}
    sizes = [film.sizes[name] for name in POINT_DIMS]
    groups = ["oil", "surface", "film", "seed"]
    factors = ["viscosity", "first_rms_roughness", "film_formula", "seed"]
    parts = np.multiply.outer([0.25, 0.5, 0.2, 0.0], np.ones(sizes))
    return xr.Dataset(
        {
            "log_probability_deviation": (POINT_DIMS, np.full(sizes, 0.4)),
            "group_first_order": (("factor_group", *POINT_DIMS), parts),
            "first_order": (("factor", *POINT_DIMS), parts),
            "first_order_lower": (("factor", *POINT_DIMS), parts - 0.01),
            "first_order_upper": (("factor", *POINT_DIMS), parts + 0.01),
            "group_of_factor": ("factor", groups),
        },
        levels | {"factor_group": groups, "factor": factors},
    )


@pytest.fixture(scope="module")
def alone(study, files):
    return plan.make(study, files, 2)


@pytest.fixture(scope="module")
def found(study, files, sensitivity):
    return plan.make(study, files | {"sensitivity": sensitivity}, 2)


def test_without_ranges_nothing_is_assumed(alone):
    assert "half_width_assumed" not in alone and "narrowing" not in alone
    assert "measure otherwise" not in tables(alone)


def test_what_else_is_not_known_makes_an_interval_wider(alone, found):
    xr.testing.assert_equal(alone["half_width"], found["half_width"])
    film = {"quantity": "film thickness", "turns": 1.0}
    wide, narrow = found["half_width_assumed"].sel(film), found["half_width"].sel(film)
    assert (wide.notnull() <= narrow.notnull()).all()
    # The surface has half of the variance, which the slope turns into that of the film; what the
    # oil does, it does by the film.
    added = quantile(8) * 0.4 * np.sqrt(0.5) / np.abs(found["slope_by_film"])
    known = wide.notnull()
    expected = np.hypot(narrow, added).where(known)
    np.testing.assert_allclose(wide.where(known), expected, rtol=1e-3)


def test_records_longer_than_a_revolution_tell_no_more(found):
    width = found["half_width"]
    xr.testing.assert_equal(width.sel(turns=10.0, drop=True), width.sel(turns=1.0, drop=True))
    ratio = (width.sel(turns=0.3) / width.sel(turns=1.0)).values
    np.testing.assert_allclose(ratio[np.isfinite(ratio)], np.sqrt(1.0 / 0.3), rtol=0.05)


def test_the_quantity_with_the_largest_part_is_to_be_measured_first(found):
    narrowing = found["narrowing"].mean(POINT_DIMS)
    assert narrowing["factor"].values.tolist() == ["viscosity", "first_rms_roughness"]
    # Half of the variance, of which a tenth is left.
    assert narrowing[1] == pytest.approx(1.0 - np.sqrt(0.55), rel=1e-4)
    assert found["accuracy_of_factor"].values.tolist() == ["+- 3.2 %", "+- 8.5 %"]


def test_tables_have_the_best_records_first(found):
    text = tables(found)
    assert text.index("**Film thickness**") < text.index("**Pressure-viscosity coefficient**")
    rows = [line for line in text.splitlines() if line.startswith("| ")]
    first = next(line for line in rows if "±" in line)
    best = found["half_width"].sel(quantity="film thickness", turns=1.0).min().item()
    assert f"± {100 * best:.3g} %" in first
    assert "| first rms roughness | -29 % to 25 % | +- 8.5 % |" in text


def test_what_is_not_above_the_noise_is_not_to_be_measured(found, sensitivity, study, files):
    noisy = sensitivity["first_order"] - 0.25 * (sensitivity["factor"] != "first_rms_roughness")
    inputs = files | {"sensitivity": sensitivity.assign(first_order_lower=noisy)}
    narrowing = plan.make(study, inputs, 2)["narrowing"]
    assert (narrowing.sel(factor="viscosity") == 0.0).all()
    assert (narrowing.sel(factor="first_rms_roughness") > 0.0).all()
    assert "| viscosity |" not in tables(found.assign(narrowing=narrowing))


def test_the_best_threshold_is_one_of_the_studys_and_read_best(study, files, found):
    electrical = files["electrical"].sel(rig="study")
    true = electrical["true_contact_share"]
    off = np.abs(electrical["threshold_contact_share"] / true.where(true > 0.0) - 1.0)
    mean = off.mean(POINT_DIMS)
    assert found["best_threshold"] in study.experiment.thresholds
    assert mean.sel(threshold=found["best_threshold"].item()) == mean.min()


def test_a_meter_of_the_mean_voltage_has_no_threshold(study, files):
    meter = study.model_copy(update={"rig": study.rig.like("mtm-ecr-10-ohm")})
    found = plan.make(meter, files, 2)
    electrical = files["electrical"].sel(rig="study", reading="mean voltage", drop=True)
    true = electrical["true_contact_share"].where(electrical["true_contact_share"] > 0.0)
    off = np.abs(electrical["read_contact_share"] / true - 1.0)
    expected = off.fillna(off.mean()).transpose(*found["reading_error"].dims)
    np.testing.assert_allclose(found["reading_error"], expected, rtol=1e-5)
    assert "Read the share from the mean voltage" in tables(found)


# --- Surfaces ------------------------------------------------------------------------------


@pytest.fixture(scope="module")
def both_study(study):
    uncertain = study.uncertainty.model_copy(update={"contact_model": None})
    return study.model_copy(update={"contact_model": ("line", "surface"), "uncertainty": uncertain})


@pytest.fixture(scope="module")
def both_files(both_study, files, sensitivity):
    with on_few_surfaces(4):
        areal = made(both_study, ("lubricant", "film", "areal"))["areal"]
    return files | {"areal": areal, "sensitivity": sensitivity}


@pytest.fixture(scope="module")
def both(both_study, both_files):
    with on_few_surfaces(4):
        return plan.make(both_study, both_files, 2)


def test_a_study_of_both_has_the_plan_of_lines_as_it_was(found, both):
    assert both["contact_model"].values.tolist() == ["line", "surface"]
    xr.testing.assert_identical(both.sel(contact_model="line", drop=True), found[list(both)])


def test_surfaces_are_planned_by_their_own_probability_and_scatter(both, both_files):
    areal = both_files["areal"].sel(slide_to_roll_ratio=0.0).isel(film_formula=0)
    areal = areal.transpose(*POINT_DIMS)
    surface = both.sel(contact_model="surface")
    share = surface["breakthrough_probability"]
    np.testing.assert_allclose(share, areal["breakthrough_probability"], rtol=1e-5)
    relative = areal["pair_deviation"] / areal["breakthrough_probability"]
    limits = [areal[f"breakthrough_probability{end}"].values for end in LIMITS]
    curve = error_of_limits(limits) / limits[0]
    error = np.hypot(np.hypot(relative, surface["reading_error"]), curve)
    expected = quantile(plan.SURFACES) * error / np.abs(surface["slope_by_film"])
    width = surface["half_width"].sel(quantity="film thickness", turns=1.0)
    known = width.notnull().values
    assert known.any()
    np.testing.assert_allclose(width.values[known], expected.values[known], rtol=1e-4)
    assert (surface["reading_error"] <= both["reading_error"].sel(contact_model="line")).all()


def test_a_rig_with_surfaces_has_its_own_error_in_reading_them(both_study, both_files, found):
    with_surfaces = both_study.rig.model_copy(update={"contact_model": "surface"})
    study = both_study.model_copy(update={"rig": with_surfaces})
    with on_few_surfaces(4):
        own = plan.make(study, both_files, 2)["reading_error"]
    own, read = own.sel(contact_model="surface", drop=True), found["reading_error"]
    np.testing.assert_allclose(own.transpose(*read.dims), read, rtol=1e-5)


def test_the_band_of_the_assumptions_is_of_the_models_that_are_sampled(
    both, both_study, both_files
):
    assumed = both["half_width_assumed"]
    assert assumed.sel(contact_model="line").notnull().any()
    assert assumed.sel(contact_model="surface").isnull().all()


def test_surfaces_alone_have_a_plan_without_that_of_lines(both, both_study, both_files):
    alone = both_study.model_copy(update={"contact_model": ("surface",)})
    with on_few_surfaces(4):
        found = plan.make(alone, both_files, 2)
    for name in ("half_width", "slope_by_film", "breakthrough_probability"):
        np.testing.assert_array_equal(found[name], both[name].sel(contact_model=["surface"]))
    assert found["half_width_assumed"].notnull().any()


def test_tables_are_made_for_either_model(found, both):
    text = tables(both)
    line, surface = text.index("**By contact of the line**"), text.index("of the surface**")
    assert line < text.index("**Film thickness**") < surface
    assert text.count("**Film thickness**") == 2
    assert "**By contact" not in tables(found)


def test_doubtful_records_are_named_in_the_tables(found):
    best = found["half_width"].sel(quantity="film thickness", turns=1.0).isel(lubricant=0)
    points = best.stack(point=POINT_DIMS[1:])
    first = {"asperities carry > 10 %": ("D", points == points.min())}
    lines = tables(found, {"line": first}).splitlines()
    width = f"± {100 * points.min().item():.3g} %"
    assert any(width in line and line.endswith("| asperities carry > 10 % |") for line in lines)
    assert any("±" in line and line.endswith("| – |") for line in lines)
    assert "doubtful" not in tables(found)
