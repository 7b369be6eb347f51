"""Nothing is lost: killed runs, full and read-only disks, two runs at once, damaged inputs."""

import shutil

import pytest
from kills import Kill, finished, survive

TRACE = "results/smoke/trace.nc"


# Killed


@pytest.fixture(scope="module")
def whole(smoke, tmp_path_factory):
    """The undisturbed run, to begin from and to compare with."""
    return finished(smoke, tmp_path_factory.mktemp("whole"))


@pytest.mark.parametrize(
    "kill",
    [
        Kill("snakemake", "figures", 0.1, 2.0),
        Kill("all", "figures", 0.1, 1.0),
        Kill("job", "datasets", 0.8, 0.5),
    ],
    ids=lambda kill: kill.victim,
)
def test_a_killed_run_is_taken_up_again_and_nothing_is_lost(smoke, whole, kill):
    """By hand, tests/faults/run_faults.py does so at 50 moments of the whole run."""
    with smoke.clean_slate():
        assert survive(smoke, whole, kill).faults == []


# A disk that is full or cannot be written


@pytest.fixture
def on_a_disk(spare, disk):
    """Put the finished results on a disk of their own, and return how to mount it again."""
    kept = spare.folder.with_name("kept")
    shutil.move(spare / "results", kept)
    (spare / "results").mkdir()

    def with_options(options, copied=False):
        disk(spare / "results", options)
        if copied:
            shutil.copytree(kept, spare / "results", dirs_exist_ok=True)

    return with_options


@pytest.mark.parametrize("size", [4, 100])
def test_a_full_disk_is_told_and_the_next_run_makes_what_is_missing(spare, smoke, on_a_disk, size):
    on_a_disk(f"size={size}k")
    finished = spare.snakemake(TRACE)
    print(finished.stdout)
    assert finished.returncode != 0
    assert 0


def test_a_folder_that_cannot_be_written_is_told(spare, on_a_disk):
    on_a_disk("size=100m", copied=True)
    (spare / TRACE).unlink()
    on_a_disk("remount,ro")
    finished = spare.snakemake(TRACE)
    print(finished.stdout)
    assert finished.returncode != 0
    assert 0
