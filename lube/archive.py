"""The archive of a study: everything a stranger needs to check it and draw its figures again.

An archive is a folder, and the same folder as a zip. It holds the datasets, figures and executed
notebooks, the study as written and as understood, the lubricant records, the code, the exact
versions of its libraries, a fingerprint of every file, and metadata for those who cite and
catalogue it. Nothing in it tells the hour: the same results make the same archive.
"""

import json
import os
import platform
import shutil
import zipfile
from collections import Counter
from importlib.metadata import distributions
from pathlib import Path

from lube.about import LICENCES, PAPER
from lube.citation import citation_file, zenodo_metadata
from lube.crate import crate_metadata
from lube.errors import DataError, StudyError, shown
from lube.fields import read_yaml
from lube.files import scratch_beside, written_whole
from lube.provenance import config_text, digest, fingerprint, title_of
from lube.records import shipped_records
from lube.repository import ROOT, changed_code, code_files, commit
from lube.schema import SUMMARIES

SUMS = "SHA256SUMS"
"""Name of the file of fingerprints, as ``sha256sum --check`` reads it."""
VALUES = "study/values.json"
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
        The archive; its zip goes beside it. What was there before is replaced when the new one
        is whole.

    Raises
    ------
    DataError
        If a result is missing, or the archive cannot be written.
    """
    folder = Path(folder)
    contents = archive_contents(study, study_file, results, kinds, figures)
    try:
        with scratch_beside(folder) as scratch:
            new = scratch / folder.name
            _fill(new, contents, study)
            _zip(new, folder.with_name(folder.name + ".zip"))
            if folder.exists():
                os.rename(folder, scratch / "old")
            os.rename(new, folder)
    except OSError as error:
        what = error.filename or folder
        raise DataError(f"{folder}: cannot be archived: {what}: {error.strerror}") from error


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
    drawn = [f"figures/{figure}.{suffix}" for figure in figures for suffix in ("pdf", "png")]
    drawn += [f"notebooks/{figure}.ipynb" for figure in figures]
    written = written_files(study, study_file)
    archived_as = next(iter(written))
    return {
        **datasets,
        **{name: results / name for name in drawn},
        **{f"study/{name}": path for name, path in written.items()},
        **{f"lubricants/{name}": path for name, path in _records(study).items()},
        **{f"code/{name}": ROOT / name for name in code_files()},
        "code/COMMIT": commit() + "\n",
        VALUES: _values(study, kinds, archived_as),
        "versions.txt": exact_versions(),
        "CITATION.cff": citation_file(study),
        ".zenodo.json": zenodo_metadata(study),
        "README.md": _readme(study, kinds, archived_as),
    }


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
        If it names one of them by an absolute path, which would lead nowhere in an archive.
    """
    content = read_yaml(study_file, StudyError)
    named = dict(zip(content["lubricants"], study.lubricants, strict=True))
    own = [file for name in set(named) - set(shipped_records()) for file in named[name].files]
    if study.experiment.manifest is not None:
        named |= {content["experiment"]["manifest"]: None}
        own.append(study.experiment.manifest)
    for name in named:
        if os.path.isabs(name):
            raise StudyError(
                f"{study_file}: got {shown(name)}, need a path from the study's folder: any "
                "other leads nowhere in an archive"
            )
    # As they are called, wherever links may lead.
    written = [Path(os.path.abspath(file)) for file in (study_file, *sorted(map(str, own)))]
    folder = os.path.commonpath([path.parent for path in written])
    return {path.relative_to(folder).as_posix(): path for path in written}


def _records(study):
    """Files of the lubricant records by their names, with the record's before one of several."""
    files = {Path(file): record.name for record in study.lubricants for file in record.files}
    times = Counter(file.name for file in files)
    return {
        file.name if times[file.name] == 1 else f"{name}/{file.name}": file
        for file, name in sorted(files.items())
    }


def _values(study, kinds, study_file):
    """Tell the study as it was understood: the values behind each dataset, their fingerprints."""
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


def files_of(folder):
    """List all files below a folder.

    Parameters
    ----------
    folder : str or Path
        The folder.

    Returns
    -------
    list of str
        Their paths below it, with slashes, in order.
    """
    folder = Path(folder)
    return sorted(
        path.relative_to(folder).as_posix() for path in folder.rglob("*") if path.is_file()
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
    (folder / "ro-crate-metadata.json").write_text(catalogue, encoding="utf-8")
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


def _example(study):
    """How to explain a number of the study."""
    grid = study.operating_grid
    levels = {name: getattr(grid, name)[-1] for name in ("force", "speed", "temperature")}
    named = " ".join(f"--{name} {level:g}" for name, level in levels.items())
    return f"lube explain data/contact.nc {named} --realisation 0"


def _readme(study, kinds, study_file):
    """One page for a stranger who opens the archive."""
    about = study.about
    rows = "\n".join(f"| `data/{kind}.nc` | {SUMMARIES[kind]} |" for kind in kinds)
    makers = "; ".join(
        creator.name + (f" ({creator.affiliation})" if creator.affiliation else "")
        for creator in about.creators
    )
    records = anew = ""
    if study.experiment.manifest is not None:
        records = (
            "\nThe measured records themselves are not in this archive; `data/experiment.nc` holds "
            "their fingerprints in its attribute `inputs_sha256`.\n"
        )
        anew = "put the measured records where their list expects them, "
    changed = ", ".join(f"`{name}`" for name in changed_code())
    changed = f"; not as in that commit: {changed}" if changed else ""
    return f"""\
# {title_of(study)}

{makers}. Licence of the results: [{about.licence}]({LICENCES[about.licence]}); of the code: see
`code/LICENSE`. To cite, see `CITATION.cff`.

{about.summary}
The model is that of the paper *{PAPER}*.

| here | what it is |
| --- | --- |
{rows}
| `figures/`, `notebooks/` | each figure as PNG and PDF, and the executed notebook that drew it |
| `study/{study_file}` | the study as it was written |
| `{VALUES}` | its values as they were understood: SI units, but r/min and °C |
| `lubricants/` | the records of its lubricants, with their sources |
| `code/` | the code, commit `{commit()}`, with its workflow and the figures' notebooks{changed} |
| `versions.txt` | the exact versions of Python and of all packages |
| `{SUMS}` | the SHA-256 of every file |
| `ro-crate-metadata.json`, `.zenodo.json` | what each file is, for catalogues |
{records}
The NetCDF files follow the CF and ACDD conventions; each says in its attributes what it follows
from. With xarray alone:

```python
import xarray as xr

contact = xr.open_dataset("data/contact.nc")
```

With Python 3.11 or newer, the same packages as then, and nothing computed anew but the drawings:

```bash
python3 -m venv ../lube-env && . ../lube-env/bin/activate
pip install -c versions.txt ./code
lube verify .                     # fingerprints, contents, and how the files hang together
lube figures . --to ../figures    # draws every figure again and compares it byte for byte
```

To see where a number comes from, and make it again to the last bit:

```bash
{_example(study)}
```

Without Python, `sha256sum --check {SUMS}` checks the fingerprints. To compute everything anew,
{anew}go to a copy of `code/`, follow its README, and give `snakemake --configfile` the path of
`study/{study_file}` here: the datasets come out as the same bytes.
"""
