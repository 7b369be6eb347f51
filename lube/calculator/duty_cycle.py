"""Duty cycles: the answer at each duty point, and the weighted mean over the cycle."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import xarray as xr

from lube import types
from lube.calculator.answers import Answer
from lube.calculator.arguments import amount, check_realisations, checked, one_name
from lube.calculator.bands import Assumptions
from lube.calculator.choices import FORMULA, REALISATIONS, SEED, Choices, Inlet
from lube.calculator.contact import contact_at
from lube.calculator.film import check_contact, film_model, film_of_oil, with_remarks
from lube.calculator.oil import Oil
from lube.calculator.rollers import Rollers
from lube.contact.ensemble import with_pair_limits
from lube.errors import DataError, located, right_one, shown
from lube.grid.gap import Gap
from lube.schema import LIMITS, values_with_limits
from lube.stages.tail import pair_limits
from lube.statistics.confidence import probability_interval
from lube.study.small_csv import HEADER_CELL, read_cells, with_points

_COLUMNS = {
    "force": "N",
    "temperature": "degC",
    "share": "1",
    "radius": "m",
    "second_radius": "m",
    "speed": "rpm",
    "entrainment_speed": "m/s",
    "surface_speed": "m/s",
    "second_surface_speed": "m/s",
}
"""Columns of a table of duty points, each with the unit that it is converted to."""
NEAR = 0.02
"""Shares may miss the whole by this much, by rounding, without a remark."""
_NUMBER = re.compile(r"\s*[-+]?[\d.]+\s*([ %]|$)")
"""Beginning of a number with or without unit, but not of a name such as ``2nd gear``."""
_OF_PAIR = "probability_pair_lower", "probability_pair_upper"
_SPEEDS = ("speed", "entrainment_speed", "surface_speed and second_surface_speed")


@checked
def duty(
    points: pd.DataFrame | Mapping[str, Sequence] | Sequence[Mapping[str, Any]] | types.File,
    rollers: Rollers,
    oil: Oil,
    *,
    film_formula: str = FORMULA,
    film_shape: types.FilmShape = "flat",
    roughness_deformation: types.RoughnessDeformation = "none",
    inlet_shear_heating: types.InletHeating = "none",
    inlet_meniscus: types.OneAmount | None = None,
    load_sharing: types.LoadSharing = "none",
    contact_model: types.ContactModel | Sequence[types.ContactModel] = "line",
    realisations: int = REALISATIONS,
    seed: int = SEED,
    bands: bool | Mapping[str, Any] = False,
) -> Answer:
    """Film and probability of contact at each point of a duty cycle, and over the cycle.

    The model's probability depends on film thickness and contact width. So each duty point has the
    film and width of its radii, and all points have the roughness lines of `rollers`.

    Parameters
    ----------
    points : pandas.DataFrame, dict, list of dict or path of a CSV file
        One row for each duty point; a dict of single values is one point. Columns of a file are
        separated by commas, semicolons or tabs, and its numbers may have decimal commas.
        Columns of numbers carry
        their unit, as in ``force [N]``; in other columns each value does, as in ``"800 N"``. Needed
        are ``force``, ``temperature``,
        and one of ``speed`` (rotation of the first roller in pure rolling, such as rpm),
        ``entrainment_speed``, or the two of ``surface_speed`` and ``second_surface_speed``.
        Optional are ``radius`` and ``second_radius``, by default those of `rollers`, and
        ``share``, the point's share of time, by default equal shares. Other columns of text, such
        as names of the points, are kept.
    rollers : Rollers
        Material, roughness and, for points without radii, the radii.
    oil : Oil
        The oil.
    film_formula, film_shape, roughness_deformation, load_sharing, contact_model, realisations, seed
        As in `lube.contact_probability`.
    inlet_shear_heating, inlet_meniscus
        As in `lube.film`; each point has its own slip.
    bands : bool or dict, optional
        As in `lube.contact_probability`. All points of a sample share its deviations, as they have
        one oil, one pair of rollers and one thermometer.

    Returns
    -------
    Answer
        The variables of `lube.contact_probability` over ``point``, the columns of `points`, and
        ``share`` (divided by the sum of all). For the whole cycle: ``whole_probability``, the share
        of time with metal contact, counted; ``whole_tail_probability``, the same by importance
        sampling; and
        ``whole_tail_rate``, breakthroughs per hour; each with ``_lower`` and ``_upper``. These
        limits are those of the mean over pairs of rollers. All points have the same pairs, so the
        whole cycle is computed on each pair first. For the surface they are
        ``whole_surface_probability`` and ``whole_surface_rate``, with limits as wide as if the
        errors at all points were the same. Limits for one pair, as at each point, are
        ``whole_probability_pair_lower`` and ``_pair_upper``, and those that begin with
        ``whole_surface_probability_pair``. Contact of lines is counted in alignments of pure
        rolling, and the first two are for these. With `bands` also
        ``whole_assumed_probability_lower`` and ``_upper``, between which 90 % of the cycle's means
        over pairs lie. The attribute ``remarks`` is as in `lube.contact_probability`.

    Raises
    ------
    LubeError
        Which column, what came, what is needed.

    Examples
    --------
    >>> rollers = Rollers(radius="5 mm", rms_roughness="0.2 um")
    >>> points = [
    ...     {"force": "100 N", "speed": "500 rpm", "temperature": "60 degC", "share": "90 %"},
    ...     {"force": "300 N", "speed": "250 rpm", "temperature": "80 degC", "share": "10 %"},
    ... ]
    >>> found = duty(points, rollers, Oil("mobilgear-shc-xmp-320"), realisations=4)
    >>> low, high = found.breakthrough_probability_mean.values
    >>> bool(low < found.whole_probability < high)
    True
    """
    columns, labels = _columns(points)
    share, remark = _shares(columns)
    columns["share"] = share
    gap, inlet = Gap(film_shape, roughness_deformation), Inlet(inlet_shear_heating, inlet_meniscus)
    choices = Choices.of(film_formula, gap, inlet, load_sharing, contact_model=contact_model)
    choices = replace(choices, slip=_slip(columns))
    check_realisations(realisations, seed)
    one_name("film_formula", film_formula)
    given = _conditions(columns, rollers)
    assumed = Assumptions(bands, rollers, oil, choices, seed)
    assumed.check(given)
    table = _films(rollers, oil, given, choices)
    parts, on_pairs = contact_at(table, rollers.rough_pair(seed, gap), choices, realisations, 0.0)
    whole = {} if on_pairs is None else _whole(parts, on_pairs, share, rollers.lines)
    if "surface" in choices.models:
        whole |= _whole_of_surface(parts, share)
    if assumed.wanted:
        samples = assumed.probabilities(given | {"slide_to_roll_ratio": choices.slip})
        parts = parts.assign(assumed.limits(samples, "assumed_breakthrough_probability"))
        # Weighted first: the samples are the same at all points.
        of_cycle = _weighted(samples, share)
        whole |= assumed.limits(of_cycle, "whole_assumed_probability")
    remarks = "\n".join(filter(None, (parts.attrs.get("remarks"), remark)))
    found = xr.Dataset(
        columns | dict(parts.data_vars) | whole, attrs=parts.attrs | {"remarks": remarks}
    )
    return _with_labels(with_remarks(found, table, rollers, choices.models), labels)


def _shares(columns):
    """Share of time of each point, together 1; and a remark if those given are less."""
    share = columns.get("share", xr.full_like(columns["force"], 1.0 / columns["force"].size))
    total = share.sum().item()
    if not total > 0.0:
        raise DataError("points: share: got 0 at all points, need a share above 0 for at least one")
    is_part = total < 1.0 - NEAR  # more than 1 are hours, or other weights
    remark = f"share: got {total:.3g} together, and the rest of the time is left out"
    return share / total, remark if is_part else ""


def _weighted(values, share):
    """Mean over the cycle; a point that takes no time does not count, even if it is not known."""
    return (values.where(share > 0.0, 0.0) * share).sum("point", skipna=False)


def _slip(columns):
    """Slide-to-roll ratio of each point."""
    names = ("surface_speed", "second_surface_speed")
    first, second = (columns.get(name, xr.ones_like(columns["force"])) for name in names)
    return 2.0 * (first - second) / (first + second)


def _whole(parts, on_pairs, share, lines):
    """Probabilities and rate of lines over the whole cycle, with their limits."""
    windows = lines.independent_windows(2.0 * parts["contact_half_width"].max().item())
    counted = _weighted(parts["breakthrough_probability"], share)
    limits = probability_interval(counted.values, windows)
    # Summed on each pair of lines first: the lines are the same at all points.
    sampled = pair_limits(_weighted(on_pairs, share))
    whole = values_with_limits("whole_probability", limits)
    on_pair = counted.to_dataset(name="breakthrough_probability")
    of_pair = with_pair_limits(on_pair, xr.DataArray(windows))
    whole |= {f"whole_{name}": of_pair[f"breakthrough_{name}"] for name in _OF_PAIR}
    for end in LIMITS:
        whole[f"whole_tail_probability{end}"] = sampled[f"breakthrough_probability{end}"]
        whole[f"whole_tail_rate{end}"] = sampled[f"breakthrough_rate{end}"]
    return whole


def _whole_of_surface(parts, share):
    """Probability and rate of the surface over the whole cycle, with their limits."""
    kinds = [f"{kind}{end}" for kind in ("probability", "rate") for end in LIMITS]
    of_points = {name: parts[f"surface_breakthrough_{name}"] for name in (*kinds, *_OF_PAIR)}
    return {f"whole_surface_{name}": _weighted(each, share) for name, each in of_points.items()}


def _films(rollers, oil, given, choices):
    """Film table over the points, each with its own radii."""
    turning = rollers.pair.with_radii(given["radius"], given["second_radius"])
    check_contact(rollers, turning.contact_half_width(given["force"]), choices)
    table = film_of_oil(oil, turning, given, **film_model(rollers, choices))
    table = table.isel(film_formula=0).drop_vars("temperature", errors="ignore")
    return table.assign(force=given["force"])


def _with_labels(found, labels):
    """Put labels of the points before what was found."""
    for name in labels.keys() & found.variables.keys():
        raise DataError(f"points: got the column {name!r}, which the answer has, need another name")
    return Answer(labels | dict(found.data_vars), found.coords, found.attrs)


def _conditions(columns, rollers):
    """Force in N, speed in rpm, temperature in degC and radii in m of each point."""
    radius = columns.get("radius", rollers.pair.first.radius)
    if (rotation := columns.get("speed")) is None:
        if (entrainment := columns.get("entrainment_speed")) is None:
            entrainment = 0.5 * (columns["surface_speed"] + columns["second_surface_speed"])
        rotation = entrainment * 60.0 / (2.0 * np.pi * radius)
    return {
        "force": columns["force"],
        "speed": rotation,
        "temperature": columns["temperature"],
        "radius": radius,
        "second_radius": columns.get("second_radius", rollers.pair.second.radius),
    }


def _columns(points):
    """Numbers of a table by column, over ``point`` in the units of `_COLUMNS`; then its labels."""
    frame = _frame(points)
    columns, labels = {}, {}
    for header, values in frame.items():
        header, missing, values = f"{header}".strip(), values.isna(), values.tolist()
        if missing.any():
            row = missing.tolist().index(True) + 1
            raise DataError(f"points: {header}: missing in row {row}, need it in every row")
        are_texts = all(isinstance(value, str) and not _NUMBER.match(value) for value in values)
        cell = HEADER_CELL.fullmatch(header)
        name, units = cell.groups() if cell else (header, None)
        if are_texts and name not in _COLUMNS:
            labels[header] = "point", np.array(values, object)
            continue
        numbers = _column(name, units, header, values)
        if name in columns:
            raise DataError(f"points: got the column {name!r} twice, need it once")
        columns[name] = numbers
    for name in ("force", "temperature"):
        if name not in columns:
            raise DataError(f"points: no column {name!r}, need one, as '{name} [{_COLUMNS[name]}]'")
    given = {name for name in columns if name.endswith("speed")}
    if given not in [set(names.split(" and ")) for names in _SPEEDS]:
        came = " and ".join(sorted(given)) or "no speed"
        raise DataError(f"points: got {came}, need one kind of speed: {', '.join(_SPEEDS)}")
    return columns, labels


def _frame(points):
    """Table of the points, with a row for each."""
    try:
        if isinstance(points, Mapping):
            points = {name: _with_units(values) for name, values in points.items()}
            points = points if any(map(np.ndim, points.values())) else [points]
        frame = _read(points) if isinstance(points, str | Path) else pd.DataFrame(points)
    except (TypeError, ValueError) as error:  # pint's errors are of the first kind
        raise DataError(f"points: got {shown(points)}, need a table: {error}") from None
    if frame.empty:
        raise DataError("points: got no rows, need one for each duty point")
    return frame


def _with_units(values):
    """Quantities of a list, a pair, or an array with a unit, each as text with its unit."""
    if isinstance(values, tuple) and len(values) == 2 and isinstance(values[1], str):
        numbers, units = values
        if not isinstance(numbers, str):
            texts = [f"{number!r} {units}" for number in np.ravel(numbers).tolist()]
            return texts if np.ndim(numbers) else texts[0]
    # Pandas would drop the units.
    is_list = isinstance(values, list | tuple) or np.ndim(getattr(values, "magnitude", None)) > 0
    return np.fromiter(map(_as_text, values), object, len(values)) if is_list else _as_text(values)


def _as_text(value):
    """Quantity as text, as other values of its column may be texts."""
    number = getattr(value, "magnitude", None)
    return value if number is None else f"{float(number)!r} {value.units}"


def _read(path):
    """Table of a CSV file, whose numbers may have decimal commas."""
    (_, header), *rows = read_cells(path, DataError)
    rows = with_points(path, rows, len(header), DataError)
    frame = pd.DataFrame(rows, columns=header).replace("", None)
    numbers = frame.apply(pd.to_numeric, errors="coerce")
    are_texts = np.broadcast_to(numbers.isna().any(), frame.shape)
    return frame.where(are_texts, numbers.to_numpy())


def _column(name, units, header, values):
    """Values of a column, over ``point``."""
    if name not in _COLUMNS:
        raise DataError(f"points: unknown column {header!r}, {right_one(name, _COLUMNS)}")
    limits = {"temperature": {"above": -273.15}, "share": {"least": 0.0}}.get(name, {"above": 0.0})
    if name == "share" and units is None and not isinstance(values[0], str):
        units = "1"
    given = values if units is None else (values, units)
    with located("points", DataError):
        numbers = amount(name, given, _COLUMNS[name], may_repeat=True, **limits)
    return xr.DataArray(numbers.values, dims="point")
