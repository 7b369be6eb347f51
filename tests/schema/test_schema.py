"""The tables of all files are complete, and every departure from them is refused by name."""

from pathlib import Path

import numpy as np
import pytest
import xarray as xr

from lube.errors import DataError
from lube.schema import ATTRIBUTES, COORDINATES, FILES, check, label, tables, values_with_limits
from lube.schema.tables import read_table

VARIABLES = [(kind, name) for kind in FILES for name in FILES[kind]]
SIZE = 2


def values_of(expected):
    """Some values of the type and shape of a variable."""
    shape = (SIZE,) * len(expected.dims)
    dtypes = {"f": float, "i": np.int64, "b": bool, "U": str}
    return np.arange(SIZE ** len(shape)).reshape(shape).astype(dtypes[expected.kind])


def example(kind):
    """A dataset with the variables, dimensions and types of a kind, but no labels."""
    variables = {name: (row.dims, values_of(row)) for name, row in FILES[kind].items()}
    dims = {dim for row in FILES[kind].values() for dim in row.dims} & COORDINATES.keys()
    coords = {dim: values_of(COORDINATES[dim]) for dim in dims}
    return xr.Dataset(variables, coords, dict.fromkeys(ATTRIBUTES.get(kind, ()), 1.0))


@pytest.fixture(scope="module")
def labelled():
    return {kind: label(example(kind), kind) for kind in FILES}


def refusal(dataset, kind):
    with pytest.raises(DataError) as caught:
        check(dataset, kind, "file.nc")
    message = str(caught.value)
    assert message.startswith("file.nc: ") and "\n" not in message
    return message


def test_label_writes_what_check_asks_for_in_place_of_other_attributes():
    for kind in FILES:
        untidy = example(kind)
        for array in untidy.variables.values():
            array.attrs = {"units": "furlong", "standard_name": "wrong"}
        tidy = label(untidy, kind)
        assert check(tidy, kind) is tidy
        xr.testing.assert_equal(tidy, untidy)
        for name, array in tidy.variables.items():
            expected = FILES[kind].get(name) or COORDINATES[name]
            assert array.attrs["long_name"] == expected.long_name
            assert array.attrs.get("units") == expected.units
            assert "standard_name" not in array.attrs
            assert untidy[name].attrs["units"] == "furlong"


CONTENTS = {
    "coordinate",
    "modelResult",
    "qualityInformation",
    "auxiliaryInformation",
    "referenceInformation",
    "physicalMeasurement",
    "record",
}


def test_the_table_describes_each_variable_of_each_file_once():
    rows = read_table(Path(tables.__file__).with_name("variables.csv"))
    named = [(file, row["name"]) for row in rows for file in row["files"].split()]
    assert len(set(named)) == len(named)
    assert {file for file, _ in named} == {"any", *FILES}
    for row in rows:
        assert row["long_name"]
        assert row["content"] in CONTENTS
        assert (row["units"] == "") == (row["type"].removesuffix("?") == "text")


def test_the_cell_methods_of_a_mean_name_what_it_is_over():
    words = ("mean ", "share of time", "breakthrough probability", "probability of", "rms diff")
    for kind, name in VARIABLES:
        row = FILES[kind][name]
        if kind in (
            "tail",
            "areal",
            "surface_records",
            "variants",
            "sensitivity_runs_batch",
            "sensitivity_runs",
            "sensitivity",
            "verification",
            "record_bands",
            "plan",
            "electrical",
        ):
            continue  # expectations, not means
        if row.long_name.startswith(words) and "limit" not in row.long_name:
            assert "cell_methods" in row.attributes, f"{kind}: {name} is a mean over what?"
            over, method = row.attributes["cell_methods"].split(": ", 1)
            assert over in (*row.dims, "revolutions", "duration")
            assert method.startswith(("mean", "root_mean_square"))


def test_a_missing_variable_wrong_units_and_a_wrong_type_are_refused_by_name(labelled):
    for kind, name in VARIABLES:
        expected, dataset = FILES[kind][name], labelled[kind]
        if expected.optional:
            check(dataset.drop_vars(name), kind)
        else:
            assert f"variable {name!r} is missing" in refusal(dataset.drop_vars(name), kind)
        wrong = dataset[name].astype(complex if expected.kind != "U" else float)
        changed = dataset.assign({name: wrong.assign_attrs(dataset[name].attrs)})
        assert f"{name!r} holds" in refusal(changed, kind)
        changed = dataset.assign({name: dataset[name].assign_attrs(units="furlong")})
        ending = f"{name!r} is in 'furlong', need {expected.units!r}"
        assert refusal(changed, kind).endswith(ending)


def test_swapped_dimensions_and_unknown_variables_are_refused(labelled):
    for kind, dataset in labelled.items():
        for name, row in FILES[kind].items():
            if len(row.dims) > 1:
                swapped = dataset.assign({name: dataset[name].transpose(*reversed(row.dims))})
                assert f"{name!r} has dimensions" in refusal(swapped, kind)
        coloured = dataset.assign(colour=1.0)
        assert "variable 'colour' does not belong there" in refusal(coloured, kind)
        with pytest.raises(DataError, match="colour"):
            label(coloured, kind)


def test_a_coordinate_that_is_missing_or_repeats_a_value_is_refused(labelled):
    for kind in ("lubricant", "film", "contact", "trace", "experiment"):
        dataset = labelled[kind]
        name = next(name for name in dataset.indexes if name in COORDINATES)
        assert f"variable {name!r} is missing" in refusal(dataset.drop_vars(name), kind)
        twice = dataset.isel({name: [0, 0]})
        assert f"coordinate {name!r} repeats a value" in refusal(twice, kind)


def test_limits_have_the_names_of_the_tables():
    assert set(values_with_limits("contact_share", [0.5, 0.4, 0.6])) <= set(FILES["experiment"])


def test_a_missing_attribute_is_refused(labelled):
    for kind, names in ATTRIBUTES.items():
        for name in names:
            dataset = labelled[kind].copy()
            del dataset.attrs[name]
            assert repr(name) in refusal(dataset, kind)


@pytest.mark.parametrize("origin", ["measured", "simulated"])
def test_a_record_is_a_measurement_only_if_it_was_measured(origin):
    dataset = label(example("experiment").assign(origin=origin), "experiment")
    word = dataset["repeatability"].attrs["coverage_content_type"]
    assert word == {"measured": "physicalMeasurement", "simulated": "modelResult"}[origin]
