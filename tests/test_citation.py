"""How an archive is cited."""

import datetime
import json

import pytest
import yaml

from lube.about import PAPER, About
from lube.citation import check_about, citation_file, publication_date, zenodo_metadata
from lube.errors import StudyError
from lube.fields import validate


def test_a_citation_names_makers_licence_day_and_paper(attributed_study):
    cited = yaml.safe_load(citation_file(attributed_study))
    assert cited["cff-version"] == "1.2.0"
    assert cited["authors"] == [
        {
            "family-names": "Popova",
            "given-names": "Elena",
            "affiliation": "TU Berlin",
            "orcid": "https://orcid.org/0000-0002-1825-0097",
        },
        {"name": "The authors of lube"},
    ]
    assert str(cited["date-released"]) == "2026-02-03"
    assert cited["license"] == "CC0-1.0"
    assert cited["doi"] == "10.5281/zenodo.123"
    assert PAPER in [reference["title"] for reference in cited["references"]]


def test_zenodo_gets_what_it_asks_for(attributed_study):
    told = json.loads(zenodo_metadata(attributed_study))
    assert told["upload_type"] == "dataset"
    assert told["title"] == "My <rollers> & oil"
    assert "Rollers &amp; oil." in told["description"]  # which is HTML
    assert told["creators"][0]["orcid"] == "0000-0002-1825-0097"
    assert told["creators"][1] == {"name": "The authors of lube"}
    assert told["license"] == "cc0-1.0"


# What an archive needs to know


def test_a_study_without_makers_makes_no_archive(study):
    with pytest.raises(StudyError, match=r"about.creators: missing, an archive needs someone"):
        check_about(study.model_copy(update={"about": About()}))


def test_the_day_is_the_studys_or_that_of_the_commit(study, monkeypatch):
    undated = study.model_copy(update={"about": About()})
    monkeypatch.setattr("lube.citation.commit_date", lambda: "2026-05-06")
    assert publication_date(undated).isoformat() == "2026-05-06"
    assert publication_date(study) == study.about.date
    monkeypatch.setattr("lube.citation.commit_date", lambda: None)
    with pytest.raises(StudyError, match=r"about.date: missing, and the code has no commit"):
        publication_date(undated)


@pytest.mark.parametrize(
    ("key", "value", "told"),
    [
        ("title", "", "title: got '', need one line of text"),
        ("title", "two\nlines", r"title: got 'two\nlines', need one line of text"),
        ("licence", "none", "licence: got 'none', need 'CC-BY-4.0'"),
        ("creators", [{"name": "A", "orcid": "12"}], "creators.0.orcid: got '12', need an ORCID"),
        ("creators", [{}], "creators.0.name: missing"),
        ("creators", [{"name": "Popova,"}], "creators.0.name: got 'Popova,', need 'Family, Given'"),
        ("creators", [{"name": ", Elena"}], "creators.0.name: got ', Elena', need 'Family, Given'"),
        ("creators", [{"name": "Popova", "Elena": None}], "got 'Elena' without a value, need"),
        (
            "creators",
            [{"name": name, "orcid": "0000-0002-1825-0097"} for name in "AB"],
            "creators: got an ORCID iD twice, need one for each",
        ),
        ("keywords", [], "keywords: got [], need one or more, each once"),
        ("keywords", ["oil", "oil"], "keywords: got ['oil', 'oil'], need one or more, each once"),
        ("doi", "doi.org/10.5281/1", "doi: got 'doi.org/10.5281/1', need a DOI such as 10."),
        ("date", "yesterday", "date: got 'yesterday', need a day such as 2026-11-21"),
        ("date", -1, "date: got -1, need a day"),
        ("date", 2026, "date: got 2026, need a day"),  # no seconds since 1970
        ("date", datetime.datetime(2026, 11, 21, 12), "date: got 2026-11-21 12:00:00, need a day"),
    ],
)
def test_what_a_study_says_of_itself_is_checked(key, value, told):
    with pytest.raises(StudyError) as caught:
        validate(About, {key: value}, "study.yaml: about", StudyError)
    assert told in str(caught.value)
