"""Rollers and what was measured of their roughness, and what is refused."""

import math
from functools import partial

import numpy as np
import pytest
import yaml
from refusals import NEEDED, one_line
from studies import PAPER, PAPER_CONTENT, REMOVED, with_value

from lube.errors import LubeError
from lube.study.resolve import resolved_content
from lube.study.rollers import RA_TO_RMS
from lube.study.study import load_study

refusal = partial(one_line, LubeError, load_study)
MICRO = 1e-6


@pytest.fixture
def study_with(paper_with):
    return lambda *changes: load_study(paper_with(*changes))


@pytest.fixture
def based(tmp_path):
    """Write a study based on another, and return its file."""

    def write(name="mine", base=PAPER, **content):
        path = tmp_path / f"{name}.yaml"
        path.write_text(yaml.safe_dump({"based_on": str(base), "name": name, **content}))
        return path

    return write


# What was measured


def test_ra_of_gaussian_heights_is_the_mean_of_their_absolute_values(study_with):
    heights = np.random.default_rng(1).normal(size=1_000_000)
    assert np.std(heights) / np.mean(np.abs(heights)) == pytest.approx(RA_TO_RMS, rel=3e-3)
    study = study_with(
        ("rollers.first.rms_roughness", REMOVED), ("rollers.first.ra_roughness", "0.16 um")
    )
    expected = 0.16 * MICRO * math.sqrt(math.pi / 2.0), 0.2 * MICRO
    assert study.rollers.rms_heights == pytest.approx(expected)
    assert study.line_spec.rms_height == pytest.approx(expected)
    assert study.rollers.composite_rms_roughness == pytest.approx(math.hypot(*expected))


def test_a_composite_roughness_is_shared_equally(study_with):
    study = study_with(
        ("rollers.first.rms_roughness", REMOVED),
        ("rollers.second.rms_roughness", REMOVED),
        ("rollers.composite_rms_roughness", "0.3 um"),
    )
    assert study.rollers.rms_heights == pytest.approx([0.3 * MICRO / 2**0.5] * 2)
    assert study.rollers.composite_rms_roughness == pytest.approx(0.3 * MICRO)
    assert study.stage_inputs("film")["composite_rms_roughness"] == pytest.approx(0.3 * MICRO)


def test_a_roughness_takes_the_place_of_one_given_otherwise_in_the_base(based):
    ra = based("ra", rollers={"first": {"ra_roughness": "0.1 um"}})
    assert "rms_roughness" not in resolved_content(ra)["rollers"]["first"]
    first, second = load_study(ra).rollers.rms_heights
    assert (first, second) == pytest.approx((0.1 * MICRO * RA_TO_RMS, 0.2 * MICRO))
    both = based("both", rollers={"composite_rms_roughness": "0.1 um"})
    assert load_study(both).rollers.rms_heights == pytest.approx([0.1 * MICRO / 2**0.5] * 2)
    each = {name: {"rms_roughness": "0.4 um"} for name in ("first", "second")}
    again = based("again", both, rollers=each)
    assert load_study(again).rollers.rms_heights == pytest.approx([0.4 * MICRO] * 2)


# Mistakes

BOTH = "rollers.composite_rms_roughness"
OWN = "rollers.second.roughness"
REFUSED = [
    ("rollers.first.ra_roughness", "0.1 um", "rollers.first.ra_roughness: got one together with"),
    (
        BOTH,
        "0.3 um",
        "rollers.composite_rms_roughness: got one together with first.rms_roughness",
    ),
    (
        "rollers.second.rms_roughness",
        REMOVED,
        "rollers.second.rms_roughness: missing, need it, or ra_",
    ),
    ("rollers.composite_roughness", "1 um", "did you mean 'composite_rms_roughness'?"),
    (OWN, {"hurst_exp": 1}, f"{OWN}.hurst_exp: unknown key, did you mean 'hurst_exponent'?"),
    ("roughness.kurtosis", 0.9, "roughness.kurtosis: got 0.9, need a value above 1"),
    ("roughness.skewness", -3.5, "got -3.5, need a value at least -3 and at most 3"),
]


@pytest.mark.parametrize(("key", "value", "needed"), REFUSED)
def test_a_mistake_is_refused_in_one_line(paper_with, key, value, needed):
    message = refusal(paper_with((key, value)))
    assert needed in message
    assert NEEDED.search(message)


def test_with_value_does_not_change_the_papers_content():
    with_value(PAPER_CONTENT, "rollers.first.roughness.kurtosis", 4)
    assert "roughness" not in PAPER_CONTENT["rollers"]["first"]
