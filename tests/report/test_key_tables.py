"""The README says what the code does: its tables, its commands, its example."""

import re

import pytest
from studies import ROOT

from lube.physics.film_formulas import FORMULAS
from lube.recordings.manifest import manifest_schema, read_manifest
from lube.recordings.reader import open_recording
from lube.report.key_tables import (
    formula_table,
    manifest_table,
    record_table,
    study_table,
    with_tables,
)

README = (ROOT / "README.md").read_text(encoding="utf-8")


def code_blocks(language):
    blocks = re.findall(r"```(\w*)\n(.*?)```", README, re.DOTALL)
    return [block for its, block in blocks if its == language]


def test_the_tables_of_the_readme_are_those_of_the_code():
    assert with_tables(README) == README, "run: python -m lube.report.key_tables README.md"


def test_tables_are_filled_between_their_markers_only():
    text = "before\n<!-- table: formulas -->\nold\n<!-- end -->\nafter"
    filled = with_tables(text)
    assert filled == f"before\n<!-- table: formulas -->\n{formula_table()}\n<!-- end -->\nafter"


def test_every_formula_has_a_row():
    rows = formula_table().splitlines()[2:]
    assert [row.split("`")[1] for row in rows] == list(FORMULAS)


@pytest.mark.parametrize(
    ("row", "table"),
    [
        ("| `rollers.first.radius` | quantity in m, above 0 |", study_table),
        ("| `rollers.second.poisson_ratio` | number, at least 0 and at most 0.5 |", study_table),
        ("| `operating_grid.force` | values and units in N, above 0 |", study_table),
        ("| `lubricants` | list of names or paths |", study_table),
        ("| `traces[].lubricant` | text (optional) |", study_table),
        ("| `rig.bandwidth` | quantity in Hz, above 0 (by default 50 kHz) |", study_table),
        (
            "| `experiment.thresholds` | values and units in ohm, above 0 (by default 10, ",
            study_table,
        ),
        ("| `gain` | number, other than 0 (by default 1) | factor of an amplifier", manifest_table),
        ("| `temperature_tolerance` | quantity in K, above 0 (optional) |", manifest_table),
        ("| `force` | quantity in N, above 0 | normal force |", manifest_table),
        ("| `density.at_15_degC` | quantity in kg/m^3, above 0 (section optional) |", record_table),
    ],
)
def test_a_key_is_told_with_its_unit_and_limits(row, table):
    assert any(line.startswith(row) for line in table().splitlines())


def test_every_key_of_a_manifest_is_explained():
    rows = manifest_table().splitlines()[2:]
    assert [row.split("`")[1] for row in rows] == list(manifest_schema()["properties"])
    assert all(row.split(" | ")[2].rstrip("| ") for row in rows)


def test_the_loggers_record_is_read_as_the_readme_says(tmp_path):
    blocks = code_blocks("")
    (tmp_path / "logger-3.csv").write_text(next(block for block in blocks if "CH1" in block))
    (tmp_path / "list.csv").write_text(next(block for block in blocks if "logger-3" in block))
    manifest = read_manifest(tmp_path / "list.csv")
    (entry,) = manifest.entries
    assert (entry.speed, entry.pair, manifest.refused) == (pytest.approx(100.0), "A", ())
    told = (entry.channel, entry.unit, entry.gain, entry.offset)
    first = next(open_recording(entry.file, None, *told).pieces())[0]
    assert first == pytest.approx(11.02e-3, rel=1e-12)
    assert "(113.2 - 3)/10 = 11.02 mV" in README


def test_continuous_integration_runs_the_test_command_of_the_readme():
    command = next(block for block in code_blocks("bash") if "pytest" in block).strip()
    script = (ROOT / ".ci/run").read_text(encoding="utf-8")
    assert command.replace("pip install ", "pip install -q ") in script


def test_the_example_without_snakemake_runs_as_printed():
    example = next(block for block in code_blocks("python") if "load_record" in block)
    *body, last = example.strip().splitlines()
    names = {}
    exec("\n".join(body).replace("100_000", "20_000").replace("range(8)", "range(2)"), names)
    mean = eval(last, names)
    assert mean.sizes == {"temperature": 2, "force": 2}
    assert (mean.sel(temperature=80) >= mean.sel(temperature=40)).all()
