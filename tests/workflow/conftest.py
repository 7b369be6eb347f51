"""The smoke study, run once by the real Snakemake in a copy of the repository."""

import shutil

import pytest
from repository import Repository, copy_of_the_repository


@pytest.fixture(scope="session")
def smoke(tmp_path_factory):
    """A repository with the smoke study done; not to be changed. What was said is in `said`."""
    repository = copy_of_the_repository(tmp_path_factory.mktemp("smoke") / "repository")
    said = repository.run()
    (repository / "said").write_text(said, encoding="utf-8")
    return repository


@pytest.fixture
def spare(smoke, tmp_path):
    """A copy of the repository with the smoke study done, free to be changed."""
    ignored = shutil.ignore_patterns("__pycache__")
    shutil.copytree(smoke.folder, tmp_path / "spare", symlinks=True, ignore=ignored)
    return Repository(tmp_path / "spare")
