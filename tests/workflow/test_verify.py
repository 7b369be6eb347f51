"""What the checks of an archive find wrong, and what they let pass."""

import errno
import json
import os
import shutil
import zipfile

import netCDF4
import numpy as np
import pytest
import xarray as xr
from refusals import in_time

from lube.archive.build import SUMS, VALUES, files_of
from lube.archive.verify import unpacked, verify_archive
from lube.errors import DataError
from lube.storage.provenance import fingerprint
from lube.storage.seals import seal

FOREIGN = f": does not belong to the archive: not in {SUMS}"


def with_true_sums(folder):
    """Give an archive fingerprints that fit its files, as a careful forger would."""
    names = [name for name in files_of(folder) if name != SUMS]
    lines = [f"{fingerprint(folder / name)}  {name}\n" for name in names]
    (folder / SUMS).write_text("".join(lines))


# What is wrong is said


@pytest.mark.parametrize(
    "name",
    ["data/film.nc", "figures/fig02_film.png", "study/smoke.yaml", "code/lube/stages/film.py"],
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
    assert {line.split(": ")[0] for line in wrong} == {
        *("data/contact.nc", "data/trace.nc", "data/master.nc", "data/rig.nc"),
        *("data/experiment.nc", "data/comparison.nc", "data/gauge.nc", "values.json"),
    }
    assert "snakemake" not in wrong[0]  # which a stranger need not have
    assert "shear_strength is 1000000.0, need 2000000.0" in wrong[0]


def test_a_file_of_another_run_is_found_out_by_the_chain_of_fingerprints(spoilt):
    film = spoilt / "data/film.nc"
    with xr.open_dataset(film) as dataset:
        changed = dataset.load()
    changed.attrs["history"] += ", twice"
    film.unlink()
    changed.to_netcdf(film)
    seal(film)
    with_true_sums(spoilt)
    wrong = verify_archive(spoilt)
    assert wrong
    assert all("was made from another film.nc than the archive's" in line for line in wrong)


@pytest.mark.parametrize("name", ["figures/fig02_film.pdf", "notebooks/fig02_film.ipynb"])
def test_a_forged_figure_is_found_out_by_what_was_made(spoilt, name):
    with (spoilt / name).open("ab") as file:
        file.write(b"\n")
    with_true_sums(spoilt)
    assert verify_archive(spoilt) == [f"{name}: not as the workflow made it"]


def test_a_figure_of_other_data_is_found_out(spoilt):
    path = spoilt / "figures/fig02_film.json"
    text = path.read_text("utf-8")
    digits = fingerprint(spoilt / "data/film.nc")
    assert text.count(digits) == 1
    path.write_text(text.replace(digits, digits[::-1]), "utf-8")
    with_true_sums(spoilt)
    told = "figures/fig02_film.png: was drawn from another film.nc"
    assert verify_archive(spoilt) == [told]


def test_a_figure_whose_origin_was_taken_away_is_named(spoilt):
    (spoilt / "figures/fig02_film.json").unlink()
    catalogue = spoilt / "ro-crate-metadata.json"
    graph = json.loads(catalogue.read_text("utf-8"))
    kept = [one for one in graph["@graph"] if one["@id"] != "figures/fig02_film.json"]
    catalogue.write_text(json.dumps({"@graph": kept}), "utf-8")
    with_true_sums(spoilt)
    assert verify_archive(spoilt) == ["figures/fig02_film.json: missing or damaged"]


def test_a_record_of_another_run_is_found_out(spoilt):
    (record,) = spoilt.glob("lubricants/*.yaml")
    record.write_text(record.read_text("utf-8") + "# as it was\n", "utf-8")
    with_true_sums(spoilt)
    told = f"data/lubricant.nc: was made from another {record.name} than the archive's"
    assert told in verify_archive(spoilt)


def test_a_dataset_that_somebody_saved_anew_is_found_out(spoilt):
    with xr.open_dataset(spoilt / "data/trace.nc") as dataset:
        changed = dataset.load()
    changed["contact_length"] = changed["contact_length"] * 3
    (spoilt / "data/trace.nc").unlink()
    changed.to_netcdf(spoilt / "data/trace.nc")
    with_true_sums(spoilt)
    assert "data/trace.nc: has no seal: not as lube saved it" in verify_archive(spoilt)


@pytest.mark.parametrize(
    ("taken", "told"),
    [
        ("figures", "figures/: missing, by ro-crate-metadata.json"),
        ("code", "code/: missing, by ro-crate-metadata.json"),
        ("data/contact.nc", "data/contact.nc: missing, by ro-crate-metadata.json"),
        ("ro-crate-metadata.json", "ro-crate-metadata.json: missing or damaged"),
    ],
)
def test_what_was_taken_away_with_its_sum_is_missed(spoilt, taken, told):
    path = spoilt / taken
    shutil.rmtree(path) if path.is_dir() else path.unlink()
    with_true_sums(spoilt)
    assert told in verify_archive(spoilt)


def test_what_was_slipped_in_with_its_sum_is_named(spoilt):
    (spoilt / "data/evil.nc").write_bytes(b"0")
    with_true_sums(spoilt)
    told = "data/evil.nc: does not belong to the archive, by ro-crate-metadata.json"
    assert verify_archive(spoilt) == [told]


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ('"seed": 20181109', '"seed": 5'),
        ('"realisations": 4', '"realisations": 3'),
        ("{", "[" * 200_000),
    ],
)
def test_forged_values_are_found_out_by_the_study(spoilt, old, new):
    values = spoilt / VALUES
    text = values.read_text("utf-8")
    assert old in text
    values.write_text(text.replace(old, new), "utf-8")
    with_true_sums(spoilt)
    (told,) = verify_archive(spoilt)
    assert told in (
        "values.json: not what study/smoke.yaml says",
        "values.json: missing or damaged",
    )


def test_a_forged_title_is_found_out_by_the_files(spoilt):
    study = spoilt / "study/smoke.yaml"
    text = study.read_text("utf-8")
    assert text.count("a toy") == 1
    study.write_text(text.replace("a toy", "the truth"), "utf-8")
    with_true_sums(spoilt)
    wrong = verify_archive(spoilt)
    assert any(line.startswith("data/film.nc: title is ") for line in wrong)


@pytest.mark.parametrize("name", ["data/__pycache__/evil.nc", "x__pycache__y", "study/build/a"])
def test_a_foreign_file_does_not_hide_behind_its_name(spoilt, name):
    (spoilt / name).parent.mkdir(exist_ok=True)
    (spoilt / name).write_bytes(b"0")
    assert verify_archive(spoilt) == [f"{name}: does not belong to the archive: not in {SUMS}"]


def test_links_and_pipes_do_not_belong_to_an_archive(spoilt):
    (spoilt / "data/link").symlink_to("nowhere")
    (spoilt / "data/root").symlink_to("/")
    os.mkfifo(spoilt / "data/pipe")
    film = spoilt / "data/film.nc"
    film.unlink()
    os.mkfifo(film)
    names = ["data/film.nc: not what it was"]
    names += [f"data/{name}: does not belong" for name in ("link", "pipe", "root")]
    with in_time():
        wrong = verify_archive(spoilt)
    assert [line.startswith(name) for line, name in zip(wrong, names, strict=True)] == [True] * 4


def test_what_looking_and_installing_leave_does_no_harm(spoilt):
    left = [".DS_Store", "figures/Thumbs.db", "code/lube/__pycache__/a.pyc", "code/build/b"]
    for name in left:
        (spoilt / name).parent.mkdir(parents=True, exist_ok=True)
        (spoilt / name).write_bytes(b"0")
    assert verify_archive(spoilt) == []


def test_sums_with_windows_line_ends_are_read(spoilt):
    sums = spoilt / SUMS
    sums.write_bytes(sums.read_bytes().replace(b"\n", b"\r\n"))
    assert verify_archive(spoilt) == []


def test_of_measured_records_the_list_is_checked_whatever_they_are_called(spare):
    for notebook in spare.notebooks[1:]:
        (spare / f"notebooks/{notebook}.ipynb").unlink()
    with netCDF4.Dataset(spare / "trace.nc", "w") as record:
        record.createDimension("time", 5000)
        for name, units, values in (("time", "s", np.arange(5000) / 1e4), ("resistance", "ohm", 5)):
            record.createVariable(name, "f8", ("time",)).units = units
            record[name][:] = values
    rows = ["file,force [N],speed [rpm],temperature [degC]", "trace.nc,800,100,40", ""]
    (spare / "records.csv").write_text("\n".join(rows), "utf-8")
    spare.run("archive", study=spare.with_values(experiment__manifest="records.csv"))
    archive = spare.results / "archive/smoke"
    assert verify_archive(archive) == []
    assert not (archive / "study/trace.nc").exists()
    (archive / "study/records.csv").write_text("\n".join(rows).replace("800", "1600"), "utf-8")
    with_true_sums(archive)
    told = "data/experiment.nc: was made from another records.csv than the archive's"
    assert verify_archive(archive) == [told]


# Zips


@pytest.mark.parametrize("root", ["", "renamed/", "one/two/"])
def test_a_zip_that_somebody_packed_anew_is_read(archive, tmp_path, root):
    path = tmp_path / "new.zip"
    with zipfile.ZipFile(path, "w") as packed:
        for name in files_of(archive):
            packed.write(archive / name, root + name)
        packed.writestr("__MACOSX/smoke/._README.md", b"as macOS does")
        if root:
            packed.writestr("seen.txt", b"beside it")
    with unpacked(path) as folder:
        wrong = verify_archive(folder)
    assert wrong == ([] if root else ["__MACOSX/smoke/._README.md" + FOREIGN])


def test_what_is_wrong_in_a_zip_is_told_by_its_place_in_it(spoilt, tmp_path):
    study = spoilt / "study/smoke.yaml"
    study.write_text(study.read_text("utf-8").replace("1 MPa", "2 MPa"), "utf-8")
    with_true_sums(spoilt)
    path = shutil.make_archive(tmp_path / "spoilt", "zip", spoilt)
    with unpacked(path) as folder:
        assert all(line.startswith(("data/", "values.json")) for line in verify_archive(folder))


def test_a_disk_too_full_to_unpack_is_told(archive, monkeypatch):
    def full(*_):
        raise OSError(errno.ENOSPC, "No space left on device")

    monkeypatch.setattr(zipfile.ZipFile, "extractall", full)
    told = "smoke.zip: cannot be unpacked: No space left on device"
    with pytest.raises(DataError, match=told), unpacked(archive.with_suffix(".zip")):
        pass


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
    told = 0
    for place in range(40, len(packed), len(packed) // 40):
        path = tmp_path / "flipped.zip"
        path.write_bytes(packed[:place] + bytes([packed[place] ^ 4]) + packed[place + 1 :])
        try:
            with unpacked(path) as folder:
                wrong = verify_archive(folder)
                # A bit may be one that matters to nobody, such as an entry's hour.
                assert wrong or contents(folder) == contents(archive)
                told += bool(wrong)
        except DataError:
            told += 1
    assert told >= 35


def contents(folder):
    return {name: (folder / name).read_bytes() for name in files_of(folder)}


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
