"""What others see who open a file: labels, units and checksums, as the conventions ask."""

import functools
import json

import cf_units
import netCDF4
import pytest
from compliance_checker.cf import util
from compliance_checker.runner import CheckSuite, ComplianceChecker

from lube.schema import FILES
from lube.storage.provenance import global_attributes

# What the compliance checker reads anew in each of its checks: most of its time.
READ = (
    "StandardNameTable",
    "get_auxiliary_coordinate_variables",
    "get_axis_variables",
    "get_geophysical_variables",
    "get_time_variables",
)


@pytest.fixture
def checker(monkeypatch):
    """The compliance checker, its conventions loaded.

    The files do not change meanwhile, nor do the standard names, so that once is enough.
    """
    for name in READ:
        monkeypatch.setattr(util, name, functools.cache(getattr(util, name)))
    CheckSuite.load_all_available_checkers()
    return ComplianceChecker


# Conventions with the checks that we run, and the complaints that we accept.
CONVENTIONS = {
    # CF's own `time` counts from a date; that of a trace begins with the revolution.
    ("cf:1.11", "all_priorities"): {
        "Coordinate variable 'time' should have standard_name='time', found: 'None'"
    },
    # There is no standard name for the variables of a lubrication study.
    ("acdd:1.3", "high_priorities"): {"standard_name"},
}


def test_files_follow_the_conventions(files, checker, tmp_path):
    for kind in FILES:
        report = tmp_path / f"{kind}.json"
        _, broke = checker.run_checker(
            str(files / f"{kind}.nc"),
            [convention for convention, _ in CONVENTIONS],
            verbose=0,
            criteria="strict",
            output_filename=str(report),
            output_format="json",
        )
        assert not broke
        found = json.loads(report.read_text(encoding="utf-8"))
        for (convention, asked), allowed in CONVENTIONS.items():
            messages = {one for result in found[convention][asked] for one in result["msgs"]}
            assert messages <= allowed, kind


def test_variables_are_named_and_stored_as_the_conventions_ask(files, study):
    for kind in FILES:
        with netCDF4.Dataset(files / f"{kind}.nc") as raw:
            assert raw.data_model == "NETCDF4"
            for name, value in global_attributes(study, kind).items():
                assert raw.getncattr(name) == value
            for name, array in raw.variables.items():
                assert array.long_name
                is_text, filters = array.dtype.kind == "S", array.filters()
                assert hasattr(array, "units") != is_text
                assert is_text or not cf_units.Unit(array.units).is_unknown()
                assert hasattr(array, "_FillValue") == (kind == "roughness" and name == "height")
                assert filters["fletcher32"] == (array.ndim > 0)
                if array.ndim and not is_text:
                    assert filters["zlib"] and filters["shuffle"] and filters["complevel"] == 4
                    assert array.chunking() != "contiguous"
