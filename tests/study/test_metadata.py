"""Title, authors and licence of a study: read as catalogues need them, or refused."""

import datetime

import pytest

from lube.errors import StudyError
from lube.study.field_types import validate
from lube.study.metadata import About

ORCID = "0000-0002-1825-0097"


def test_dois_orcids_and_days_are_accepted():
    for doi in ("10.5281/zenodo.1234567", "10.1000.10/123", "10.1016/a(b)[c];d_e"):
        assert About(doi=doi).doi == doi
    for orcid in (ORCID, "0000-0002-9079-593X"):
        assert About(creators=[{"name": "A", "orcid": orcid}]).creators[0].orcid == orcid
    assert About(date="2026-11-21").date == datetime.date(2026, 11, 21)


def test_what_a_catalogue_would_not_accept_is_refused():
    for key, value, message in [
        ("title", "", "title: got '', need one line of text"),
        ("title", "two\nlines", r"title: got 'two\nlines', need one line of text"),
        ("summary", "two\u2028lines", "summary: got 'two\\u2028lines', need one line of text"),
        ("licence", "none", "licence: got 'none', need 'CC-BY-4.0'"),
        ("creators", [{}], "creators.0.name: missing"),
        ("creators", [{"name": "Popova,"}], "creators.0.name: got 'Popova,', need 'Family, Given'"),
        ("creators", [{"name": "Popova", "Elena": None}], "unknown key, need one of name"),
        ("creators", [{"name": name, "orcid": ORCID} for name in "AB"], f"{ORCID} repeatedly"),
        ("creators", [{"name": "A"}, {"name": "A"}], "repeatedly, need it once"),
        ("creators", [{"name": "A", "orcid": "12"}], "creators.0.orcid: got '12', need an ORCID"),
        ("creators", [{"name": "A", "orcid": "0000-0000-0000-0000"}], "need an ORCID iD such as"),
        ("keywords", [], "keywords: got [], need 1 or more entries"),
        ("keywords", ["oil", "oil"], "keywords: got oil repeatedly, need it once"),
        ("doi", "doi.org/10.5281/1", "doi: got 'doi.org/10.5281/1', need a DOI such as 10."),
        ("doi", '10.5281/zenodo.1"<>&x', "need a DOI such as 10."),
        ("date", "yesterday", "date: got 'yesterday', need a day such as 2026-11-21"),
        ("date", "2026-02-30", "date: got '2026-02-30', need a day"),
        ("date", "2026-11-21 12:00:00", "date: got '2026-11-21 12:00:00', need a day"),
    ]:
        with pytest.raises(StudyError) as caught:
            validate(About, {key: value}, "study.yaml: about", StudyError)
        assert message in str(caught.value)
