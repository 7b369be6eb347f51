"""``lube compare``: which values and figures of two results differ, and by how much."""

import json
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import xarray as xr

from lube.errors import DataError, shown
from lube.schema import LIMITS
from lube.storage.netcdf import opened
from lube.storage.provenance import single_values
from lube.types import File

STAMP_STRIP = 27
"""Height of the strip below a figure that names study and commit, in pixels."""

_MOST_CHANGES = 10  # values of the studies that are listed
_MOST_NAMED = 5  # coordinates in only one dataset that are listed


def compare_results(first: File, second: File) -> Iterator[str]:
    """Compare two folders of results, two archives, or two datasets of one kind.

    Values are compared at equal coordinates, whatever their order. NaN equals NaN.

    Parameters
    ----------
    first, second : str or Path
        Two folders or two NetCDF files.

    Yields
    ------
    str
        A line for each variable, coordinate, figure or file that differs; nothing if all are the
        same.

    Raises
    ------
    DataError
        If either is missing or damaged, or they have nothing in common to compare.
    """
    first, second = Path(first), Path(second)
    for path in (first, second):
        if not path.exists():
            raise DataError(f"{path}: no such file, need a folder of results or a dataset")
    if first.is_dir() != second.is_dir():
        raise DataError(f"got {first} and {second}, need two folders or two datasets")
    one, other = _files(first), _files(second)
    if not first.is_dir():
        one, other = {first.name: first}, {first.name: second}
    if not one.keys() & other.keys():
        raise DataError(f"got {first} and {second}, need two folders with results of one kind")
    yield from _only_in_one(one, other)
    for name in sorted(one.keys() & other.keys()):
        if one[name].read_bytes() != other[name].read_bytes():
            kind = _figures if name.endswith(".png") else _datasets
            yield from kind(one[name], other[name], name)


def _files(folder):
    """Datasets and figures of a folder of results, or of an archive, by name."""
    patterns = ("*.nc", "data/*.nc", "figures/*.png")
    return {path.name: path for pattern in patterns for path in sorted(folder.glob(pattern))}


def _only_in_one(one, other):
    for number, here, there in (("first", one, other), ("second", other, one)):
        yield from (f"{name}: only in the {number}" for name in here if name not in there)


def _figures(first, second, name):
    from matplotlib.image import imread

    one, other = (imread(path)[:-STAMP_STRIP] for path in (first, second))
    if one.shape != other.shape:
        yield f"{name}: {_pixels(one)} pixels against {_pixels(other)}"
    elif share := np.any(one != other, axis=-1).mean():
        yield f"{name}: {share:.2%} of the pixels differ"


def _pixels(picture):
    return f"{picture.shape[1]} x {picture.shape[0]}"


def _datasets(first, second, where):
    one, other = _in_words(first), _in_words(second)
    if not set(one.data_vars) & set(other.data_vars):
        raise DataError(f"{first} and {second}: no variable in common, need datasets of one kind")
    lines = [*_only_in_one(sorted(one.variables), sorted(other.variables))]
    labelled = [dim for dim in one.dims if dim in one.indexes and dim in other.indexes]
    for dim in labelled:
        lines += _labels_only_in_one(one.indexes[dim], other.indexes[dim], dim)
    unlabelled = {*one.dims, *other.dims}.difference(labelled)
    one, other = xr.align(one, other, join="inner", exclude=unlabelled)
    shared = sorted(set(one.variables) & set(other.variables) - set(labelled))
    differing = {name: line for name in shared if (line := _variables(one, other, name))}
    for name in differing:
        # The line on a value already shows its limits.
        value = name.removesuffix("_lower").removesuffix("_upper")
        if value == name or not differing.keys() & {value, f"{value}_mean"}:
            lines.append(f"{name}: {differing[name]}")
    if lines:
        lines += _values_of_studies(one, other)
    yield from (f"{where}: {line}" for line in lines)


def _in_words(path):
    """Load a dataset, with the meanings of its flags in place of their numbers."""
    with opened(path) as dataset:
        dataset = dataset.load()
    for name, flags in dataset.data_vars.items():
        if "flag_meanings" in flags.attrs:
            meanings = np.array(flags.attrs["flag_meanings"].split())
            dataset[name] = flags.dims, meanings[flags.values.astype(int)]
    return dataset


def _labels_only_in_one(here, there, dim):
    """Name the labels of a dimension that only one of both datasets has."""
    for number, own, others in (("first", here, there), ("second", there, here)):
        if alone := [_short(label) for label in own if label not in others]:
            names = "; ".join([*alone[:_MOST_NAMED], *["..."] * (len(alone) > _MOST_NAMED)])
            yield f"{dim}: {len(alone)} of {own.size} only in the {number}: {names}"


def _short(value):
    is_number = isinstance(value, int | float | np.number) and not isinstance(value, bool)
    return f"{value:.6g}" if is_number else str(value)


def _variables(one, other, name):
    """Say how the values of a variable differ; an empty text if they are the same."""
    here, there = one[name], other[name]
    if not (here.size and there.size):
        return ""  # no label in common, as other lines say
    if dict(here.sizes) != dict(there.sizes):
        return f"{_sizes(here)} against {_sizes(there)}"
    there = there.transpose(*here.dims)
    numbers = here.dtype.kind in "fiu" and there.dtype.kind in "fiu"
    lacking = here.isnull().values & there.isnull().values
    # NumPy returns a number for two scalars; an array is needed below.
    differ = np.asarray((here.values != there.values) & ~lacking)
    if not differ.any():
        return ""
    gap = differ.astype(float)
    if numbers:
        gap[differ] = np.abs(there.values[differ].astype(float) - here.values[differ])
    # A value that only one dataset has counts as the largest difference.
    place = np.unravel_index(np.argmax(np.where(np.isnan(gap), np.inf, gap)), gap.shape)
    at = dict(zip(here.dims, place, strict=True))
    line = f"{np.count_nonzero(differ)} of {gap.size} differ, {'most' if numbers else 'first'}"
    line += f"{_coordinates(here, at)}: {_value(one, name, at)} against {_value(other, name, at)}"
    if numbers and np.isfinite(gap[place]):
        largest = max(np.abs([here.values[place], there.values[place]]))
        line += f", {100.0 * gap[place] / largest:.3g} %"
    return line + _intervals_apart(one, other, name)


def _sizes(variable):
    return " x ".join(f"{size} {dim}" for dim, size in variable.sizes.items()) or "a single value"


def _coordinates(variable, at):
    """Say where a value is."""
    labels = [
        f"{dim} {_short(variable[dim].values[index]) if dim in variable.coords else index}"
        for dim, index in at.items()
        if variable.sizes[dim] > 1
    ]
    return f" at {', '.join(labels)}" if labels else ""


def _value(dataset, name, at):
    """Format a value, with its interval if it has one."""
    value, *interval = (one.isel(at).item() for one in (dataset[name], *_limits(dataset, name)))
    between = f" ({_short(interval[0])} to {_short(interval[1])})" if interval else ""
    return f"{_short(value) if not isinstance(value, str) else shown(value)}{between}"


def _limits(dataset, name):
    """Limits of the 95 % intervals of a variable; none if it has none."""
    names = [f"{name.removesuffix('_mean')}{limit}" for limit in LIMITS[1:]]
    found = [dataset[limit] for limit in names if limit in dataset]
    alike = all(set(limit.dims) == set(dataset[name].dims) for limit in found)
    return found if len(found) == 2 and alike else []


def _intervals_apart(one, other, name):
    """Say how many intervals do not overlap, or are in one dataset only."""
    here, there = _limits(one, name), _limits(other, name)
    if not (here and there):
        return ""
    alone = here[0].isnull() != there[0].isnull()
    apart = int((alone | (here[0] > there[1]) | (there[0] > here[1])).sum())
    if apart == 1:
        return "; 1 interval does not overlap"
    return f"; {apart or 'all'} intervals {'do not ' * (apart > 0)}overlap"


def _values_of_studies(one, other):
    """Name the values of the two studies that differ: they explain different results."""
    configs = []
    for dataset in (one, other):
        stages = json.loads(dataset.attrs.get("config", "{}")).values()
        configs.append({name: value for stage in stages for name, value in single_values(stage)})
    names = configs[0] | configs[1]
    names = [name for name in names if configs[0].get(name) != configs[1].get(name)]
    for name in names[:_MOST_CHANGES]:
        here, there = (shown(config.get(name)) for config in configs)
        yield f"the studies differ in {name}: {here} against {there}"
    if len(names) > _MOST_CHANGES:
        yield f"the studies differ in {len(names) - _MOST_CHANGES} more values"
