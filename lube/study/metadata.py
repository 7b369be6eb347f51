"""Authors, title and licence of a study, for the attributes of its files and for its archive."""

import datetime
import re
from typing import Annotated, Literal

from pydantic import AfterValidator, Field, StringConstraints, field_validator

from lube.errors import shown
from lube.study.field_types import StrictModel, each_once, read_by

PAPER = "Mixed and boundary lubrication in rolling contact: experiment and simulation"
"""Title of the paper whose model every study uses."""

LICENCES = {
    "CC-BY-4.0": "https://creativecommons.org/licenses/by/4.0/",
    "CC-BY-SA-4.0": "https://creativecommons.org/licenses/by-sa/4.0/",
    "CC0-1.0": "https://creativecommons.org/publicdomain/zero/1.0/",
}
"""Licences for data that repositories such as Zenodo know, by their SPDX names."""

_KEYWORDS = (
    "tribology, mixed lubrication, boundary lubrication, elastohydrodynamic lubrication, "
    "rolling contact, surface roughness"
)


def _text(accepted, needed):
    """Field type for a text that a function accepts."""

    def check(text):
        if not accepted(text):
            raise ValueError(f"got {shown(text)}, need {needed}")
        return text

    return Annotated[str, StringConstraints(strip_whitespace=True), AfterValidator(check)]


def _is_orcid(text):
    """Whether a text has the form of an ORCID iD and its check digit (ISO 7064, MOD 11-2)."""
    if not re.fullmatch(r"\d{4}-\d{4}-\d{4}-\d{3}[\dX]", text, re.ASCII):
        return False
    *digits, last = text.replace("-", "")
    total = sum(int(digit) << (15 - place) for place, digit in enumerate(digits))
    return "0123456789X"[(12 - total % 11) % 11] == last


def _day(value):
    try:
        return datetime.date.fromisoformat(str(value))
    except ValueError:
        raise ValueError(f"got {shown(value)}, need a day such as 2026-11-21") from None


_Line = _text(lambda text: text and text.isprintable(), "one line of text")
_Name = _text(
    lambda text: text.isprintable() and all(part.strip() for part in text.split(",", 1)),
    "'Family, Given', or a name without a comma",
)
_Orcid = _text(_is_orcid, "an ORCID iD such as 0000-0002-1825-0097, whose last digit is a check")
_Day = Annotated[datetime.date, read_by(_day, {"type": ["string", "integer"], "format": "date"})]
# The characters that CITATION.cff allows.
_Doi = _text(
    re.compile(r"10\.\d{4,9}(\.\d+)?/[\w:/;.()\[\]\\-]{1,200}", re.ASCII).fullmatch,
    "a DOI such as 10.5281/zenodo.1234567",
)


class Creator(StrictModel):
    """An author of a study."""

    name: _Name
    """as it is cited: `Family, Given`"""
    affiliation: _Line | None = None
    """institution"""
    orcid: _Orcid | None = None
    """ORCID iD, such as 0000-0002-1825-0097"""


class About(StrictModel):
    """Title, authors and licence of a study's results."""

    title: _Line | None = None
    """title of the results; by default one with the study's name"""
    summary: _Line = (
        "Share of time with metal contact between two rough rollers that roll under load with oil "
        "between them: elastohydrodynamic film thickness, rough lines by the Method of "
        "Dimensionality Reduction or rough surfaces, and the break-up of a boundary layer."
    )
    """what the results are, in a sentence or two"""
    creators: tuple[Creator, ...] = ()
    """who made them; an archive needs at least one"""
    licence: Literal[tuple(LICENCES)] = "CC-BY-4.0"
    """licence of the results"""
    keywords: tuple[_Line, ...] = Field(tuple(_KEYWORDS.split(", ")), min_length=1)
    """keywords"""
    date: _Day | None = None
    """day of publication, for the archive; by default that of the code's commit"""
    doi: _Doi | None = None
    """DOI that the repository reserved for the archive"""

    _each_once = field_validator("keywords")(each_once)

    @field_validator("creators")
    @classmethod
    def _check_creators(cls, creators):
        each_once(tuple(one.orcid or f"{one.name}, {one.affiliation}" for one in creators))
        return creators

    @property
    def in_files(self) -> dict:
        """What every file states; the rest is for the archive alone."""
        only_archived = {"date": True, "doi": True, "creators": {"__all__": {"orcid"}}}
        return self.model_dump(mode="json", exclude=only_archived)
