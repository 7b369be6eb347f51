"""Numbers with units from Python, and results in customary units."""

import inspect
import re

import numpy as np
import pint
import pytest
import xarray as xr
from studies import ROOT

import lube
from lube import StudyError
from lube.calculator.answers import described
from lube.calculator.arguments import amount, bare_number
from lube.lazy import homes


@pytest.mark.parametrize(
    "value",
    [
        ["400 N", "0.8 kN"],
        ("400 N", "800 N"),
        np.array(["400 N", "800 N"]),
        ([0.4, 0.8], "kN"),
        (np.array([400, 800]), "N"),
        pint.UnitRegistry().Quantity([0.4, 0.8], "kN"),
    ],
)
def test_several_numbers_are_given_in_many_ways(value):
    numbers = amount("force", value, "N")
    np.testing.assert_allclose(numbers, [400.0, 800.0], rtol=1e-14)
    assert numbers.dims == ("force",)


def test_one_number_has_no_dimension():
    for value in ("800 N", (0.8, "kN"), pint.UnitRegistry().Quantity(0.8, "kN")):
        assert amount("force", value, "N").dims == ()


@pytest.mark.parametrize(
    ("value", "message"),
    [
        (800, "force: got 800, need a number with its unit, such as '1 N'"),
        ("800", "force: got '800', need a number with its unit, such as '1 N'"),
        ("800 m", "force: wrong dimension or unit 'm', need a unit of the kind 'N'"),
        ("-1 N", "force: got -1 N, need a value above 0 N"),
        ((float("nan"), "N"), "force: got nan, need a value above 0 N"),
        ([], "force: got [], need a number with its unit, such as '1 N'"),
        (([], "N"), "force: got ([], 'N'), need one number with its unit, or a list of them"),
        (([[1]], "N"), "force: got ([[1]], 'N'), need one number with its unit, or a list of them"),
        ((["a"], "N"), "force: got ['a'], need numbers and their unit"),
    ],
)
def test_a_mistake_is_one_line_that_names_the_argument(value, message):
    with pytest.raises(StudyError) as error:
        amount("force", value, "N", above=0.0)
    assert str(error.value) == message


def test_a_share_may_be_in_percent():
    assert bare_number("share", "1 %", below=1.0) == bare_number("share", 0.01, below=1.0) == 0.01


def test_results_have_customary_units_and_names():
    table = xr.Dataset(
        {"film_thickness": ("force", [1e-6, 2e-6]), "regime": ("force", [0, 3])},
        {"force": [100.0, 200.0]},
    )
    found = described(table)
    np.testing.assert_array_equal(found["film_thickness"], [1.0, 2.0])
    assert found["film_thickness"].attrs == {"long_name": "film thickness", "units": "um"}
    assert found["regime"].values.tolist() == ["isoviscous_rigid", "piezoviscous_elastic"]
    assert found["force"].attrs["units"] == "N"
    assert "units" not in table["force"].attrs


def test_the_documentation_says_which_function_takes_which_choice():
    text = (ROOT / "docs/python.md").read_text(encoding="utf-8")
    head, _, *rows = re.findall(r"^\| (.*) \|$", text, re.MULTILINE)
    choices = [re.findall(r"`(\w+)`", cell) for cell in head.split(" | ")[1:]]
    listed = set()
    for row in rows:
        names, *cells = row.split(" | ")
        first, *others = re.findall(r"`(\w+)`", names)
        names = [first] + [f"required{one}" if one[0] == "_" else one for one in others]
        listed.update(names)
        for name in names:
            taken = inspect.signature(getattr(lube, name)).parameters
            for arguments, cell in zip(choices, cells, strict=True):
                is_taken = cell.startswith(("yes", "line"))
                assert all((each in taken) == is_taken for each in arguments), (name, arguments)
    functions = {name: getattr(lube, name) for name in homes("lube")}
    functions = {name: one for name, one in functions.items() if inspect.isfunction(one)}
    assert listed == {
        name for name, one in functions.items() if "rollers" in inspect.signature(one).parameters
    }
