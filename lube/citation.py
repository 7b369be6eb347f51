"""How an archive is cited and catalogued: CITATION.cff, Zenodo's metadata, and an RO-Crate."""

import datetime
import html
import json
import mimetypes
from importlib.metadata import version

import yaml
from rocrate.model import ContextEntity, File, Person
from rocrate.model.dataset import Dataset
from rocrate.rocrate import ROCrate

from lube.about import LICENCES, PAPER
from lube.errors import StudyError
from lube.provenance import title_of
from lube.repository import commit_date
from lube.schema import SUMMARIES

RO_CRATE = "1.3"
"""Version of the RO-Crate specification that the archive follows."""

_FORMATS = {
    ".nc": "application/netcdf",
    ".ipynb": "application/x-ipynb+json",
    ".yaml": "application/yaml",
    ".cff": "application/yaml",
    ".smk": "text/plain",
    ".md": "text/markdown",
}


def publication_date(study):
    """Day that an archive bears.

    Parameters
    ----------
    study : Study
        The study.

    Returns
    -------
    datetime.date
        As the study says; else that of the code's commit.

    Raises
    ------
    StudyError
        If neither is known.
    """
    if study.about.date is not None:
        return study.about.date
    if commit_date() is None:
        raise StudyError(
            "about.date: missing, and the code has no commit whose day could stand for it; need "
            "the day of publication, such as 2026-11-21"
        )
    return datetime.date.fromisoformat(commit_date())


def check_about(study):
    """Refuse a study that does not say enough of itself for an archive.

    Parameters
    ----------
    study : Study
        The study.

    Raises
    ------
    StudyError
        If it names no creators, or there is no day of publication.
    """
    if not study.about.creators:
        raise StudyError(
            "about.creators: missing, an archive needs someone who made it, such as "
            "about: {creators: [{name: 'Family, Given'}]}"
        )
    publication_date(study)


def citation_file(study):
    """Text of CITATION.cff, by the Citation File Format 1.2.0.

    Parameters
    ----------
    study : Study
        The study.

    Returns
    -------
    str
        YAML.
    """
    about = study.about
    content = {
        "cff-version": "1.2.0",
        "message": "If you use these results, please cite them and the paper whose model they use.",
        "type": "dataset",
        "title": title_of(study),
        "authors": [_cff_person(creator) for creator in about.creators],
        "abstract": about.summary,
        "keywords": list(about.keywords),
        "license": about.licence,
        "date-released": publication_date(study),
        **({"doi": about.doi} if about.doi else {}),
        "references": [
            {"type": "article", "title": PAPER, "authors": [{"name": "The authors of the paper"}]},
            {
                "type": "software",
                "title": "lube",
                "version": version("lube"),
                "authors": [{"name": "The authors of lube"}],
            },
        ],
    }
    return yaml.safe_dump(content, sort_keys=False, allow_unicode=True, width=90)


def _cff_person(creator):
    family, comma, given = (part.strip() for part in creator.name.partition(","))
    names = {"family-names": family, "given-names": given} if comma else {"name": creator.name}
    if comma and creator.affiliation:
        names["affiliation"] = creator.affiliation  # CFF has none for an entity
    return names | ({"orcid": f"https://orcid.org/{creator.orcid}"} if creator.orcid else {})


def zenodo_metadata(study):
    """Text of .zenodo.json, the metadata of a deposit on Zenodo.

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
        "title": title_of(study),
        "description": f"<p>{html.escape(about.summary)}</p><p>The model is that of: {PAPER}.</p>",
        "creators": [creator.model_dump(exclude_none=True) for creator in about.creators],
        "publication_date": publication_date(study).isoformat(),
        "access_right": "open",
        "license": about.licence.lower(),
        "keywords": list(about.keywords),
        "notes": "Made with lube. README.md tells how to check the files and make the figures "
        "again.",
        **({"doi": about.doi} if about.doi else {}),
    }
    return json.dumps(content, indent=2, ensure_ascii=False) + "\n"


def crate_metadata(study, files):
    """Text of ro-crate-metadata.json: what each file of an archive is.

    Parameters
    ----------
    study : Study
        The study.
    files : dict
        From the path of each file below the archive's root, with slashes, to its size in bytes.

    Returns
    -------
    str
        JSON-LD by RO-Crate 1.3.
    """
    about, crate = study.about, ROCrate(version=RO_CRATE)
    crate.name, crate.description = title_of(study), about.summary
    crate.datePublished = publication_date(study)
    crate.keywords = ", ".join(about.keywords)
    crate.license = crate.add(_licence(crate, about.licence))
    crate.creator = [
        crate.add(_person(crate, creator, number)) for number, creator in enumerate(about.creators)
    ]
    if about.doi:
        crate.root_dataset["identifier"] = f"https://doi.org/{about.doi}"
    folders = {
        folder: crate.add(Dataset(crate, None, folder, properties=_folder(folder)))
        for folder in sorted({_folder_of(path) for path in files} - {""})
    }
    for path, size in sorted(files.items()):
        if _folder_of(path) == "code/":
            continue  # described as a whole
        entity = crate.add(File(crate, None, path, properties=_described(path, size)))
        if _folder_of(path):
            folders[_folder_of(path)].append_to("hasPart", entity)
    return json.dumps(crate.metadata.generate(), indent=2, ensure_ascii=False) + "\n"


_FOLDERS = {
    "data/": "the datasets, NetCDF by the CF and ACDD conventions",
    "figures/": "each figure as PNG and PDF",
    "notebooks/": "the executed notebook of each figure",
    "study/": "the study as it was written, and its values as they were understood",
    "lubricants/": "the records of its lubricants",
    "code/": "the code that made everything, its workflow and the figures' notebooks: lube, "
    "under the licence in its file LICENSE",
}


def _licence(crate, licence):
    properties = {
        "@type": "CreativeWork",
        "name": licence,
        "description": f"The licence known as {licence}.",
    }
    return ContextEntity(crate, LICENCES[licence], properties=properties)


def _person(crate, creator, number):
    identifier = f"https://orcid.org/{creator.orcid}" if creator.orcid else f"#creator-{number + 1}"
    properties = {"name": creator.name}
    if creator.affiliation:
        properties["affiliation"] = creator.affiliation
    return Person(crate, identifier, properties=properties)


def _folder_of(path):
    """First folder of a path below the archive's root, with a slash; empty for a file there."""
    first, slash, _ = path.partition("/")
    return first + slash if slash else ""


def _folder(name):
    return {"name": name.rstrip("/"), "description": _FOLDERS[name]}


def _described(path, size):
    """Name, meaning, size and format of a file, for the catalogue."""
    folder, _, name = path.rpartition("/")
    stem, dot, suffix = name.rpartition(".")
    described = SUMMARIES[stem] if folder == "data" else _FOLDERS.get(_folder_of(path))
    guessed = _FORMATS.get(dot + suffix) or mimetypes.guess_type(name)[0] or "text/plain"
    return {
        "name": name,
        "description": described or "about the archive",
        "contentSize": str(size),
        "encodingFormat": guessed,
    }
