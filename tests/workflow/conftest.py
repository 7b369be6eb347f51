"""The smoke study, run once by the real Snakemake in a copy of the repository."""

import os
import shutil
import time

import pytest
from repository import Repository, copy_of_the_repository

PATIENCE = 900.0
"""Seconds that one test process waits for the other to make the smoke study."""

WITHOUT_CACHES = shutil.ignore_patterns("__pycache__")


@pytest.fixture(scope="session")
def smoke(tmp_path_factory, worker_id):
    """A repository with the smoke study done; not to be changed. What was said is in `said`.

    Of several test processes the first to need it makes it, and the others copy it.
    """
    folder = tmp_path_factory.mktemp("smoke") / "repository"
    if worker_id == "master":
        return made(folder)
    shared = tmp_path_factory.getbasetemp().parent / "smoke"
    try:
        shared.mkdir()
    except FileExistsError:
        return copied(shared / "repository", folder)
    try:
        repository = made(folder)
    except BaseException:
        (shared / "failed").touch()
        raise
    shutil.copytree(folder, shared / "part", symlinks=True, ignore=WITHOUT_CACHES)
    os.rename(shared / "part", shared / "repository")
    return repository


def made(folder):
    repository = copy_of_the_repository(folder)
    said = repository.run()
    (repository / "said").write_text(said, encoding="utf-8")
    return repository


def copied(whole, folder):
    deadline = time.monotonic() + PATIENCE
    while not whole.exists():
        failed = whole.with_name("failed").exists() or time.monotonic() > deadline
        assert not failed, "the other test process did not make the smoke study"
        time.sleep(0.5)
    return Repository(shutil.copytree(whole, folder, symlinks=True))


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
    """Where all spare repositories lie, one after the other: compiled kernels hang on the path."""
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
