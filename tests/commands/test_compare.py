"""`lube compare`: the same results are the same; what differs is said with its size and place."""

import json
import shutil
from itertools import pairwise

import numpy as np
import pytest
import xarray as xr
from matplotlib import rcParams
from matplotlib.image import imread, imsave
from refusals import one_line
from unlike_studies import STUDIES

from lube import plots
from lube.cli import main
from lube.commands.compare import STAMP_STRIP, compare_results
from lube.errors import DataError

DIMS = ("force", "temperature")
P = "breakthrough_probability"


def dataset(values, lower=0.1, upper=0.1, force=(800.0, 1600.0), temperature=(40.0, 80.0)):
    values = np.array(values)
    variables = {f"{P}_mean": (DIMS, values), f"{P}_lower": (DIMS, values - lower)}
    variables |= {f"{P}_upper": (DIMS, values + upper), "regime": ((), "elastic")}
    coords = {"force": list(force), "temperature": list(temperature)}
    return xr.Dataset(variables, coords, {"config": json.dumps({"contact": {"seed": 1}})})


BASE = [[0.2, 0.3], [0.4, np.nan]]


@pytest.fixture
def compared(tmp_path):
    """Lines of the comparison of two datasets."""

    def compare(one, other):
        for name, content in (("one.nc", one), ("other.nc", other)):
            content.to_netcdf(tmp_path / name)
        lines = list(compare_results(tmp_path / "one.nc", tmp_path / "other.nc"))
        assert all(line.startswith("one.nc: ") for line in lines)
        return [line.removeprefix("one.nc: ") for line in lines]

    return compare


def test_the_order_of_coordinates_and_of_dimensions_does_not_matter(compared):
    one = dataset(BASE)
    assert compared(one, one) == []
    assert compared(one, one.isel(force=[1, 0]).transpose("temperature", "force")) == []


def test_a_value_is_shown_with_its_place_size_and_interval(compared):
    (line,) = compared(dataset(BASE), dataset([[0.2, 0.3], [0.5, np.nan]]))
    assert line == (
        f"{P}_mean: 1 of 4 differ, most at force 1600, temperature 40: "
        "0.4 (0.3 to 0.5) against 0.5 (0.4 to 0.6), 20 %; all intervals overlap"
    )
    (line,) = compared(dataset(BASE), dataset([[0.2, 0.3], [0.7, np.nan]]))
    assert line.endswith("; 1 interval does not overlap")


def test_a_value_that_only_one_has_is_the_largest_difference(compared):
    (line,) = compared(dataset(BASE), dataset([[0.9, 0.3], [np.nan, np.nan]]))
    assert "2 of 4 differ, most at force 1600, temperature 40: 0.4 (0.3 to 0.5) against nan" in line
    assert line.endswith("; 2 intervals do not overlap")  # one of them is in the first only


def test_a_limit_that_differs_alone_is_named(compared):
    (line,) = compared(dataset(BASE), dataset(BASE, upper=0.2))
    assert line.startswith(f"{P}_upper: 3 of 4 differ")


def test_what_only_one_has_is_named_and_the_rest_compared(compared):
    one = dataset(BASE)
    other = dataset([[0.2], [0.4]], temperature=[40.0]).drop_vars("regime").assign(new=1.0)
    assert compared(one, other) == [
        "regime: only in the first",
        "new: only in the second",
        "temperature: 1 of 2 only in the first: 80",
    ]
    far = dataset(BASE, force=(1.0, 2.0))
    # Where no label is in common, the dimensions may differ, too.
    assert compared(one, far.isel(temperature=0, drop=True)) == [
        "temperature: only in the first",
        "force: 2 of 2 only in the first: 800; 1600",
        "force: 2 of 2 only in the second: 1; 2",
    ]
    assert compared(one, far) == [
        "force: 2 of 2 only in the first: 800; 1600",
        "force: 2 of 2 only in the second: 1; 2",
    ]


def test_texts_and_sizes_differ_too_and_the_studies_say_why(compared):
    one, other = dataset(BASE).assign(shares=("pair", [1, 2])), dataset(BASE)
    other = other.assign(regime="rigid", shares=("pair", [1, 2, 3]))
    other.attrs["config"] = json.dumps({"contact": {"seed": 2}})
    assert compared(one, other) == [
        "regime: 1 of 1 differ, first: 'elastic' against 'rigid'",
        "shares: 2 pair against 3 pair",
        "the studies differ in seed: 1 against 2",
    ]


def test_values_of_either_study_are_named(compared):
    one, other = dataset(BASE), dataset([[0.0, 0.3], [0.4, np.nan]])
    one.attrs["config"] = json.dumps({"trace": {"traces": [{"force": 1.0}], "surface": None}})
    traces = [{"force": 1.0}, {"force": 2.0}]
    other.attrs["config"] = json.dumps({"trace": {"traces": traces, "surface": {"use": "x"}}})
    (_, *named), reverse = compared(one, other), compared(other, one)
    assert sorted(named) == [
        "the studies differ in surface.use: None against 'x'",
        "the studies differ in traces[1].force: None against 2.0",
    ]
    assert "the studies differ in traces[1].force: 2.0 against None" in reverse


def test_flags_are_compared_by_their_meanings(compared):
    flags = xr.DataArray(np.int8([0, 1]), dims="force", attrs={"flag_meanings": "rigid elastic"})
    assert compared(flags.to_dataset(name="regime"), (0 * flags).to_dataset(name="regime")) == [
        "regime: 1 of 2 differ, first at force 1: 'elastic' against 'rigid'"
    ]


def test_a_scalar_that_differs_is_shown_with_both_values(compared):
    one = xr.Dataset({"number": 2.0, "count": 3, "flag": True, "word": "x", "lacking": np.nan})
    one["zero"] = 0.0
    other = xr.Dataset({"number": 2.5, "count": 4, "flag": False, "word": "y", "lacking": 1.0})
    other["zero"] = -0.1
    assert compared(one, other) == [
        "count: 1 of 1 differ, most: 3 against 4, 25 %",
        "flag: 1 of 1 differ, first: True against False",
        "lacking: 1 of 1 differ, most: nan against 1",
        "number: 1 of 1 differ, most: 2 against 2.5, 20 %",
        "word: 1 of 1 differ, first: 'x' against 'y'",
        "zero: 1 of 1 differ, most: 0 against -0.1, 100 %",
    ]
    assert compared(one, one) == []


def altered(dataset):
    """A dataset that differs in the labels and in every value."""
    changed = dataset.copy(deep=True)
    for name, variable in dataset.variables.items():
        match variable.dtype.kind:
            case "i" if "flag_meanings" in variable.attrs:
                values = (variable.values + 1) % len(variable.attrs["flag_meanings"].split())
            case "f" | "i" | "u":
                values = variable.values * 2 + 1
            case "b":
                values = ~variable.values
            case _:
                values = np.array(np.char.add(variable.values.astype(str), "!"), object)
        changed[name] = (variable.dims, values, variable.attrs)
    return changed


def test_datasets_of_every_kind_that_differ_in_everything_are_compared(datasets, compared):
    for kind, dataset in datasets.items():
        dataset = dataset.isel({dim: slice(4) for dim in dataset.dims})
        named = {line.split(":")[0] for line in compared(dataset, altered(dataset))}
        scalars = {name for name, variable in dataset.data_vars.items() if variable.ndim == 0}
        assert named, kind
        # Limits are beside their value.
        assert {name for name in scalars if not name.endswith(("_lower", "_upper"))} <= named, kind


@pytest.mark.slow
def test_each_of_unlike_studies_is_compared_with_the_next(unlike):
    for one, other in pairwise([*STUDIES, next(iter(STUDIES))]):
        lines = list(compare_results(unlike(one), unlike(other)))
        assert lines and all(line.isprintable() for line in lines), (one, other)
        assert any("the studies differ in" in line for line in lines), (one, other)


@pytest.fixture(scope="module")
def results(tmp_path_factory):
    """A folder with a dataset and a figure."""
    folder = tmp_path_factory.mktemp("one") / "results"
    (folder / "figures").mkdir(parents=True)
    dataset(BASE).to_netcdf(folder / "contact.nc")
    imsave(folder / "figures/fig01.png", np.zeros((100, 50, 3)))
    return folder


def test_the_exit_status_is_for_scripts(results, tmp_path, capsys):
    other = shutil.copytree(results, tmp_path / "other")
    assert main(["compare", str(results), str(other)]) == 0
    assert capsys.readouterr().out == "The same\n"
    (other / "contact.nc").unlink()
    assert main(["compare", str(results), str(other)]) == 1
    assert capsys.readouterr().out == "contact.nc: only in the first\n"
    assert main(["compare", str(results), str(tmp_path / "gone")]) == 2
    assert capsys.readouterr().err.startswith("Error: ")


def test_figures_are_compared_but_for_their_stamps(results, tmp_path):
    other = shutil.copytree(results, tmp_path / "other")
    picture = imread(other / "figures/fig01.png")
    picture[-STAMP_STRIP:] = 1.0
    imsave(other / "figures/fig01.png", picture)
    assert list(compare_results(results, other)) == []
    picture[:10] = 1.0
    imsave(other / "figures/fig01.png", picture)
    assert list(compare_results(results, other)) == ["fig01.png: 13.70% of the pixels differ"]
    imsave(other / "figures/fig01.png", picture[:50])
    assert list(compare_results(results, other)) == ["fig01.png: 50 x 73 pixels against 50 x 23"]


def test_the_strip_is_that_of_the_stamp():
    plots.use_style()
    height = plots._STAMP_STRIP * rcParams["savefig.dpi"]
    assert height <= STAMP_STRIP < height + 1.0


def test_what_cannot_be_compared_is_refused_in_one_line(results, tmp_path):
    file = results / "contact.nc"
    (tmp_path / "damaged.nc").write_text("nothing")
    xr.Dataset({"other": 1.0}).to_netcdf(tmp_path / "other.nc")
    for other, expected in (
        (results, "need two folders or two datasets"),
        (tmp_path / "damaged.nc", "damaged.nc: not a complete NetCDF file"),
        (tmp_path / "other.nc", "no variable in common"),
    ):
        assert expected in one_line(DataError, list, compare_results(file, other))
    empty = tmp_path / "empty"
    empty.mkdir()
    assert "results of one kind" in one_line(DataError, list, compare_results(results, empty))
