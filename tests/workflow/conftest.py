"""The smoke study, run once by the real Snakemake in a copy of the repository."""

import fcntl
import shutil

import pytest
from repository import Repository, copy_of_the_repository

WITHOUT_CACHES = shutil.ignore_patterns("__pycache__")


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
            return Repository(shutil.copytree(shared, folder, symlinks=True))
        repository = made(folder)
        shutil.copytree(folder, shared, symlinks=True, ignore=WITHOUT_CACHES)
        return repository


def made(folder):
    repository = copy_of_the_repository(folder)
    (repository / "said").write_text(repository.run(), encoding="utf-8")
    return repository


@pytest.fixture(scope="session")
def archived(smoke, tmp_path_factory):
    """A repository with the smoke study archived by Snakemake; not to be changed."""
    folder = tmp_path_factory.mktemp("archived") / "repository"
    repository = Repository(shutil.copytree(smoke.folder, folder, symlinks=True))
    said = repository.run("archive")
    assert "Archive: results/smoke/archive/smoke.zip" in said
    return repository


@pytest.fixture(scope="session")
def archive(archived):
    """The smoke study's archive; not to be changed."""
    return archived.results / "archive/smoke"


@pytest.fixture(scope="session")
def spare_folder(tmp_path_factory):
    """Folder of all spare repositories in turn: compiled kernels depend on the path."""
    return tmp_path_factory.mktemp("spare") / "repository"


@pytest.fixture
def spare(smoke, spare_folder):
    """A copy of the repository with the smoke study done, free to be changed."""
    caches = spare_folder / "lube/kernels/__pycache__"
    kept = spare_folder.with_name("compiled")
    if caches.exists():
        caches.rename(kept)
    shutil.rmtree(spare_folder, ignore_errors=True)
    shutil.copytree(smoke.folder, spare_folder, symlinks=True, ignore=WITHOUT_CACHES)
    if kept.exists():
        kept.rename(caches)
    return Repository(spare_folder)
