"""The archive of the smoke study, as a stranger finds it: whole, checkable, and drawn again."""

import json
import shutil
import subprocess
import sys
import zipfile

import pytest
from crates import issues_of
from repository import Repository, environment

from lube.archive import SUMS, VALUES, files_of
from lube.errors import DataError, LubeError
from lube.provenance import fingerprint
from lube.verify import redraw, unpacked, verify_archive


@pytest.fixture(scope="module")
def archived(smoke, tmp_path_factory):
    """A repository with the smoke study archived by Snakemake."""
    folder = tmp_path_factory.mktemp("archived") / "repository"
    repository = Repository(shutil.copytree(smoke.folder, folder, symlinks=True))
    said = repository.run("archive")
    assert "Archive: results/smoke/archive/smoke.zip" in said
    return repository


@pytest.fixture(scope="module")
def archive(archived):
    """The smoke study's archive; not to be changed."""
    return archived.results / "archive/smoke"


@pytest.fixture
def spoilt(archive, tmp_path):
    """A copy of the archive, free to be changed."""
    return shutil.copytree(archive, tmp_path / "archive")


def with_true_sums(folder):
    """Give an archive fingerprints that fit its files, as a careful forger would."""
    names = [name for name in files_of(folder) if name != SUMS]
    lines = [f"{fingerprint(folder / name)}  {name}\n" for name in names]
    (folder / SUMS).write_text("".join(lines))


def lube(*arguments, folder, code):
    """Run the command `lube` of an archive's own code, somewhere else."""
    return subprocess.run(
        [sys.executable, "-m", "lube.command", *map(str, arguments)],
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
        for name in (f"figures/{figure}.png", f"figures/{figure}.pdf", f"notebooks/{figure}.ipynb"):
            assert (archive / name).read_bytes() == (smoke.results / name).read_bytes()
    assert {
        *("README.md", "CITATION.cff", ".zenodo.json", "ro-crate-metadata.json", SUMS, VALUES),
        *("versions.txt", "study/smoke.yaml", "lubricants/mobilgear-shc-xmp-320.yaml"),
        *("code/Snakefile", "code/lube/film.py", "code/notebooks/fig02_film.ipynb", "code/COMMIT"),
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
    assert told.stdout.count("the same bits") == 4, told.stderr
    checked = lube("verify", "smoke", folder=tmp_path, code=code)
    assert checked.returncode == 0, checked.stdout


def test_a_figure_that_is_not_in_the_archive_is_refused(archive, tmp_path):
    with pytest.raises(DataError, match=r"got fig99, need a figure of the archive: fig01_visc"):
        list(redraw(archive, tmp_path, ["fig99"]))


@pytest.mark.parametrize("place", [".", "figures", "notebooks/../figures"])
def test_nothing_is_drawn_over_an_archive(archive, place):
    with pytest.raises(DataError, match="need a folder outside the archive"):
        list(redraw(archive, archive / place))
    assert verify_archive(archive) == []


def test_figures_are_drawn_of_an_archive_and_nothing_else(archive, archived, tmp_path):
    for folder in (archive.parent, archived.results):
        with pytest.raises(DataError, match="not an archive: SHA256SUMS is missing"):
            list(redraw(folder, tmp_path))


def test_a_notebook_that_is_not_there_is_told(spoilt, tmp_path):
    (spoilt / "code/notebooks/fig02_film.ipynb").unlink()
    with pytest.raises(LubeError, match=r"fig02_film.ipynb: cannot be read: No such file"):
        list(redraw(spoilt, tmp_path / "new", ["fig02_film"]))


def test_what_a_notebook_sets_besides_paths_stays_when_it_is_drawn_again(spoilt, tmp_path):
    notebook = spoilt / "code/notebooks/fig02_film.ipynb"
    content = json.loads(notebook.read_text("utf-8"))
    for cell in content["cells"]:
        if "parameters" in cell["metadata"].get("tags", []):
            cell["source"] += ["\nshown_force = 800"]
    content["cells"][-1]["source"] += ["\nassert shown_force == 800"]
    notebook.write_text(json.dumps(content), "utf-8")
    drawn = dict(redraw(spoilt, tmp_path / "new", ["fig02_film"]))
    assert drawn == {"fig02_film.png": True, "fig02_film.pdf": True}


def test_snakemake_verifies_what_is_there_and_makes_nothing(archived, archive):
    before = archived.snapshot()
    said = archived.run("verify")
    assert "results/smoke/archive/smoke: nothing wrong" in said
    made = dict(archived.snapshot().items() - before.items())
    assert {path.name for path in made} == {"verify.log", "verify.tsv"}


# What is wrong is said


@pytest.mark.parametrize(
    "name", ["data/film.nc", "figures/fig02_film.png", "study/smoke.yaml", "code/lube/film.py"]
)
def test_a_changed_file_is_named(spoilt, name):
    with (spoilt / name).open("r+b") as file:
        file.seek(100)
        byte = file.read(1)
        file.seek(100)
        file.write(bytes([byte[0] ^ 1]))
    assert verify_archive(spoilt) == [
        f"{name}: not what it was: its SHA-256 is not the one in SHA256SUMS"
    ]


def test_missing_and_foreign_files_are_named(spoilt):
    (spoilt / "data/film.nc").rename(spoilt / "data/movie.nc")
    assert verify_archive(spoilt) == [
        "data/film.nc: missing",
        "data/movie.nc: does not belong to the archive: not in SHA256SUMS",
    ]


def test_a_forged_study_is_found_out_by_the_values_in_the_files(spoilt):
    study = spoilt / "study/smoke.yaml"
    study.write_text(study.read_text().replace("shear_strength: 1 MPa", "shear_strength: 2 MPa"))
    with_true_sums(spoilt)
    wrong = verify_archive(spoilt)
    assert {line.split(": ")[0].rpartition("/")[2] for line in wrong} == {
        *("contact.nc", "trace.nc", "master.nc", "rig.nc"),
        *("experiment.nc", "comparison.nc", "gauge.nc"),
    }
    assert "shear_strength is 1000000.0, need 2000000.0" in wrong[0]


def test_a_file_of_another_run_is_found_out_by_the_chain_of_fingerprints(spoilt):
    film = spoilt / "data/film.nc"
    with film.open("ab") as file:
        file.write(b"\0")  # still a whole NetCDF file
    with_true_sums(spoilt)
    wrong = verify_archive(spoilt)
    assert wrong
    assert all("another film.nc than" in line for line in wrong)


def test_a_file_of_another_kind_is_found_out_by_the_schema(spoilt):
    shutil.copy(spoilt / "data/film.nc", spoilt / "data/lubricant.nc")
    with_true_sums(spoilt)
    assert any("lubricant.nc: not a lubricant file" in line for line in verify_archive(spoilt))


def test_files_of_another_study_are_found_out_by_its_name_and_makers(spoilt):
    study = spoilt / "study/smoke.yaml"
    text = study.read_text("utf-8").replace("name: smoke", "name: theirs")
    study.write_text(text.replace("The authors of lube", "Somebody Else"), "utf-8")
    with_true_sums(spoilt)
    wrong = verify_archive(spoilt)
    assert any("film.nc: study is 'smoke', need 'theirs'" in line for line in wrong)
    assert any("creator_name is 'The authors of lube', need 'Somebody" in line for line in wrong)


@pytest.mark.parametrize("content", [b"\xff", b"no sums"])
def test_damaged_sums_are_told(spoilt, content):
    with (spoilt / SUMS).open("r+b") as file:
        file.write(content)
    assert verify_archive(spoilt)


def test_a_zip_damaged_anywhere_is_told(archive, tmp_path):
    packed = archive.with_suffix(".zip").read_bytes()
    told = []
    for place in range(40, len(packed), len(packed) // 40):
        path = tmp_path / "flipped.zip"
        path.write_bytes(packed[:place] + bytes([packed[place] ^ 4]) + packed[place + 1 :])
        try:
            with unpacked(path) as folder:
                told += verify_archive(folder)
        except DataError as error:
            told.append(str(error))
    assert len(told) >= 40


@pytest.mark.parametrize(
    ("content", "told"),
    [
        (None, "no such archive; `snakemake archive` makes it"),
        (b"not a zip", "neither an archive's folder nor its zip"),
    ],
)
def test_what_is_no_archive_is_told(tmp_path, content, told):
    path = tmp_path / "some.zip"
    if content is not None:
        path.write_bytes(content)
    with pytest.raises(DataError, match=told), unpacked(path):
        pass


def test_a_folder_without_sums_is_no_archive(tmp_path):
    with pytest.raises(DataError, match="not an archive: SHA256SUMS is missing"):
        verify_archive(tmp_path)


# What is refused before any job


def test_a_study_without_makers_is_refused_before_any_job(smoke):
    before = smoke.snapshot()
    about = {"title": "mine", "date": "2026-11-21"}
    finished = smoke.snakemake("archive", study=smoke.with_values(about=about))
    assert finished.returncode != 0
    assert "The study cannot start. about.creators: missing" in finished.stdout
    assert "Traceback" not in finished.stdout
    assert smoke.snapshot() == before
