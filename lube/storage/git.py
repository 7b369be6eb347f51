"""The code that runs: its folder, its commit, and the files it consists of."""

import functools
import re
from collections.abc import Iterable
from pathlib import Path
from subprocess import DEVNULL, CalledProcessError, check_output

ROOT = Path(__file__).parents[2]
"""Folder of the Snakefile, if the code runs from a clone or an unpacked archive."""

# The files are named one by one, since the user's studies, records and notes may lie beside them.
_CODE = """
Snakefile pyproject.toml LICENSE CITATION.cff README.md CHANGELOG.md CONTRIBUTING.md
docs/**/* lube/**/* notebooks/*.ipynb benchmarks/*.py profiles/*/config.yaml
workflow/Snakefile workflow/rules/*.smk workflow/scripts/*.py workflow/report/*
workflow/envs/constraints.txt workflow/config/surfaces/example.x3p
workflow/config/paper.yaml workflow/config/smoke.yaml workflow/config/slip.yaml
workflow/config/thousand.yaml workflow/config/run-in.yaml workflow/config/measured.yaml
workflow/config/oils.yaml workflow/config/complete.yaml workflow/config/ground.yaml
config/README.md config/config.yaml
""".split()

_CACHE = re.compile(r"(^|/)(\.|__pycache__/)")


def code_files() -> list[str]:
    """List the files of the repository that make and draw a study's results.

    Returns
    -------
    list of str
        Their paths below `ROOT`, with slashes.
    """
    paths = {path for pattern in _CODE for path in ROOT.glob(pattern) if path.is_file()}
    names = (path.relative_to(ROOT).as_posix() for path in paths)
    return sorted(name for name in names if not _CACHE.search(name))


def changed_code() -> list[str]:
    """List the files of `code_files` that differ from the commit, new files included.

    Returns
    -------
    list of str
        Their paths below `ROOT`; empty outside a Git repository.
    """
    return changed_since("HEAD", code_files()) or []


@functools.cache
def commit() -> str:
    """Commit of the code that runs.

    Returns
    -------
    str
        Hexadecimal digits, followed by ``+changes`` if the code that computes (`lube` or the
        workflow's scripts) differs from the commit. In an unpacked archive, the content of its
        file ``COMMIT``; otherwise ``unknown``.
    """
    head = _git("rev-parse", "HEAD")
    if head is None:
        stated = ROOT / "COMMIT"
        return stated.read_text(encoding="utf-8").strip() if stated.exists() else "unknown"
    changed = _git("status", "--porcelain", "--untracked-files=no", "lube", "workflow/scripts")
    return head + ("+changes" if changed else "")


def changed_since(revision: str, files: Iterable[str]) -> list[str] | None:
    """List the files that differ from a commit, new files included.

    Parameters
    ----------
    revision : str
        The commit, by any name that Git knows.
    files : iterable of str
        Their paths below `ROOT`.

    Returns
    -------
    list of str or None
        None if there is no Git repository or no such commit.
    """
    files = set(files)
    changed = _git("diff", "--name-only", "-z", revision, "--")
    if changed is None:
        return None
    new = _git("ls-files", "--others", "--exclude-standard", "-z")
    return sorted(files & {*changed.split("\0"), *new.split("\0")})


def text_in(revision: str, file: str) -> str | None:
    """Text of a file, given by its path below `ROOT`, in a commit; None if it has no such file."""
    return _git("show", f"{revision}:{file}")


@functools.cache
def commit_date() -> str | None:
    """Date of the commit of the code that runs, such as 2026-11-21, if there is one."""
    return _git("show", "--no-patch", "--format=%cs", "HEAD")


def _git(*arguments):
    """Output of a Git command; None if it fails or `ROOT` is not a Git repository."""
    if not (ROOT / ".git").exists():  # Git would look for one in the folders above
        return None
    command = ["git", "--no-optional-locks", *arguments]
    try:
        return check_output(command, cwd=ROOT, stderr=DEVNULL, encoding="utf-8").strip()
    except (OSError, CalledProcessError):
        return None
