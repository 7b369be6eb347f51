"""What the checks of an archive find wrong, and what they accept."""

import shutil
import zipfile

import pytest
import xarray as xr
import yaml
from studies import CONFIG, SMOKE_DATASETS

from lube.archive.build import SUMS, VALUES, files_of, make_archive, sums_of
from lube.archive.verify import unpacked, verify_archive
from lube.errors import DataError
from lube.storage.netcdf import save
from lube.storage.provenance import fingerprint
from lube.study.study import load_study

FOREIGN = f": does not belong to the archive: not in {SUMS}"


def verified_with_new_sums(folder):
    """What is wrong with an archive once its sums fit its files again."""
    (folder / SUMS).write_text(sums_of(folder))
    return verify_archive(folder)


def edit(path, old, new):
    """Replace a text that occurs once in a file."""
    text = path.read_text("utf-8")
    assert text.count(old) == 1
    path.write_text(text.replace(old, new), "utf-8")


# Sums


def test_changed_missing_and_foreign_files_are_named(changed):
    assert verify_archive(changed) == []
    (changed / "study/smoke.yaml").write_text("other")
    (changed / "data/film.nc").rename(changed / "data/movie.nc")
    assert verify_archive(changed) == [
        "data/film.nc: missing",
        "study/smoke.yaml: changed: its SHA-256 is not the one in SHA256SUMS",
        f"data/movie.nc{FOREIGN}",
    ]


def test_files_left_by_browsing_and_running_the_code_are_accepted(changed):
    for name in (".DS_Store", "figures/Thumbs.db", "code/lube/__pycache__/a.pyc", "code/build/b"):
        (changed / name).parent.mkdir(parents=True, exist_ok=True)
        (changed / name).write_bytes(b"0")
    assert verify_archive(changed) == []


def test_damaged_sums_are_found(changed):
    for content in (b"\xff", b"no sums"):
        (changed / SUMS).write_bytes(content)
        assert verify_archive(changed)
    (changed / SUMS).unlink()
    with (
        pytest.raises(DataError, match="not an archive: SHA256SUMS is missing"),
        unpacked(changed),
    ):
        pass


def test_the_results_that_an_archive_lies_in_are_not_taken_for_it(tmp_path):
    inside = tmp_path / "archive" / "mine"
    inside.mkdir(parents=True)
    (inside / SUMS).touch()
    for folder in (inside, inside.parent):
        with unpacked(folder) as found:
            assert found == inside
    with pytest.raises(DataError, match="not an archive"), unpacked(tmp_path):
        pass


# Contents


def test_a_dataset_of_another_kind_or_damaged_is_found(changed):
    shutil.copy(changed / "data/film.nc", changed / "data/lubricant.nc")
    (changed / "data/trace.nc").write_bytes(b"no NetCDF")
    (changed / "data/rig.nc").unlink()
    wrong = verified_with_new_sums(changed)
    for expected in (
        "data/lubricant.nc: not a lubricant file",
        "data/trace.nc: not a complete NetCDF file",
        "data/rig.nc: no such file",
    ):
        assert any(line.startswith(expected) for line in wrong)


def test_values_that_are_not_the_studys_are_found(changed):
    edit(changed / VALUES, '"realisations": 4', '"realisations": 3')
    assert verified_with_new_sums(changed) == ["values.json: not what study/smoke.yaml says"]


# Origin


def test_a_study_of_other_values_is_found_by_the_values_in_the_files(changed):
    edit(changed / "study/paper.yaml", "shear_strength: 1 MPa", "shear_strength: 2 MPa")
    wrong = verified_with_new_sums(changed)
    assert {line.split(": ")[0] for line in wrong} == {
        "data/contact.nc",
        "data/trace.nc",
        "data/master.nc",
        "data/rig.nc",
        "data/experiment.nc",
        "data/comparison.nc",
        "data/gauge.nc",
        "values.json",
        "data/tail.nc",
        "data/height_distribution.nc",
    }
    assert wrong[0].endswith("shear_strength is 1000000.0, need 2000000.0")


def test_files_of_another_study_are_found_by_its_title_and_creators(changed):
    edit(changed / "study/smoke.yaml", "a toy", "the truth")
    edit(changed / "study/paper.yaml", "The authors of lube", "Somebody Else")
    wrong = verified_with_new_sums(changed)
    assert any(line.startswith("data/film.nc: title is ") for line in wrong)
    assert any("creator_name is 'The authors of lube', need 'Somebody" in line for line in wrong)


def test_files_of_another_run_are_found_by_the_chain_of_sums(changed):
    film = changed / "data/film.nc"
    with xr.open_dataset(film) as dataset:
        saved_again = dataset.load()
    film.unlink()
    saved_again.to_netcdf(film)
    wrong = verified_with_new_sums(changed)
    assert "data/contact.nc: was made from another film.nc than the archive's" in wrong
    (record,) = changed.glob("lubricants/*.yaml")
    record.write_text(record.read_text("utf-8") + "# changed\n", "utf-8")
    expected = f"data/lubricant.nc: was made from another {record.name} than the archive's"
    assert expected in verified_with_new_sums(changed)


def test_a_changed_figure_and_one_of_other_data_are_found(changed):
    origin = changed / "figures/fig02_film.json"
    sha = fingerprint(changed / "data/film.nc")
    edit(origin, sha, sha[::-1])
    (changed / "figures/fig02_film.pdf").write_text("another")
    assert verified_with_new_sums(changed) == [
        "figures/fig02_film.pdf: not as the workflow made it",
        "figures/fig02_film.png: was drawn from another film.nc",
    ]
    origin.unlink()
    assert verified_with_new_sums(changed) == ["figures/fig02_film.json: missing or damaged"]


def test_of_measured_records_the_manifest_is_checked(datasets, archive, tmp_path):
    shutil.copytree(CONFIG, tmp_path, dirs_exist_ok=True)
    mine, manifest, record = (tmp_path / name for name in ("mine.yaml", "list.csv", "film.nc"))
    content = {"based_on": "smoke.yaml", "name": "mine", "experiment": {"manifest": "list.csv"}}
    mine.write_text(yaml.safe_dump(content))
    manifest.write_text("file\nfilm.nc\n")  # a record with the name of a dataset
    record.write_text("measured")
    study = load_study(mine)
    results = shutil.copytree(archive / "data", tmp_path / "results")
    for kind in SMOKE_DATASETS:
        inputs = [results / "film.nc", manifest, record] if kind == "experiment" else []
        save(datasets[kind], results / f"{kind}.nc", kind, study, inputs)
    (results / "explorer.html").write_text("page")
    make_archive(study, mine, results, [], results / "mine")
    assert verify_archive(results / "mine") == []
    assert "study/film.nc" not in files_of(results / "mine")
    (results / "mine/study/list.csv").write_text("file\nother.nc\n")
    expected = "data/experiment.nc: was made from another list.csv than the archive's"
    assert verified_with_new_sums(results / "mine") == [expected]


# Zips


@pytest.mark.parametrize("root", ["", "renamed/", "one/two/"])
def test_a_zip_is_read_however_it_was_packed(archive, tmp_path, root):
    path = tmp_path / "new.zip"
    with zipfile.ZipFile(path, "w") as packed:
        for name in files_of(archive):
            packed.write(archive / name, root + name)
        packed.writestr("__MACOSX/smoke/._README.md", b"as macOS does")
    with unpacked(path) as folder:
        wrong = verify_archive(folder)
    assert wrong == ([] if root else ["__MACOSX/smoke/._README.md" + FOREIGN])


def test_a_damaged_zip_is_found(archive, tmp_path):
    packed = archive.with_suffix(".zip").read_bytes()
    path = tmp_path / "damaged.zip"
    with zipfile.ZipFile(archive.with_suffix(".zip")) as whole:
        largest = sorted(whole.infolist(), key=lambda member: member.compress_size)[-2:]
    for member in largest:
        position = member.header_offset + 100 + member.compress_size // 2  # behind its header
        path.write_bytes(packed[:position] + bytes([packed[position] ^ 4]) + packed[position + 1 :])
        with (
            pytest.raises(DataError, match=r"damaged.zip: neither a folder nor a complete zip"),
            unpacked(path),
        ):
            pass
