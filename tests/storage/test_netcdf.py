"""NetCDF in and out: whole, exact, the same bytes, or not there at all."""

import hashlib
import shutil

import netCDF4
import numpy as np
import pytest
import xarray as xr
from every_kind import KINDS, load_as_jobs_do

from lube.errors import DataError
from lube.storage.netcdf import load, opened, save


def bytes_of(path):
    return hashlib.sha256(path.read_bytes()).hexdigest()


# Round trips


def test_there_is_a_dataset_of_every_kind(datasets):
    assert set(datasets) == set(KINDS)


@pytest.mark.parametrize("kind", KINDS)
def test_what_is_saved_is_loaded_with_its_labels(datasets, files, kind):
    loaded = load_as_jobs_do(files / f"{kind}.nc", kind)
    for name in {"in_validity_range", "within_prediction"} & set(loaded):
        loaded[name] = loaded[name].astype(bool)  # NetCDF has no truth values
    xr.testing.assert_equal(loaded, datasets[kind])
    for name, array in datasets[kind].variables.items():
        assert loaded[name].attrs["long_name"] == array.attrs["long_name"]
        assert loaded[name].attrs.get("units") == array.attrs.get("units")
    for name, value in datasets[kind].attrs.items():
        np.testing.assert_array_equal(loaded.attrs[name], value)


def test_heights_are_exact_after_packing_and_padding_stays_missing(datasets, files):
    heights = datasets["roughness"]["height"].values
    loaded = load(files / "roughness.nc", "roughness")["height"].values
    assert loaded.dtype == np.float64
    assert np.isnan(heights).any()
    np.testing.assert_array_equal(loaded, heights)
    with netCDF4.Dataset(files / "roughness.nc") as raw:
        assert raw["height"].dtype == np.int32


def test_packed_heights_are_whole_steps_of_the_batch(datasets, files):
    steps = load(files / "roughness.nc", "roughness")["height"].values
    expected = datasets["roughness_batch"]["height"].values
    present = ~np.isnan(steps)
    step = datasets["roughness"].attrs["height_step"]
    np.testing.assert_array_equal(np.rint(steps[present] / step), expected[present])


def test_a_batch_is_left_as_whole_steps(datasets, files):
    with opened(files / "roughness_batch.nc", "roughness_batch") as dataset:
        loaded = dataset.load()
    assert loaded["height"].dtype == np.int32
    np.testing.assert_array_equal(loaded["height"], datasets["roughness_batch"]["height"])


def test_a_loaded_dataset_does_not_hang_on_its_file(files, tmp_path):
    path = shutil.copy(files / "film.nc", tmp_path / "film.nc")
    film = load(path, "film")
    path.unlink()
    assert np.isfinite(film["film_thickness"].values).all()


# The same bytes, and whole or not at all


@pytest.mark.parametrize("kind", KINDS)
def test_two_saves_are_the_same_bytes(datasets, files, study, tmp_path, kind):
    save(datasets[kind], tmp_path / "again.nc", kind, study)
    assert bytes_of(tmp_path / "again.nc") == bytes_of(files / f"{kind}.nc")


@pytest.mark.parametrize("kind", KINDS)
def test_loading_and_saving_again_keeps_the_values(files, study, tmp_path, kind):
    first = load_as_jobs_do(files / f"{kind}.nc", kind)
    save(first, tmp_path / "again.nc", kind, study)
    xr.testing.assert_identical(load_as_jobs_do(tmp_path / "again.nc", kind), first)


@pytest.mark.parametrize("kind", KINDS)
def test_files_of_the_study_are_taken_and_of_other_values_refused(files, study, kind):
    load_as_jobs_do(files / f"{kind}.nc", kind, study)
    seed = study.model_copy(update={"seed": 1})
    message = r"belongs to other values than this study's: .*seed is 20181109, need 1; take it"
    if "seed" in study.stage_inputs(kind.removesuffix("_batch")):
        with pytest.raises(DataError, match=f"{kind}.nc: {message}"):
            load_as_jobs_do(files / f"{kind}.nc", kind, seed)


def test_a_dataset_that_does_not_fit_its_kind_leaves_the_old_file(datasets, files, study, tmp_path):
    path = shutil.copy(files / "film.nc", tmp_path / "film.nc")
    before = bytes_of(path)
    with pytest.raises(DataError, match="film_thickness"):
        save(datasets["film"].drop_vars("film_thickness"), path, "film", study)
    assert bytes_of(path) == before
    assert list(tmp_path.iterdir()) == [path]


@pytest.mark.parametrize("moment", ["os.replace", "xarray.Dataset.to_netcdf"])
def test_a_save_that_fails_midway_leaves_the_old_file_and_no_rest(
    datasets, files, study, tmp_path, monkeypatch, moment
):
    path = shutil.copy(files / "film.nc", tmp_path / "film.nc")
    before = bytes_of(path)

    def fail(*arguments, **options):
        raise OSError("No space left on device")

    monkeypatch.setattr(moment, fail)
    with pytest.raises(DataError, match=r"film.nc: cannot be written: No space left.*MiB are free"):
        save(datasets["film"], path, "film", study)
    assert bytes_of(path) == before
    assert list(tmp_path.iterdir()) == [path]


@pytest.mark.parametrize("kind", ["film", "roughness_batch"])
def test_on_a_disk_of_any_size_a_file_is_whole_or_not_there(datasets, study, tmp_path, disk, kind):
    """The library may run out of space anywhere in the file, at the last also while it closes."""
    path = tmp_path / "small" / f"{kind}.nc"
    path.parent.mkdir()
    saved = {}
    for size in range(4, 400, 18):
        disk(path.parent, f"size={size}k")
        try:
            save(datasets[kind], path, kind, study, compress=kind == "film")
        except DataError as error:
            assert str(error).startswith(f"{path}: cannot be written: ")
            assert "MiB are free on its disk" in str(error)
            assert not list(path.parent.iterdir())
        saved[size] = path.exists() and bool(load_as_jobs_do(path, kind))
    assert list(saved.values()) == sorted(saved.values())
    assert not saved[4] and saved[382]


@pytest.mark.parametrize("error", [OSError(28, "No space left"), ValueError(), RuntimeError()])
def test_what_goes_wrong_while_a_whole_file_is_open_is_not_its_fault(files, error):
    with pytest.raises(type(error)) as caught, opened(files / "film.nc", "film"):
        raise error
    assert caught.value is error


def test_saving_makes_the_folder_it_needs(datasets, study, tmp_path):
    save(datasets["film"], tmp_path / "new" / "folder" / "film.nc", "film", study)
    load(tmp_path / "new" / "folder" / "film.nc", "film")
