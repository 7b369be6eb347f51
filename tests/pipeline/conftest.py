"""The smoke study, run once by the real Snakemake in a copy of the repository."""

import fcntl
import shutil

import pytest
from repository import Repository, copy_of_the_repository


@pytest.fixture(scope="session")
def smoke(tmp_path_factory, worker_id):
    """A repository with the smoke study done; not to be changed. Its output is in `said`.

    Of several test processes the first to need it makes it, and the others copy it.
    """
    folder = tmp_path_factory.mktemp("smoke") / "repository"
    if worker_id == "master":
        return made(folder)
    shared = tmp_path_factory.getbasetemp().parent / "smoke"
    with shared.with_suffix(".lock").open("w") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        if shared.exists():
            return Repository(shared).copied(folder)
        repository = made(folder)
        repository.copied(shared)
        return repository


def made(folder):
    repository = copy_of_the_repository(folder)
    (repository / "said").write_text(repository.run(), encoding="utf-8")
    return repository


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
