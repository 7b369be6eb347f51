"""Contact shares of a rig's records, brought to the operating points of a study."""

from lube.errors import DataError
from lube.levels import SAME, level_index, levels_told
from lube.schema import COORDINATES, EXPERIMENT_DIMS, LIMITS, POINT_DIMS

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


def on_study_levels(experiment, levels, share="contact_share"):
    """Shares at all levels of a study, NaN where the experiment has none.

    Parameters
    ----------
    experiment : xarray.Dataset
        An ``experiment`` dataset.
    levels : xarray.Dataset
        Dataset of the study; the shares get its coordinates to the last bit.
    share : str, optional
        Which share: ``contact_share`` of whole records, or ``revolution_share``.

    Returns
    -------
    xarray.Dataset
        The share and its limits over the dimensions of the experiment, with the origin as a
        coordinate.

    Raises
    ------
    DataError
        If a level of the experiment is not the study's.
    """
    shares = experiment[[f"{share}{limit}" for limit in LIMITS]]
    for name in filter(levels.dims.__contains__, EXPERIMENT_DIMS):
        found = _study_levels(name, experiment[name].values, levels[name].values)
        shares = shares.assign_coords({name: found}).reindex({name: levels[name].values})
    return shares.assign_coords(origin=experiment["origin"].item())


def _study_levels(name, found, wanted):
    """Levels of the study that some levels are."""
    indices = [level_index(wanted.tolist(), level, SAME) for level in found.tolist()]
    if None in indices:
        level = found[indices.index(None)]
        raise DataError(
            f"experiment: {name} {level} is not a level of the study, need one of "
            f"{levels_told(wanted.tolist())}"
        )
    return wanted[indices]


def at_comparison_threshold(shares, experiment):
    """Shares at the threshold that is compared with the simulation.

    Parameters
    ----------
    shares : xarray.Dataset
        From `on_study_levels`.
    experiment : xarray.Dataset
        The ``experiment`` dataset they are from.

    Returns
    -------
    xarray.Dataset
        The same without the dimension ``threshold``.

    Raises
    ------
    DataError
        If the records were not evaluated at that threshold.
    """
    wanted = experiment["comparison_threshold"].item()
    levels = shares["threshold"].values.tolist()
    index = level_index(levels, wanted, SAME)
    if index is None:
        raise DataError(
            f"experiment: threshold {wanted:g} ohm is not among those evaluated, "
            f"{levels_told(levels)}"
        )
    return shares.isel(threshold=index, drop=True)


def in_pure_rolling(dataset):
    """Part of a dataset without slip.

    Parameters
    ----------
    dataset : xarray.Dataset
        With the dimension ``slide_to_roll_ratio``.

    Returns
    -------
    xarray.Dataset
        The same without that dimension; numbers are NaN if there is slip everywhere.
    """
    return dataset.reindex(slide_to_roll_ratio=[0.0]).isel(slide_to_roll_ratio=0, drop=True)


def compared_in_pure_rolling(film, experiment):
    """Shares without slip, at the threshold that is compared, at all points of a film table.

    Parameters
    ----------
    film, experiment : xarray.Dataset
        Datasets of these kinds, of one study.

    Returns
    -------
    xarray.Dataset
        ``contact_share`` and its limits over (lubricant, temperature, speed, force), NaN without
        a record.

    Raises
    ------
    DataError
        If the records have a level that is not the study's, or were not evaluated at their
        comparison threshold.
    """
    rolling = in_pure_rolling(experiment)
    shares = at_comparison_threshold(on_study_levels(rolling, film), experiment)
    return shares.drop_vars("duration").transpose(*POINT_DIMS)


def lines_of(absent, reason):
    """Tell the operating points where something is missing, a line each.

    Parameters
    ----------
    absent : xarray.DataArray
        True where it is missing, over operating variables.
    reason : str
        What is missing, such as ``no record``.

    Returns
    -------
    list of str
        Such as ``800 N, 100 rpm, 40 degC: no record``; lubricant and slip are named where
        there are several.
    """
    told = ["force", "speed", "temperature"]
    told += [name for name in ("lubricant", "slide_to_roll_ratio") if absent.sizes.get(name, 1) > 1]
    points = absent.stack(point=absent.dims)
    return [
        ", ".join(_level(name, point[name].item()) for name in told) + f": {reason}"
        for point in points[points.values]["point"]
    ]


def _level(name, value):
    if name == "slide_to_roll_ratio":
        return f"slide-to-roll ratio {value:g}"
    if name == "lubricant":
        return value
    return f"{value:.6g} {COORDINATES[name].units}"


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
