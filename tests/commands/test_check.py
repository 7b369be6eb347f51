"""`lube check`: what a study will compute, and the records that it cannot use."""

import subprocess
import sys

import pytest
from refusals import one_line
from studies import CONFIG, PAPER, ROOT, SMOKE

from lube.cli import main
from lube.commands.check import check_study
from lube.errors import StudyError


@pytest.fixture(autouse=True)
def elsewhere(tmp_path, monkeypatch):
    """A folder whose Snakefile runs no study yet."""
    (tmp_path / "workflow/rules").mkdir(parents=True)
    for name in ("Snakefile", "workflow/rules/study.smk"):
        (tmp_path / name).touch()
    monkeypatch.chdir(tmp_path)


@pytest.mark.parametrize("path", sorted(CONFIG.glob("*.yaml")), ids=lambda path: path.stem)
def test_shipped_studies_are_valid(path):
    summary, refused = check_study(path)
    assert summary[0].split() == ["study", f"{path.stem}:", "valid"]
    assert not refused


def test_the_amount_of_work_is_said():
    summary, _ = check_study(PAPER)
    assert "operating points  125 = 5 forces × 5 speeds × 5 temperatures" in summary
    assert "contact runs      56,000 = 125 × 7 film formulas × 64 realisations" in summary
    assert "results           results/paper" in summary
    assert summary[-1].split() == [
        "last",
        "run",
        "none,",
        "so",
        "its",
        "time",
        "is",
        "not",
        "known",
    ]


def test_a_last_run_gives_its_time(tmp_path):
    (tmp_path / "results/smoke/benchmarks").mkdir(parents=True)
    for name, seconds in (("film", 20.0), ("trace", 100.0)):
        file = tmp_path / f"results/smoke/benchmarks/{name}.tsv"
        file.write_text(f"s\th:m:s\n{seconds}\t0\n", encoding="utf-8")
    assert check_study(SMOKE)[0][-1].endswith("2 jobs took 2.0 min, one after the other")


def test_changes_are_those_of_snakemake():
    changes = ["name=mine", "realisations=8", "rollers={first: {radius: 30 mm}}"]
    summary = check_study(PAPER, changes)[0]
    assert any("× 8 realisations" in line for line in summary)
    band = "band              waves 364 µm (contact width at the largest force) to 1.88 µm"
    assert band in summary
    for change, expected in (
        ("realisations=8", "--config: name: missing"),
        ("realisations", "need key=value"),
        ("rollers.first.radius=1 mm", "need 'rollers={first: {radius: 1 mm}}' for a nested key"),
    ):
        assert expected in one_line(StudyError, check_study, PAPER, [change])


RECORDS = """file, force [N], speed [rpm], temperature [degC], probability
good.csv, 800, 100, 40,
gap.csv, 800, 100, 40,
saturated.csv, 800, 100, 40,
good.csv, 800, 100, 10,
gone.csv, 800, 100, 40,
, 800, 100, 40, 0.5
"""


def test_each_record_is_read_and_refused_as_by_the_workflow(tmp_path, capsys):
    for name, samples in (
        ("good", "0,1\n1,2\n2,1\n"),
        ("gap", "0,1\n1,2\n2,1\n3,2\n7,1\n"),
        ("saturated", "0,1\n1,2\n2,101\n"),
    ):
        (tmp_path / f"{name}.csv").write_text(f"t [s],U [mV]\n{samples}")
    (tmp_path / "records.csv").write_text(RECORDS)
    (tmp_path / "mine.yaml").write_text(
        f"based_on: {SMOKE}\nname: mine\nexperiment: {{manifest: records.csv}}\n"
    )
    assert main(["check", "mine.yaml"]) == 1
    *_, first, second, third, fourth = capsys.readouterr().out.splitlines()
    assert "gone.csv', no such file" in first
    assert "gap.csv: line 6: time goes from 3 s to 7 s" in second
    assert "saturated.csv: saturated, 33.3% of its samples" in third
    assert "records.csv: line 5: mobilgear-shc-xmp-320: got 10 degC" in fourth
    assert "2 of the 6 in records.csv can be used" in "\n".join(check_study("mine.yaml")[0])


def test_a_list_without_usable_records_is_refused(tmp_path):
    (tmp_path / "records.csv").write_text(RECORDS.splitlines()[0])
    (tmp_path / "mine.yaml").write_text(
        f"based_on: {SMOKE}\nname: mine\nexperiment: {{manifest: records.csv}}\n"
    )
    assert check_study("mine.yaml")[1] == ["records.csv: no record can be used, need one at least"]


def test_it_takes_less_than_1_5_seconds_of_the_processor():
    times = "import os; t = os.times(); print(t.user + t.system)"
    code = f"from lube.cli import main; main(['check', {str(PAPER)!r}]); {times}"
    command = [sys.executable, "-c", code]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=True)
    assert float(done.stdout.splitlines()[-1]) < 1.5
