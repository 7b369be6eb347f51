"""Damaged, truncated and foreign files: told in one line that names the file, or harmless."""

import netCDF4
import numpy as np
import pytest
import xarray as xr
from every_kind import KINDS, load_as_jobs_do
from refusals import one_line

from lube.errors import DataError
from lube.storage.netcdf import load, save
from lube.storage.seals import LENGTH


def refusal(path, kind):
    message = one_line(DataError, load_as_jobs_do, path, kind)
    assert message.startswith(f"{path}: ")
    return message


# What is no file of its kind


def test_a_missing_file_is_named(tmp_path):
    assert "no such file, need a film dataset" in refusal(tmp_path / "film.nc", "film")


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("part", [0.0, 0.01, 0.5, 0.99])
def test_a_truncated_file_is_named(files, tmp_path, kind, part):
    whole = (files / f"{kind}.nc").read_bytes()
    path = tmp_path / f"{kind}.nc"
    path.write_bytes(whole[: int(part * len(whole))])
    assert "not a whole NetCDF file" in refusal(path, kind)


@pytest.mark.parametrize(
    "content", [b"", b"force,speed\n800,100\n", b"CDF\x01 and nonsense", b"\x89HDF\r\n\x1a\n" * 100]
)
def test_what_is_no_netcdf_is_named(tmp_path, content):
    path = tmp_path / "film.nc"
    path.write_bytes(content)
    assert "not a whole NetCDF file" in refusal(path, "film")


def test_a_folder_is_no_file(tmp_path):
    assert "no such file" in refusal(tmp_path, "film")


def test_a_foreign_netcdf_is_refused(tmp_path):
    path = tmp_path / "film.nc"
    xr.Dataset({"sea_surface_temperature": ("time", [1.0, 2.0])}).to_netcdf(path)
    assert "not a film file" in refusal(path, "film")


def test_a_netcdf_with_a_time_nobody_can_read_is_refused(tmp_path):
    path = tmp_path / "film.nc"
    time = ("time", [0.0, 1.0], {"units": "days since the flood"})
    xr.Dataset(coords={"time": time}).to_netcdf(path)
    assert "not a" in refusal(path, "film")


@pytest.mark.parametrize("kind", KINDS)
def test_a_file_of_another_kind_is_refused(files, kind):
    other = "film" if kind != "film" else "trace"
    assert f"not a {other} file" in refusal(files / f"{kind}.nc", other)


@pytest.mark.parametrize("kind", KINDS)
def test_one_flipped_bit_inside_the_data_is_noticed(datasets, study, tmp_path, kind):
    path = tmp_path / f"{kind}.nc"
    save(datasets[kind], path, kind, study, compress=False)
    whole = bytearray(path.read_bytes())
    whole[place_of_largest_array(path, whole)] ^= 1
    path.write_bytes(whole)
    assert "damaged" in refusal(path, kind)


def place_of_largest_array(path, whole):
    """Where in an uncompressed file the last bytes of the largest array's first line lie."""
    with netCDF4.Dataset(path) as raw:
        raw.set_auto_maskandscale(False)
        arrays = [array[:] for array in raw.variables.values() if array.dtype is not str]
    stored = max(arrays, key=np.size)
    whole_chunk = stored.size <= 2**18  # larger arrays are stored line by line
    line = (stored if whole_chunk else stored.reshape(-1, stored.shape[-1])[0]).tobytes()
    assert whole.count(line) == 1
    return whole.index(line) + len(line) - 1


def test_one_flipped_bit_inside_compressed_data_is_noticed(files, tmp_path):
    whole = bytearray((files / "roughness.nc").read_bytes())
    whole[len(whole) // 2] ^= 1  # heights are nearly all of this file
    path = tmp_path / "roughness.nc"
    path.write_bytes(whole)
    assert "damaged" in refusal(path, "roughness")


# Nothing but what was saved


def spread(size, count, seed):
    """Places all over a file: at its beginning, in its midst, and a few in its seal."""
    midst = np.random.default_rng(seed).integers(0, size - LENGTH, count).tolist()
    return {*range(20), *midst, *range(size - LENGTH - 2, size, 30)}


@pytest.mark.parametrize("kind", KINDS)
def test_a_flipped_bit_anywhere_is_told_or_harmless(datasets, files, tmp_path, kind):
    """Data, header, index of chunks, texts, unused space: HDF5 protects only some of them."""
    whole = (files / f"{kind}.nc").read_bytes()
    path = tmp_path / f"{kind}.nc"
    expected = load_as_jobs_do(files / f"{kind}.nc", kind)
    for place in spread(len(whole), 100, seed=len(kind)):
        flipped = bytearray(whole)
        flipped[place] ^= 1 << (place % 8)
        path.write_bytes(flipped)
        try:
            loaded = load_as_jobs_do(path, kind)
        except DataError as error:
            assert str(error).startswith(f"{path}: not a whole NetCDF file, damaged")
        else:
            assert place >= len(whole) - LENGTH  # in the seal itself
            xr.testing.assert_identical(loaded, expected)


@pytest.mark.parametrize("kind", KINDS)
def test_a_file_cut_anywhere_is_told_or_whole(files, tmp_path, kind):
    whole = (files / f"{kind}.nc").read_bytes()
    path = tmp_path / f"{kind}.nc"
    expected = load_as_jobs_do(files / f"{kind}.nc", kind)
    for length in spread(len(whole), 20, seed=len(kind)):
        path.write_bytes(whole[:length])
        try:
            loaded = load_as_jobs_do(path, kind)
        except DataError as error:
            assert str(error).startswith(f"{path}: not a whole NetCDF file, truncated")
            assert "\n" not in str(error)
        else:
            assert length >= len(whole) - LENGTH  # only the seal is cut
            xr.testing.assert_identical(loaded, expected)


def test_a_file_without_a_seal_is_taken_with_a_warning(datasets, files, tmp_path, caplog):
    path = tmp_path / "film.nc"
    path.write_bytes((files / "film.nc").read_bytes()[:-LENGTH])
    thickness = load(path, "film")["film_thickness"]
    xr.testing.assert_equal(thickness, datasets["film"]["film_thickness"])
    assert caplog.messages == [f"{path}: has no seal, so nobody knows if it is undamaged"]
