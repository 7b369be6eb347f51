"""Records read by the surface: exact inverses and limits."""

import numpy as np
import pytest
import xarray as xr
from experiments import experiment_of

from lube.inference.record_curves import map_curves
from lube.schema import CONTACT_DIMS, FILES, LIMITS, check, label
from lube.stages.areal_gauge import make
from lube.stages.gauge import gauge_records

NAMES = [f"surface_lambda_ratio{limit}" for limit in LIMITS]


def probability(ratio, width):
    """Probability of a strip in which contacts are independent."""
    return -np.expm1(-width * 2e4 * np.exp(-0.8 * ratio**2))


@pytest.fixture(scope="module")
def areal(busy):
    """A surface of this probability, known without error."""
    first = busy.film.isel(film_formula=[0])
    found = probability(first["lambda_ratio"], 2.0 * first["contact_half_width"])
    found = found.expand_dims(slide_to_roll_ratio=[0.0]).transpose(*CONTACT_DIMS)
    names = [name for name, row in FILES["areal"].items() if not row.optional]
    values = {name: found for name in names if name != "length"}
    values["pair_deviation"] = np.sqrt(found * (1.0 - found) / 300.0)
    return label(xr.Dataset(values).assign(length=0.01), "areal")


@pytest.fixture(scope="module")
def read(busy, compared, areal):
    """Read records of given shares by both models."""

    def run(shares, force, areal=areal, **values):
        comparison = compared(experiment_of(shares, force, 100.0, 60.0, **values))
        gauge = gauge_records(map_curves(busy.master, comparison), busy.study, comparison)
        inputs = {"film": busy.film, "areal": areal, "comparison": comparison, "gauge": gauge}
        return make(busy.study, inputs)

    return run


def test_a_share_of_the_surface_is_read_back_to_its_film(busy, read):
    """Also at a force beside the grid's, by its own contact width."""
    film = busy.film.isel(film_formula=0, lubricant=0)
    near = busy.film["force"].values[-1]
    ratios = np.unique(film["lambda_ratio"].sel(force=near).values)
    for force in (near, 1.3 * near):
        width = 2.0 * busy.study.rollers.contact_half_width(force)
        shares = probability(ratios, width)
        inside = shares < 1.0 - 1e-4
        assert inside.sum() > 1
        found = read(shares[inside], force)
        np.testing.assert_allclose(found["surface_lambda_ratio"], ratios[inside], rtol=1e-6)
        value, lower, upper = (found[name].values for name in NAMES)
        assert (lower < value).all() and (value < upper).all()


def test_the_line_reads_as_in_the_gauge_and_the_quotient_is_of_both(busy, read, compared):
    shares = [0.3, 0.1]
    found = read(shares, 400.0)
    comparison = compared(experiment_of(shares, 400.0, 100.0, 60.0))
    gauge = gauge_records(map_curves(busy.master, comparison), busy.study, comparison)
    for limit in LIMITS:
        one, other = found[f"line_lambda_ratio{limit}"], gauge[f"gauged_lambda_ratio{limit}"]
        np.testing.assert_array_equal(one, other)
    quotient = found["surface_lambda_ratio"] / found["line_lambda_ratio"]
    np.testing.assert_array_equal(found["surface_over_line"], quotient)
    check(found, "areal_gauge")


def test_a_noisy_record_and_an_uncertain_curve_are_read_less_surely(read, areal):
    def width(**values):
        found = read([0.3], 400.0, **values)
        value, lower, upper = (found[name].item() for name in NAMES)
        assert lower < value < upper
        return upper - lower

    names = [f"breakthrough_probability{side}" for side in ("_lower", "_upper")]
    spread = {name: areal[name] * factor for name, factor in zip(names, (0.7, 1.3), strict=True)}
    plain = width()
    assert width(share_error=0.05) > 1.2 * plain
    assert width(areal=areal.assign(spread)) > 1.2 * plain


def test_records_without_contact_have_a_lower_limit_only_and_without_a_share_none(read):
    never, missing = (read([share], 400.0) for share in (0.0, np.nan))
    assert np.isnan(never["surface_lambda_ratio"]).all()
    assert np.isnan(never["surface_over_line"]).all()
    assert (never["surface_lambda_ratio_lower"] > 0.5).all()
    assert (never["surface_lambda_ratio_upper"] == np.inf).all()
    assert all(np.isnan(missing[name]).all() for name in NAMES)
