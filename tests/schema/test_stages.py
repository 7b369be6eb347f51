"""The registry of stages: each row has its function and schema, and names real values."""

import inspect
import json

import pytest
from studies import ROOT, SMOKE
from unlike_studies import STUDIES, write_study

from lube.errors import LubeError
from lube.schema import DATASETS, FILES, ON_REQUEST, STAGES, SUMMARIES, forerunners
from lube.stages import maker
from lube.study.study import load_study
from lube.study.surface_checks import check_surfaces
from lube.surfaces.rare_contact import check_stands_for_surface


def test_every_kept_file_of_the_schema_has_its_row():
    assert set(STAGES) == set(SUMMARIES) == {*DATASETS, *ON_REQUEST}
    assert {kind.removesuffix("_batch") for kind in FILES} == set(STAGES)


def test_every_stage_has_a_function_that_makes_it_or_a_benchmark():
    for name, stage in STAGES.items():
        if stage.target == "benchmark":
            assert (ROOT / f"benchmarks/bench_{name}.py").is_file()
        else:
            assert list(inspect.signature(maker(name)).parameters) == ["study", "inputs", "threads"]
        assert bool(stage.in_batches) == (f"{name}_batch" in FILES)


def test_stages_stand_after_those_they_depend_on():
    names = list(STAGES)
    for name in names:
        assert set(forerunners(name)) <= set(names[: names.index(name)])


def test_every_value_of_a_row_is_one_of_the_study_and_plain():
    study = load_study(SMOKE)
    for name, stage in STAGES.items():
        inputs = study.stage_inputs(name)
        assert list(inputs) == list(stage.values)
        assert set(study.origin(name)) == {*study.forerunners(name), name}
        json.dumps(inputs, allow_nan=False)


def refuses(stage, *arguments):
    """Whether a stage refuses the lines before it needs a film, which is missing here."""
    try:
        stage(*arguments)
    except LubeError:
        return True
    except (TypeError, KeyError):
        return False
    return False


@pytest.mark.parametrize("name", STUDIES)
def test_what_the_registry_promises_is_what_the_stages_can_make(name, tmp_path):
    study = load_study(write_study(STUDIES[name], tmp_path / name))
    surfaces = study.line_spec, study.rollers.length, 0.0, study.gap
    assert study.has("areal") == (not refuses(check_surfaces, *surfaces))
    on_surface = study.has("areal") and study.has("gauge") and study.gap.is_plain
    on_surface &= not study.has("surface_records")  # gauge.nc then has films by surfaces
    assert study.has("areal_gauge") == on_surface
    for_surface = not refuses(check_stands_for_surface, study.line_spec)
    assert study.has("patch") == (for_surface and study.line_spec.is_isotropic)
    assert study.has("surface") == bool(study.topographies)
    conducts, has_line = study.resistivity != "insulator", study.line_spec.follows_rolling
    assert study.has("rig") == (conducts and has_line)
    has_records = conducts and (has_line or study.experiment.manifest is not None)
    for stage in ("experiment", "comparison"):
        assert study.has(stage) == has_records
    for stage, row in STAGES.items():  # a file cannot be made without those it reads
        missing = set(row.inputs) - set(study.inputs_of(stage))
        without = {"master", "surface_response", "sensitivity", *(() if has_line else ("contact",))}
        assert not study.has(stage) or missing <= without
    # Without the map the gauge makes curves of its own.
    assert study.has("gauge") == has_records
