"""The catalogue of an archive: an RO-Crate, which describes each of its files."""

import json
import mimetypes
from itertools import groupby
from pathlib import PurePosixPath
from urllib.parse import quote

from rocrate.model import ContextEntity, File, Person
from rocrate.model.dataset import Dataset
from rocrate.rocrate import ROCrate

from lube.archive.citation import publication_date
from lube.schema import SUMMARIES
from lube.study.metadata import LICENCES
from lube.study.study import Study

CATALOGUE = "ro-crate-metadata.json"
"""Name of the catalogue, given by the RO-Crate specification."""
RO_CRATE = "1.3"
"""Version of the RO-Crate specification that the archive follows."""

_FORMATS = {
    ".nc": "application/netcdf",
    ".ipynb": "application/x-ipynb+json",
    ".yaml": "application/yaml",
    ".cff": "application/yaml",
}

_FOLDERS = {
    "data": "the datasets, NetCDF by the CF and ACDD conventions",
    "figures": "each figure as PNG and PDF, and the SHA-256 sums of what it was drawn from",
    "notebooks": "the executed notebook of each figure",
    "study": "the study as it was written",
    "lubricants": "the lubricant records of the study",
    "code": "the code that made everything, its workflow and the figures' notebooks: lube, "
    "under the licence in its file LICENSE",
}


def crate_metadata(study: Study, files: dict[str, int]) -> str:
    """Write ro-crate-metadata.json, the description of each file of an archive.

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
    crate.name, crate.description = study.title, about.summary
    crate.datePublished = publication_date(study)
    crate.keywords = ", ".join(about.keywords)
    licence = {"name": about.licence, "description": f"The licence {about.licence}."}
    licence = ContextEntity(crate, LICENCES[about.licence], {"@type": "CreativeWork", **licence})
    crate.license = crate.add(licence)
    people = [_person(crate, *numbered) for numbered in enumerate(about.creators, start=1)]
    crate.root_dataset.append_to("creator", people, compact=True)
    # The publisher is the first creator's institution, or else that creator.
    crate.publisher = people[0].get("affiliation") or people[0]
    if about.doi:
        crate.root_dataset["identifier"] = f"https://doi.org/{about.doi}"
    for folder, paths in groupby(sorted(files, key=_folder_of), _folder_of):
        # The code has one description for its folder.
        listed = () if folder == "code" else sorted(paths)
        described = [crate.add(_file(crate, path, files[path])) for path in listed]
        if folder:
            properties = {"name": folder, "description": _FOLDERS[folder]}
            entity = crate.add(Dataset(crate, None, f"{folder}/", properties=properties))
            if described:
                entity.append_to("hasPart", described, compact=True)
    return json.dumps(crate.metadata.generate(), indent=2, ensure_ascii=False) + "\n"


def _person(crate, number, creator):
    identifier = f"https://orcid.org/{creator.orcid}" if creator.orcid else f"#creator-{number}"
    person = crate.add(Person(crate, identifier, properties={"name": creator.name}))
    if creator.affiliation:
        properties = {"@type": "Organization", "name": creator.affiliation}
        # Named after itself, so that creators of one institution share one entity.
        name = f"#institution-{quote(creator.affiliation, safe='')}"
        person["affiliation"] = crate.add(ContextEntity(crate, name, properties=properties))
    return person


def _folder_of(path):
    """First folder of a path below the archive's root; empty for a file in the root."""
    return path.rpartition("/")[0].partition("/")[0]


def _file(crate, path, size):
    name, folder = PurePosixPath(path), _folder_of(path)
    description = SUMMARIES[name.stem] if folder == "data" else _FOLDERS.get(folder)
    guessed = _FORMATS.get(name.suffix) or mimetypes.guess_type(path)[0] or "text/plain"
    properties = {"name": name.name, "description": description or "about the archive"}
    properties |= {"contentSize": str(size), "encodingFormat": guessed}
    return File(crate, None, path, properties=properties)
