"""Contact shares of a study's records, arranged over the operating grid, and words for messages."""

from collections.abc import Mapping, Sequence
from logging import Logger

import pandas as pd
import xarray as xr

from lube.errors import DataError
from lube.schema import COORDINATES
from lube.units import with_unit

MOST_LINES = 10
"""Largest number of lines of a list that are logged."""


def over_grid(dataset: xr.Dataset) -> xr.Dataset:
    """Arrange records over the operating grid, by the levels near their conditions.

    Parameters
    ----------
    dataset : xarray.Dataset
        An ``experiment``, ``comparison`` or ``gauge`` dataset.

    Returns
    -------
    xarray.Dataset
        Its variables over (slide_to_roll_ratio, lubricant, temperature, speed, force, repeat)
        instead of ``record``, NaN where there is no record; ``repeat`` numbers the records of one
        operating point. Records not at a level are left out.

    Raises
    ------
    DataError
        If the dataset has no records.
    """
    if "temperature_level" not in dataset:
        raise DataError(
            "over_grid: got no records, need an experiment, comparison or gauge dataset"
        )
    levels = {name: dataset[f"{name}_level"].values for name in ("temperature", "speed", "force")}
    names = {name: dataset[name].values for name in ("slide_to_roll_ratio", "lubricant")}
    table = pd.DataFrame(names | levels)
    labelled = table.notna().all(axis=1).values
    table = table[labelled].assign(repeat=lambda rows: rows.groupby(list(rows)).cumcount())
    index = xr.Coordinates.from_pandas_multiindex(pd.MultiIndex.from_frame(table), "record")
    records = dataset.isel(record=labelled)
    own = {name for name in records.coords if "record" in records[name].dims}
    clashing = own & {*table.columns, "record"}
    records = records.drop_vars(clashing).reset_coords(own - clashing)
    return records.assign_coords(index).unstack("record")


def refused_in_one_line(experiment: xr.Dataset) -> str:
    """List the records that were refused, with the reasons.

    Parameters
    ----------
    experiment : xarray.Dataset
        An ``experiment`` dataset.

    Returns
    -------
    str
        One line; empty if none was refused.
    """
    refused = experiment.attrs["refused"].splitlines()
    if not refused:
        return ""
    records = len(refused) + experiment.sizes["record"]
    return f"Refused: {len(refused)} of {records} records. {'; '.join(refused)}"


def levels_named(levels: Mapping[str, float]) -> str:
    """Name an operating point.

    Parameters
    ----------
    levels : mapping of str to float
        Values of operating variables, by their coordinates' names.

    Returns
    -------
    str
        The values with their units.

    Examples
    --------
    >>> levels_named({"force": 800.0, "speed": 100.0, "temperature": 40.0})
    '800 N, 100 r/min, 40 °C'
    """
    return ", ".join(with_unit(value, COORDINATES[name].units) for name, value in levels.items())


def log_lines(log: Logger, lines: Sequence[str]) -> None:
    """Log lines as warnings, the first `MOST_LINES` of a long list.

    Parameters
    ----------
    log : logging.Logger
        The log.
    lines : sequence of str
        The lines.
    """
    for line in lines[:MOST_LINES]:
        log.warning("%s", line)
    if len(lines) > MOST_LINES:
        log.warning("... and %d more", len(lines) - MOST_LINES)
