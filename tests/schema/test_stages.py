"""The registry of stages: each row has its script, rule and schema, and names real values."""

import json

from studies import ROOT, SMOKE

from lube.schema import DATASETS, FILES, ON_REQUEST, STAGES, SUMMARIES, forerunners
from lube.study.study import load_study


def test_every_kept_file_of_the_schema_has_its_row():
    assert set(STAGES) == set(SUMMARIES) == {*DATASETS, *ON_REQUEST}
    assert {kind.removesuffix("_batch") for kind in FILES} == set(STAGES)


def test_every_stage_has_a_rule_and_a_script_of_its_name():
    rules = "\n".join(path.read_text("utf-8") for path in (ROOT / "workflow/rules").glob("*.smk"))
    for name, stage in STAGES.items():
        assert f"rule {name}:\n" in rules
        assert f'result("{name}.nc"),' in rules
        if stage.target != "benchmark":
            assert (ROOT / f"workflow/scripts/{name}.py").is_file()


def test_stages_stand_after_those_they_depend_on():
    names = list(STAGES)
    for name in names:
        assert set(forerunners(name)) <= set(names[: names.index(name)])


def test_every_value_of_a_row_is_one_of_the_study_and_plain():
    study = load_study(SMOKE)
    for name, stage in STAGES.items():
        inputs = study.stage_inputs(name)
        assert list(inputs) == list(stage.values)
        assert set(study.origin(name)) == {*forerunners(name), name}
        json.dumps(inputs, allow_nan=False)
