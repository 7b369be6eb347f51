"""The catalogue of an archive: an RO-Crate, which says what each of its files is."""

import json
import mimetypes
from urllib.parse import quote

from rocrate.model import ContextEntity, File, Person
from rocrate.model.dataset import Dataset
from rocrate.rocrate import ROCrate

from lube.archive.citation import publication_date
from lube.schema import SUMMARIES
from lube.storage.provenance import title_of
from lube.study.metadata import LICENCES

CATALOGUE = "ro-crate-metadata.json"
"""Name of the catalogue, as RO-Crate wants it."""
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

_FOLDERS = {
    "data/": "the datasets, NetCDF by the CF and ACDD conventions",
    "figures/": "each figure as PNG and PDF, and fingerprints of what it was drawn from",
    "notebooks/": "the executed notebook of each figure",
    "study/": "the study as it was written, and its values as they were understood",
    "lubricants/": "the records of its lubricants",
    "code/": "the code that made everything, its workflow and the figures' notebooks: lube, "
    "under the licence in its file LICENSE",
}


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
    people = [_person(crate, *numbered) for numbered in enumerate(about.creators, start=1)]
    crate.creator = _one_or_all(people)
    # Who makes it public: the first maker's institution, else the first maker.
    crate.publisher = people[0].get("affiliation") or people[0]
    if about.doi:
        crate.root_dataset["identifier"] = f"https://doi.org/{about.doi}"
    folders = {
        folder: crate.add(Dataset(crate, None, folder, properties=_folder(folder)))
        for folder in sorted({_folder_of(path) for path in files} - {""})
    }
    for path, size in sorted(files.items()):
        if _folder_of(path) != "code/":  # which is described as a whole
            crate.add(File(crate, None, path, properties=_described(path, size)))
    for name, folder in folders.items():
        parts = [file for file in crate.data_entities if _folder_of(file.id) == name != file.id]
        if parts:
            folder["hasPart"] = _one_or_all(parts)
    return json.dumps(crate.metadata.generate(), indent=2, ensure_ascii=False) + "\n"


def _licence(crate, licence):
    properties = {
        "@type": "CreativeWork",
        "name": licence,
        "description": f"The licence known as {licence}.",
    }
    return ContextEntity(crate, LICENCES[licence], properties=properties)


def _person(crate, number, creator):
    identifier = f"https://orcid.org/{creator.orcid}" if creator.orcid else f"#creator-{number}"
    person = crate.add(Person(crate, identifier, properties={"name": creator.name}))
    if creator.affiliation:
        properties = {"@type": "Organization", "name": creator.affiliation}
        # One entity, however many work there.
        name = f"#institution-{quote(creator.affiliation, safe='')}"
        institution = ContextEntity(crate, name, properties=properties)
        person["affiliation"] = crate.add(institution)
    return person


def _one_or_all(entities):
    """Reduce a list of one to its one, as RO-Crate wants it."""
    return entities[0] if len(entities) == 1 else entities


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
