"""Plots of the answers: probabilities with their intervals, duty cycles, profiles."""

import matplotlib.pyplot as plt
import numpy as np
import xarray as xr
from matplotlib.axes import Axes

from lube import plots
from lube.errors import LubeError, right_one

_COUNTED, _SAMPLED = "breakthrough_probability", "tail_breakthrough_probability"
_SHOWN = (f"{_COUNTED}_mean", "pressure", "contact_length", "film_thickness")
"""Variables to show where none is named: the first of these that the answer has."""
_ALONG = ("temperature", "speed", "force")
"""Dimensions along which an answer is drawn rather than along others."""
_DECADE = 0.1
"""Least probability over the greatest, below which the axis is logarithmic."""
_SIDES = np.array([-2.0, 1.5])
"""Ends of the drawn part of a profile, in half-widths."""
_MOST_FILM = 4.0
"""Greatest gap in a profile, over the central film."""
_MOST_MARKERS = 50


def draw(found: xr.Dataset, x: str | None = None, y: str | None = None) -> Axes:
    """Draw an answer.

    Parameters
    ----------
    found : xarray.Dataset
        The answer.
    x, y : str, optional
        Dimension along the axis, and variable, as of `lube.Answer.plot`.

    Returns
    -------
    matplotlib.axes.Axes
        The panel, of a figure of its own.

    Raises
    ------
    LubeError
        If it has no such dimension or variable, or a single value only.
    """
    variables = list(found.data_vars)
    y = _chosen("y", y, variables, *(name for name in _SHOWN if name in variables))
    dims = sorted(found[y].dims, key=lambda name: name not in _ALONG)
    if not dims:
        raise LubeError("plot: got a single value, need several forces, speeds or temperatures")
    x = _chosen("x", x, dims, max(dims, key=found.sizes.get))
    with plt.rc_context():
        plots.use_style()
        axes = plt.figure(figsize=(5.6, 3.6)).add_subplot()
        _draw_lines(axes, found, x, y)
        axes.set_xlabel(plots.axis_label(found[x]) if x in found.coords else x.capitalize())
        axes.set_ylabel(plots.axis_label(found[y]))
        if y == f"{_COUNTED}_mean":
            axes.set_ylabel("Breakthrough probability")
        if x == "point":
            _label_points(axes, found, y)
        if y == "pressure":
            _draw_film(axes, found)
        if axes.get_legend_handles_labels()[1]:
            several = _SAMPLED in found and len(dims) > 1
            title = "points counted, curves by importance sampling" if several else None
            plots.legend_above(axes.figure, axes.figure.axes, title)
    return axes


def _chosen(argument, name, known, *usual):
    if name is not None and name not in known:
        raise LubeError(f"plot: {argument}: got {name!r}, {right_one(f'{name}', known)}")
    return next(iter([*usual, *known])) if name is None else name


def _draw_lines(axes, found, x, y):
    """Draw a line for each level of the other dimensions."""
    others = [name for name in found[y].dims if name != x]
    sizes = [found.sizes[name] for name in others]
    shades = plots.level_colours(range(np.prod(sizes, dtype=int)))
    is_probability = y == f"{_COUNTED}_mean"
    if is_probability:
        _scale(axes, found)
    for number, index in enumerate(np.ndindex(*sizes)):
        one = found.isel(dict(zip(others, index, strict=True)))
        name = ", ".join(_level(one[other]) for other in others)
        color = shades[number] if others else plots.COLOURS["blue"]
        if is_probability:
            _draw_probability(axes, one, x, color, name)
        else:
            marker = "." if one.sizes[x] <= _MOST_MARKERS else None
            axes.plot(one[x], one[y], marker=marker, color=color, label=name or None)


def _level(value):
    units = value.attrs.get("units")
    return plots.level_name(value.item(), units) if units else f"{value.item()}"


def _scale(axes, found):
    """Scale and limits of the axis of probabilities."""
    names = (f"{_COUNTED}_mean", f"{_COUNTED}_upper", _SAMPLED)
    values = np.concatenate([found[name].values.ravel() for name in names if name in found])
    positive = values[values > 0.0]
    if positive.min() < _DECADE * positive.max():
        axes.set_yscale("log")
        axes.set_ylim(0.3 * positive.min(), min(1.0, 2.0 * positive.max()))
        plots.log_ticks(axes.yaxis)
    else:
        axes.set_ylim(0.0, min(1.0, 1.1 * positive.max()))


def _draw_probability(axes, one, x, color, name):
    """Draw counted probabilities where any is seen, and the curve of the sampled ones."""
    places = one[x].values
    known = _SAMPLED in one and bool(one[_SAMPLED].notnull().all())
    mean, lower, upper = (one[f"{_COUNTED}{end}"].values for end in ("_mean", "_lower", "_upper"))
    seen = (mean > 0.0) | (not known)
    limits = mean, np.minimum(np.maximum(lower, axes.get_ylim()[0]), mean), upper
    style = {"fmt": "o", "color": color, "label": name or "counted, 95 %", "clip_on": False}
    plots.interval_bars(axes, places[seen], *(each[seen] for each in limits), **style)
    if known:
        lower, upper = (one[f"{_SAMPLED}{end}"].values for end in ("_lower", "_upper"))
        axes.fill_between(places, lower, upper, color=color, alpha=0.25, linewidth=0)
        style = {"marker": ".", "color": color, "label": None if name else "importance sampling"}
        axes.plot(places, one[_SAMPLED].values, clip_on=False, **style)


def _label_points(axes, found, y):
    """Name the points of a duty cycle, and mark the probability of the whole of it."""
    # Labels are the only columns without a unit.
    texts = [n for n, one in found.items() if one.dims == ("point",) and "units" not in one.attrs]
    numbers = found["point"].values
    names = found[texts[0]].values if texts else numbers + 1
    slanted = {"rotation": 30, "ha": "right"} if sum(map(len, map(str, names))) > 60 else {}
    axes.set_xticks(numbers, names, **slanted)
    axes.set_xlabel(texts[0] if texts else "Point")
    if y == f"{_COUNTED}_mean":
        whole = found["whole_tail_probability"].fillna(found["whole_probability"]).item()
        axes.axhline(whole, color=plots.COLOURS["grey"], linestyle="--", label="whole cycle")


def _draw_film(axes, found):
    """Draw the film of a profile, on an axis of its own."""
    axes.lines[0].set_label("pressure")
    axes.set_xlim(*_SIDES * found["contact_half_width"].item())
    axes.set_ylim(bottom=0.0)
    film, color = axes.twinx(), plots.COLOURS["vermilion"]
    film.plot(found["position"], found["film"], color=color, label="film")
    film.set_ylim(0.0, _MOST_FILM * found["central_film"].item())
    film.set_ylabel(plots.axis_label(found["film"]))
    film.grid(False)
    film.spines["right"].set_visible(True)
