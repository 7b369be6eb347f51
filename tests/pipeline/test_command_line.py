"""The study that a Snakemake command asks for, and mistakes in it: one line before any job."""

import pytest
from refusals import one_line
from snakemake.cli import parse_config
from studies import PAPER, SMOKE

from lube.errors import RecordError, StudyError
from lube.pipeline.command_line import (
    changes_of,
    check_command_line,
    same_study,
    study_of_command,
    study_of_module,
)
from lube.study.study import load_study


@pytest.fixture(autouse=True)
def from_the_repository(monkeypatch):
    monkeypatch.chdir(PAPER.parents[2])


def refusal(*arguments):
    """The line that a command is refused with."""
    with pytest.raises(SystemExit) as refused:
        check_command_line(arguments)
    line = refused.value.code
    assert line.startswith("The study cannot start. ") and "\n" not in line
    return line


def test_a_command_that_snakemake_understands_passes():
    for arguments in [
        (),
        ("-n", "archive"),
        ("archive", "--configfile", str(SMOKE), "--cores", "2"),
        ("--configfile", str(SMOKE), "--", "archive"),
        ("--config", "name=mine", "rig={revolutions: 3}", "--forcerun", "film"),
        ("--summary",),
        ("results/smoke/study.yaml", "--configfile", str(SMOKE)),
        ("--report-metadata", "me.yaml", "-n"),
    ]:
        check_command_line(arguments)


def test_a_target_after_an_option_is_to_be_put_first():
    assert "put targets before it, as in `snakemake archive --configfile mine.yaml`" in refusal(
        "--configfile", "mine.yaml", "archive"
    )
    assert "begins with `based_on: a.yaml`" in refusal("--configfile", "a.yaml", "b.yaml")
    assert "`snakemake archive --config key=value`" in refusal("--config", "seed=3", "archive")


def test_a_fluid_without_viscosity_is_refused_before_any_job(tmp_path):
    (tmp_path / "fluid.yaml").write_text(
        "name: my-fluid\ntitle: My fluid\n"
        "viscosity: {source: CoolProp, coolprop_fluid: n-Undecane}\n"
        "pressure_viscosity: {source: CoolProp, definition: slope-at-atmospheric}\n"
        "temperature_range: {source: x, lowest: 0 degC, highest: 100 degC}\n"
    )
    path = tmp_path / "mine.yaml"
    path.write_text(f"based_on: {SMOKE}\nname: mine\nlubricants: [fluid.yaml]\n")
    line = one_line(RecordError, study_of_command, [path], {})
    assert "lubricants: my-fluid: coolprop_fluid: got 'n-Undecane', need a fluid whose visc" in line


def test_a_study_is_no_target():
    for before in ((), ("-n",), ("--cores", "2"), ("archive",)):
        line = refusal(*before, "mine.yaml")
        assert "got the target mine.yaml, need `--configfile mine.yaml` for a study" in line


def test_a_nested_key_is_to_be_written_as_snakemake_reads_it():
    line = refusal("--config", "rollers.first.radius=40 mm", "name=mine")
    assert "need 'rollers={first: {radius: 40 mm}}' for a nested key" in line


def test_a_file_is_named_from_the_working_folder():
    study, arguments = study_of_command([SMOKE], {})
    assert study.name == "smoke"
    assert arguments == {"path": "workflow/config/smoke.yaml", "changes": {}}


def test_config_changes_values_whose_numbers_snakemake_leaves_as_text():
    # As `--config name=mine seed=3 'rig={revolutions: 3}' 'kept_realisations=[0,1]' ...`.
    config = {
        "name": "mine",
        "seed": 3,
        "rig": {"revolutions": "3", "drift": "0.1"},
        "kept_realisations": ["0", "1"],
        "experiment": {"manifest": "null"},
    }
    study, arguments = study_of_command([SMOKE], config)
    assert (study.name, study.seed, study.kept_realisations) == ("mine", 3, (0, 1))
    assert (study.rig.revolutions, study.rig.drift) == (3, 0.1)
    assert load_study(**arguments) == study


def test_the_options_of_the_same_study_are_read_as_it():
    changes = {"name": "mine", "seed": 3, "rig": {"revolutions": 3, "bias_voltage": "40 mV"}}
    changes["operating_grid"] = {"slide_to_roll_ratio": [0, 0.5]}
    _, path, _, *values = same_study("workflow/config/smoke.yaml", changes)
    read = parse_config(values)
    assert study_of_command([path], read)[1] == {"path": path, "changes": changes}
    assert same_study("a.yaml", {}) == ["--configfile", "a.yaml"]


def test_mistakes_in_config_are_refused_as_those_in_a_file():
    assert "seeed: unknown key" in one_line(
        StudyError, study_of_command, [SMOKE], {"name": "mine", "seeed": 3}
    )
    unnamed = one_line(StudyError, study_of_command, [], {"seed": "3"})
    assert "name: missing, need one other than 'paper'" in unnamed


def test_another_workflow_names_the_study_and_changes_its_values():
    study, arguments = study_of_module({"study": str(SMOKE), "name": "mine", "seed": 3})
    assert (study.name, study.seed) == ("mine", 3)
    assert arguments == {
        "path": "workflow/config/smoke.yaml",
        "changes": {"name": "mine", "seed": 3},
    }


def test_a_module_without_a_study_is_refused():
    line = one_line(StudyError, study_of_module, {"seed": 3})
    assert "study: got None, need the path of a study's file" in line


def test_nested_keys_that_are_changed_one_by_one_are_merged_as_by_snakemake():
    of_both = [f"rollers={{{roller}: {{radius: 30 mm}}}}" for roller in ("first", "second")]
    entries = ["name=mine", *of_both, "rollers={first: {young_modulus: 200 GPa}}"]
    assert changes_of(entries) == parse_config(entries)
