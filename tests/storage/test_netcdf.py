"""NetCDF in and out: exact, the same bytes each time, whole or not there at all."""

import netCDF4
import numpy as np
import pytest
import xarray as xr

from lube.errors import DataError
from lube.schema import FILES
from lube.storage.netcdf import load, save


def test_what_is_saved_is_loaded_with_its_labels(datasets, files):
    assert set(datasets) == set(FILES)
    for kind, dataset in datasets.items():
        loaded = load(files / f"{kind}.nc", kind)
        for name in {"in_validity_range", "within_prediction"} & set(loaded):
            loaded[name] = loaded[name].astype(bool)  # NetCDF has no Boolean type
        xr.testing.assert_equal(loaded, dataset)
        for name, array in dataset.variables.items():
            assert loaded[name].attrs["long_name"] == array.attrs["long_name"]
            assert loaded[name].attrs.get("units") == array.attrs.get("units")
        for name, value in dataset.attrs.items():
            np.testing.assert_array_equal(loaded.attrs[name], value)


def test_heights_are_exact_after_packing_and_padding_stays_missing(datasets, files):
    heights = datasets["roughness"]["height"].values
    loaded = load(files / "roughness.nc", "roughness")["height"].values
    assert loaded.dtype == np.float64
    assert np.isnan(heights).any()
    np.testing.assert_array_equal(loaded, heights)
    with netCDF4.Dataset(files / "roughness.nc") as raw:
        assert raw["height"].dtype == np.int32


def test_a_dataset_saved_twice_or_loaded_and_saved_again_is_the_same(
    datasets, files, study, tmp_path
):
    again = tmp_path / "new" / "again.nc"
    for kind, dataset in datasets.items():
        save(dataset, again, kind, study)
        assert again.read_bytes() == (files / f"{kind}.nc").read_bytes()
        first = load(again, kind)
        save(first, again, kind, study)
        xr.testing.assert_identical(load(again, kind), first)


def test_a_kind_that_there_is_not_is_refused(files):
    with pytest.raises(DataError, match=r"kind: got 'films', did you mean 'film'\?"):
        load(files / "film.nc", "films")


def test_a_file_of_other_values_than_the_studys_is_refused(files, study):
    load(files / "contact.nc", "contact", study)
    other = study.model_copy(update={"seed": 1})
    expected = r"contact.nc: made from other values than this study's: .*seed is 20181109, need 1"
    with pytest.raises(DataError, match=expected):
        load(files / "contact.nc", "contact", other)


def test_on_a_disk_of_any_size_a_file_is_whole_or_not_there(datasets, study, tmp_path, disk):
    """The library may run out of space anywhere in the file, even while it closes it."""
    path = tmp_path / "small" / "film.nc"
    path.parent.mkdir()
    saved = {}
    for size in range(4, 400, 18):
        disk(path.parent, f"size={size}k")
        try:
            save(datasets["film"], path, "film", study)
        except DataError as error:
            assert str(error).startswith(f"{path}: cannot be written: ")
            assert "MiB are free on its disk" in str(error)
            assert not list(path.parent.iterdir())
        saved[size] = path.exists() and bool(load(path, "film"))
    assert list(saved.values()) == sorted(saved.values())
    assert not saved[4] and saved[382]
