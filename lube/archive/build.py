"""The archive of a study: everything a stranger needs to check it and draw its figures again.

An archive is a folder, and the same folder as a zip. It holds the datasets, figures and executed
notebooks, the study as written and as understood, the lubricant records, the code, the exact
versions of its libraries, a fingerprint of every file, and metadata for those who cite and
catalogue it. Nothing in it tells the hour: the same results make the same archive.
"""

import errno
import json
import os
import platform
import shutil
import zipfile
from collections import Counter
from importlib.metadata import distributions
from pathlib import Path

from lube.archive.citation import citation_file, zenodo_metadata
from lube.archive.crate import CATALOGUE, crate_metadata
from lube.archive.page import archive_page
from lube.errors import DataError, StudyError, shown
from lube.storage.files import scratch_beside, why_not, written_whole
from lube.storage.git import ROOT, code_files, commit
from lube.storage.netcdf import load
from lube.storage.provenance import config_text, digest, fingerprint
from lube.study.lubricant_record import shipped_records
from lube.study.resolve import resolved_content
from lube.workflow.figures import origin, products, wrong_figures

SUMS = "SHA256SUMS"
"""Name of the file of fingerprints, as ``sha256sum --check`` reads it."""
VALUES = "values.json"
"""Name of the file with the study's values, as they were understood."""


def make_archive(study, study_file, results, kinds, figures, folder):
    """Gather a study's results into an archive.

    Parameters
    ----------
    study : Study
        The study; it names its creators.
    study_file : str or Path
        Its YAML file.
    results : str or Path
        Folder of its results.
    kinds : sequence of str
        Datasets to take, by the kinds of `lube.schema`.
    figures : sequence of str
        Figures to take.
    folder : str or Path
        The archive; its zip and the zip's SHA-256 go beside it. What was there before is replaced
        when the new one is whole.

    Raises
    ------
    DataError
        If a result is missing, a figure or executed notebook is not as the workflow made it
        from these datasets, or the archive cannot be written.
    """
    folder = Path(folder)
    for wrong in wrong_figures(figures, results, results):
        raise DataError(wrong)
    contents = archive_contents(study, study_file, results, kinds, figures)
    try:
        with scratch_beside(folder) as scratch:
            new = scratch / folder.name
            _fill(new, contents, study)
            packed = folder.with_name(folder.name + ".zip")
            _zip(new, packed)
            if folder.exists():
                os.rename(folder, scratch / "old")
            os.rename(new, folder)
        with written_whole(packed.with_name(packed.name + ".sha256")) as part:
            part.write_text(f"{fingerprint(packed)}  {packed.name}\n", encoding="utf-8")
    except OSError as error:
        raise DataError(f"{folder}: cannot be archived: {_told(error, folder)}") from error


def _told(error, folder):
    """Tell why a file could not be read, or not be written."""
    if error.errno == errno.ENOENT:
        return f"{error.filename}: {error.strerror}"
    return why_not(error, folder)


def archive_contents(study, study_file, results, kinds, figures):
    """List what goes into an archive, but for its catalogue and its fingerprints.

    Parameters
    ----------
    study, study_file, results, kinds, figures
        As in `make_archive`.

    Returns
    -------
    dict
        From the name below the archive's root to the file to copy, or the text to write.
    """
    results = Path(results)
    datasets = {f"data/{kind}.nc": results / f"{kind}.nc" for kind in kinds}
    drawn = [name for figure in figures for name in (*products(figure), origin(figure))]
    written = written_files(study, study_file)
    archived_as = next(iter(written))
    return {
        **datasets,
        **{name: results / name for name in drawn},
        **{f"study/{name}": path for name, path in written.items()},
        **{f"lubricants/{name}": path for name, path in _records(study).items()},
        **{f"code/{name}": ROOT / name for name in code_files()},
        "code/COMMIT": commit() + "\n",
        VALUES: values_text(study, kinds, archived_as),
        "versions.txt": exact_versions(),
        "CITATION.cff": citation_file(study),
        ".zenodo.json": zenodo_metadata(study),
        "README.md": archive_page(study, kinds, archived_as, _refused(results, kinds)),
    }


def _refused(results, kinds):
    """Lines about the measured records of a study that were not used."""
    if "experiment" not in kinds:
        return ()
    return load(results / "experiment.nc", "experiment").attrs["refused"].splitlines()


def written_files(study, study_file):
    """Files of a study that people wrote, but for the measured records.

    Parameters
    ----------
    study : Study
        The study.
    study_file : str or Path
        Its YAML file.

    Returns
    -------
    dict
        From their places towards one another, with slashes, to the files: the study's file
        first, then lubricant records of its own and the list of its measured records.

    Raises
    ------
    StudyError
        If it names one of them by a path that would lead nowhere in an archive.
    """
    content = resolved_content(study_file)
    records = zip(content["lubricants"], study.lubricants, strict=True)
    named = {name: record.files for name, record in records if name not in shipped_records()}
    if study.experiment.manifest is not None:
        named[content["experiment"]["manifest"]] = (study.experiment.manifest,)
    for name in named:
        _check_path(name, study_file)
    own = {str(file) for files in named.values() for file in files}
    # As they are called, wherever links may lead.
    written = [Path(os.path.abspath(file)) for file in (study_file, *sorted(own))]
    folder = os.path.commonpath([path.parent for path in written])
    return {path.relative_to(folder).as_posix(): path for path in written}


def _check_path(name, study_file):
    """Refuse any way to a file but the straight one from the study's folder.

    Others hang on folders that are not archived: those above, those passed on the way.
    """
    here = os.path.abspath(Path(study_file).parent)
    straight = os.path.relpath(os.path.join(here, name), here)
    if Path(name) != Path(straight):
        raise StudyError(
            f"{study_file}: got {shown(name)}, need the straight path from the study's folder, "
            f"{shown(straight)}: any other leads nowhere in an archive"
        )


def _records(study):
    """Files of the lubricant records by their names, with the record's before one of several."""
    files = {Path(file): record.name for record in study.lubricants for file in record.files}
    times = Counter(file.name for file in files)
    return {
        file.name if times[file.name] == 1 else f"{name}/{file.name}": file
        for file, name in sorted(files.items())
    }


def values_text(study, kinds, study_file):
    """Tell a study as it was understood: the values behind each dataset, their fingerprints.

    Parameters
    ----------
    study : Study
        The study.
    kinds : sequence of str
        Its datasets.
    study_file : str
        Where its file stands in the archive's folder ``study``, with slashes.

    Returns
    -------
    str
        JSON.
    """
    texts = {kind: config_text(study, kind) for kind in kinds}
    values = {}
    for text in texts.values():
        values |= json.loads(text)
    content = {
        "study": study.name,
        "study_file": study_file,
        "seed": study.seed,
        "realisations": study.realisations,
        "about": study.about.in_files,
        "config_sha256": {kind: digest(text) for kind, text in texts.items()},
        "values": values,
    }
    return json.dumps(content, indent=1, sort_keys=True, ensure_ascii=False) + "\n"


def exact_versions():
    """Versions of Python and of all installed packages, fit for ``pip install -c``.

    Returns
    -------
    str
        One a line.
    """
    system = f"# Python {platform.python_version()}, {platform.system()} {platform.machine()}\n"
    installed = {f"{found.name}=={found.version}" for found in distributions()}
    kept = sorted((line for line in installed if not line.startswith("lube==")), key=str.lower)
    return system + "\n".join(kept) + "\n"


def check_is_archive(folder):
    """Refuse a folder that is no archive.

    Parameters
    ----------
    folder : str or Path
        The folder.

    Raises
    ------
    DataError
        If it has no fingerprints.
    """
    if not (Path(folder) / SUMS).is_file():
        raise DataError(f"{folder}: not an archive: {SUMS} is missing")


def files_of(folder):
    """List all files below a folder.

    Parameters
    ----------
    folder : str or Path
        The folder.

    Returns
    -------
    list of str
        Their paths below it, with slashes, in order; links and pipes as well.
    """
    folder, found = Path(folder), Path(folder).rglob("*")
    return sorted(
        path.relative_to(folder).as_posix()
        for path in found
        if path.is_symlink() or not path.is_dir()
    )


def _fill(folder, contents, study):
    """Write an archive's folder, its catalogue and its fingerprints."""
    for name, content in contents.items():
        path = folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        if isinstance(content, Path):
            shutil.copyfile(content, path)
        else:
            path.write_text(content, encoding="utf-8")
    sizes = {name: (folder / name).stat().st_size for name in files_of(folder)}
    catalogue = crate_metadata(study, sizes)
    (folder / CATALOGUE).write_text(catalogue, encoding="utf-8")
    sums = [f"{fingerprint(folder / name)}  {name}\n" for name in files_of(folder)]
    (folder / SUMS).write_text("".join(sums), encoding="utf-8")


def _zip(folder, path):
    """Pack a folder, the same bytes each time."""
    with written_whole(path) as part, zipfile.ZipFile(part, "w", zipfile.ZIP_DEFLATED) as packed:
        for name in files_of(folder):
            entry = zipfile.ZipInfo(f"{folder.name}/{name}")  # of the year 1980
            entry.compress_type = zipfile.ZIP_DEFLATED
            entry.external_attr = 0o644 << 16
            packed.writestr(entry, (folder / name).read_bytes())
