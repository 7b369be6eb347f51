"""Plots of the answers: probabilities with their intervals, duty cycles, profiles."""

import matplotlib.pyplot as plt
import numpy as np
import xarray as xr
from matplotlib.axes import Axes

from lube import plots
from lube.errors import LubeError, right_one
from lube.schema import LIMITS

_COUNTED, _SAMPLED = "breakthrough_probability", "tail_breakthrough_probability"
_SURFACE = "surface_breakthrough_probability"
_SHOWN = (f"{_COUNTED}_mean", _SURFACE, "pressure", "contact_length", "film_thickness")
"""Variable that is drawn where none is named: the first of these that the answer has."""
_ALONG = ("temperature", "speed", "force")
"""Dimensions along which an answer is drawn, if it has one of them."""
_DECADE = 0.1
"""Ratio of the least to the greatest probability below which the axis is logarithmic."""
_BORNE = 0.02
"""Ratio of the pressure to its maximum from which a profile is drawn."""
_MOST_FILM = 4.0
"""Ratio of the greatest gap that is drawn to the central film."""


def draw(found: xr.Dataset, x: str | None = None, y: str | None = None) -> Axes:
    """Draw an answer.

    Parameters
    ----------
    found : xarray.Dataset
        The answer.
    x, y : str, optional
        Dimension along the axis, and variable, as in `lube.Answer.plot`.

    Returns
    -------
    matplotlib.axes.Axes
        The panel of a new figure.

    Raises
    ------
    LubeError
        If the answer has no such dimension or variable, or a single value only.
    """
    y = y or next(name for name in (*_SHOWN, *found.data_vars) if name in found)
    if y not in found.data_vars:
        raise LubeError(f"plot: got y={y!r}, {right_one(y, map(str, found.data_vars))}")
    dims = sorted(found[y].dims, key=lambda name: (name not in _ALONG, -found.sizes[name]))
    if not dims:
        raise LubeError(f"plot: got a single value of {y}, need several to draw a curve")
    if x not in (None, *dims):
        raise LubeError(f"plot: got x={x!r}, {right_one(x, map(str, dims))}")
    x = x or dims[0]
    with plt.rc_context():
        plots.use_style()
        axes = plt.figure(figsize=(5.6, 3.6)).add_subplot()
        axes.set_xlabel(plots.axis_label(found[x]) if x in found.coords else x.capitalize())
        axes.set_ylabel(plots.axis_label(found[y]))
        if y == _SURFACE:
            axes.set(ylabel="Breakthrough probability of the surface", ylim=(0.0, 1.05))
        _draw_lines(axes, found, x, y)
        if x == "point":
            _label_points(axes, found, y)
        if y == "pressure":
            _draw_film(axes, found)
        plots.legend_above(axes.figure, axes.figure.axes)
    return axes


def _draw_lines(axes, found, x, y):
    """Draw a line for each level of the other dimensions."""
    others = [name for name in found[y].dims if name != x]
    indices = list(np.ndindex(*(found.sizes[name] for name in others)))
    blue = plots.COLOURS["blue"]
    shades = plots.level_colours(range(len(indices))).values() if others else (blue,)
    if y == _SHOWN[0]:
        _scale(axes, found)
    for index, color in zip(indices, shades, strict=True):
        one = found.isel(dict(zip(others, index, strict=True)))
        name = ", ".join(_level(one[other]) for other in others)
        if y == _SHOWN[0]:
            _draw_probability(axes, one, x, color, name)
        elif y == _SURFACE:
            limits = (one[f"{y}{end}"].values for end in LIMITS)
            style = {"fmt": "o-", "color": color, "label": name or "sampled, 95 %"}
            plots.interval_bars(axes, one[x].values, *limits, **style, clip_on=False)
        else:
            axes.plot(one[x], one[y], color=color, label=name)


def _level(value):
    units = value.attrs.get("units")
    return plots.level_name(value.item(), units) if units else f"{value.item()}"


def _scale(axes, found):
    """Set name, scale and limits of the axis of probabilities."""
    names = (f"{_COUNTED}_mean", f"{_COUNTED}_upper", _SAMPLED)
    values = np.concatenate([found[name].values.ravel() for name in names if name in found])
    least, most = values[values > 0.0].min(), np.nanmax(values)
    axes.set_ylabel("Breakthrough probability")
    if least < _DECADE * most:
        axes.set(yscale="log", ylim=(0.3 * least, min(1.0, 2.0 * most)))
        plots.log_ticks(axes.yaxis)
    else:
        axes.set_ylim(0.0, min(1.0, 1.1 * most))


def _draw_probability(axes, one, x, color, name):
    """Draw counted probabilities where contact was seen, and the curve of the sampled ones."""
    mean, lower, upper = (one[f"{_COUNTED}{end}"].values for end in ("_mean", "_lower", "_upper"))
    known = _SAMPLED in one and bool(one[_SAMPLED].notnull().all())
    seen = (mean > 0.0) | (not known)
    limits = mean, np.minimum(np.maximum(lower, axes.get_ylim()[0]), mean), upper
    style = {"fmt": "o", "color": color, "label": name or "counted, 95 %", "clip_on": False}
    plots.interval_bars(axes, one[x].values[seen], *(each[seen] for each in limits), **style)
    if known:
        limits = (one[f"{_SAMPLED}{end}"].values for end in ("_lower", "_upper"))
        axes.fill_between(one[x].values, *limits, color=color, alpha=0.25, linewidth=0)
        style = {"marker": ".", "color": color, "clip_on": False}
        axes.plot(one[x].values, one[_SAMPLED].values, label="importance sampling", **style)


def _label_points(axes, found, y):
    """Name the points of a duty cycle, and mark the probability of the whole cycle."""
    # Labels are the only columns without a unit.
    texts = [n for n, one in found.items() if one.dims == ("point",) and "units" not in one.attrs]
    numbers = found["point"].values
    axes.set_xticks(numbers, found[texts[0]].values if texts else numbers + 1)
    if texts:
        axes.set_xlabel(texts[0])
        axes.tick_params(axis="x", labelrotation=20)
    whole = None
    if y == _SHOWN[0]:
        whole = found["whole_tail_probability"].fillna(found["whole_probability"])
    elif y == _SURFACE:
        whole = found["whole_surface_probability"]
    if whole is not None:
        axes.axhline(whole.item(), color=plots.COLOURS["grey"], linestyle="--", label="whole cycle")


def _draw_film(axes, found):
    """Draw the film of a profile, on a second axis."""
    axes.lines[0].set_label("pressure")
    borne = found["position"].values[found["pressure"] > _BORNE * found["pressure"].max()]
    axes.set(xlim=1.3 * borne[[0, -1]], ylim=(0.0, None))
    film, color = axes.twinx(), plots.COLOURS["vermilion"]
    film.plot(found["position"], found["film"], color=color, label="film, gap outside")
    film.set(ylim=(0.0, _MOST_FILM * found["central_film"].item()))
    film.set_ylabel(plots.axis_label(found["film"].assign_attrs(long_name="film")))
    film.grid(False)
    film.spines["right"].set_visible(True)
