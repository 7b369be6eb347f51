"""The configuration in the report: every key of the file and every value it was given."""

import html
import re

import pytest
from studies import SMOKE, SMOKE_DATASETS

from lube.report.configuration import configuration
from lube.report.key_tables import keys
from lube.study.study import Study


@pytest.fixture(scope="module")
def shown(study):
    return configuration(study, SMOKE.read_text("utf-8"))


def rows(shown):
    cells = re.findall(r"<tr><td><code>(.*?)</code></td><td>(.*?)</td>", shown)
    return {key: html.unescape(value) for key, value in cells}


def test_the_file_is_shown_as_written(shown):
    written = re.search(r'<pre class="file">(.*?)</pre>', shown, re.DOTALL)[1]
    text = html.unescape(re.sub(r"</?span[^>]*>", "", written))
    assert text == SMOKE.read_text("utf-8").rstrip("\n")
    assert written.count('class="comment"') == SMOKE.read_text("utf-8").count("#")


def test_every_value_that_is_set_is_shown_with_its_unit(shown):
    values = rows(shown.split("Values that each stage")[0])
    assert values["rollers.first.radius"] == "50 mm"
    assert values["operating_grid.force"] == "800 N, 1600 N"
    assert values["operating_grid.slide_to_roll_ratio"] == "0, 0.1"
    assert values["traces[].temperature"] == "40 °C, 80 °C"
    assert values["lubricants"] == "mobilgear-shc-xmp-320"
    assert values["roughness.shortest_wavelength"] == "10 points"
    assert values["pressure_viscosity.gold_base"] == "polyalphaolefin"
    unset = {"experiment.manifest", "traces[].lubricant", "traces[].film_formula"}
    unset |= {"traces[].slide_to_roll_ratio", "about.doi", "rig.preset"}
    unset |= {"about.creators[].affiliation", "about.creators[].orcid"}
    unset |= {f"uncertainty.roughness_deformation.{key}" for key in ("choices", "source")}
    unset |= {
        f"uncertainty.{roller}_rms_roughness.{key}"
        for roller in ("first", "second")
        for key in ("range", "source", "distribution")
    }
    unset |= {"rollers.composite_rms_roughness", "roughness.roll_off_wavelength"}
    unset |= {"roughness.long_cutoff", "roughness.short_cutoff", "roughness.lay_angle"}
    known = {key.strip("`") for key, _, _ in keys(Study)}
    own = ("ra_roughness", "roughness", "topography")
    for roller in ("first", "second"):
        unset |= {
            key
            for key in known
            if key.split(".")[:2] == ["rollers", roller] and key.split(".")[2] in own
        }
    assert known - set(values) == unset


def test_every_stage_shows_the_values_that_it_depends_on(shown, study):
    for stage in SMOKE_DATASETS:
        assert (f"<summary>{stage}</summary>" in shown) == bool(study.stage_inputs(stage))
    assert rows(shown)["seed"] == str(study.seed)
    assert rows(shown)["lubricants[0].viscosity.points[1].temperature"] == "100"
    assert float(rows(shown)["lines.lines[1].q_max"]) == pytest.approx(study.line_spec.q_max)
