"""Check an archive: the sums of its files, their contents, and their origin.

Every check yields one line for each thing that is wrong.
"""

import contextlib
import json
import os
import shutil
import tempfile
import zipfile
import zlib
from collections.abc import Iterator
from pathlib import Path

from lube.archive.build import SUMS, VALUES, files_of, values_text
from lube.errors import DataError, LubeError, shown
from lube.pipeline.figures import wrong_figures
from lube.storage.netcdf import load
from lube.storage.provenance import REMEDY, descriptive_attributes, fingerprint, json_attribute
from lube.study.study import load_study
from lube.types import File

_OF_BROWSERS = (".DS_Store", "Thumbs.db", "desktop.ini")


@contextlib.contextmanager
def unpacked(path: File) -> Iterator[Path]:
    """Open an archive, zipped or not.

    Parameters
    ----------
    path : str or Path
        Folder or zip.

    Yields
    ------
    Path
        Its folder; a zip is unpacked into a temporary one.

    Raises
    ------
    DataError
        If it does not exist, is neither a folder nor a zip, cannot be unpacked, or is not an
        archive.
    """
    path = Path(path)
    if not path.exists():
        raise DataError(f"{path}: no such archive; `snakemake archive` makes it")
    with tempfile.TemporaryDirectory(prefix="lube-") as scratch:
        folder = path
        if not path.is_dir():
            folder = Path(scratch)
            try:
                shutil.unpack_archive(path, scratch, "zip")
            except (OSError, zipfile.BadZipFile, zlib.error) as error:
                raise DataError(f"{path}: neither a folder nor a complete zip ({error})") from None
        # A zip may have been packed with folders around the archive's. The archive deep in a folder
        # of results is only a copy of what was asked about.
        below = [SUMS, f"*/{SUMS}"] if folder == path else [f"**/{SUMS}"]
        found = [sums for pattern in below for sums in folder.glob(pattern)]
        roots = sorted(found, key=lambda sums: len(sums.parts))
        if not roots:
            raise DataError(f"{path}: not an archive: {SUMS} is missing")
        yield roots[0].parent


def verify_archive(folder: File) -> list[str]:
    """Check the sums of an archive's files, their contents and their origin.

    Parameters
    ----------
    folder : str or Path
        The archive, from `unpacked`.

    Returns
    -------
    list of str
        What is wrong, one line each, with paths below the archive; empty if nothing is.
    """
    folder = Path(folder).resolve()
    # A later check would only repeat what an earlier one found.
    for check in (_wrong_sums, _wrong_datasets, _wrong_figures):
        wrong = [line.replace(f"{folder}{os.sep}", "") for line in check(folder)]
        if wrong:
            return [line.removesuffix(REMEDY) for line in wrong]
    return []


def _sums(folder):
    """SHA-256 sum of each file, as the archive states it."""
    lines = (folder / SUMS).read_text(encoding="utf-8", errors="replace").splitlines()
    return {name: sha for sha, _, name in (line.partition("  ") for line in lines)}


def _wrong_sums(folder):
    """Compare every file with its SHA-256 sum."""
    sums, present = _sums(folder), set(files_of(folder)) - {SUMS}
    for name, expected in sums.items():
        if name not in present:
            yield f"{name}: missing"
        elif fingerprint(folder / name) != expected:
            yield f"{name}: changed: its SHA-256 is not the one in {SUMS}"
    for name in sorted(present - set(sums)):
        # Running the archived code leaves files, and so do file browsers.
        if not name.startswith("code/") and Path(name).name not in _OF_BROWSERS:
            yield f"{name}: does not belong to the archive: not in {SUMS}"


def _wrong_datasets(folder):
    """Check that the study can be read and that every dataset is complete and of this study."""
    text = (folder / VALUES).read_text(encoding="utf-8")
    study_file = json.loads(text)["study_file"]
    try:
        study = load_study(folder / "study" / study_file)
    except LubeError as error:
        yield str(error)
        return
    kinds = study.datasets_in(folder / "data")
    for kind in kinds:
        path = folder / "data" / f"{kind}.nc"
        try:
            yield from _wrong_origin(load(path, kind, study), path, kind, study)
        except DataError as error:
            yield str(error)
    if text != values_text(study, study_file, kinds):
        yield f"{VALUES}: not what study/{study_file} says"


def _wrong_origin(dataset, path, kind, study):
    """Check that a dataset names this study and was made from the archive's files."""
    for name, needed in descriptive_attributes(study, kind).items():
        if dataset.attrs.get(name) != needed:
            yield f"{path}: {name} is {shown(dataset.attrs.get(name))}, need {shown(needed)}"
    made_from = json_attribute(dataset, "inputs_sha256", path)
    if kind == "experiment" and study.experiment.manifest is not None:
        # The measured records themselves are not in the archive.
        files = [path.with_name("film.nc"), Path(study.experiment.manifest)]
        other = [file.name for file in files if fingerprint(file) not in made_from.values()]
    else:
        sums = _sums(path.parents[1]).items()
        folders = ("data/", "lubricants/", "study/")
        archived = {sha for name, sha in sums if name.startswith(folders)}
        other = [name for name, sha in made_from.items() if sha not in archived]
    for name in other:
        yield f"{path}: was made from another {name} than the archive's"


def _wrong_figures(folder):
    """Check that the figures were drawn from these datasets."""
    figures = sorted(path.stem for path in (folder / "notebooks").glob("*.ipynb"))
    yield from wrong_figures(figures, folder, folder / "data")
