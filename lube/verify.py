"""Whether a study's files, or an archive of them, are what they were and hang together.

Every check yields one line for each thing that is wrong; silence is a good answer.
"""

import contextlib
import json
import os
import tempfile
import zipfile
import zlib
from collections import defaultdict
from pathlib import Path

from lube.archive import SUMS, VALUES, files_of
from lube.errors import DataError, LubeError, shown
from lube.io import opened
from lube.notebooks import execute_notebook, parameters_of
from lube.provenance import fingerprint, makers_of, told_inputs
from lube.study import load_study

_BYPRODUCTS = ("code/build/", "code/lube.egg-info/", "__pycache__")
"""What appears in an archive's folder when its code is installed and run."""

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
    with tempfile.TemporaryDirectory(prefix="lube-") as scratch:
        try:
            with zipfile.ZipFile(path) as packed:
                packed.extractall(scratch)  # which keeps every entry below the folder
        except _UNREADABLE as error:
            raise DataError(f"{path}: neither an archive's folder nor its zip ({error})") from None
        inside = [folder for folder in Path(scratch).iterdir() if folder.is_dir()]
        if len(inside) != 1:
            raise DataError(f"{path}: not an archive: it holds {len(inside)} folders, need one")
        yield inside[0]


def verify_archive(folder):
    """Check an archive: fingerprints, datasets, and how they hang together.

    Parameters
    ----------
    folder : str or Path
        The unpacked archive.

    Returns
    -------
    list of str
        What is wrong, a line each; empty if all is well.

    Raises
    ------
    DataError
        If it is no archive.
    """
    folder = Path(folder)
    _check_is_archive(folder)
    wrong = list(_wrong_sums(folder))
    if wrong:
        return wrong  # anything else would only repeat it
    try:
        told = json.loads((folder / VALUES).read_text(encoding="utf-8"))
        study_file, kinds = folder / "study" / told["study_file"], list(told["config_sha256"])
    except (OSError, ValueError, KeyError, TypeError):
        return [f"{VALUES}: missing or damaged"]
    records = [path for path in folder.glob("lubricants/**/*") if path.is_file()]
    return [*verify_datasets(folder / "data", study_file, kinds, records)]


def _check_is_archive(folder):
    if not (folder / SUMS).is_file():
        raise DataError(f"{folder}: not an archive: {SUMS} is missing")


def _wrong_sums(folder):
    """Compare every file with its fingerprint."""
    try:
        lines = (folder / SUMS).read_text(encoding="utf-8").splitlines()
    except (OSError, ValueError):
        yield f"{SUMS}: damaged"
        return
    sums = dict(reversed(line.split("  ", 1)) for line in lines if "  " in line)
    there = set(files_of(folder)) - {SUMS}
    for name, expected in sums.items():
        if name not in there:
            yield f"{name}: missing"
        elif fingerprint(folder / name) != expected:
            yield f"{name}: not what it was: its SHA-256 is not the one in {SUMS}"
    for name in sorted(there - set(sums)):
        if not any(known in name for known in _BYPRODUCTS):
            yield f"{name}: does not belong to the archive: not in {SUMS}"


def verify_datasets(folder, study_file, kinds, records=()):
    """Check a study's datasets: each whole and by its schema, all of one study.

    Parameters
    ----------
    folder : str or Path
        Folder of the datasets.
    study_file : str or Path
        The study that they must follow from.
    kinds : iterable of str
        Which datasets there must be.
    records : iterable of Path, optional
        Files of its lubricant records.

    Yields
    ------
    str
        What is wrong, a line each.
    """
    folder, kinds = Path(folder), list(kinds)
    try:
        study = load_study(study_file)
    except LubeError as error:
        yield str(error)
        return
    inputs = defaultdict(list)
    for path in (*records, *(folder / f"{kind}.nc" for kind in kinds)):
        if path.is_file():
            inputs[path.name].append(path)
    for kind in kinds:
        path = folder / f"{kind}.nc"
        try:
            with opened(path, kind, study, raw=False) as dataset:
                dataset.load()  # every chunk has a checksum
                yield from _wrong_names(dataset, path, study)
                yield from _wrong_inputs(dataset, path, inputs)
        except DataError as error:
            yield str(error)


def _wrong_names(dataset, path, study):
    """Compare what a dataset says of its study and makers with the study."""
    wanted = {"study": study.name, "creator_name": makers_of(study)}
    for name, needed in wanted.items():
        if dataset.attrs.get(name) != needed:
            yield f"{path}: {name} is {shown(dataset.attrs.get(name))}, need {shown(needed)}"


def _wrong_inputs(dataset, path, inputs):
    """Compare what a dataset says of the files it was made from with those files."""
    for name, known in told_inputs(dataset, path).items():
        for file in inputs.get(name, ()):
            if fingerprint(file) not in known:
                yield f"{path}: was made from another {name} than {file}"


def redraw(folder, target, figures=()):
    """Draw figures of an archive again, from its datasets and notebooks alone.

    Parameters
    ----------
    folder : str or Path
        The unpacked archive.
    target : str or Path
        Where the new figures go, outside the archive.
    figures : iterable of str, optional
        Which figures, such as ``fig02_film``; all if none is named.

    Yields
    ------
    str, bool
        Name of a file, such as ``fig02_film.png``, and whether it equals the archived one, byte
        for byte.

    Raises
    ------
    LubeError
        If it is no archive, there is no such figure, or its notebook cannot be executed.
    """
    folder, target = Path(folder).resolve(), Path(target).resolve()
    _check_is_archive(folder)
    if target.is_relative_to(folder):
        raise DataError(f"got {target} for the new figures, need a folder outside the archive")
    archived = sorted(path.stem for path in (folder / "figures").glob("*.png"))
    for figure in figures:
        if figure not in archived:
            raise DataError(f"got {figure}, need a figure of the archive: {', '.join(archived)}")
    with _code_first(folder / "code"):
        for figure in figures or archived:
            notebook = folder / "code/notebooks" / f"{figure}.ipynb"
            paths = {path.stem: path for path in (folder / "data").glob("*.nc")}
            paths |= {"figure": target / figure}
            # What else stands in its cell keeps its value, as in the workflow.
            names = [name for name in parameters_of(notebook) if name in paths]
            parameters = {name: str(paths[name]) for name in names}
            execute_notebook(notebook, target / notebook.name, parameters)
            for name in (f"{figure}.png", f"{figure}.pdf"):
                yield name, (target / name).read_bytes() == (folder / "figures" / name).read_bytes()


@contextlib.contextmanager
def _code_first(code):
    """Let notebooks use the archived code, whatever else is installed."""
    before = os.environ.get("PYTHONPATH")
    os.environ["PYTHONPATH"] = os.pathsep.join(filter(None, [str(code), before]))
    try:
        yield
    finally:
        del os.environ["PYTHONPATH"]
        if before is not None:
            os.environ["PYTHONPATH"] = before
