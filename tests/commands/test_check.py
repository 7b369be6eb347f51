"""`lube check`: what a study will compute, and the records that it cannot use."""

import pytest
import yaml
from refusals import one_line
from studies import CONFIG, PAPER, SMOKE

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
    assert summary[0].split()[:2] == ["study", f"{path.stem}:"] and "valid" in summary[0]
    assert not refused
    assert not any("no sensitivity study" in line for line in summary)


def test_ranges_that_hold_for_another_study_only_are_named(paper_with):
    _, remarks = lines_of(paper_with(("roughness.longest_wavelength", "0.8 mm")))
    assert [one.split(":")[:2] for one in remarks if "sensitivity" in one] == [
        ["no sensitivity study is possible", " uncertainty"]
    ]


def test_the_amount_of_work_is_said():
    summary, _ = check_study(PAPER)
    assert "operating points  125 = 5 forces × 5 speeds × 5 temperatures" in summary
    assert "contact runs      56,000 = 125 × 7 film formulas × 64 realisations" in summary
    assert "results           results/paper" in summary
    assert "last run          none, so its time is not known" in summary


def lines_of(path, *changes):
    """Lines of the summary by their first words, and the remarks."""
    summary, _ = check_study(path, changes)
    remarks = [line.removeprefix("Remark: ") for line in summary if line.startswith("Remark: ")]
    return {line[:18].strip(): line[18:] for line in summary}, remarks


def test_operating_points_are_counted_at_each_slip():
    lines, _ = lines_of(CONFIG / "slip.yaml")
    assert lines["operating points"].startswith("40 = 2 forces × 2 temperatures × 10 ")
    assert "of 40 outside" in lines["film"]
    _, remarks = lines_of(
        CONFIG / "slip.yaml", "name=rough", "rollers={first: {rms_roughness: 1 um}}"
    )
    assert any(" of 40 operating points" in one for one in remarks)


def test_what_an_engineer_looks_at_first_is_said():
    lines, _ = lines_of(PAPER)
    assert lines["Hertz pressure"] == "121 MPa to 485 MPa"
    assert lines["lambda ratio"] == "0.898 to 8.63"
    assert lines["film"].endswith("by paper; 66 of 125 outside its range of validity")
    assert lines["contact width"].startswith("105 µm to 420 µm")
    assert lines["grid"].startswith("10 points in the shortest wave")
    assert "load share" in lines and "GB for each job" in lines["expected run"]


def test_the_load_share_is_that_under_the_film_of_the_study():
    """As docs/limits.md has it for this point."""
    change = (
        "name=mine",
        "contact_model=[line, surface]",
        "operating_grid={force: {values: [1600], units: N}, speed: {values: [100], units: rpm}, "
        "temperature: {values: [80], units: degC}}",
        "traces=[{force: 1600 N, speed: 100 rpm, temperature: 80 degC}]",
    )
    shaped = "film_formulas=[computed]", "film_shape=computed"
    for choices, share in (((), 21), (shaped, 24)):
        lines, _ = lines_of(PAPER, *change, *choices)
        assert lines["load share"].endswith(f"{share} % by asperities of the surface")


@pytest.mark.parametrize(
    ("change", "expected"),
    [
        ("rollers={first: {young_modulus: 310 MPa}}", "Young's modulus: 310 MPa to 210 GPa"),
        (
            "operating_grid={force: {values: [800, 1600, 90000], units: N}}",
            "Hertz pressure: up to 3.64 GPa",
        ),
        ("roughness={points: 250000}", "shortest wave: 12.6 µm"),
        ("roughness={points: 250000, shortest_wavelength: 3.1416 um}", "grid: 2.5 points in"),
        ("rollers={length: 0.2 mm}", "length of the rollers: 200 µm, but the contact is up to"),
        (
            "roughness={skewness: -1, kurtosis: 5}",
            "contact is counted in realisations, not sampled: roughness: got a skewness of -1",
        ),
        ("rollers={first: {rms_roughness: 3 um}}", "load share: at 125 of 125 operating points"),
    ],
)
def test_what_is_unlikely_to_be_meant_is_remarked(change, expected):
    lines, remarks = lines_of(PAPER, "name=mine", change)
    assert any(remark.startswith(expected) for remark in remarks)
    assert lines["study"] == "mine: valid, see the remarks below"
    assert not any(remark.startswith(expected) for remark in lines_of(PAPER)[1])


def test_a_last_run_gives_its_time(tmp_path):
    (tmp_path / "results/smoke/benchmarks").mkdir(parents=True)
    for name, seconds in (("film", 20.0), ("trace", 100.0)):
        file = tmp_path / f"results/smoke/benchmarks/{name}.tsv"
        file.write_text(f"s\th:m:s\n{seconds}\t0\n", encoding="utf-8")
    said = next(line for line in check_study(SMOKE)[0] if line.startswith("last run"))
    assert said.endswith("2 jobs took 2.0 min, one after the other")


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
    summary = "\n".join(check_study("mine.yaml")[0])
    assert "2 of the 6 in records.csv can be used" in summary
    assert "Remark: good.csv (records.csv: line 2): reads as contact all the time" in summary


def test_a_list_without_usable_records_is_refused(tmp_path):
    (tmp_path / "records.csv").write_text(RECORDS.splitlines()[0])
    (tmp_path / "mine.yaml").write_text(
        f"based_on: {SMOKE}\nname: mine\nexperiment: {{manifest: records.csv}}\n"
    )
    assert check_study("mine.yaml")[1] == [
        "records.csv: no record can be used, need at least one usable record"
    ]


@pytest.mark.parametrize("own", [{}, {"about": {"creators": [{"name": "Popova, Elena"}]}}])
def test_authors_of_the_base_are_named_unless_they_are_replaced(tmp_path, own):
    content = {"based_on": str(CONFIG / "paper.yaml"), "name": "mine", "uncertainty": None} | own
    file = tmp_path / "mine.yaml"
    file.write_text(yaml.safe_dump(content), encoding="utf-8")
    remarks = [line for line in check_study(file)[0] if "names The authors of lube" in line]
    assert len(remarks) == (not own)


def test_ranges_of_the_base_are_named_unless_they_are_replaced(tmp_path):
    file, paper = tmp_path / "mine.yaml", CONFIG / "paper.yaml"
    own = "uncertainty: {temperature: {range: +- 2 K}, force: null}"
    file.write_text(f"based_on: {paper}\nname: mine\n{own}\n", encoding="utf-8")
    remark = check_study(file)[0][-1]
    assert remark.startswith(
        f"Remark: uncertainty: {paper} gives the ranges and choices of viscosity"
    )
    assert "temperature" not in remark and "force" not in remark
    assert "uncertainty" not in check_study(paper)[0][-1]
