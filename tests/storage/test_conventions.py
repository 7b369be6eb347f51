"""What a stranger sees who opens a file: labels, units and checksums, as the conventions ask."""

import json

import cf_units
import netCDF4
import numpy as np
import pytest
import xarray as xr
from compliance_checker.runner import CheckSuite, ComplianceChecker
from every_kind import KINDS

from lube.schema import check
from lube.storage.netcdf import save
from lube.storage.provenance import global_attributes

FINAL_KINDS = [kind for kind in KINDS if not kind.endswith("_batch")]


@pytest.mark.parametrize("kind", FINAL_KINDS)
def test_xarray_alone_gives_metres_and_labels(datasets, files, kind):
    with xr.open_dataset(files / f"{kind}.nc") as opened:
        check(opened, kind)
        for name, array in opened.variables.items():
            if array.dtype.kind == "f":
                assert array.attrs["units"]
                np.testing.assert_array_equal(array.values, datasets[kind][name].values)


def test_an_operating_point_is_selected_by_the_values_people_say(files, study):
    point = {"force": 800, "speed": 100, "temperature": 40}
    with xr.open_dataset(files / "contact.nc") as contact:
        chosen = contact["breakthrough_probability_mean"].sel(point)
        assert chosen.sizes["film_formula"] == len(study.film_formulas)
        assert chosen.notnull().all()


@pytest.mark.parametrize("kind", KINDS)
def test_files_say_where_they_come_from(files, study, kind):
    with netCDF4.Dataset(files / f"{kind}.nc") as raw:
        assert raw.data_model == "NETCDF4"
        for name, value in global_attributes(study, kind).items():
            assert raw.getncattr(name) == value


@pytest.fixture(scope="module")
def checker():
    """The compliance checker, its conventions loaded."""
    CheckSuite.load_all_available_checkers()
    return ComplianceChecker


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize(
    ("convention", "asked", "allowed"),
    [
        # CF's own `time` counts from a date; that of a trace begins with the revolution.
        (
            "cf:1.11",
            "all_priorities",
            {"Coordinate variable 'time' should have standard_name='time', found: 'None'"},
        ),
        # There is no standard name for anything that a lubrication study finds.
        ("acdd:1.3", "high_priorities", {"standard_name"}),
    ],
)
def test_files_keep_the_conventions(files, checker, tmp_path, kind, convention, asked, allowed):
    report = tmp_path / "report.json"
    _, broke = checker.run_checker(
        str(files / f"{kind}.nc"),
        [convention],
        verbose=0,
        criteria="strict",
        output_filename=str(report),
        output_format="json",
    )
    assert not broke
    found = json.loads(report.read_text(encoding="utf-8"))[convention]
    assert {message for result in found[asked] for message in result["msgs"]} <= allowed


@pytest.mark.parametrize("kind", KINDS)
def test_every_number_has_a_unit_that_udunits_knows_and_every_variable_a_long_name(files, kind):
    with netCDF4.Dataset(files / f"{kind}.nc") as raw:
        for array in raw.variables.values():
            assert array.long_name
            assert hasattr(array, "units") == (array.dtype.kind != "S")
            if hasattr(array, "units"):
                assert not cf_units.Unit(array.units).is_unknown()


@pytest.mark.parametrize("kind", KINDS)
def test_no_coordinate_has_a_fill_value_and_heights_alone_have_one(files, kind):
    with netCDF4.Dataset(files / f"{kind}.nc") as raw:
        filled = {name for name, array in raw.variables.items() if "_FillValue" in array.ncattrs()}
    assert filled == ({"height"} if kind == "roughness" else set())


@pytest.mark.parametrize("kind", KINDS)
def test_every_array_is_checksummed_and_numbers_are_compressed(files, kind):
    with netCDF4.Dataset(files / f"{kind}.nc") as raw:
        for array in raw.variables.values():
            filters = array.filters()
            assert filters["fletcher32"] == (array.ndim > 0)
            if array.ndim and array.dtype.kind != "S":
                assert filters["zlib"] and filters["shuffle"]
                assert filters["complevel"] == 4
                assert array.chunking() != "contiguous"


def test_a_file_for_minutes_is_checksummed_but_not_compressed(datasets, study, tmp_path):
    save(datasets["roughness_batch"], tmp_path / "b.nc", "roughness_batch", study, compress=False)
    with netCDF4.Dataset(tmp_path / "b.nc") as raw:
        filters = raw["height"].filters()
    assert filters["fletcher32"] and not filters["zlib"]
