"""How an archive is cited: CITATION.cff, and the metadata for Zenodo."""

import datetime
import html
import json
from importlib.metadata import version

import yaml

from lube.errors import StudyError
from lube.storage.git import commit_date
from lube.study.metadata import PAPER
from lube.study.study import Study


def publication_date(study: Study) -> datetime.date:
    """Date of publication of an archive: the study's date, or else the date of the commit.

    Parameters
    ----------
    study : Study
        The study.

    Returns
    -------
    datetime.date
        The date.

    Raises
    ------
    StudyError
        If neither is known.
    """
    date = study.about.date or commit_date()
    if date is None:
        raise StudyError(
            "about.date: missing, and the code has no commit whose date could be taken"
        )
    return datetime.date.fromisoformat(str(date))


def check_about(study: Study) -> None:
    """Check that a study names its creators and its date, as an archive needs them.

    Parameters
    ----------
    study : Study
        The study.

    Raises
    ------
    StudyError
        If one of them is missing.
    """
    if not study.about.creators:
        example = "about: {creators: [{name: 'Family, Given'}]}"
        raise StudyError(f"about.creators: missing, an archive needs one at least, as in {example}")
    publication_date(study)


def citation_file(study: Study) -> str:
    """Write CITATION.cff, by the Citation File Format 1.2.0.

    Parameters
    ----------
    study : Study
        The study.

    Returns
    -------
    str
        YAML.
    """
    about, authors = study.about, [{"name": "The authors of lube"}]
    content = {
        "cff-version": "1.2.0",
        "message": "If you use these results, please cite them and the paper whose model they use.",
        "type": "dataset",
        "title": study.title,
        "authors": [_cff_person(creator) for creator in about.creators],
        "abstract": about.summary,
        "keywords": list(about.keywords),
        "license": about.licence,
        "date-released": publication_date(study),
        **({"doi": about.doi} if about.doi else {}),
        "references": [
            {"type": "article", "title": PAPER, "authors": [{"name": "The authors of the paper"}]},
            {"type": "software", "title": "lube", "version": version("lube"), "authors": authors},
        ],
    }
    return yaml.safe_dump(content, sort_keys=False, allow_unicode=True, width=90)


def _cff_person(creator):
    family, comma, given = (part.strip() for part in creator.name.partition(","))
    names = {"family-names": family, "given-names": given} if comma else {"name": creator.name}
    if comma and creator.affiliation:
        names["affiliation"] = creator.affiliation  # CFF has no affiliation of an entity
    return names | ({"orcid": f"https://orcid.org/{creator.orcid}"} if creator.orcid else {})


def zenodo_metadata(study: Study) -> str:
    """Write .zenodo.json, the metadata of a deposit on Zenodo.

    Parameters
    ----------
    study : Study
        The study.

    Returns
    -------
    str
        JSON.
    """
    about = study.about
    content = {
        "upload_type": "dataset",
        "title": study.title,
        "description": f"<p>{html.escape(about.summary)}</p><p>The model is that of: {PAPER}.</p>",
        "creators": [creator.model_dump(exclude_none=True) for creator in about.creators],
        "publication_date": publication_date(study).isoformat(),
        "access_right": "open",
        "license": about.licence.lower(),
        "keywords": list(about.keywords),
        "notes": "Made with lube. README.md explains how to check it and draw the figures again.",
        **({"doi": about.doi} if about.doi else {}),
    }
    return json.dumps(content, indent=2, ensure_ascii=False) + "\n"
