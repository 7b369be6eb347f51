"""What an archive's checks find wrong, and that nothing but its own figures is drawn again."""

import json
import shutil

import pytest

from lube.archive import SUMS, files_of
from lube.errors import DataError, LubeError
from lube.provenance import fingerprint
from lube.verify import redraw, unpacked, verify_archive


@pytest.fixture
def spoilt(archive, tmp_path):
    """A copy of the archive, free to be changed."""
    return shutil.copytree(archive, tmp_path / "archive")


def with_true_sums(folder):
    """Give an archive fingerprints that fit its files, as a careful forger would."""
    names = [name for name in files_of(folder) if name != SUMS]
    lines = [f"{fingerprint(folder / name)}  {name}\n" for name in names]
    (folder / SUMS).write_text("".join(lines))


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


# What is drawn again


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
