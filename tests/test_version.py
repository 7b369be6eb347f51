"""The version of the package is that of the distribution."""

import tomllib
from pathlib import Path

import lube

ROOT = Path(__file__).parents[1]


def test_the_version_is_that_of_the_distribution():
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    assert project["version"] == lube.__version__
