"""Whose study it is and under which licence: what its files and its archive say of themselves."""

import datetime
import re
from typing import Annotated, Literal

from pydantic import AfterValidator, BeforeValidator, Field, StringConstraints, model_validator

from lube.errors import shown
from lube.study.field_types import StrictModel

PAPER = "Mixed and boundary lubrication in rolling contact: experiment and simulation"
"""Title of the paper whose model and operating points the study takes."""

LICENCES = {
    "CC-BY-4.0": "https://creativecommons.org/licenses/by/4.0/",
    "CC-BY-SA-4.0": "https://creativecommons.org/licenses/by-sa/4.0/",
    "CC0-1.0": "https://creativecommons.org/publicdomain/zero/1.0/",
}
"""Licences for data that Zenodo and its like know, by their SPDX names."""


def _text(pattern, needed):
    """Field type for a text of a given form."""

    def check(text):
        if not re.fullmatch(pattern, text, re.ASCII):
            raise ValueError(f"got {shown(text)}, need {needed}")
        return text

    return Annotated[str, StringConstraints(strip_whitespace=True), AfterValidator(check)]


def _day(value):
    """Read a day; YAML makes one of 2026-11-21, and a number is none."""
    try:
        return value if type(value) is datetime.date else datetime.date.fromisoformat(value)
    except (TypeError, ValueError):
        came = value if isinstance(value, datetime.datetime) else shown(value)
        raise ValueError(f"got {came}, need a day such as 2026-11-21") from None


def _true_orcid(orcid):
    """Refuse an ORCID iD with a slip of the pen, by its last digit (ISO 7064, MOD 11-2)."""
    *digits, last = orcid.replace("-", "")
    total = 0
    for digit in digits:
        total = 2 * (total + int(digit))
    if "0123456789X"[(12 - total % 11) % 11] != last:
        raise ValueError(f"got {shown(orcid)}, need an ORCID iD whose last digit fits the others")
    return orcid


_Line = _text(
    r"[^\x00-\x1f\x7f-\x9f\u2028\u2029]{1,2000}", "one line of text, 2000 letters at most"
)
_Orcid = Annotated[
    _text(r"\d{4}-\d{4}-\d{4}-\d{3}[\dX]", "an ORCID iD such as 0000-0002-1825-0097"),
    AfterValidator(_true_orcid),
]
_Day = Annotated[datetime.date, BeforeValidator(_day)]
# The characters that CITATION.cff allows.
_Doi = _text(
    r"10\.\d{4,9}(\.\d+)?/[\w:/;.()\[\]\\-]{1,200}", "a DOI such as 10.5281/zenodo.1234567"
)


def _cited(name):
    """Refuse half a name."""
    if not all(part.strip() for part in name.split(",", 1)):
        raise ValueError(f"got {shown(name)}, need 'Family, Given', or a name without a comma")
    return name


def _once(values):
    """Refuse a list that is empty or says something twice."""
    if not values or len(set(values)) < len(values):
        raise ValueError(f"got {shown(list(values))}, need one or more, each once")
    return values


class Creator(StrictModel):
    """Someone who made a study."""

    name: Annotated[_Line, AfterValidator(_cited)] = Field(
        description="as it is cited: `Family, Given`"
    )
    affiliation: _Line | None = Field(None, description="institution")
    orcid: _Orcid | None = Field(None, description="ORCID iD, such as 0000-0002-1825-0097")

    @model_validator(mode="before")
    @classmethod
    def _check_quotes(cls, content):
        # For YAML {name: Somebody, Else} has two keys, the second without a value.
        if isinstance(content, dict):
            for key in content:
                if key not in cls.model_fields and content[key] is None:
                    raise ValueError(
                        f"got {shown(key)} without a value, need quotes where a name has a comma: "
                        "{name: 'Family, Given'}"
                    )
        return content


class About(StrictModel):
    """Title, makers and licence of a study's results."""

    title: _Line | None = Field(None, description="title of the results; else the study's name")
    summary: _Line = Field(
        "Share of time with metal contact between two rough rollers that roll under load with oil "
        "between them: elastohydrodynamic film thickness, rough lines by the Method of "
        "Dimensionality Reduction, and the break-up of a boundary layer.",
        description="what the results are, in a sentence or two",
    )
    creators: tuple[Creator, ...] = Field(
        (), description="who made them; an archive needs one at least"
    )
    licence: Literal[tuple(LICENCES)] = Field("CC-BY-4.0", description="licence of the results")
    keywords: Annotated[tuple[_Line, ...], AfterValidator(_once)] = Field(
        (
            *("tribology", "mixed lubrication", "boundary lubrication"),
            *("elastohydrodynamic lubrication", "rolling contact", "surface roughness"),
        ),
        description="keywords",
    )
    date: _Day | None = Field(
        None, description="day of publication, for the archive; else that of the code's commit"
    )
    doi: _Doi | None = Field(None, description="DOI that the repository reserved for the archive")

    @model_validator(mode="after")
    def _check_creators(self):
        people = [tuple(dict(one).items()) for one in self.creators]
        orcids = [one.orcid for one in self.creators if one.orcid is not None]
        for what, known in (("somebody", people), ("an ORCID iD", orcids)):
            if len(set(known)) < len(known):
                raise ValueError(f"creators: got {what} twice, need each once")
        return self

    @property
    def in_files(self):
        """What every file of the study says; the rest concerns the archive alone."""
        passing = {"date": True, "doi": True, "creators": {"__all__": {"orcid"}}}
        return self.model_dump(mode="json", exclude=passing)
