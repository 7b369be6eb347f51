"""The README of an archive."""

import re
from html import unescape

import pytest
from example_sensitivity import dataset
from markdown_it import MarkdownIt
from studies import SMOKE_DATASETS

from lube.archive.build import archive_page
from lube.report.pages import render
from lube.report.sensitivity import rests_on
from lube.study.metadata import About


@pytest.fixture
def page_of(study, datasets):
    def write(study_file="smoke.yaml", changes=(), experiment=datasets["experiment"], **about):
        about = About.model_validate({"creators": [{"name": "A"}]} | about)
        study_of_test = study.model_copy(update={"about": about, **dict(changes)})
        results = datasets | {"experiment": experiment}
        return archive_page(study_of_test, study_file, list(SMOKE_DATASETS), results)

    return write


def shown(page):
    return MarkdownIt("commonmark").enable(["table", "strikethrough"]).render(page)


def test_title_summary_and_creators_are_shown_as_written(page_of):
    plain = shown(page_of())
    for words in ("<script>alert(1)</script>", "Müller*_`, 😀", "1. first", "[a](b)", "n*m & a_b"):
        creators = [{"name": "Oil Lab", "affiliation": words}]
        html = shown(page_of(title=words, summary=words, creators=creators))
        blocks = re.findall(r"<(?:h1|p)>(.*?)</(?:h1|p)>", html, re.DOTALL)
        title, creators_line, licence, summary, model = map(unescape, blocks[:5])
        assert [title, summary, creators_line] == [words, words, f"Oil Lab ({words})"]
        assert licence.startswith("Licence of the results: <a href=")
        assert model.startswith("The model is that of the paper <em>")
        assert all(html.count(tag) == plain.count(tag) for tag in ("<p>", "<td>", "<pre>"))


def test_every_dataset_and_the_code_are_named(page_of):
    page = page_of("studies/mine.yaml")
    assert all(f"`data/{kind}.nc`" in page for kind in SMOKE_DATASETS)
    assert "| `study/studies/mine.yaml` | the study as it was written |" in page
    assert "lube explain data/contact.nc --force 1600 --speed 100 --temperature 80" in page
    assert "measured records" not in page


def test_the_examples_name_a_file_of_the_archive_where_there_are_no_lines(study):
    lay = study.roughness.model_copy(update={"lay_ratio": 5.0, "lay_angle": 0.0})
    ground = study.model_copy(update={"roughness": lay, "contact_model": ("surface",)})
    assert not ground.has("contact")
    texts = {"facts": "", "findings": "", "rests_on": "", "study_file": "g.yaml"}
    known = {"licence": "", "paper": "", "datasets": {}, "commit": "", "changed": ()}
    page = render("archive.md", study=ground, **texts, **known)
    assert 'areal = xr.open_dataset("data/areal.nc")' in page and "contact.nc" not in page
    assert "lube explain data/areal.nc --force 1600 --speed 100 --temperature 80\n```" in page


def test_the_place_of_measured_records_is_named_and_refused_ones_with_their_reasons(
    study, datasets, page_of
):
    measured = study.experiment.model_copy(update={"manifest": "list.csv"})
    refused = datasets["experiment"].assign_attrs(refused="run_7.csv: line 3: got 'x', need y")
    page = page_of(changes={"experiment": measured}, experiment=refused)
    assert "measured records themselves are not in this archive" in page
    assert "again,\nput the measured records where their list expects them" in page
    assert "refused, and are in no result" in page
    assert "run_7.csv: line 3: got 'x', need y" in unescape(shown(page))


def test_code_that_is_not_as_in_its_commit_is_named(page_of, monkeypatch):
    monkeypatch.setattr("lube.archive.build.changed_code", lambda: ["notebooks/fig02_film.ipynb"])
    assert "; changed since that commit: `notebooks/fig02_film.ipynb` |" in page_of()


def test_the_values_and_findings_of_the_study_are_stated(page_of):
    page = page_of()
    assert "| **Rollers** | two equal rollers: radius 50 mm, Young's modulus 210 GPa" in page
    assert "Metal contact occurs at" in page or "No metal contact was seen" in page


def test_what_the_assumptions_do_is_said_if_the_archive_has_it(study, datasets, page_of):
    results = datasets | {"sensitivity": dataset(), "record_bands": None}
    kinds = [*SMOKE_DATASETS, "sensitivity"]
    page = archive_page(study, "smoke.yaml", kinds, results)
    table = rests_on(study, dataset())
    assert f"{table}\n## What the archive contains" in page
    without = archive_page(study, "smoke.yaml", list(SMOKE_DATASETS), results)
    assert "What this does" not in without and "\n\n## What the archive contains" in without
