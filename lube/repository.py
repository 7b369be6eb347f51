"""The code that runs: where it lies, at which commit, and which files it is made of."""

import functools
import subprocess
from pathlib import Path

ROOT = Path(__file__).parents[1]
"""Folder of the Snakefile, if the code runs from a clone or an unpacked archive."""

_CODE = (
    *("Snakefile", "pyproject.toml", "README.md", "LICENSE", "CITATION.cff"),
    *("lube", "notebooks", "workflow", "profiles", "tests/benchmarks"),
)
_PASSING = {"__pycache__", ".ipynb_checkpoints"}


def code_files():
    """List the files of the repository that make and draw a study's results.

    Returns
    -------
    list of str
        Their paths below `ROOT`, with slashes, as far as they are there.
    """
    found = []
    for name in _CODE:
        path = ROOT / name
        files = [file.relative_to(ROOT) for file in (path, *path.rglob("*")) if file.is_file()]
        found += [file.as_posix() for file in files if not _PASSING.intersection(file.parts)]
    return sorted(found)


@functools.cache
def commit():
    """Commit of the code that runs.

    Returns
    -------
    str
        Hexadecimal digits, with ``+changes`` behind them if the code differs from the commit;
        in an unpacked archive, what its file ``COMMIT`` says; else ``unknown``.
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
            text=True,
            timeout=30,
            check=True,
        )
    except (OSError, subprocess.SubprocessError):
        return None
    return said.stdout.strip()
