"""The stub and the version of the package agree with what they repeat."""

import ast
import tomllib
from pathlib import Path

import lube

ROOT = Path(__file__).parents[1]


def test_the_stub_for_editors_lists_the_public_names():
    stub = ast.parse((ROOT / "lube" / "__init__.pyi").read_text(encoding="utf-8"))
    homes = {
        alias.asname: node.module
        for node in stub.body
        if isinstance(node, ast.ImportFrom)
        for alias in node.names
    }
    assert homes == lube._HOME_OF


def test_the_version_is_that_of_the_distribution():
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    assert project["version"] == lube.__version__
