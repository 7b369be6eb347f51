"""Nothing is lost: killed runs, full and read-only disks.

`pytest -m slow` runs these tests.
"""

import shutil

import pytest
from kills import Kill, finished, recovery_commands, survive

pytestmark = pytest.mark.slow

FILM, COMPARISON = "results/smoke/film.nc", "results/smoke/comparison.nc"


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
        _, faults = survive(smoke, whole, kill)
        assert faults == []


def recover(repository, *targets):
    """Do what the documentation says after a crash."""
    for arguments in recovery_commands():
        repository.run(*arguments, *([] if arguments else targets))


# A disk that is full or cannot be written


@pytest.fixture
def on_a_disk(spare, disk, tmp_path):
    """Put the finished results on a disk of their own, and return how to mount it again."""
    kept = tmp_path / "kept"
    shutil.move(spare / "results", kept)
    (spare / "results").mkdir()

    def with_options(options, copied=False):
        disk(spare / "results", options)
        if copied:
            shutil.copytree(kept, spare / "results", dirs_exist_ok=True)

    return with_options


def test_a_full_disk_is_reported_and_the_next_run_makes_what_is_missing(spare, smoke, on_a_disk):
    oil, film = ((smoke.results / f"{kind}.nc").stat().st_size for kind in ("lubricant", "film"))
    on_a_disk(f"size={(oil + film // 2) // 1024}k")
    refused = spare.snakemake(FILM)
    assert refused.returncode != 0
    assert f"Error: {FILM}: cannot be written: No space left" in refused.stdout
    assert "Traceback" not in refused.stdout
    on_a_disk("remount,size=100m")
    recover(spare, FILM)
    made = spare.products()
    assert made == {name: smoke.products()[name] for name in ("lubricant.nc", "film.nc")}
    assert not list(spare.results.rglob("*.part"))


def test_an_archive_stays_until_a_new_one_is_whole(spare, on_a_disk):
    on_a_disk("size=200m", copied=True)
    spare.run("archive")
    whole = spare.snapshot()
    ballast = spare.results / "ballast"
    ballast.write_bytes(bytes(shutil.disk_usage(spare.results).free - 2**21))
    refused = spare.snakemake("archive", "--forcerun", "archive")
    assert refused.returncode != 0
    assert "archive/smoke: cannot be archived: No space left on device" in refused.stdout
    assert "Traceback" not in refused.stdout
    ballast.unlink()
    archived = {path for path in whole if "archive" in path.relative_to(spare.results).parts}
    contents = {path: seen[1] for path, seen in spare.snapshot().items() if path in archived}
    assert contents == {path: whole[path][1] for path in archived if path.suffix != ".sha256"}
    assert "archive/smoke: nothing wrong" in spare.run("verify")
    assert not list(spare.results.rglob("*.part"))


def test_a_folder_that_cannot_be_written_is_reported_before_any_job(spare, smoke, on_a_disk):
    on_a_disk("size=100m", copied=True)
    (spare / COMPARISON).unlink()
    before = spare.snapshot()
    on_a_disk("remount,ro")
    refused = spare.snakemake(COMPARISON)
    assert refused.returncode != 0
    line = "results/smoke: cannot be written: the folder results/smoke is not writable"
    assert refused.stdout.splitlines()[-1] == f"The study cannot start. {line}"
    assert "Traceback" not in refused.stdout
    assert spare.snapshot() == before
    on_a_disk("remount,rw")
    spare.run(COMPARISON)
    assert spare.products() == smoke.products()
