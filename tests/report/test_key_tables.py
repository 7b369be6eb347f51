"""The documentation agrees with the code: its tables, commands, examples and links."""

import re

import pytest
from generated_tables import TABLES, table, with_tables
from markdown_it import MarkdownIt
from mdit_py_plugins.anchors import anchors_plugin
from studies import ROOT

from lube.recordings.manifest import read_manifest
from lube.recordings.reader import open_recording

PAGES = {
    path.relative_to(ROOT).as_posix(): path.read_text(encoding="utf-8")
    for path in (*ROOT.glob("*.md"), *ROOT.glob("docs/*.md"))
}


def code_blocks(page, language):
    blocks = re.findall(r"```(\w*)\n(.*?)```", PAGES[page], re.DOTALL)
    return [block for its, block in blocks if its == language]


def test_the_tables_are_those_of_the_code():
    for name, text in PAGES.items():
        assert with_tables(text) == text, f"run: python docs/tools/generated_tables.py {name}"
    assert set(re.findall(r"<!-- table: (\w+) -->", "".join(PAGES.values()))) == set(TABLES)


def test_tables_are_filled_between_their_markers_only():
    text = "before\n<!-- table: formulas -->\nold\n<!-- end -->\nafter"
    filled = with_tables(text)
    assert filled == f"before\n<!-- table: formulas -->\n{table('formulas')}\n<!-- end -->\nafter"


def test_a_key_has_its_unit_limits_and_default():
    lines = {name: table(name).splitlines() for name in ("study", "manifest", "record")}
    for row, name in {
        "| `rollers.first.radius` | quantity in m, above 0 |": "study",
        "| `rollers.second.poisson_ratio` | number, at least 0 and at most 0.5 |": "study",
        "| `operating_grid.force` | values and units in N, above 0 |": "study",
        "| `lubricants` | list of names or paths |": "study",
        "| `traces[].lubricant` | text (optional) |": "study",
        "| `rig.bandwidth` | quantity in Hz, above 0 (by default 50 kHz) |": "study",
        "| `experiment.thresholds` | values and units in ohm, above 0 (by default 10": "study",
        "| `gain` | number, other than 0 (by default 1) |": "manifest",
        "| `temperature_tolerance` | quantity in K, above 0 (optional) |": "manifest",
        "| `density.at_15_degC` | quantity in kg/m^3, at least 400": "record",
    }.items():
        assert any(line.startswith(row) for line in lines[name]), row


def headings(page):
    """Anchors of a page's headings, as GitHub and the site make them."""
    tokens = MarkdownIt().use(anchors_plugin, max_level=3).parse(page.read_text(encoding="utf-8"))
    return {token.attrGet("id") for token in tokens if token.type == "heading_open"}


def test_links_lead_to_files_and_headings():
    for name, text in PAGES.items():
        for target, anchor in re.findall(r"\]\(([^)#\s]*)#?([^)\s]*)\)", text):
            if not target.startswith("https:"):
                page = (ROOT / name).parent / target if target else ROOT / name
                assert page.exists(), f"{name}: {target}"
                assert not anchor or anchor in headings(page), f"{name}: {target}#{anchor}"


def test_the_readme_is_short():
    assert len(PAGES["README.md"].splitlines()) <= 130


def test_continuous_integration_runs_the_test_command_of_the_readme():
    command = next(block for block in code_blocks("README.md", "bash") if "pytest" in block)
    script = (ROOT / ".ci/run").read_text(encoding="utf-8")
    assert command.strip().replace("pip install ", "pip install -q ") in script


def test_the_loggers_record_is_read_as_the_documentation_says(tmp_path):
    blocks = code_blocks("docs/records.md", "")
    (tmp_path / "logger-3.csv").write_text(next(block for block in blocks if "CH1" in block))
    (tmp_path / "list.csv").write_text(next(block for block in blocks if "logger-3" in block))
    manifest = read_manifest(tmp_path / "list.csv")
    (entry,) = manifest.entries
    assert (entry.speed, entry.pair, manifest.refused) == (pytest.approx(100.0), "A", ())
    channel = (entry.channel, entry.unit, entry.gain, entry.offset)
    first = next(open_recording(entry.file, None, *channel).pieces())[0]
    assert first == pytest.approx(11.02e-3, rel=1e-12)
    assert "(113.2 - 3)/10 = 11.02 mV" in PAGES["docs/records.md"]
