"""The archive of the smoke study, made by Snakemake and used by somebody who has only its zip."""

import json
import shutil
import subprocess
import sys
import zipfile

import pytest
from crates import issues_of
from repository import ROOT, Repository, environment, products_of

from lube.archive.build import SUMS, VALUES, files_of
from lube.storage.provenance import fingerprint


def share_kernels(code):
    """Spare the unpacked code the compilation of kernels, which takes longer than all else."""
    for path in (ROOT / "lube/kernels").glob("*.py"):
        unpacked = code / "lube/kernels" / path.name
        assert unpacked.read_bytes() == path.read_bytes()
        shutil.copystat(path, unpacked)  # Numba goes by the times of sources
    Repository(code).share_kernels()


SEVERAL = "import json, sys; from lube.cli import main; print([*map(main, json.load(sys.stdin))])"


def lube(*commands, folder):
    """Give commands `lube` to an archive's own code, in one process; return all that is printed."""
    finished = subprocess.run(
        [sys.executable, "-c", SEVERAL],
        input=json.dumps([[str(word) for word in command] for command in commands]),
        cwd=folder,
        env=environment() | {"PYTHONPATH": str(folder / "smoke/code")},
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
        check=False,
    )
    return finished.stdout


def test_the_archive_holds_results_study_records_code_and_metadata(smoke, archive, tmp_path):
    names = files_of(archive)
    for path in smoke.results.glob("*.nc"):
        assert (archive / "data" / path.name).read_bytes() == path.read_bytes()
    for figure in smoke.notebooks:
        for name in products_of(figure):
            assert (archive / name).read_bytes() == (smoke.results / name).read_bytes()
    page = "explorer.html"
    assert (archive / page).read_bytes() == (smoke.results / page).read_bytes()
    assert {
        "README.md",
        "CITATION.cff",
        ".zenodo.json",
        "ro-crate-metadata.json",
        SUMS,
        VALUES,
        "versions.txt",
        "study/smoke.yaml",
        "study/paper.yaml",
        "lubricants/mobilgear-shc-xmp-320.yaml",
        "code/COMMIT",
        "code/Snakefile",
        "code/lube/stages/film.py",
        "code/notebooks/fig02_film.ipynb",
    } <= set(names)
    assert not [name for name in names if "__pycache__" in name or "log" in name.split("/")]
    assert "numpy==" in (archive / "versions.txt").read_text()
    assert issues_of(archive, tmp_path) == []


def test_zip_and_folder_hold_the_same_and_their_sums_are_right(archive):
    with zipfile.ZipFile(archive.with_suffix(".zip")) as packed:
        assert sorted(packed.namelist()) == [f"smoke/{name}" for name in files_of(archive)]
        assert {entry.date_time for entry in packed.infolist()} == {(1980, 1, 1, 0, 0, 0)}
        for name in files_of(archive):
            assert packed.read(f"smoke/{name}") == (archive / name).read_bytes()
    for sums, folder in ((SUMS, archive), ("smoke.zip.sha256", archive.parent)):
        command = ["sha256sum", "--strict", "--quiet", "--check", sums]
        assert subprocess.run(command, cwd=folder, check=False).returncode == 0


def test_figures_and_numbers_are_made_again_from_the_zip_alone(archive, tmp_path):
    with zipfile.ZipFile(archive.with_suffix(".zip")) as packed:
        packed.extractall(tmp_path)
    share_kernels(tmp_path / "smoke/code")
    point = ("--force", 1600, "--speed", 100, "--temperature", 80, "--realisation", 3)
    said = lube(
        ["figures", "smoke", "fig17_gauge", "--to", "new"],
        ["explain", "smoke/data/contact.nc", *point],
        ["verify", "smoke"],
        folder=tmp_path,
    )
    assert "2 of 2 the same, byte for byte\n" in said
    assert said.count("the same bits") == 5, said
    assert said.endswith("smoke: nothing wrong\n[0, 0, 0]\n"), said


@pytest.mark.slow
def test_snakemake_makes_the_same_archive_again_and_verifies_it_each_time(published, archive):
    first = fingerprint(archive.with_suffix(".zip"))
    published.run("archive", "--forcerun", "archive")
    assert fingerprint(archive.with_suffix(".zip")) == first
    before = published.snapshot()
    assert "results/smoke/archive/smoke: nothing wrong" in published.run("verify")
    made = dict(published.snapshot().items() - before.items())
    assert {path.name for path in made} == {"verify.log"}
    picture = archive / "figures/fig02_film.png"
    whole = picture.read_bytes()
    picture.write_bytes(whole + b"0")
    verified = published.snakemake("verify")
    picture.write_bytes(whole)
    assert verified.returncode != 0
    assert "Wrong: figures/fig02_film.png: changed" in verified.stdout
