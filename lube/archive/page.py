"""What an archive says of itself to a stranger who opens it: its README."""

from lube.report.markdown import escaped
from lube.schema import SUMMARIES
from lube.storage.git import changed_code, commit
from lube.storage.provenance import title_of
from lube.study.metadata import LICENCES, PAPER


def archive_page(study, kinds, study_file, refused=()):
    """One page for a stranger who opens the archive: its README.md.

    Parameters
    ----------
    study : Study
        The study.
    kinds : sequence of str
        Its datasets.
    study_file : str
        Where its file stands in the archive's folder ``study``, with slashes.
    refused : sequence of str, optional
        Lines about measured records that were not used, and why.

    Returns
    -------
    str
        Markdown.
    """
    about = study.about
    rows = "\n".join(f"| `data/{kind}.nc` | {SUMMARIES[kind]} |" for kind in kinds)
    makers = "; ".join(
        escaped(creator.name + (f" ({creator.affiliation})" if creator.affiliation else ""))
        for creator in about.creators
    )
    records = anew = ""
    if study.experiment.manifest is not None:
        records = (
            "\nThe measured records themselves are not in this archive; `data/experiment.nc` holds "
            "their fingerprints in its attribute `inputs_sha256`.\n"
        )
        if refused:
            lines = "\n".join(f"- {escaped(line)}" for line in refused)
            records += f"\nThese records were refused, and are in no result:\n\n{lines}\n"
        anew = "put the measured records where their list expects them, "
    changed = ", ".join(f"`{name}`" for name in changed_code())
    changed = f"; not as in that commit: {changed}" if changed else ""
    return f"""\
# {escaped(title_of(study))}

{makers}

Licence of the results: [{about.licence}]({LICENCES[about.licence]}); of the code: see
`code/LICENSE`. To cite, see `CITATION.cff`.

{escaped(about.summary)}

The model is that of the paper *{PAPER}*.

| here | what it is |
| --- | --- |
{rows}
| `figures/`, `notebooks/` | each figure as PNG and PDF, what it was drawn from, and the \
executed notebook that drew it |
| `study/{study_file}` | the study as it was written |
| `values.json` | its values as they were understood: SI units, but r/min and °C |
| `lubricants/` | the records of its lubricants, with their sources |
| `code/` | the code, commit `{commit()}`, with its workflow and the figures' notebooks{changed} |
| `versions.txt` | the exact versions of Python and of all packages |
| `SHA256SUMS` | the SHA-256 of every file |
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

Without Python, `sha256sum --check SHA256SUMS` checks the fingerprints. To compute everything anew,
{anew}go to a copy of `code/`, follow its README, and give `snakemake --configfile` the path of
`study/{study_file}` here: the datasets come out as the same bytes.
"""


def _example(study):
    """How to explain a number of the study."""
    grid = study.operating_grid
    levels = {name: getattr(grid, name)[-1] for name in ("force", "speed", "temperature")}
    named = " ".join(f"--{name} {level:g}" for name, level in levels.items())
    return f"lube explain data/contact.nc {named} --realisation 0"
