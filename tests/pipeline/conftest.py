"""The smoke study, run once by the real Snakemake in a copy of the repository."""

import shutil

import pytest
from repository import Repository, copy_of_the_repository


@pytest.fixture(scope="session")
def smoke(tmp_path_factory, made_once):
    """A repository with the smoke study done; not to be changed. Its output is in `said`.

    Each test process has its own, because Snakemake locks the folder in which it runs.
    """
    made = Repository(made_once("smoke", make_smoke))
    return made.copied(tmp_path_factory.mktemp("smoke") / "repository")


def make_smoke(folder):
    """Run the smoke study. If it fails, the next process that needs it tries again."""
    unfinished = folder.with_name("unfinished")
    shutil.rmtree(unfinished, ignore_errors=True)
    repository = copy_of_the_repository(unfinished)
    (repository / "said").write_text(repository.run(), encoding="utf-8")
    repository.copied(folder)


@pytest.fixture(scope="session")
def archived(smoke, tmp_path_factory):
    """A repository with the smoke study archived by Snakemake; not to be changed."""
    folder = tmp_path_factory.mktemp("archived") / "repository"
    repository = smoke.copied(folder)
    said = repository.run("archive")
    assert "Archive: results/smoke/archive/smoke.zip" in said
    return repository


@pytest.fixture(scope="session")
def archive(archived):
    """The smoke study's archive; not to be changed."""
    return archived.results / "archive/smoke"


@pytest.fixture
def spare(smoke, tmp_path_factory):
    """A copy of the repository with the smoke study done, free to be changed."""
    copy = smoke.copied(tmp_path_factory.mktemp("spare") / "repository")
    yield copy
    shutil.rmtree(copy.folder, ignore_errors=True)
