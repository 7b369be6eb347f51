"""Whether an archive is what it was, and whether what is in it hangs together.

Every check yields one line for each thing that is wrong; silence is a good answer.
"""

import contextlib
import errno
import json
import os
import tempfile
import zipfile
import zlib
from pathlib import Path
from urllib.parse import unquote

from lube.archive.build import SUMS, VALUES, check_is_archive, files_of, values_text
from lube.archive.crate import CATALOGUE
from lube.errors import DataError, LubeError, shown
from lube.schema import DATASETS
from lube.storage.files import why_not
from lube.storage.netcdf import opened
from lube.storage.provenance import WAY_OUT, fingerprint, names_of, told_inputs
from lube.storage.seals import holds
from lube.study.study import load_study
from lube.workflow.figures import wrong_figures

_INPUTS = ("data/", "lubricants/")
_DRAWN = ("figures/", "notebooks/")

# What Python's zipfile says of a file that is none, damaged, or locked by a password.
_UNREADABLE = (OSError, EOFError, ValueError, RuntimeError, zipfile.BadZipFile, zlib.error)


@contextlib.contextmanager
def unpacked(path):
    """Open an archive, zipped or not.

    Parameters
    ----------
    path : str or Path
        Folder or zip.

    Yields
    ------
    Path
        Its folder; that of a zip is there for the time being.

    Raises
    ------
    DataError
        If it is neither, or not there.
    """
    path = Path(path)
    if not path.exists():
        raise DataError(f"{path}: no such archive; `snakemake archive` makes it")
    if path.is_dir():
        yield path
        return
    if not path.is_file():  # to open a pipe may take forever
        raise DataError(f"{path}: neither an archive's folder nor its zip")
    with tempfile.TemporaryDirectory(prefix="lube-") as scratch:
        try:
            with zipfile.ZipFile(path) as packed:
                packed.extractall(scratch)  # which keeps every entry below the folder
        except _UNREADABLE as error:
            if isinstance(error, OSError) and error.errno == errno.ENOSPC:
                told = f"cannot be unpacked: {why_not(error, Path(scratch) / path.name)}"
            else:
                told = f"neither an archive's folder nor its zip ({error})"
            raise DataError(f"{path}: {told}") from None
        yield _root(Path(scratch), path)


def _root(scratch, path):
    """Find the archive in what was in a zip, whoever packed it: with its folder or without."""
    roots = [sums.parent for depth in ("", "*/", "*/*/") for sums in scratch.glob(depth + SUMS)]
    if not roots:
        raise DataError(f"{path}: not an archive: {SUMS} is missing")
    return roots[0]


def verify_archive(folder):
    """Check an archive: fingerprints, catalogue, study, datasets, figures, how they hang together.

    Parameters
    ----------
    folder : str or Path
        The unpacked archive.

    Returns
    -------
    list of str
        What is wrong, a line each; empty if all is as it should be. Files are told by their
        places in the archive.

    Raises
    ------
    DataError
        If it is no archive.
    """
    check_is_archive(folder)
    folder = Path(folder).resolve()
    # What one finds wrong, the next would only repeat.
    for look in (_wrong_sums, _wrong_catalogue, _wrong_datasets, _wrong_figures):
        wrong = [line.replace(f"{folder}{os.sep}", "") for line in look(folder)]
        if wrong:
            return [line.removesuffix(WAY_OUT) for line in wrong]
    return []


def _sums(folder):
    """Fingerprints by file, as the archive tells them."""
    lines = (folder / SUMS).read_text(encoding="utf-8").split("\n")
    pairs = [line.rstrip("\r").split("  ", 1) for line in lines]
    return {pair[1]: pair[0] for pair in pairs if len(pair) == 2}


def _wrong_sums(folder):
    """Compare every file with its fingerprint."""
    try:
        sums = _sums(folder)
    except (OSError, ValueError):
        yield f"{SUMS}: damaged"
        return
    there = set(files_of(folder)) - {SUMS}
    for name, expected in sums.items():
        if name not in there:
            yield f"{name}: missing"
        elif not (folder / name).is_file() or fingerprint(folder / name) != expected:
            yield f"{name}: not what it was: its SHA-256 is not the one in {SUMS}"
    for name in sorted(there - set(sums)):
        if not _is_byproduct(name):
            yield f"{name}: does not belong to the archive: not in {SUMS}"


def _is_byproduct(name):
    """Whether a file appears when an archive is looked at, or its code installed and run."""
    folder, *parts = name.split("/")
    if folder == "code" and parts:
        return parts[0] in ("build", "lube.egg-info") or "__pycache__" in parts
    return [folder, *parts][-1] in (".DS_Store", "Thumbs.db", "desktop.ini")


def _wrong_catalogue(folder):
    """Compare the files with what the catalogue lists; the code it lists as a whole."""
    try:
        graph = json.loads((folder / CATALOGUE).read_text(encoding="utf-8"))["@graph"]
        listed = {unquote(each["@id"]) for each in graph if each["@type"] in ("File", "Dataset")}
    except (OSError, ValueError, KeyError, TypeError, RecursionError):
        yield f"{CATALOGUE}: missing or damaged"
        return
    named = set(_sums(folder))
    folders = {name.split("/")[0] + "/" for name in named if "/" in name}
    there = {name for name in named if not name.startswith("code/")} | folders
    for name in sorted((listed ^ there) - {CATALOGUE, "./"}):
        told = "missing" if name in listed else "does not belong to the archive"
        yield f"{name}: {told}, by {CATALOGUE}"


def _wrong_datasets(folder):
    """Check the study, and that every dataset is whole, by its schema, and of this study."""
    try:
        text = (folder / VALUES).read_text(encoding="utf-8")
        study_file = json.loads(text)["study_file"]
        study = load_study(folder / "study" / study_file)
    except (OSError, ValueError, KeyError, TypeError, RecursionError):
        yield f"{VALUES}: missing or damaged"
        return
    except LubeError as error:
        yield str(error)
        return
    for kind in DATASETS:
        path = folder / "data" / f"{kind}.nc"
        try:
            if holds(path) is None:
                yield f"{path}: has no seal: not as lube saved it"
                continue
            with opened(path, kind, study, raw=False) as dataset:
                dataset.load()  # every chunk has a checksum
                yield from _wrong_names(dataset, path, names_of(study, kind))
                yield from _wrong_inputs(dataset, path, kind, study)
        except (OSError, DataError) as error:
            yield str(error)
    if text != values_text(study, DATASETS, study_file):
        yield f"{VALUES}: not what study/{study_file} says"


def _wrong_figures(folder):
    """Compare figures and executed notebooks with what the workflow made of the datasets."""
    drawn = {Path(name).stem for name in _sums(folder) if name.startswith(_DRAWN)}
    yield from wrong_figures(sorted(drawn), folder, folder / "data")


def _wrong_names(dataset, path, wanted):
    """Compare what a dataset says of its study and makers with the study."""
    for name, needed in wanted.items():
        if dataset.attrs.get(name) != needed:
            yield f"{path}: {name} is {shown(dataset.attrs.get(name))}, need {shown(needed)}"


def _wrong_inputs(dataset, path, kind, study):
    """Compare what a dataset says of the files it was made from with those files."""
    told = told_inputs(dataset, path)
    if kind == "experiment" and study.experiment.manifest is not None:
        # The measured records, of whatever names, are not in the archive.
        files = [path.with_name("film.nc"), Path(study.experiment.manifest)]
        wrong = [file.name for file in files if fingerprint(file) not in told.get(file.name, ())]
    else:
        sums = _sums(path.parents[1])
        at_hand = {digits for name, digits in sums.items() if name.startswith(_INPUTS)}
        wrong = [name for name, digits in told.items() if not digits <= at_hand]
    for name in wrong:
        yield f"{path}: was made from another {name} than the archive's"
