"""The checks of a small study: all pass on a fine grid, and what is wrong is found."""

import numpy as np
import pytest
import xarray as xr
from studies import CONFIG

from lube.report.verification import outcomes
from lube.stages import verification
from lube.stages.lubricant import make as make_lubricant
from lube.study.study import load_study
from lube.verification import lines, surfaces
from lube.verification.check import CHECKS, KINDS, errors_apart, percent_off


def found_in(study):
    return verification.make(study, {"lubricant": make_lubricant(study, {})}, threads=2)


@pytest.fixture(scope="module")
def few():
    patch = pytest.MonkeyPatch()
    patch.setattr(lines, "PAIRS", 12)
    patch.setattr(surfaces, "SURFACES", 8)
    yield
    patch.undo()


@pytest.fixture(scope="module")
def study():
    own = load_study(CONFIG / "smoke.yaml")
    roughness = own.roughness.model_copy(update={"points": 400_000})
    return own.model_copy(update={"roughness": roughness})


@pytest.fixture(scope="module")
def found(few, study):
    return found_in(study)


def test_all_checks_pass_on_a_fine_grid(found):
    wrong = found["check_subject"].values[found["check_outcome"].values == "differs"]
    assert wrong.tolist() == []
    assert set(found["check_kind"].values) == set(KINDS)
    assert found["check_subject"].values.tolist() == CHECKS["subject"].tolist()


def test_a_grid_that_is_too_coarse_does_not_pass(few, caplog):
    coarse = found_in(load_study(CONFIG / "smoke.yaml"))
    wrong = coarse["check_subject"].values[coarse["check_outcome"].values == "differs"]
    runs = "runs of touching points, sampled, lambda ratios 1 to 8"
    assert runs in wrong
    assert f"check 2: {runs}, and rate of upward crossings, differ by" in caplog.text
    ratio = coarse["breakthrough_probability_ratio"].sel(grid="twice the points")
    assert (ratio > 1.5).all()


@pytest.mark.parametrize(
    ("name", "check"), [("crossing_rate", "runs"), ("breaking_curvature", "curvature")]
)
def test_theory_that_is_a_tenth_off_does_not_pass(few, study, monkeypatch, name, check):
    right = getattr(lines, name)
    monkeypatch.setattr(lines, name, lambda *given: 1.1 * right(*given))
    seen = lines.line_checks(study, lines.curves(study, 2), 2)
    assert seen[check] > CHECKS.loc[check, "allowed"]


def test_a_kernel_that_misses_a_point_is_found(few, study, monkeypatch):
    right = lines.ContactWindows.trace
    monkeypatch.setattr(
        lines.ContactWindows, "trace", lambda *given: np.roll(right(*given), 1, axis=1)
    )
    assert lines.line_checks(study, lines.curves(study, 2), 2)["whole_windows"] > 0.0


def test_rollers_with_another_contact_width_are_found(study, monkeypatch):
    monkeypatch.setattr(lines, "_other_rollers", lambda rollers: rollers)
    seen = lines.scaled_checks(study, make_lubricant(study, {}))
    assert seen["scaled_films"] > 1.0
    assert seen["scaled_contact"] > 0.0


def test_deviations_from_a_limit_and_a_bound_are_shown_as_they_are(found):
    deviation = dict(zip(CHECKS.index, found["check_deviation"].values, strict=True))
    assert deviation["bound"] < 0.0
    assert deviation["sharp_runs"] > 1.0


def test_more_points_change_little_and_another_band_more(found):
    ratio = found["breakthrough_probability_ratio"]
    assert abs(ratio.sel(grid="twice the points") - 1.0).max() < 0.05
    assert (ratio.sel(grid="shortest wave twice as long") < 0.95).all()


def test_deviations_of_means_and_numbers():
    assert percent_off([1.0, 1.02], 1.0) == pytest.approx(2.0)
    first = np.array([[0.0, 1.0], [2.0, 1.0]])
    # Means 1 and 4 with standard errors of 1 each; the column without scatter is left out.
    assert errors_apart(first, first + np.array([3.0, 9.0])) == pytest.approx(3.0 / np.sqrt(2.0))


def test_the_table_has_a_row_for_each_check(found):
    table = outcomes(found)
    assert sum(line.startswith("| ") for line in table.splitlines()) == found.sizes["check"] + 10
    failed = found.assign(check_outcome=xr.full_like(found["check_outcome"], "differs"))
    assert outcomes(failed).count("(**differs**)") == found.sizes["check"]
