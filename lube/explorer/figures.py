"""The explorer's figures, by Bokeh: axes, ranges and styles; the page's JavaScript fills them."""

import math

import numpy as np
import xarray as xr
from bokeh import models
from bokeh.palettes import Cividis256
from bokeh.plotting import figure
from bokeh.transform import log_cmap

from lube.explorer.content import CHOICES, MODEL
from lube.physics.regimes import regime
from lube.plots import COLOURS

TINTS = ("#D6ECFA", "#FFF4D1", "#E0E0E0", "#F4D3C0")
"""Light colours of the regimes."""
_SHARES = (1e-6, 1e-4, 1e-2, 1.0)  # labels of the master map's colours, from end to end
_DIGITS = {0.5: (1, 1.2, 1.5, 2, 2.5, 3, 4, 5, 6, 8), 1.2: (1, 1.5, 2, 3, 5, 7),
           2.5: (1, 2, 5), 3.5: (1, 3), math.inf: (1,)}  # fmt: skip
"""Digits that get a label on a logarithmic axis, by the largest number of its decades."""
_MOST_DECADES = 8
"""Largest number of decades on a logarithmic axis that all get a label."""
_SUPERSCRIPTS = str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹")
_RAREST = 1e-20
"""Lowest probability on the axes: at very thick films probabilities fall below any number."""
_POINT = (
    *"x film mean lower upper limit lambda width M L name".split(),
    *"outside falling separated deformed rubbing".split(),
    *CHOICES,
    MODEL,
)
COLUMNS = {
    # The chosen point, those along one variable, at one force, and at all levels of the grid.
    **dict.fromkeys(("chosen", "along", "force", "grid"), _POINT),
    "records": ("x", "lambda", "share", "name"),
    "master": ("lambda", "narrow", "near", "lower", "upper", "wide"),
    "frame": ("left", "right", "bottom", "top"),  # of the film formula's validity
    **dict.fromkeys(("whole", "close"), ("time", "length", "resistance")),
}
"""Columns of each source of the figures. ``limit`` is an upper limit where no contact was seen;
``outside``, ``falling``, ``separated``, ``deformed`` and ``rubbing`` are means where the model
cannot hold, where contact is less than at a thicker film, where the oil may keep lines apart that
touch here, where the linear response to roughness is not valid, or where asperities of the surfaces
carry much of the load."""


def draw(
    content: dict, datasets: dict[str, xr.Dataset], sources: dict[str, models.ColumnDataSource]
) -> dict[str, figure]:
    """Draw the page's figures, as yet without an operating point.

    Parameters
    ----------
    content : dict
        From `lube.explorer.content.page_content`.
    datasets : dict of str to xarray.Dataset
        The datasets that `content` was made from.
    sources : dict of str to bokeh.models.ColumnDataSource
        One for each of `COLUMNS`, by its name.

    Returns
    -------
    dict of str to bokeh.plotting.figure
        The figures by the names of their positions on the page.
    """
    ratios = _spread(_values(datasets, "lambda_ratio", "film", "master"), 1.1)
    shares = _share_range(datasets)
    films = _spread(1e6 * datasets["film"]["film_thickness"].values)
    resistances = _spread(_values(datasets, "contact_resistance", "trace", "surface_trace"), 1.5)
    across = models.Range1d()
    figures = {
        "film": _film_along(sources, across, films),
        "probability": _probability_along(sources, across, shares),
        "regimes": _regime_map(datasets["film"], content["validity"], sources),
        "curve": _master_curve(sources, ratios, shares),
    }
    if content["master"] and len(content["master"]["contact_width"]) > 1:
        figures["map"] = _master_map(content["master"], ratios, sources)
    for part in ("whole", "close"):
        figures |= _trace(part, sources[part], resistances)
        if not content["conducts"]:
            del figures[f"{part}_resistance"]
    return figures


def _spread(values, by=1.3):
    """Range of positive values, with some room at both ends of a logarithmic axis."""
    values = values[np.isfinite(values) & (values > 0.0)]
    return (values.min() / by, values.max() * by) if values.size else (0.1, 10.0)


def _values(datasets, variable, *kinds):
    """Values of a variable in all datasets of these kinds that there are."""
    made = [datasets[kind] for kind in kinds if kind in datasets]
    return np.concatenate([dataset[variable].values.ravel() for dataset in made])


def _share_range(datasets):
    """Range of the study's probabilities, or of their upper limits where no contact was seen."""
    counted = datasets["tail"].attrs["remarks"]
    kinds, end = (("contact", "master"), "_mean") if counted else (("tail",), "")
    names = (f"breakthrough_probability{each}" for each in (end, "_upper"))
    mean, upper = (_values(datasets, name, *kinds) for name in names)
    return max(_spread(np.where(mean > 0.0, mean, upper))[0], _RAREST), 1.6


def _plot(x_axis_label, y_axis_label, **options):
    options |= {"tools": "", "toolbar_location": None}
    plot = figure(x_axis_label=x_axis_label, y_axis_label=y_axis_label, **options)
    for axis, span in ((plot.xaxis, plot.x_range), (plot.yaxis, plot.y_range)):
        if isinstance(axis[0], models.LogAxis):
            _label(axis, _round_numbers(span.start, span.end), "{:g}".format)
    return plot


def _label(axis, ticks, text):
    axis.ticker = models.FixedTicker(ticks=ticks)
    axis.major_label_overrides = {tick: text(tick) for tick in ticks}


def _round_numbers(low, high):
    """Round numbers for a logarithmic axis: the more decades, the fewer numbers in each."""
    decades = math.log10(high / low)
    digits = next(digits for most, digits in _DIGITS.items() if decades <= most)
    step = math.ceil(decades / _MOST_DECADES)
    powers = range(math.floor(math.log10(low)), math.ceil(math.log10(high)))
    found = [float(f"{digit}e{power}") for power in powers if power % step == 0 for digit in digits]
    return [number for number in found if low <= number <= high]


def _percent(share):
    percent = 100.0 * share
    if percent > 0.99e-4:
        return f"{percent:.10f}".rstrip("0").rstrip(".") + " %"
    digits, power = f"{percent:.1e}".split("e")
    factor = "" if digits == "1.0" else f"{digits.removesuffix('.0')} × "
    return f"{factor}10{str(int(power)).translate(_SUPERSCRIPTS)} %"


def _percent_axis(plot):
    """Label the probabilities on a plot's vertical axis with percentages."""
    _label(plot.yaxis, [share for share in plot.yaxis[0].ticker.ticks if share <= 1.0], _percent)


def _points(plot, source, x, y, size=8, **look):
    """Draw points that look the same when another point is chosen."""
    look = {"fill_color": COLOURS["sky"], "line_color": COLOURS["blue"]} | look
    points = plot.scatter(x, y, source=source, size=size, **look)
    points.nonselection_glyph = points.glyph
    return points


def _all_points(plot, sources, x, y, around="grid"):
    """Draw the chosen operating point, and others, which show their names and can be chosen."""
    small = _points(plot, sources[around], x, y, size=6 if around == "grid" else 8)
    look = {"fill_color": COLOURS["vermilion"], "line_color": "black"}
    _points(plot, sources["chosen"], x, y, size=15, **look)
    plot.add_tools(
        models.HoverTool(renderers=[small], tooltips="<b>@name</b>", point_policy="snap_to_data"),
        models.TapTool(renderers=[small]),
    )


def _probabilities(plot, sources, x, around):
    """Draw probabilities with intervals, and upper limits where no contact was seen."""
    _whiskers(plot, sources["chosen"], x, "black", 2)
    _all_points(plot, sources, x, "mean", around)
    _points(plot, sources[around], x, "outside", fill_color="white")
    around_it = {"size": 15, "fill_color": None, "line_color": "black"}
    _points(plot, sources[around], x, "falling", **around_it)
    _points(plot, sources[around], x, "deformed", marker="square", **around_it)
    _points(plot, sources[around], x, "separated", marker="star", **around_it | {"size": 22})
    _points(plot, sources[around], x, "rubbing", marker="diamond", **around_it | {"size": 26})
    look = {"marker": "inverted_triangle", "fill_color": "white"}
    limits = _points(plot, sources[around], x, "limit", **look)
    for tool in (models.HoverTool, models.TapTool):
        plot.select_one(tool).renderers.append(limits)
    look |= {"line_color": COLOURS["vermilion"], "line_width": 2.5}
    _points(plot, sources["chosen"], x, "limit", size=15, **look)
    records = plot.scatter(
        x, "share", source=sources["records"], marker="x", size=10,
        line_color=COLOURS["purple"], line_width=2.5,
    )  # fmt: skip
    plot.add_tools(models.HoverTool(renderers=[records], tooltips="<b>@name</b>"))


def _whiskers(plot, source, x, colour, width):
    look = {"line_color": colour, "line_width": width}
    whisker = models.Whisker(base=x, lower="lower", upper="upper", source=source, **look)
    whisker.upper_head.size = whisker.lower_head.size = 8
    whisker.upper_head.line_color = whisker.lower_head.line_color = colour
    plot.add_layout(whisker)


def _film_along(sources, across, films):
    plot = _plot("", "Film thickness (µm)", y_axis_type="log", x_range=across, y_range=films)
    plot.line("x", "film", source=sources["along"], line_color=COLOURS["blue"], line_width=2)
    _all_points(plot, sources, "x", "film", "along")
    return plot


def _probability_along(sources, across, shares):
    plot = _plot("", "Breakthrough probability", y_axis_type="log", x_range=across, y_range=shares)
    _percent_axis(plot)
    plot.line("x", "mean", source=sources["along"], line_color=COLOURS["blue"], line_width=2)
    _whiskers(plot, sources["along"], "x", COLOURS["blue"], 1)
    _probabilities(plot, sources, "x", "along")
    return plot


def _regime_map(film, validity, sources):
    """Draw the operating points on the map of the four regimes, over the Moes numbers."""
    frames = np.array([[*one["moes_load"], *one["moes_material"]] for one in validity.values()])
    materials = np.append(film["moes_material"].values, frames[:, 2:])
    left, right = _spread(np.append(film["moes_load"].values, frames[:, :2]), 1.6)
    bottom, top = max(materials.min() - 1.0, 0.05), materials.max() + 1.0
    across, up = np.geomspace(left, right, 400), np.linspace(bottom, top, 300)
    flags = regime(across, up[:, None])
    plot = _plot(
        "Moes load number M", "Moes material number L",
        x_axis_type="log", x_range=(left, right), y_range=(bottom, top),
    )  # fmt: skip
    plot.image(
        [flags.astype(np.uint8)], x=left, y=bottom, dw=right - left, dh=top - bottom,
        color_mapper=models.LinearColorMapper(palette=TINTS, low=0, high=3), level="image",
    )  # fmt: skip
    plot.quad(
        source=sources["frame"], left="left", right="right", bottom="bottom", top="top",
        fill_color=None, line_color="black", line_dash="dashed",
    )  # fmt: skip
    _all_points(plot, sources, "M", "L")
    return plot


def _master_curve(sources, ratios, shares):
    """Draw the probability against the lambda ratio, and curves of the master map if it exists."""
    plot = _plot(
        "Lambda ratio", "Breakthrough probability",
        x_axis_type="log", y_axis_type="log", x_range=ratios, y_range=shares,
    )  # fmt: skip
    _percent_axis(plot)
    source = sources["master"]
    light = {"fill_color": COLOURS["orange"], "fill_alpha": 0.35}
    plot.varea("lambda", "lower", "upper", source=source, **light)
    grey = {"line_color": COLOURS["grey"], "line_width": 2}
    plot.line("lambda", "narrow", source=source, line_dash="dotted", **grey)
    plot.line("lambda", "wide", source=source, line_dash="dashed", **grey)
    plot.line("lambda", "near", source=source, line_color=COLOURS["orange"], line_width=2.5)
    _probabilities(plot, sources, "lambda", "force")
    return plot


def _master_map(master, span, sources):
    """Draw the master map: each value is a coloured field."""
    ratios = np.array(master["lambda_ratio"])
    edges = np.exp(_edges(np.log(ratios)))
    lines = _edges(1e6 * np.array(master["contact_width"]))
    mean = np.array(master["mean"], dtype=float).ravel()
    rows, columns = np.divmod(np.arange(mean.size), ratios.size)
    colour = log_cmap("mean", Cividis256, _SHARES[0], _SHARES[-1], nan_color="white")
    plot = _plot(
        "Lambda ratio", "Contact width (µm)",
        x_axis_type="log", x_range=span, y_range=(lines[0], lines[-1]),
        background_fill_color=TINTS[2],
    )  # fmt: skip
    fields = {
        "left": edges[columns],
        "right": edges[columns + 1],
        "bottom": lines[rows],
        "top": lines[rows + 1],
        "mean": np.where(mean > 0.0, mean, np.nan),
    }
    plot.quad(
        source=fields, left="left", right="right", bottom="bottom", top="top",
        fill_color=colour, line_color=colour,  # without outlines, gaps would show
    )  # fmt: skip
    bar = models.ColorBar(color_mapper=colour.transform, width=12, padding=4)
    _label(bar, list(_SHARES), _percent)
    plot.add_layout(bar, "right")
    _all_points(plot, sources, "lambda", "width")
    return plot


def _edges(values):
    """Edges of fields around rising values."""
    inner = 0.5 * (values[1:] + values[:-1])
    return np.concatenate([[2 * values[0] - inner[0]], inner, [2 * values[-1] - inner[-1]]])


def _trace(part, source, resistances):
    """Draw contact length and resistance of a trace, or of its part around the peak."""
    time = "Time (s)" if part == "whole" else "Time from the peak (ms)"
    common = {"height": 230, "x_range": models.Range1d(), "min_border_left": 75}
    length = _plot(time, "Contact length (µm)", y_range=models.Range1d(), **common)
    length.line("time", "length", source=source, line_color=COLOURS["blue"])
    resistance = _plot(time, "Resistance (Ω)", y_axis_type="log", y_range=resistances, **common)
    green = COLOURS["green"]
    resistance.line("time", "resistance", source=source, line_color=green)
    resistance.scatter("time", "resistance", source=source, color=green, size=3)
    return {f"{part}_length": length, f"{part}_resistance": resistance}
