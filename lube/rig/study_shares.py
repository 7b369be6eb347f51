"""Contact shares of a rig's records, and lines about them."""

import pandas as pd
import xarray as xr

from lube.errors import DataError
from lube.grid.levels import SAME, format_levels, level_index
from lube.schema import COORDINATES, LIMITS

MOST_LINES = 10
"""Lines that a log shows of a longer list."""


def limited(name, values):
    """Name a value and the limits of its interval.

    Parameters
    ----------
    name : str
        Name of the value.
    values : sequence
        Value, lower and upper limit.

    Returns
    -------
    dict
        The three by their names.
    """
    return {f"{name}{limit}": value for limit, value in zip(LIMITS, values, strict=True)}


def at_comparison_threshold(experiment):
    """Shares at the threshold that is compared with the simulation.

    Parameters
    ----------
    experiment : xarray.Dataset
        An ``experiment`` dataset.

    Returns
    -------
    xarray.Dataset
        ``contact_share`` and its limits over ``record``.

    Raises
    ------
    DataError
        If the records were not evaluated at that threshold.
    """
    wanted = experiment["comparison_threshold"].item()
    levels = experiment["threshold"].values.tolist()
    index = level_index(levels, wanted, SAME)
    if index is None:
        raise DataError(
            f"experiment: threshold {wanted:g} ohm is not among those evaluated, "
            f"{format_levels(levels)}"
        )
    shares = experiment[[f"contact_share{limit}" for limit in LIMITS]]
    return shares.isel(threshold=index, drop=True)


def over_grid(dataset):
    """View records as a table over the operating grid, by the levels that they are near.

    Parameters
    ----------
    dataset : xarray.Dataset
        An ``experiment``, ``comparison`` or ``gauge`` dataset.

    Returns
    -------
    xarray.Dataset
        Its variables over (slide_to_roll_ratio, lubricant, temperature, speed, force, repeat)
        in place of ``record``, NaN where there is none; ``repeat`` counts the records of one
        point. Records near no level are left out.
    """
    levels = {name: dataset[f"{name}_level"].values for name in ("temperature", "speed", "force")}
    names = {name: dataset[name].values for name in ("slide_to_roll_ratio", "lubricant")}
    table = pd.DataFrame(names | levels)
    labelled = table.notna().all(axis=1).values
    table = table[labelled]
    table["repeat"] = table.groupby(list(table.columns)).cumcount()
    index = xr.Coordinates.from_pandas_multiindex(pd.MultiIndex.from_frame(table), "record")
    records = dataset.isel(record=labelled)
    own = {name for name in records.coords if "record" in records[name].dims}
    clashing = own & {*table.columns, "record"}
    records = records.drop_vars(clashing).reset_coords(own - clashing)
    return records.assign_coords(index).unstack("record")


def refused_in_one_line(experiment):
    """Name the records that were refused, with the reasons.

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


def levels_named(levels):
    """Name an operating point.

    Parameters
    ----------
    levels : dict of str to float
        Values of operating variables, by their coordinates' names.

    Returns
    -------
    str
        Such as ``800 N, 100 rpm, 40 degC``.
    """
    return ", ".join(f"{value:.6g} {COORDINATES[name].units}" for name, value in levels.items())


def log_lines(log, lines):
    """Warn of some lines, and of a longer list's first ones.

    Parameters
    ----------
    log : logging.Logger
        Log to warn in.
    lines : list of str
        What to tell.
    """
    for line in lines[:MOST_LINES]:
        log.warning("%s", line)
    if len(lines) > MOST_LINES:
        log.warning("... and %d more", len(lines) - MOST_LINES)
