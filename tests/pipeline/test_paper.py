"""The paper to cite: its references are there, and its figures are figures of the study."""

import re

import yaml
from repository import ROOT

PAPER = (ROOT / "docs/paper/paper.md").read_text("utf-8")
REFERENCES = (ROOT / "docs/paper/paper.bib").read_text("utf-8")


def test_every_reference_is_cited_and_every_citation_is_a_reference():
    body = PAPER.split("---", 2)[2]
    cited = set(re.findall(r"@([a-z]+\d*)", body))
    known = re.findall(r"^@\w+\{(\w+),", REFERENCES, flags=re.MULTILINE)
    assert cited == set(known) and len(known) == len(set(known))


def test_its_head_is_that_of_the_journal():
    head = yaml.safe_load(PAPER.split("---", 2)[1])
    assert {"title", "tags", "authors", "affiliations", "date", "bibliography"} <= head.keys()
    assert (ROOT / "docs/paper" / head["bibliography"]).is_file()


def test_it_has_the_sections_and_the_length_that_the_journal_asks_for():
    """By its page "JOSS Paper Format" of 2026."""
    sections = (
        "Summary, Statement of need, State of the field, Software design, "
        "Research impact statement, AI usage disclosure, References"
    ).split(", ")
    found = re.findall(r"^# (.+)$", PAPER, flags=re.MULTILINE)
    assert [name for name in found if name in sections] == sections
    assert 750 <= len(PAPER.split()) <= 1750


def test_its_figures_are_drawn_by_notebooks_and_referred_to():
    for label, path in re.findall(r"label\{(fig:\w+)\}\]\((\S+)\)", PAPER):
        assert rf"\autoref{{{label}}}" in PAPER
        name = path.removeprefix("../../results/paper/figures/").removesuffix(".png")
        assert (ROOT / f"notebooks/{name}.ipynb").is_file()
    assert PAPER.count("../../results/paper/figures/") == 2
