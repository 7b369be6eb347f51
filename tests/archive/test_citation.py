"""How an archive is cited."""

import json

import pytest
import yaml

from lube.archive.citation import check_about, citation_file, publication_date, zenodo_metadata
from lube.errors import StudyError
from lube.study.metadata import PAPER, About


def test_a_citation_names_creators_licence_date_and_paper(attributed_study):
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
    deposit = json.loads(zenodo_metadata(attributed_study))
    assert deposit["upload_type"] == "dataset"
    assert deposit["title"] == "My <rollers> & oil"
    assert "Rollers &amp; oil." in deposit["description"]  # HTML
    assert deposit["creators"][0]["orcid"] == "0000-0002-1825-0097"
    assert deposit["creators"][1] == {"name": "The authors of lube"}
    assert deposit["license"] == "cc0-1.0"


def test_an_archive_needs_creators_and_a_date(study, monkeypatch):
    undated = study.model_copy(update={"about": About()})
    with pytest.raises(StudyError, match=r"about.creators: missing, an archive needs one at least"):
        check_about(undated)
    monkeypatch.setattr("lube.archive.citation.commit_date", lambda: "2026-05-06")
    assert publication_date(undated).isoformat() == "2026-05-06"
    assert publication_date(study) == study.about.date
    monkeypatch.setattr("lube.archive.citation.commit_date", lambda: None)
    with pytest.raises(StudyError, match=r"about.date: missing, and the code has no commit"):
        publication_date(undated)
