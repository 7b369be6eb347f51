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
def published(smoke, made_once):
    """A repository with archive and report of the smoke study, by Snakemake; not to be changed."""

    def make(folder):
        unfinished = folder.with_name("unpublished")
        shutil.rmtree(unfinished, ignore_errors=True)
        said = smoke.copied(unfinished).run("archive", "report")
        assert "Archive: results/smoke/archive/smoke.zip" in said
        unfinished.rename(folder)

    return Repository(made_once("published", make))


@pytest.fixture(scope="session")
def archive(published):
    """The smoke study's archive; not to be changed."""
    return published.results / "archive/smoke"


@pytest.fixture
def spare(smoke, tmp_path_factory):
    """A copy of the repository with the smoke study done, free to be changed."""
    copy = smoke.copied(tmp_path_factory.mktemp("spare") / "repository")
    yield copy
    shutil.rmtree(copy.folder, ignore_errors=True)
