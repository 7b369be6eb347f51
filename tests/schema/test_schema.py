"""The schema: labels written last, and every departure from it refused by name."""

import numpy as np
import pytest
import xarray as xr

from lube.errors import DataError
from lube.schema import ATTRIBUTES, COORDINATES, FILES, check, label

KINDS = list(FILES)
VARIABLES = [(kind, name) for kind in KINDS for name in FILES[kind]]
SIZE = 2


def values_of(expected):
    """Some values of the type and shape that the schema expects of a variable."""
    shape = (SIZE,) * len(expected.dims)
    count = np.arange(SIZE ** len(shape)).reshape(shape)
    dtypes = {"f": float, "i": np.int64, "b": bool, "U": str}
    return count.astype(dtypes[expected.kind])


def example(kind):
    """A dataset with the variables, dimensions and types of a kind, but no labels."""
    variables = {name: (row.dims, values_of(row)) for name, row in FILES[kind].items()}
    dims = {dim for row in FILES[kind].values() for dim in row.dims}
    coords = {
        dim: values_of(COORDINATES[dim]) for dim in dims if dim in COORDINATES and dim != "position"
    }
    return xr.Dataset(variables, coords, dict.fromkeys(ATTRIBUTES.get(kind, ()), 1.0))


def refusal(dataset, kind):
    with pytest.raises(DataError) as caught:
        check(dataset, kind, "file.nc")
    message = str(caught.value)
    assert message.startswith("file.nc: ")
    assert "\n" not in message
    return message


@pytest.mark.parametrize("kind", KINDS)
def test_label_writes_what_check_asks_for(kind):
    labelled = label(example(kind), kind)
    assert check(labelled, kind) is labelled
    for name, array in labelled.variables.items():
        expected = FILES[kind].get(name) or COORDINATES[name]
        assert array.attrs["long_name"] == expected.long_name
        assert array.attrs.get("units") == expected.units


@pytest.mark.parametrize("kind", KINDS)
def test_label_replaces_what_arithmetic_left_and_keeps_the_values(kind):
    untidy = example(kind)
    for array in untidy.variables.values():
        array.attrs = {"units": "furlong", "standard_name": "wrong"}
    labelled = label(untidy, kind)
    xr.testing.assert_equal(labelled, untidy)
    assert all("standard_name" not in array.attrs for array in labelled.variables.values())
    assert all(array.attrs["units"] == "furlong" for array in untidy.variables.values())


@pytest.mark.parametrize("row", [*COORDINATES.values(), *(FILES[k][n] for k, n in VARIABLES)])
def test_every_variable_is_described(row):
    assert row.long_name
    assert row.kind in "fibU"
    assert (row.units is None) == (row.kind == "U")


@pytest.mark.parametrize(("kind", "name"), VARIABLES)
def test_what_is_a_mean_says_over_what(kind, name):
    row = FILES[kind][name]
    words = ("mean ", "share of time", "breakthrough probability", "probability of", "rms diff")
    if row.long_name.startswith(words) and "limit" not in row.long_name:
        over, method = row.attributes["cell_methods"].split(": ", 1)
        assert over in (*row.dims, "revolutions", "duration")
        assert method.startswith(("mean", "root_mean_square"))


@pytest.mark.parametrize(
    "row", [FILES[k][n] for k, n in VARIABLES if "flag_values" in FILES[k][n].attributes]
)
def test_flags_have_as_many_meanings_as_values(row):
    assert len(row.attributes["flag_values"]) == len(row.attributes["flag_meanings"].split())


@pytest.mark.parametrize(("kind", "name"), VARIABLES)
def test_a_missing_variable_is_refused_by_name(kind, name):
    dataset = label(example(kind), kind).drop_vars(name)
    assert f"variable {name!r} is missing" in refusal(dataset, kind)


@pytest.mark.parametrize(("kind", "name"), VARIABLES)
def test_wrong_units_are_refused_with_both(kind, name):
    dataset = label(example(kind), kind)
    dataset[name].attrs["units"] = "furlong"
    assert refusal(dataset, kind).endswith(
        f"{name!r} is in 'furlong', need {FILES[kind][name].units!r}"
    )


@pytest.mark.parametrize(("kind", "name"), VARIABLES)
def test_a_wrong_type_is_refused(kind, name):
    dataset = label(example(kind), kind)
    attributes = dataset[name].attrs
    dataset[name] = dataset[name].astype(np.complex128 if FILES[kind][name].kind != "U" else float)
    dataset[name].attrs = attributes
    assert f"{name!r} holds" in refusal(dataset, kind)


@pytest.mark.parametrize("kind", [kind for kind in KINDS if kind != "reading"])
def test_swapped_dimensions_are_refused(kind):
    name = next(name for name, row in FILES[kind].items() if len(row.dims) > 1)
    dataset = label(example(kind), kind)
    dataset[name] = dataset[name].transpose(*reversed(dataset[name].dims))
    assert f"{name!r} has dimensions" in refusal(dataset, kind)


@pytest.mark.parametrize("kind", KINDS)
def test_a_variable_that_does_not_belong_there_is_refused(kind):
    dataset = label(example(kind), kind).assign(colour=1.0)
    assert "variable 'colour' does not belong there" in refusal(dataset, kind)
    with pytest.raises(DataError, match="colour"):
        label(dataset, kind)


@pytest.mark.parametrize("kind", ["lubricant", "film", "contact", "trace", "experiment"])
def test_a_missing_coordinate_is_refused(kind):
    dataset = label(example(kind), kind)
    name = next(name for name in dataset.indexes if name in COORDINATES)
    assert f"coordinate {name!r} is missing" in refusal(dataset.drop_vars(name), kind)


@pytest.mark.parametrize("kind", ["lubricant", "film", "contact", "trace", "gauge"])
def test_a_coordinate_that_repeats_a_value_is_refused(kind):
    dataset = label(example(kind), kind)
    name = next(name for name in dataset.indexes if name in COORDINATES)
    twice = dataset.isel({name: [0, 0]})
    assert f"coordinate {name!r} repeats a value" in refusal(twice, kind)


@pytest.mark.parametrize("kind", KINDS)
def test_a_file_of_another_kind_is_refused(kind):
    dataset = label(example(kind), kind)
    for other in set(KINDS) - {kind}:
        refusal(dataset, other)


@pytest.mark.parametrize("kind", ["experiment", "comparison", "gauge"])
def test_each_record_has_its_own_conditions_and_the_levels_it_is_near(kind):
    for name in ("force", "speed", "temperature", "lubricant", "slide_to_roll_ratio", "pair"):
        assert FILES[kind][name].dims == ("record",)
    for name in ("force", "speed", "temperature"):
        assert FILES[kind][f"{name}_level"].units == FILES[kind][name].units


@pytest.mark.parametrize("origin", ["measured", "simulated"])
def test_what_is_recorded_is_a_measurement_only_if_it_was_measured(origin):
    dataset = example("experiment")
    dataset["origin"] = origin
    word = label(dataset, "experiment")["repeatability"].attrs["coverage_content_type"]
    assert word == {"measured": "physicalMeasurement", "simulated": "modelResult"}[origin]


def test_truth_values_may_be_stored_as_small_integers():
    dataset = label(example("film"), "film")
    dataset["in_validity_range"] = dataset["in_validity_range"].astype("int8")
    check(label(dataset, "film"), "film")


def test_an_empty_dataset_is_no_file_of_any_kind():
    for kind in KINDS:
        assert "is missing" in refusal(xr.Dataset(), kind)


@pytest.mark.parametrize(
    ("kind", "name"), [(kind, name) for kind in ATTRIBUTES for name in ATTRIBUTES[kind]]
)
def test_a_missing_attribute_is_refused(kind, name):
    dataset = label(example(kind), kind)
    del dataset.attrs[name]
    assert repr(name) in refusal(dataset, kind)
