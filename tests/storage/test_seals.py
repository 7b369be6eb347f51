"""A seal notices every change of a file, and no reader of the file notices the seal."""

import shutil
import subprocess

import netCDF4
import pytest
import xarray as xr

from lube.storage.seals import LENGTH, holds, seal

CONTENT = b"lines\nand\0bytes" * 3


@pytest.fixture
def sealed(tmp_path):
    """A small file with its seal."""
    path = tmp_path / "sealed"
    path.write_bytes(CONTENT)
    seal(path)
    return path


def test_a_seal_is_a_last_line_of_its_own(sealed):
    whole = sealed.read_bytes()
    assert whole.startswith(CONTENT + b"\nsha256 of all before this line: ")
    assert len(whole) == len(CONTENT) + LENGTH
    assert holds(sealed) is True


def test_every_flipped_bit_breaks_the_seal_or_takes_it_away(sealed):
    whole = sealed.read_bytes()
    for place in range(len(whole)):
        for bit in range(8):
            flipped = bytearray(whole)
            flipped[place] ^= 1 << bit
            sealed.write_bytes(flipped)
            held = holds(sealed)
            assert held is False or (held is None and place >= len(CONTENT))


def test_a_file_cut_short_anywhere_has_no_seal(sealed):
    whole = sealed.read_bytes()
    for length in range(len(whole)):
        sealed.write_bytes(whole[:length])
        assert holds(sealed) is None


@pytest.mark.parametrize("size", [0, 1, 2**20 - 1, 2**20, 2**20 + 1])
def test_files_of_any_size_are_sealed(tmp_path, size):
    path = tmp_path / "sealed"
    path.write_bytes(b"\n" * size)
    seal(path)
    assert holds(path) is True


@pytest.mark.skipif(not shutil.which("sha256sum"), reason="no sha256sum here")
def test_a_stranger_checks_a_seal_with_the_shell_as_documented(sealed):
    command = f"head -c -{LENGTH} {sealed} | sha256sum; tail -n 1 {sealed}"
    said = subprocess.run(["sh", "-c", command], capture_output=True, text=True, check=True)
    computed, told = said.stdout.splitlines()
    assert computed.split()[0] == told.split(": ")[1]


def test_changing_a_sealed_netcdf_file_takes_its_seal_away(tmp_path):
    path = tmp_path / "sealed.nc"
    xr.Dataset({"height": ("position", [1.0, 2.0])}).to_netcdf(path)
    seal(path)
    assert holds(path) is True
    with xr.open_dataset(path) as opened:
        assert opened["height"].values.tolist() == [1.0, 2.0]
    with netCDF4.Dataset(path, "a") as file:
        file["height"][:] = 3.0
    assert holds(path) is not True
