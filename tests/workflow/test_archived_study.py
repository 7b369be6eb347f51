"""The archive of the smoke study, as a stranger finds it: whole, checkable, and drawn again."""

import shutil
import subprocess
import sys
import zipfile

from crates import issues_of
from repository import environment, products_of

from lube.archive.build import SUMS, VALUES, files_of
from lube.storage.provenance import fingerprint


def lube(*arguments, folder, code):
    """Run the command `lube` of an archive's own code, somewhere else."""
    return subprocess.run(
        [sys.executable, "-m", "lube.cli", *map(str, arguments)],
        cwd=folder,
        env=environment() | {"PYTHONPATH": str(code)},
        capture_output=True,
        text=True,
        check=False,
    )


# What it holds


def test_the_archive_holds_results_study_records_code_and_metadata(smoke, archive):
    names = files_of(archive)
    for path in smoke.results.glob("*.nc"):
        assert (archive / "data" / path.name).read_bytes() == path.read_bytes()
    for figure in smoke.notebooks:
        for name in products_of(figure):
            assert (archive / name).read_bytes() == (smoke.results / name).read_bytes()
    assert {
        *("README.md", "CITATION.cff", ".zenodo.json", "ro-crate-metadata.json", SUMS, VALUES),
        *("versions.txt", "study/smoke.yaml", "lubricants/mobilgear-shc-xmp-320.yaml"),
        *(
            "code/Snakefile",
            "code/lube/stages/film.py",
            "code/notebooks/fig02_film.ipynb",
            "code/COMMIT",
        ),
    } <= set(names)
    assert not [name for name in names if "__pycache__" in name or "log" in name.split("/")]
    assert "numpy==" in (archive / "versions.txt").read_text()


def test_the_zip_holds_the_same_and_no_hour(archive):
    with zipfile.ZipFile(archive.with_suffix(".zip")) as packed:
        assert sorted(packed.namelist()) == [f"smoke/{name}" for name in files_of(archive)]
        assert {entry.date_time for entry in packed.infolist()} == {(1980, 1, 1, 0, 0, 0)}
        for name in files_of(archive):
            assert packed.read(f"smoke/{name}") == (archive / name).read_bytes()


def test_the_archive_is_the_same_bytes_each_time(archived, archive):
    first = fingerprint(archive.with_suffix(".zip"))
    archived.run("archive", "--forcerun", "archive")
    assert fingerprint(archive.with_suffix(".zip")) == first


def test_the_catalogue_is_valid_under_its_own_validator(archive, tmp_path):
    assert issues_of(archive, tmp_path) == []


def test_common_tools_check_the_sums(archive):
    checked = subprocess.run(
        ["sha256sum", "--strict", "--quiet", "--check", SUMS], cwd=archive, check=False
    )
    assert checked.returncode == 0


# What a stranger does with it


def test_a_stranger_checks_the_zip_and_draws_figures_again(archive, tmp_path):
    shutil.copy(archive.with_suffix(".zip"), tmp_path)
    with zipfile.ZipFile(tmp_path / "smoke.zip") as packed:
        packed.extractall(tmp_path)
    code = tmp_path / "smoke/code"
    checked = lube("verify", "smoke", folder=tmp_path, code=code)
    assert (checked.stdout, checked.returncode) == ("smoke: nothing wrong\n", 0)
    drawn = lube(
        *("figures", "smoke", "fig02_film", "fig17_gauge", "--to", "new"),
        folder=tmp_path,
        code=code,
    )
    assert drawn.stdout.splitlines()[-1] == "4 of 4 the same, byte for byte", drawn.stderr
    place = ("--force", 1600, "--speed", 100, "--temperature", 80, "--realisation", 3)
    told = lube("explain", "smoke/data/contact.nc", *place, folder=tmp_path, code=code)
    assert told.stdout.count("the same bits") == 5, told.stderr
    checked = lube("verify", "smoke", folder=tmp_path, code=code)
    assert checked.returncode == 0, checked.stdout


def test_snakemake_verifies_what_is_there_each_time_and_makes_nothing(archived, archive):
    before = archived.snapshot()
    assert "results/smoke/archive/smoke: nothing wrong" in archived.run("verify")
    made = dict(archived.snapshot().items() - before.items())
    assert {path.name for path in made} == {"verify.log"}
    picture = archive / "figures/fig02_film.png"
    whole = picture.read_bytes()
    picture.write_bytes(whole + b"0")
    said = archived.snakemake("verify")
    picture.write_bytes(whole)
    assert said.returncode != 0
    assert "Wrong: figures/fig02_film.png: not what it was" in said.stdout


# What is refused before any job


def test_a_study_without_makers_is_refused_before_any_job(smoke):
    before = smoke.snapshot()
    about = {"title": "mine", "date": "2026-11-21"}
    finished = smoke.snakemake("archive", study=smoke.with_values(about=about))
    assert finished.returncode != 0
    assert "The study cannot start. about.creators: missing" in finished.stdout
    assert "Traceback" not in finished.stdout
    assert smoke.snapshot() == before
