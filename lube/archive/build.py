"""The archive of a study: everything needed to check it and to draw its figures again.

An archive is a folder, and the same folder as a zip. It holds the datasets, figures and executed
notebooks, the study as written and as understood, the lubricant records, the code, the exact
versions of its libraries, the SHA-256 sum of every file, and metadata for citations and
catalogues. It holds no clock time: the same results give the same archive.
"""

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
from lube.errors import DataError, StudyError, shown
from lube.pipeline.figure_files import origin, products
from lube.pipeline.figures import wrong_figures
from lube.report import ON_ASSUMPTIONS, SUMMARISED
from lube.report.pages import render
from lube.report.summary import facts, findings
from lube.schema import SUMMARIES
from lube.storage.files import why_not, write_text, written_whole
from lube.storage.git import ROOT, changed_code, code_files, commit
from lube.storage.netcdf import load
from lube.storage.provenance import config_text, digest, fingerprint
from lube.study.lubricant_record import SHIPPED_FOLDER
from lube.study.metadata import LICENCES, PAPER
from lube.study.resolve import study_files, with_paths
from lube.study.study import Study
from lube.study.text_files import read_yaml
from lube.types import Datasets, File

SUMS = "SHA256SUMS"
"""Name of the file of SHA-256 sums, in the format of ``sha256sum --check``."""
VALUES = "values.json"
"""Name of the file with the study's values as they were understood."""


def make_archive(study: Study, path: File, results: File, figures: list[str], folder: File) -> None:
    """Write the archive of a study: a folder, its zip, and the SHA-256 sum of the zip.

    Parameters
    ----------
    study : Study
        The study; it must name its creators.
    path : str or Path
        Its YAML file.
    results : str or Path
        Folder of its results.
    figures : list of str
        Figures to include.
    folder : str or Path
        The archive; its zip is written beside it. An older archive is replaced when the new one is
        complete.

    Raises
    ------
    DataError
        If a result is missing, a figure or executed notebook is not as the workflow made it
        from these datasets, or the archive cannot be written.
    """
    folder, results = Path(folder), Path(results)
    for wrong in wrong_figures(figures, results, results):
        raise DataError(wrong)
    contents = archive_contents(study, path, results, figures)
    new, packed = (folder.with_name(folder.name + end) for end in (".part", ".zip"))
    try:
        shutil.rmtree(new, ignore_errors=True)  # left by a killed process
        _fill(new, contents, study)
        _zip(new, packed, folder.name)
        shutil.rmtree(folder, ignore_errors=True)
        os.rename(new, folder)
        write_text(f"{packed}.sha256", f"{fingerprint(packed)}  {packed.name}\n")
    except OSError as error:
        raise DataError(f"{folder}: cannot be archived: {why_not(error, folder)}") from error
    finally:
        shutil.rmtree(new, ignore_errors=True)


def archive_contents(
    study: Study, path: File, results: File, figures: list[str]
) -> dict[str, Path | str]:
    """List what an archive contains, apart from its catalogue and its SHA-256 sums.

    Parameters
    ----------
    study, path, results, figures
        As in `make_archive`.

    Returns
    -------
    dict
        From the path below the archive's root to the file to copy, or the text to write.
    """
    results = Path(results)
    written = written_files(study, path)
    study_file = next(iter(written))
    kinds = study.datasets_in(results)
    shown = [kind for kind in (*SUMMARISED, *ON_ASSUMPTIONS) if kind in kinds]
    summarised = {kind: load(results / f"{kind}.nc", kind) for kind in shown}
    drawn = [name for figure in figures for name in (*products(figure), origin(figure))]
    return {
        **{f"data/{kind}.nc": results / f"{kind}.nc" for kind in kinds},
        **{name: results / name for name in drawn},
        "explorer.html": results / "explorer.html",
        **{f"study/{name}": path for name, path in written.items()},
        **{f"lubricants/{name}": path for name, path in _records(study).items()},
        **{f"code/{name}": ROOT / name for name in code_files()},
        "code/COMMIT": commit() + "\n",
        VALUES: values_text(study, study_file, kinds),
        "versions.txt": exact_versions(),
        "CITATION.cff": citation_file(study),
        ".zenodo.json": zenodo_metadata(study),
        "README.md": archive_page(study, study_file, kinds, summarised),
    }


def written_files(study: Study, path: File) -> dict[str, Path]:
    """List the files of a study that people wrote, apart from the measured records.

    Parameters
    ----------
    study : Study
        The study.
    path : str or Path
        Its YAML file.

    Returns
    -------
    dict
        From their paths relative to their common folder, with slashes, to the files: first the
        study's own file, then the files it is based on, lubricant records that do not come with
        the package, the measured topographies, and the manifest of its measured records.

    Raises
    ------
    StudyError
        If the study names one of them by a path that would not resolve in an archive.
    """
    files = study_files(path)
    for file in files:
        _check_paths(file)
    for record in study.lubricants:
        if Path(record.files[0]).parent != SHIPPED_FOLDER:
            files += record.files
    files += [topography.file for topography in study.topographies.values()]
    if study.experiment.manifest is not None:
        files.append(study.experiment.manifest)
    # By the names that the study uses, even where one is a symbolic link.
    paths = [Path(os.path.abspath(file)) for file in files]
    folder = os.path.commonpath([path.parent for path in paths])
    return {path.relative_to(folder).as_posix(): path for path in paths}


def _check_paths(study_file):
    """Refuse paths in a study's file that would not resolve in an archive.

    These are absolute ones, and those that pass through a folder only to leave it again: that
    folder would not exist in the archive.
    """
    content, folder = read_yaml(study_file, StudyError), os.path.abspath(Path(study_file).parent)
    names = [content.get("based_on")]
    with_paths(content, lambda name: names.append(name) or name)
    for name in filter(None, names):
        direct = os.path.relpath(os.path.join(folder, name), folder)
        if Path(name) != Path(direct):
            message = f"got {shown(name)}, an archive needs the direct relative path"
            raise StudyError(f"{study_file}: {message}, {shown(direct)}")


def _records(study):
    """Files of the lubricant records by name, preceded by the record's name if not unique."""
    files = {Path(file): record.name for record in study.lubricants for file in record.files}
    count = Counter(file.name for file in files)
    return {
        file.name if count[file.name] == 1 else f"{name}/{file.name}": file
        for file, name in sorted(files.items())
    }


def values_text(study: Study, study_file: str, kinds: list[str]) -> str:
    """State a study as it was understood: the values that determine each dataset.

    Parameters
    ----------
    study : Study
        The study.
    study_file : str
        Path of its file below the archive's folder ``study``, with slashes.
    kinds : list of str
        Its datasets in the archive.

    Returns
    -------
    str
        JSON.
    """
    content = {
        "study": study.name,
        "study_file": study_file,
        "seed": study.seed,
        "realisations": study.realisations,
        "about": study.about.in_files,
        "config_sha256": {kind: digest(config_text(study, kind)) for kind in kinds},
        "values": {kind: study.stage_inputs(kind) for kind in kinds},
    }
    return json.dumps(content, indent=1, sort_keys=True, ensure_ascii=False) + "\n"


def archive_page(study: Study, study_file: str, kinds: list[str], results: Datasets) -> str:
    """Write the README.md of an archive, for a reader who has nothing else.

    Parameters
    ----------
    study, study_file, kinds
        As in `values_text`.
    results : dict of str to xarray.Dataset
        Its datasets `lube.report.SUMMARISED` and `lube.report.ON_ASSUMPTIONS`, by name.

    Returns
    -------
    str
        Markdown.
    """
    effects = ""
    if "sensitivity" in kinds:
        # Imports of the sensitivity study are slow.
        from lube.report.sensitivity import rests_on

        effects = rests_on(study, *map(results.get, ON_ASSUMPTIONS))
    return render(
        "archive.md",
        study=study,
        licence=LICENCES[study.about.licence],
        paper=PAPER,
        datasets={kind: SUMMARIES[kind] for kind in kinds},
        study_file=study_file,
        commit=commit(),
        changed=changed_code(),
        facts=facts(study, results["lubricant"]),
        findings=findings(study, results),
        rests_on=effects,
    )


def exact_versions() -> str:
    """List the versions of Python and of all installed packages, for ``pip install -c``.

    Returns
    -------
    str
        One per line.
    """
    system = f"# Python {platform.python_version()}, {platform.system()} {platform.machine()}\n"
    installed = {f"{found.name}=={found.version}" for found in distributions()}
    kept = sorted((line for line in installed if not line.startswith("lube==")), key=str.lower)
    return system + "\n".join(kept) + "\n"


def files_of(folder: File) -> list[str]:
    """List all files below a folder.

    Parameters
    ----------
    folder : str or Path
        The folder.

    Returns
    -------
    list of str
        Their paths below it, with slashes, sorted.
    """
    files = (path for path in Path(folder).rglob("*") if path.is_file())
    return sorted(path.relative_to(folder).as_posix() for path in files)


def _fill(folder, contents, study):
    """Write an archive's folder, its catalogue and its SHA-256 sums."""
    for name, content in contents.items():
        path = folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        if isinstance(content, Path):
            shutil.copyfile(content, path)
        else:
            path.write_text(content, encoding="utf-8")
    sizes = {name: (folder / name).stat().st_size for name in files_of(folder)}
    (folder / CATALOGUE).write_text(crate_metadata(study, sizes), encoding="utf-8")
    (folder / SUMS).write_text(sums_of(folder), encoding="utf-8")


def sums_of(folder: File) -> str:
    """SHA-256 sums of all files below a folder, in the format of ``sha256sum``."""
    names = [name for name in files_of(folder) if name != SUMS]
    return "".join(f"{fingerprint(Path(folder, name))}  {name}\n" for name in names)


def _zip(folder, path, root):
    """Pack a folder under the name `root`, the same bytes each time."""
    with written_whole(path) as part, zipfile.ZipFile(part, "w", zipfile.ZIP_DEFLATED) as packed:
        for name in files_of(folder):
            entry = zipfile.ZipInfo(f"{root}/{name}")  # dated 1980
            entry.compress_type = zipfile.ZIP_DEFLATED
            entry.external_attr = 0o644 << 16
            packed.writestr(entry, (folder / name).read_bytes())
