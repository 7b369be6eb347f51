"""The code that runs: where it lies, at which commit, and which files it is made of."""

import functools
import re
import subprocess
from pathlib import Path

ROOT = Path(__file__).parents[2]
"""Folder of the Snakefile, if the code runs from a clone or an unpacked archive."""

# What lies among it besides is its user's: other studies, records, notes.
_CODE = (
    *("Snakefile", "pyproject.toml", "README.md", "CHANGELOG.md", "CONTRIBUTING.md"),
    *("LICENSE", "CITATION.cff", "lube/py.typed", "lube/**/*.py"),
    *("lube/study/lubricants/*", "notebooks/*.ipynb", "tests/benchmarks/*.py"),
    *("workflow/rules/*.smk", "workflow/scripts/*.py", "workflow/envs/constraints.txt"),
    *(f"workflow/config/{name}.yaml" for name in ("paper", "smoke", "slip", "thousand")),
    *("workflow/report/*", "lube/report/templates/*", "docs/*", "profiles/*/config.yaml"),
)

_COMMIT = re.compile("[0-9a-f]{7,64}")


def code_files():
    """List the files of the repository that make and draw a study's results.

    Returns
    -------
    list of str
        Their paths below `ROOT`, with slashes, as far as they are there.
    """
    found = (file for pattern in _CODE for file in ROOT.glob(pattern) if file.is_file())
    return sorted(file.relative_to(ROOT).as_posix() for file in found)


def changed_code():
    """List the files of `code_files` that are not as in the commit.

    Returns
    -------
    list of str
        Their paths below `ROOT`, new files included; empty if all are, or nobody knows.
    """
    if not (ROOT / ".git").exists():
        return []
    changed = _git("diff", "--name-only", "-z", "HEAD") or ""
    new = _git("ls-files", "--others", "--exclude-standard", "-z") or ""
    return sorted({*changed.split("\0"), *new.split("\0")} & set(code_files()))


@functools.cache
def commit():
    """Commit of the code that runs.

    Returns
    -------
    str
        Hexadecimal digits, with ``+changes`` behind them if what computes differs from the
        commit, `lube` or the workflow's scripts; in an unpacked archive, what its file
        ``COMMIT`` says; else ``unknown``.
    """
    try:
        told = (ROOT / "COMMIT").read_text(encoding="utf-8").strip()
    except OSError:
        told = "unknown"
    if not (ROOT / ".git").exists():
        return told
    head = _git("rev-parse", "HEAD")
    changed = _git("status", "--porcelain", "--untracked-files=no", "lube", "workflow/scripts")
    return told if head is None else head + ("+changes" if changed else "")


def changed_since(name, files):
    """List the files that are not as in a commit.

    Parameters
    ----------
    name : str
        The commit.
    files : iterable of str
        Their paths below `ROOT`.

    Returns
    -------
    list of str
        Those that differ, new files included; None if nobody knows: there is no Git, or no such
        commit.
    """
    files = list(files)
    if not _COMMIT.fullmatch(name) or not (ROOT / ".git").exists():
        return None
    if not files:  # Git would take it for all
        return []
    git = functools.partial(_git, "--literal-pathspecs")
    changed = git("diff", "--name-only", "-z", name, "--", *files)
    new = git("ls-files", "--others", "-z", "--", *files)
    if changed is None or new is None:
        return None
    return sorted({*changed.split("\0"), *new.split("\0")} - {""})


def text_in(name, file):
    """Text of a file, told by its path below `ROOT`, in a commit; None if it is not there."""
    return _git("show", f"{name}:{file}")


@functools.cache
def commit_date():
    """Day of the commit of the code that runs, such as 2026-11-21, or None."""
    return _git("show", "--no-patch", "--format=%cs", "HEAD") if (ROOT / ".git").exists() else None


def _git(*arguments):
    """Ask Git; None where there is no Git, or it refuses."""
    try:
        said = subprocess.run(
            ["git", "--no-optional-locks", *arguments],
            cwd=ROOT,
            capture_output=True,
            encoding="utf-8",
            errors="surrogateescape",
            timeout=30,
            check=True,
        )
    except (OSError, subprocess.SubprocessError):
        return None
    return said.stdout.strip()
