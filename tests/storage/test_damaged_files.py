"""Missing, damaged, truncated and foreign files are refused in one line that names the file."""

import shutil

import xarray as xr
from refusals import one_line

from lube.errors import DataError
from lube.schema import FILES
from lube.storage.netcdf import load


def refusal(path, kind):
    message = one_line(DataError, load, path, kind)
    assert message.startswith(f"{path}: ")
    return message


def test_a_missing_file_and_a_folder_are_named(tmp_path):
    for path, came in ((tmp_path / "film.nc", "no such file"), (tmp_path, "a folder")):
        assert f": {came}, need a film dataset" in refusal(path, "film")


def test_a_truncated_file_is_refused(files, tmp_path):
    for kind in FILES:
        whole = (files / f"{kind}.nc").read_bytes()
        path = tmp_path / f"{kind}.nc"
        for length in (0, 7, len(whole) // 100, len(whole) // 2, len(whole) - 1):
            path.write_bytes(whole[:length])
            assert "not a complete NetCDF file" in refusal(path, kind)


def test_foreign_files_are_refused(tmp_path):
    path = tmp_path / "film.nc"
    path.write_bytes(b"force,speed\n800,100\n")
    assert "not a complete NetCDF file" in refusal(path, "film")
    xr.Dataset({"sea_surface_temperature": ("time", [1.0, 2.0])}).to_netcdf(path)
    assert "not a film file" in refusal(path, "film")
    time = ("time", [0.0, 1.0], {"units": "days since yesterday"})
    xr.Dataset(coords={"time": time}).to_netcdf(path)
    assert "not a complete NetCDF file" in refusal(path, "film")


def test_a_file_of_another_kind_is_refused(files):
    for kind in FILES:
        other = "film" if kind != "film" else "trace"
        assert f"not a {other} file" in refusal(files / f"{kind}.nc", other)


def test_one_flipped_bit_of_the_data_is_found_by_its_checksum(files, tmp_path):
    path = shutil.copy(files / "roughness.nc", tmp_path / "roughness.nc")
    whole = bytearray(path.read_bytes())
    whole[len(whole) // 4] ^= 1  # among the heights, which follow the header
    path.write_bytes(whole)
    assert "damaged" in refusal(path, "roughness")
