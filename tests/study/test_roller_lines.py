"""The lines of rollers: each its own band and heights, and what does not fit the grid."""

import math
from functools import partial

import numpy as np
import pytest
from refusals import NEEDED, one_line
from studies import PAPER, REMOVED

from lube.errors import LubeError
from lube.study.study import load_study
from lube.surfaces.spectra import power_spectrum
from lube.surfaces.synthetic import draw_line

refusal = partial(one_line, LubeError, load_study)


@pytest.fixture
def study_with(paper_with):
    return lambda *changes: load_study(paper_with(*changes))


def test_a_roller_without_values_of_its_own_has_the_studys(study_with):
    own = {
        "hurst_exponent": 0.9,
        "longest_wavelength": "0.2 mm",
        "shortest_wavelength": "20 points",
        "roll_off_wavelength": "0.1 mm",
        "skewness": -0.5,
        "kurtosis": 4,
    }
    first, second = study_with(("rollers.second.roughness", own)).line_spec.lines
    assert first == load_study(PAPER).line_spec.lines[0]
    assert second.hurst_exponent == 0.9
    lengths = [2.0 * math.pi / q for q in (second.q_min, second.q_max, second.q_roll_off)]
    assert lengths == pytest.approx([2e-4, 20 * 2.0 * math.pi * 0.05 / 1e6, 1e-4])
    assert (second.skewness, second.kurtosis) == (-0.5, 4.0)
    assert first.is_gaussian and not second.is_gaussian
    assert first.q_roll_off == first.q_min


def test_the_longest_wavelength_of_both_is_that_of_the_pair(study_with):
    spec = study_with(("rollers.first.roughness", {"longest_wavelength": "0.2 mm"})).line_spec
    assert spec.q_min == spec.lines[1].q_min < spec.lines[0].q_min
    assert not study_with(("roughness.skewness", -0.1)).line_spec.is_gaussian


def test_lines_are_alike_if_they_differ_in_height_alone(study_with):
    assert load_study(PAPER).line_spec.has_like_lines
    other = study_with(
        ("rollers.second.rms_roughness", "0.3 um"), ("rollers.second.radius", "40 mm")
    )
    assert other.line_spec.has_like_lines
    for key, value in ("hurst_exponent", 0.8), ("longest_wavelength", "0.2 mm"):
        assert not study_with(("rollers.second.roughness", {key: value})).line_spec.has_like_lines


def test_a_rollers_own_roughness_is_an_input_of_its_lines_but_not_of_the_film(study_with):
    before, after = load_study(PAPER), study_with(("rollers.first.roughness", {"kurtosis": 4}))
    assert before.stage_inputs("film") == after.stage_inputs("film")
    assert before.stage_inputs("roughness") != after.stage_inputs("roughness")


def test_a_lay_is_of_a_roller_and_lengthens_the_waves_of_its_line(study_with):
    own = {"lay_ratio": 3, "lay_angle": "90 deg"}
    study = study_with(("rollers.second.roughness", own))
    first, second = study.line_spec.lines
    assert (second.lay_ratio, second.lay_angle) == (3.0, 90.0)
    assert second.longest_wavelength == pytest.approx(3.0 * first.longest_wavelength)
    assert second.q_max == first.q_max and study.line_spec.q_min == second.q_min / 3.0
    assert study.line_spec.follows_rolling and not study.line_spec.is_isotropic
    band = study_with(("rollers.first.roughness", own), ("rollers.second.roughness", own)).band
    assert band.endswith("to 3.14 µm across ridges 3 times longer, at 90 deg")
    alone = (
        ("contact_model", ["surface"]),
        ("roughness.lay_ratio", 3),
        ("roughness.lay_angle", "0 deg"),
    )
    ground = study_with(*alone)
    assert not ground.line_spec.follows_rolling and ground.has("areal")
    assert {"lubricant", "film", "tail"} == set(ground.datasets)


CUTOFFS = {"long_cutoff": "0.4 mm", "short_cutoff": "10 um"}


@pytest.mark.parametrize(
    "changes", [{}, {"roll_off_wavelength": "0.2 mm"}, {"hurst_exponent": 0.9}]
)
@pytest.mark.parametrize("longest", ["0.8 mm", "0.25 mm"])
def test_a_height_stated_within_cutoffs_is_that_of_the_drawn_waves_within_them(
    study_with, changes, longest
):
    pairs = CUTOFFS | changes | {"longest_wavelength": longest}
    study = study_with(*((f"roughness.{name}", value) for name, value in pairs.items()))
    spec = study.line_spec
    heights = spec.height_step * draw_line(spec, 0, np.random.SeedSequence(1))
    rms = spec.rms_height[0]
    assert np.std(heights) == pytest.approx(rms, rel=1e-6)
    assert study.rough_rollers.rms_heights == spec.rms_height
    q, density = power_spectrum(heights, spec.spacing)

    def within(shortest, longest):
        inside = (q >= 2.0 * math.pi / longest) & (q <= 2.0 * math.pi / shortest)
        return math.sqrt(np.sum(density[inside]) * q[0])

    if longest == "0.8 mm":  # the stated waves are drawn, and others
        assert within(10e-6, 0.4e-3) == pytest.approx(2e-7, rel=0.01)
        assert rms > 2.01e-7
    # The whole spectrum by quadrature, also of the waves that are not drawn.
    roll_off = 2.0 * math.pi / (2e-4 if "roll_off_wavelength" in changes else 1e-2)
    hurst = spec.lines[0].hurst_exponent

    def power(longest, shortest):
        q = np.geomspace(2.0 * math.pi / longest, 2.0 * math.pi / shortest, 200_001)
        rising, falling = q / roll_off, (q / roll_off) ** (-2.0 * hurst - 1.0)
        return np.trapezoid(np.where(q < roll_off, rising, falling), q)

    whole = power(2.0 * math.pi / spec.q_min, 2.0 * math.pi / spec.q_max)
    assert rms / 2e-7 == pytest.approx(math.sqrt(whole / power(4e-4, 1e-5)), rel=1e-6)


def test_a_height_without_cutoffs_is_that_of_the_line_to_the_last_bit(study_with):
    study = load_study(PAPER)
    assert study.rough_rollers == study.rollers
    of_ra = study_with(("rollers.second", {**STEEL, "ra_roughness": "0.16 um"}))
    assert of_ra.line_spec.rms_height == of_ra.rollers.rms_heights
    both = study_with(("roughness.long_cutoff", "0.8 mm"), ("rollers.first.rms_roughness", REMOVED),
                      ("rollers.second.rms_roughness", REMOVED),
                      ("rollers.composite_rms_roughness", "0.3 um"))  # fmt: skip
    assert both.rough_rollers.composite_rms_roughness == pytest.approx(
        math.hypot(*both.line_spec.rms_height), rel=1e-15
    )
    assert both.rough_rollers.composite_rms_roughness < 0.3e-6
    inputs = both.stage_inputs("film")["composite_rms_roughness"]
    assert inputs == both.rough_rollers.composite_rms_roughness


def test_the_band_is_said(study_with):
    assert load_study(PAPER).band == (
        "waves 420 µm (contact width at the largest force) to 3.14 µm"
    )
    own = {"longest_wavelength": "0.8 mm", "short_cutoff": "2.5 um"}
    assert study_with((OWN, own)).band == (
        "first: waves 420 µm (contact width at the largest force) to 3.14 µm; second: waves 800 µm "
        "to 3.14 µm, heights stated for 800 µm to 2.5 µm"
    )


# Mistakes

OWN = "rollers.second.roughness"
STEEL = {"radius": "50 mm", "young_modulus": "210 GPa", "poisson_ratio": 0.3}
REFUSED = [
    ("roughness.long_cutoff", "2 um", "roughness.long_cutoff: got a height stated for waves of 2 "),
    ("roughness.short_cutoff", "1 mm", "roughness.short_cutoff: got a height stated for waves of"),
    (OWN, {"long_cutoff": "1 um", "short_cutoff": "2 um"}, f"{OWN}.long_cutoff: got a height"),
    ("roughness.roll_off_wavelength", "1 mm", "roughness.roll_off_wavelength: got 1 mm, need"),
    ("roughness.roll_off_wavelength", "3 um", "from the shortest to the longest wavelength, 3.14"),
    (OWN, {"roll_off_wavelength": "1 mm"}, f"{OWN}.roll_off_wavelength: got 1 mm, need one"),
    (OWN, {"longest_wavelength": "3 um"}, "got 10 points, need less than the longest, 3 µm"),
    (OWN, {"shortest_wavelength": "1 mm"}, f"{OWN}.shortest_wavelength: got 1 mm, need less"),
    (OWN, {"shortest_wavelength": "0.1 um"}, "too coarse a grid: its spacing is 0.314 µm"),
    (OWN, {"longest_wavelength": "1 m"}, "rollers.second.radius: got a perimeter of 314 mm,"),
    (OWN, {"kurtosis": 1.2}, f"{OWN}.kurtosis: got 1.2 with a skewness of 0, need at least 1.5"),
    (
        "roughness.skewness",
        -1.5,
        "roughness.kurtosis: got 3 with a skewness of -1.5, need at least",
    ),
    ("roughness.skewness", -1.5, "no kurtosis is below 3.25, the skewness squared plus one"),
]


@pytest.mark.parametrize(("key", "value", "needed"), REFUSED)
def test_a_mistake_is_refused_in_one_line(paper_with, key, value, needed):
    message = refusal(paper_with((key, value)))
    assert needed in message
    assert NEEDED.search(message)


def test_a_drift_of_lines_that_are_not_gaussian_is_refused(paper_with):
    message = refusal(paper_with(("rig.drift", 0.1), ("roughness.kurtosis", 4)))
    assert "rig.drift: got 0.1, need 0 for a simulated rig with roughness that is" in message


def test_a_rig_with_surfaces_is_refused_what_its_surfaces_cannot_do(paper_with):
    surfaces = (("rig.contact_model", "surface"), ("contact_model", ["line", "surface"]))
    load_study(paper_with(*surfaces))
    slip = ("operating_grid.slide_to_roll_ratio", [0.1, 0.2])
    for change, needed in (
        (("contact_model", ["line"]), "need line, or contact_model: surface or [line, surface]"),
        (("rollers.second.radius", "40 mm"), "need line, or rollers of one radius"),
        (slip, "need line, or a slide-to-roll ratio of 0 in operating_grid and traces"),
        (("rig.drift", 0.1), "need line, or rig.drift: 0"),
    ):
        message = refusal(paper_with(*surfaces, change))
        assert f"rig.contact_model: got surface, {needed}" in message
