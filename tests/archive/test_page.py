"""The README of an archive: what it says, whoever chose the words."""

import re
from html import unescape

import pytest
from markdown_it import MarkdownIt

from lube.archive.page import archive_page
from lube.schema import DATASETS
from lube.study.metadata import About

WORDS = [
    *("<script>alert(1)</script>", "Müller*_`, 😀", "<!-- hidden", "```", "# of contacts"),
    *("n*m and a*b", "1. first", "[a](b)", "a \\", "Oil &amp; rollers", "__init__ of a_b_c"),
]


def page_of(study, study_file="smoke.yaml", **about):
    about = About.model_validate({"creators": [{"name": "A"}]} | about)
    return archive_page(study.model_copy(update={"about": about}), DATASETS, study_file)


def shown(page):
    return MarkdownIt("commonmark").enable(["table", "strikethrough"]).render(page)


@pytest.mark.parametrize("words", WORDS)
def test_anybodys_words_are_shown_as_they_are(study, words):
    creators = [{"name": "Oil Lab", "affiliation": words}]
    page = page_of(study, title=words, summary=words, creators=creators)
    html = shown(page)
    blocks = re.findall(r"<(?:h1|p)>(.*?)</(?:h1|p)>", html, re.DOTALL)
    title, makers, licence, summary, model = blocks[:5]
    assert [unescape(title), unescape(summary)] == [words, words]
    assert unescape(makers) == f"Oil Lab ({words})"
    assert licence.startswith("Licence of the results: <a href=")
    assert model.startswith("The model is that of the paper <em>")
    plain = shown(page_of(study))
    assert all(html.count(tag) == plain.count(tag) for tag in ("<p>", "<td>", "<pre>", "<code>"))


def test_every_dataset_and_the_code_are_named(study):
    page = page_of(study, "studies/mine.yaml")
    assert all(f"`data/{kind}.nc`" in page for kind in DATASETS)
    assert "| `study/studies/mine.yaml` | the study as it was written |" in page
    assert "lube explain data/contact.nc --force 1600 --speed 100 --temperature 80" in page
    assert "measured records" not in page


def test_where_measured_records_belong_is_told(study):
    measured = study.experiment.model_copy(update={"manifest": "list.csv"})
    page = page_of(study.model_copy(update={"experiment": measured}))
    assert "measured records themselves are not in this archive" in page
    assert "anew,\nput the measured records where their list expects them" in page


def test_refused_records_are_named_with_their_reasons(study):
    measured = study.experiment.model_copy(update={"manifest": "list.csv"})
    study = study.model_copy(update={"experiment": measured})
    page = archive_page(study, DATASETS, "smoke.yaml", ["run_7.csv: line 3: got 'x', need y"])
    assert "refused, and are in no result" in page
    assert "run_7.csv: line 3: got 'x', need y" in unescape(shown(page))


def test_code_that_is_not_as_in_its_commit_is_named(study, monkeypatch):
    monkeypatch.setattr("lube.archive.page.changed_code", lambda: ["notebooks/fig02_film.ipynb"])
    assert "; not as in that commit: `notebooks/fig02_film.ipynb` |" in page_of(study)
