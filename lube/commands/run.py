"""``lube run``: Snakemake in the folder of the Snakefile, wherever the user is."""

import os
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import NoReturn

from lube.errors import LubeError
from lube.storage.git import ROOT

_SNAKEMAKE = "import sys; from snakemake.cli import main; sys.argv[0] = 'lube run'; main()"
"""As ``python -m snakemake``, under the name by which its help and messages call it."""
_SIGN = "workflow/rules/study.smk"  # only the repository of lube has this file


def snakemake_command(arguments: Sequence[str]) -> list[str]:
    """Compose the command that runs a study.

    Parameters
    ----------
    arguments : sequence of str
        YAML file of a study (without it, the paper's is run), then targets and options of
        Snakemake.

    Returns
    -------
    list of str
        The command; the study comes last, so that targets precede it.
    """
    study, rest = [], list(arguments)
    if rest and rest[0].endswith((".yaml", ".yml")):
        study = ["--configfile", str(Path(rest.pop(0)).resolve())]
    return [sys.executable, "-c", _SNAKEMAKE, *rest, *study]


def repository(here: Path | None = None) -> Path:
    """Find the folder of the Snakefile.

    Parameters
    ----------
    here : Path, optional
        Folder to search first, then those above it; by default the current one.

    Returns
    -------
    Path
        This folder or one above it, or else the clone that the package was installed from.

    Raises
    ------
    LubeError
        If none of them has the Snakefile.
    """
    here = here or Path.cwd()
    for folder in (here, *here.parents, ROOT):
        if (folder / _SIGN).is_file():
            return folder
    needed = "need a clone of its repository or a folder in it"
    raise LubeError(f"{here}: no Snakefile of lube, {needed}")


def run(arguments: Sequence[str]) -> NoReturn:
    """Replace this process by Snakemake, which then gets the signals and sets the exit status.

    Parameters
    ----------
    arguments : sequence of str
        As for `snakemake_command`.

    Raises
    ------
    LubeError
        As from `repository`.
    """
    command = snakemake_command(arguments)
    os.chdir(repository())
    os.execv(command[0], command)
