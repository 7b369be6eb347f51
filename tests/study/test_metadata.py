"""What a study says of itself: read as catalogues need it, or told."""

import datetime

import pytest

from lube.errors import StudyError
from lube.study.field_types import validate
from lube.study.metadata import About


@pytest.mark.parametrize("doi", ["10.5281/zenodo.1234567", "10.1000.10/123", "10.1016/a(b)[c];d_e"])
def test_dois_of_many_forms(doi):
    assert About(doi=doi).doi == doi


@pytest.mark.parametrize("orcid", ["0000-0002-1825-0097", "0000-0002-9079-593X"])
def test_orcids_with_the_right_last_digit(orcid):
    assert About(creators=[{"name": "A", "orcid": orcid}]).creators[0].orcid == orcid


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
            "creators: got an ORCID iD twice, need each once",
        ),
        (
            "creators",
            [{"name": "A"}, {"name": "A"}],
            "creators: got somebody twice, need each once",
        ),
        ("creators", [{"name": "A", "orcid": "0000-0000-0000-0000"}], "whose last digit fits"),
        ("creators", [{"name": "A", "orcid": "٠٠٠٠-0002-1825-0097"}], "need an ORCID iD such as"),
        ("summary", "two\u2028lines", "summary: got 'two\\u2028lines', need one line of text"),
        ("keywords", [], "keywords: got [], need one or more, each once"),
        ("keywords", ["oil", "oil"], "keywords: got ['oil', 'oil'], need one or more, each once"),
        ("doi", "doi.org/10.5281/1", "doi: got 'doi.org/10.5281/1', need a DOI such as 10."),
        ("doi", '10.5281/zenodo.1"<>&x', "need a DOI such as 10."),
        ("doi", "10.٥٢٨١/zenodo.1", "need a DOI such as 10."),
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
