"""The catalogue of an archive: an RO-Crate, which says what each of its files is."""

import json
import mimetypes

from rocrate.model import ContextEntity, File, Person
from rocrate.model.dataset import Dataset
from rocrate.rocrate import ROCrate

from lube.about import LICENCES
from lube.citation import publication_date
from lube.provenance import title_of
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

_FOLDERS = {
    "data/": "the datasets, NetCDF by the CF and ACDD conventions",
    "figures/": "each figure as PNG and PDF",
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
