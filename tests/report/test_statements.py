"""Statements about the paper's study stand only where a study shares its values."""

import re

from studies import CONFIG, PAPER, ROOT

from lube.report.statements import assumptions_of, limits_of
from lube.study.study import load_study

DOCS = {
    name: (ROOT / f"docs/{name}.md").read_text("utf-8").partition("<!-- effects -->")[0]
    for name in ("limits", "assumptions")
}
OWN = {"name": "mine", "rollers": {"first": {"young_modulus": "310 GPa"}}, "resistivity": "1 ohm*m"}


def left_open(text):
    return re.findall(r"^\| ([^|]+) \|", text.partition("paper's study\n")[2], re.MULTILINE)[2:]


def test_the_papers_study_keeps_all():
    paper = load_study(PAPER)
    assert assumptions_of(paper, paper, DOCS["assumptions"]) == DOCS["assumptions"]
    page = (ROOT / "docs/assumptions.md").read_text("utf-8")
    assert assumptions_of(paper, paper, page) == DOCS["assumptions"] != page
    assert limits_of(paper, paper, DOCS["limits"]) == DOCS["limits"]
    # More realisations change no value that the numbers of the limits follow from.
    more = load_study(PAPER, {"name": "mine", "realisations": 128})
    assert limits_of(more, paper, DOCS["limits"]) == DOCS["limits"]


def test_another_study_keeps_what_it_shares():
    paper, own = load_study(PAPER), load_study(PAPER, OWN)
    kept = assumptions_of(own, paper, DOCS["assumptions"])
    assert "## The same as in the paper's study" in kept
    lost = {"steel", "resistivity", "film shape", "heating of the oil at the inlet"}
    assert set(left_open(DOCS["assumptions"])) - set(left_open(kept)) == lost
    assert "125" not in limits_of(own, paper, DOCS["limits"])
    grid = assumptions_of(load_study(CONFIG / "slip.yaml"), paper, DOCS["assumptions"])
    assert "steel" in left_open(grid) and "125 points" not in grid


def test_a_study_without_records_says_nothing_of_a_rig():
    paper, own = load_study(PAPER), load_study(PAPER, {"name": "mine", "resistivity": "insulator"})
    lost = {"resistivity", "the measured values", "the rig's circuit, amplifier, sampling"}
    kept = assumptions_of(own, paper, DOCS["assumptions"])
    assert set(left_open(DOCS["assumptions"])) - set(left_open(kept)) == lost


def test_what_is_said_of_the_model_is_said_of_every_study():
    paper, smoke = load_study(PAPER), load_study(CONFIG / "smoke.yaml")
    for name, reduce in (("limits", limits_of), ("assumptions", assumptions_of)):
        general = DOCS[name].partition("## In the paper's study")[0].strip()
        assert reduce(smoke, paper, DOCS[name]).startswith(general)
        assert not re.search(r"\bMobilgear|\bsteel|\d+ N\b|r/min", general)
