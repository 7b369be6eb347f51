"""A copy of the repository, in which the real Snakemake runs the smoke study."""

import contextlib
import hashlib
import os
import shutil
import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path

import yaml
from numba.core.caching import _CacheLocator

from lube.kernels.layer import layer_breaks
from lube.pipeline.cells import datasets_of
from lube.schema import STAGES
from lube.study.resolve import resolved_content
from lube.study.study import load_study

ROOT = Path(__file__).parents[2]
COPIED = ("Snakefile", "README.md", "CHANGELOG.md", "pyproject.toml")
COPIED += ("config", "workflow", "docs", "lube", "notebooks", "profiles", "benchmarks")
SMOKE = "workflow/config/smoke.yaml"
RESULTS = "results/smoke"
SNAKEMAKE = Path(sys.executable).with_name("snakemake")


FEW = "fig02_film", "fig07_probability", "fig17_gauge"
"""Figures of the copy, from three chapters: to draw all takes longer than the rest of the study."""


def figures_in(notebooks):
    """Figures that bare `snakemake` makes of the smoke study, which has one oil, and lines."""
    others = set(STAGES).difference(load_study(ROOT / SMOKE).datasets)
    texts = {path.stem: path.read_text("utf-8") for path in sorted(notebooks.glob("fig*.ipynb"))}
    return [
        figure
        for figure, text in texts.items()
        if not any(tag in text for tag in ("several-lubricant", "no-lines"))
        and not any(f'study / \\"{kind}.nc' in text for kind in others)
    ]


@dataclass(frozen=True)
class Repository:
    """A copy of the repository, in which the smoke study may be run and spoilt."""

    folder: Path

    def __truediv__(self, name):
        return self.folder / name

    @property
    def results(self):
        return self.folder / RESULTS

    @property
    def notebooks(self):
        """Those of the figures that bare `snakemake` makes of the smoke study."""
        return figures_in(self.folder / "notebooks")

    def take_notebooks(self, figures="*"):
        """Copy the notebooks of more figures, by default of all."""
        for path in (ROOT / "notebooks").glob(f"{figures}.ipynb"):
            shutil.copy2(path, self / "notebooks")

    def command(self, *arguments, study=SMOKE):
        options = ["--configfile", study] if study else []
        return [str(SNAKEMAKE), *arguments, *options]

    def snakemake(self, *arguments, study=SMOKE):
        """Run Snakemake and return the finished process; its `stdout` is all it said."""
        return subprocess.run(
            self.command(*arguments, study=study),
            cwd=self.folder,
            env=environment(),
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            text=True,
            check=False,
        )

    def run(self, *arguments, study=SMOKE):
        """Run Snakemake, which must succeed."""
        finished = self.snakemake(*arguments, study=study)
        assert finished.returncode == 0, finished.stdout
        return finished.stdout

    def planned(self, study=SMOKE):
        """Results that the next run would make, but for pages, which follow all."""
        return {name for name in self.all_planned(study) if not name.endswith(".html")}

    def all_planned(self, study=SMOKE):
        """All files that the next run would make, by Snakemake's own dry plan."""
        rows = [line.split("\t") for line in self.run("--summary", study=study).splitlines()]
        made = {row[0] for row in rows if row[-1] == "update pending"}
        return {str(Path(name).relative_to(RESULTS)) for name in made}

    def with_values(self, **changes):
        """Write a copy of the smoke study with some values changed, and return its name."""
        content = resolved_content(self / SMOKE, folder=self.folder)
        for key, value in changes.items():
            *path, last = key.split("__")
            inner = content
            for part in path:
                inner = inner[part]
            inner[last] = value
        (self / "mine.yaml").write_text(yaml.safe_dump(content), encoding="utf-8")
        return "mine.yaml"

    def copied(self, folder):
        """A copy."""
        copy = Repository(shutil.copytree(self.folder, folder, symlinks=True))
        copy.share_kernels()
        return copy

    def share_kernels(self):
        """Use one folder with the tests' own kernels for machine code, so that each kernel is
        compiled once. A changed kernel has another folder."""
        compiled = Path(layer_breaks.stats.cache_path)
        kernels = self / "lube/kernels"
        name = _CacheLocator.get_suitable_cache_subpath(kernels / "any.py")
        link = kernels / "__pycache__" / compiled.parent.name / name
        link.parent.mkdir(parents=True, exist_ok=True)
        link.symlink_to(compiled)

    def append(self, name, text):
        """Add a line to a file."""
        with (self / name).open("a", encoding="utf-8") as file:
            file.write(text + "\n")

    def snapshot(self):
        """Contents and times of all results."""
        files = (path for path in self.results.rglob("*") if path.is_file())
        return {path: (path.stat().st_mtime_ns, digest(path)) for path in files}

    def products(self):
        """Digests of what a study is run for: datasets, figures, notebooks and the explorer."""
        paths = [*self.results.glob("*.nc"), *self.results.glob("figures/*")]
        paths += self.results.glob("*.html")
        paths += self.results.glob("notebooks/*")
        return {str(path.relative_to(self.results)): digest(path) for path in paths}

    @contextlib.contextmanager
    def clean_slate(self):
        """Remove all results for a while; compiled kernels stay."""
        kept = self.folder.with_name("kept")
        kept.mkdir()
        for name in ("results", ".snakemake"):
            shutil.move(self / name, kept / name)
        try:
            yield
        finally:
            for name in ("results", ".snakemake"):
                shutil.rmtree(self / name, ignore_errors=True)
                shutil.move(kept / name, self / name)
            kept.rmdir()


def environment():
    """The environment of a user who has not prepared anything for the copy."""
    names = {"PYTHONPATH", "SNAKEMAKE_PROFILE", "PYTHONDONTWRITEBYTECODE"}
    return {name: value for name, value in os.environ.items() if name not in names}


def digest(path):
    return hashlib.sha256(Path(path).read_bytes()).hexdigest()


def not_copied(folder, names):
    """Names that a copy does without: most figures, and machine code of kernels, which is shared
    instead. Bytecode of modules is copied, so that not each copy compiles them anew."""
    if Path(folder).parts[-2:] == ("kernels", "__pycache__"):
        return [name for name in names if Path(folder, name).is_dir()]
    if Path(folder).name == "notebooks":
        return [name for name in names if Path(name).stem not in FEW]
    return [name for name in names if name == ".ipynb_checkpoints"]


def copy_of_the_repository(folder):
    folder.mkdir(parents=True)
    for name in COPIED:
        if (ROOT / name).is_dir():
            shutil.copytree(ROOT / name, folder / name, ignore=not_copied)
        else:
            shutil.copy2(ROOT / name, folder / name)
    repository = Repository(folder)
    repository.share_kernels()
    return repository


def products_of(figure):
    """Files that a figure's job makes."""
    return {
        *(f"figures/{figure}.{suffix}" for suffix in ("png", "pdf", "json")),
        f"notebooks/{figure}.ipynb",
    }


def figures_of(repository, *datasets):
    """Files of all figures that use one of some datasets."""
    users = [
        figure
        for figure in repository.notebooks
        if set(datasets_of(repository / f"notebooks/{figure}.ipynb").values()) & set(datasets)
    ]
    return {name for figure in users for name in products_of(figure)}
