"""The explorer's page: controls and figures by Bokeh, in a template of our own.

The page holds everything, Bokeh's JavaScript included, so it needs neither server nor network.
What happens when a control moves is in ``templates/explorer.mjs``.
"""

import functools
import json
from pathlib import Path

import numpy as np
import xarray as xr
from bokeh.core.properties import value as constant
from bokeh.document import Document
from bokeh.models import (
    BasicTicker,
    CategoricalSlider,
    ColorBar,
    ColumnDataSource,
    CustomJS,
    FixedTicker,
    HoverTool,
    InlineStyleSheet,
    LogColorMapper,
    RadioButtonGroup,
    Select,
    TapTool,
    Whisker,
)
from bokeh.palettes import Cividis256
from bokeh.plotting import figure
from bokeh.resources import Resources
from bokeh.themes import Theme
from jinja2 import Environment, PackageLoader, StrictUndefined
from scipy.ndimage import distance_transform_edt

from lube.explorer.content import CHOICES, page_content
from lube.physics.regimes import regime
from lube.plots import COLOURS
from lube.schema import COORDINATES
from lube.workflow.stamps import stamp

_TEMPLATES = Path(__file__).parent / "templates"
_NAMES = {
    "lubricant": "Oil",
    "film_formula": "Film formula",
    "force": "Force",
    "speed": "Speed",
    "temperature": "Temperature",
    "slide_to_roll_ratio": "Slide-to-roll ratio",
}
"""Names of the choices on the page."""
_AXES = {"force": "Force (N)", "speed": "Speed (r/min)", "temperature": "Temperature (°C)"}
_TINTS = ("#E8F4FB", "#FDF3DC", "#DFF3EC", "#F9E6DA")  # of the regimes: light Okabe-Ito colours
_SHARES = (1e-6, 1.0)  # probabilities that the master map's colours tell apart
_FONT = "system-ui, sans-serif"
_THEME = Theme(
    json={
        "attrs": {
            "Axis": {
                "axis_label_text_font": _FONT,
                "axis_label_text_font_size": "14px",
                "axis_label_text_font_style": "normal",
                "major_label_text_font": _FONT,
                "major_label_text_font_size": "13px",
                "minor_tick_line_color": None,
            },
            "Grid": {"grid_line_color": "#E4E4E4"},
            "Plot": {
                "height": 320,
                "sizing_mode": "stretch_width",
                "outline_line_color": "#94A3B8",
                "toolbar_location": None,
            },
            "BaseColorBar": {"major_label_text_font_size": "13px"},
        }
    }
)
_POINTS = (
    *("x", "film", "mean", "lower", "upper", "limit", "lambda", "width", "M", "L", "name"),
    *CHOICES,
)
"""Columns of the sources of operating points; ``limit`` is an upper limit without contact."""


def explorer_page(datasets: dict[str, xr.Dataset]) -> str:
    """Make the explorer of a study.

    Parameters
    ----------
    datasets : dict of str to xarray.Dataset
        The study's ``lubricant``, ``film``, ``contact``, ``master``, ``trace`` and
        ``comparison``, as loaded.

    Returns
    -------
    str
        HTML that needs no other file. The same datasets give the same page.

    Raises
    ------
    DataError
        As from `lube.workflow.stamps.stamp`.
    """
    content = page_content(datasets)
    start = content["traces"][0]["at"]
    controls = _controls(content["levels"], start)
    sources = {
        **{name: ColumnDataSource({column: [] for column in _POINTS}, name=name)
           for name in ("grid", "along", "chosen")},
        "records": _source("lambda", "x", "share", "lower", "upper", "name", "here"),
        "master": _source("lambda", "narrow", "near", "lower", "upper", "wide"),
        "frame": _source("left", "right", "bottom", "top"),
        "whole": _source("time", "length", "resistance"),
        "close": _source("time", "length", "resistance"),
    }  # fmt: skip
    figures = _figures(content, datasets, sources)
    return _filled(content, datasets, controls, sources, figures)


def _source(*columns):
    return ColumnDataSource({name: [] for name in columns})


# Controls


def _controls(levels, start):
    """A control for each choice that has several levels, and one for the abscissa."""
    controls = {}
    sheets = [InlineStyleSheet(css=(_TEMPLATES / "controls.css").read_text(encoding="utf-8"))]
    common = {"stylesheets": sheets, "sizing_mode": "stretch_width"}
    for name, level in levels.items():
        names = level["names"]
        if len(names) == 1:
            continue
        options = {"name": name, "title": _NAMES[name], "value": names[start[name]], **common}
        if name in ("lubricant", "film_formula"):
            controls[name] = Select(options=names, **options)
        else:
            controls[name] = CategoricalSlider(
                categories=names, bar_color=COLOURS["blue"], **options
            )
    several = [name for name in CHOICES[2:] if name in controls]
    if several:
        first = several.index("temperature") if "temperature" in several else 0
        controls["along"] = RadioButtonGroup(
            labels=[_NAMES[name] for name in several],
            active=first,
            name="along",
            tags=several,
            **common,
        )
    return controls


# Figures


def _figures(content, datasets, sources):
    ratios, shares = _ratio_range(datasets), _share_range(datasets)
    figures = {
        "film": _film_along(sources, _film_range(datasets)),
        "probability": _probability_along(sources, shares),
        "regimes": _regime_map(datasets["film"], content["validity"], sources),
        "curve": _master_curve(sources, ratios, shares),
    }
    if len(content["master"]["contact_width"]) > 1:
        figures["map"] = _master_map(content["master"], sources)
    for part in ("whole", "close"):
        figures |= _trace(part, sources[part])
    return figures


def _spread(values, by=1.3):
    """Range of positive values with some room on a logarithmic axis."""
    values = values[np.isfinite(values) & (values > 0.0)]
    return (values.min() / by, values.max() * by)


def _film_range(datasets):
    return _spread(1e6 * datasets["film"]["film_thickness"].values)


def _ratio_range(datasets):
    ratios = [datasets[kind]["lambda_ratio"].values.ravel() for kind in ("film", "master")]
    return _spread(np.concatenate(ratios), 1.1)


def _share_range(datasets):
    """Probabilities of the study: down to the smallest estimate, or limit where none was seen."""
    mean, upper = (
        np.concatenate(
            [
                datasets[kind][f"breakthrough_probability_{limit}"].values.ravel()
                for kind in ("contact", "master")
            ]
        )
        for limit in ("mean", "upper")
    )
    low, _ = _spread(np.where(mean > 0.0, mean, upper))
    return low, 1.6


def _plot(x_axis_label, y_axis_label, **options):
    return figure(
        x_axis_label=x_axis_label, y_axis_label=y_axis_label, tools="", toolbar_location=None,
        **options
    )  # fmt: skip


def _percent_axis(plot):
    """Label powers of ten of a share with percentages."""
    plot.yaxis.ticker = FixedTicker(ticks=[10.0**power for power in range(-9, 1)])
    plot.yaxis.major_label_overrides = {
        10.0**power: f"{10.0 ** (power + 2):.10f}".rstrip("0").rstrip(".") + " %"
        for power in range(-9, 1)
    }


def _points(plot, source, x, y, size=8, **look):
    """Points that tell their name when hovered or touched, and are chosen by a click."""
    look = {"fill_color": COLOURS["sky"], "line_color": COLOURS["blue"]} | look
    points = plot.scatter(x, y, source=source, size=size, **look)
    points.nonselection_glyph = points.glyph
    return points


def _all_points(plot, sources, x, y, along=False, tips=()):
    """The operating points around the chosen one, and the chosen one."""
    around = sources["along" if along else "grid"]
    small = _points(plot, around, x, y, size=8 if along else 6)
    _points(
        plot, sources["chosen"], x, y, size=15, fill_color=COLOURS["vermilion"], line_color="black"
    )
    plot.add_tools(
        HoverTool(renderers=[small], tooltips="<b>@name</b>", point_policy="snap_to_data"),
        TapTool(renderers=[small]),
    )


def _probabilities(plot, sources, x, along=False):
    """Probabilities with their intervals; where no contact was seen, their upper limits."""
    _all_points(plot, sources, x, "mean", along)
    for name, size, colour in (
        ("along" if along else "grid", 9 if along else 6, COLOURS["blue"]),
        ("chosen", 15, COLOURS["vermilion"]),
    ):
        limits = plot.scatter(
            x, "limit", source=sources[name], size=size, marker="inverted_triangle",
            fill_color="white", line_color=colour, line_width=2 if name == "chosen" else 1,
        )  # fmt: skip
        limits.nonselection_glyph = limits.glyph
        if name != "chosen":
            plot.select_one(TapTool).renderers.append(limits)
            plot.select_one(HoverTool).renderers.append(limits)
    records = plot.scatter(
        "x" if along else "lambda", "share", source=sources["records"], marker="x", size=10,
        line_color=COLOURS["purple"], line_width=2, line_alpha="here" if along else 1.0,
    )  # fmt: skip
    plot.add_tools(HoverTool(renderers=[records], tooltips="<b>@name</b>"))


def _whiskers(plot, source, x, colour, width):
    whisker = Whisker(
        base=x, lower="lower", upper="upper", source=source, line_color=colour, line_width=width
    )
    whisker.upper_head.size = whisker.lower_head.size = 8
    whisker.upper_head.line_color = whisker.lower_head.line_color = colour
    plot.add_layout(whisker)


def _film_along(sources, films):
    plot = _plot("", "Film thickness (µm)", y_axis_type="log", y_range=films, name="film")
    plot.line("x", "film", source=sources["along"], line_color=COLOURS["blue"], line_width=2)
    _all_points(plot, sources, "x", "film", along=True)
    return plot


def _probability_along(sources, shares):
    plot = _plot("", "Breakthrough probability", y_axis_type="log", y_range=shares)
    _percent_axis(plot)
    plot.line("x", "mean", source=sources["along"], line_color=COLOURS["blue"], line_width=2)
    _whiskers(plot, sources["along"], "x", COLOURS["blue"], 1)
    _whiskers(plot, sources["chosen"], "x", "black", 2)
    _probabilities(plot, sources, "x", along=True)
    return plot


def _regime_map(film, validity, sources):
    """Where the points lie among the four regimes, over the Moes numbers."""
    names = film["regime"].attrs["flag_meanings"].split()
    frames = np.array([[*one["moes_load"], *one["moes_material"]] for one in validity.values()])
    loads = np.append(film["moes_load"].values, frames[:, :2])
    materials = np.append(film["moes_material"].values, frames[:, 2:])
    left, right = _spread(loads, 1.6)
    bottom, top = max(materials.min() - 1.5, 0.05), materials.max() + 1.5
    across, up = np.geomspace(left, right, 400), np.linspace(bottom, top, 300)
    flags = regime(across, up[:, None])
    plot = _plot(
        "Moes load number M", "Moes material number L",
        x_axis_type="log", x_range=(left, right), y_range=(bottom, top),
    )  # fmt: skip
    plot.image(
        [flags.astype(np.uint8)], x=left, y=bottom, dw=right - left, dh=top - bottom,
        palette=_TINTS, level="image",
    )  # fmt: skip
    for flag in np.unique(flags):
        # In the middle of the widest part of the regime.
        inside = np.pad(flags == flag, 1)
        row, column = np.unravel_index(distance_transform_edt(inside).argmax(), inside.shape)
        plot.text(
            [across[column - 1]], [up[row - 1]], [names[flag].replace("_", "\n")],
            text_align="center", text_baseline="middle", text_font=constant(_FONT),
            text_font_size="14px", text_color="#475569",
        )  # fmt: skip
    plot.quad(
        source=sources["frame"], left="left", right="right", bottom="bottom", top="top",
        fill_color=None, line_color="black", line_dash="dashed",
    )  # fmt: skip
    _all_points(plot, sources, "M", "L")
    return plot


def _master_curve(sources, ratios, shares):
    """Probability against the lambda ratio, by the master map."""
    plot = _plot(
        "Lambda ratio", "Breakthrough probability",
        x_axis_type="log", y_axis_type="log", x_range=ratios, y_range=shares,
    )  # fmt: skip
    _percent_axis(plot)
    source = sources["master"]
    plot.varea(
        "lambda", "lower", "upper", source=source, fill_color=COLOURS["orange"], fill_alpha=0.35
    )
    plot.line("lambda", "narrow", source=source, line_color=COLOURS["grey"], line_dash="dotted",
              line_width=2)  # fmt: skip
    plot.line("lambda", "wide", source=source, line_color=COLOURS["grey"], line_dash="dashed",
              line_width=2)  # fmt: skip
    plot.line("lambda", "near", source=source, line_color=COLOURS["orange"], line_width=2.5)
    _whiskers(plot, sources["chosen"], "lambda", "black", 2)
    _probabilities(plot, sources, "lambda")
    return plot


def _master_map(master, sources):
    """The master map, each of its values as a coloured field."""
    ratios = np.array(master["lambda_ratio"])
    widths = 1e6 * np.array(master["contact_width"])
    edges = np.exp(_edges(np.log(ratios)))
    lines = _edges(widths)
    mean = np.array(master["mean"], dtype=float).ravel()
    rows, columns = np.divmod(np.arange(mean.size), ratios.size)
    mapper = LogColorMapper(
        palette=Cividis256, low=_SHARES[0], high=_SHARES[1], low_color=Cividis256[0]
    )
    plot = _plot(
        "Lambda ratio", "Contact width (µm)",
        x_axis_type="log", x_range=(edges[0], edges[-1]), y_range=(lines[0], lines[-1]),
    )  # fmt: skip
    fields = ColumnDataSource(
        {
            "left": edges[columns],
            "right": edges[columns + 1],
            "bottom": lines[rows],
            "top": lines[rows + 1],
            "mean": np.where(mean > 0.0, mean, np.nan),
        }
    )
    mapper.nan_color = "#FFFFFF"
    plot.quad(
        source=fields, left="left", right="right", bottom="bottom", top="top", line_color=None,
        fill_color={"field": "mean", "transform": mapper},
    )  # fmt: skip
    bar = ColorBar(color_mapper=mapper, width=12, padding=4, ticker=FixedTicker(ticks=[1e-6, 1e-4, 1e-2, 1]))
    bar.major_label_overrides = {1e-6: "0.0001 %", 1e-4: "0.01 %", 1e-2: "1 %", 1.0: "100 %"}
    plot.add_layout(bar, "right")
    _all_points(plot, sources, "lambda", "width")
    return plot


def _edges(values):
    """Edges of fields around rising values."""
    inner = 0.5 * (values[1:] + values[:-1])
    return np.concatenate([[2 * values[0] - inner[0]], inner, [2 * values[-1] - inner[-1]]])


def _trace(part, source):
    """Contact length and resistance of a trace, or of its part around the peak."""
    time = "Time (s)" if part == "whole" else "Time from the peak (ms)"
    length = _plot(time, "Contact length (µm)", height=240)
    length.line("time", "length", source=source, line_color=COLOURS["blue"])
    length.y_range.start = 0
    resistance = _plot(
        time, "Resistance (Ω)", height=240, y_axis_type="log", x_range=length.x_range
    )
    resistance.line("time", "resistance", source=source, line_color=COLOURS["green"])
    return {f"{part}_length": length, f"{part}_resistance": resistance}


# Page


def _filled(content, datasets, controls, sources, figures):
    """The page as text."""
    arguments = {"controls": controls, "sources": sources, "figures": figures}
    react = CustomJS.from_file(_TEMPLATES / "explorer.mjs", **arguments)
    for name, control in controls.items():
        control.js_on_change("active" if name == "along" else "value", react)
    for name in ("grid", "along"):
        sources[name].selected.js_on_change("indices", react)
    document = Document(theme=_THEME)
    document.js_on_event("document_ready", react)
    for model in (*controls.values(), *figures.values()):
        document.add_root(model)
    # As `bokeh.embed.components` does, but with names instead of random numbers.
    places = {model.id: f"figure-{name}" for name, model in figures.items()}
    places |= {model.id: f"control-{name}" for name, model in controls.items()}
    items = [{"docid": "explorer", "roots": places, "root_ids": list(places)}]
    return _environment().get_template("explorer.html").render(
        title=datasets["contact"].attrs["title"].rpartition(", ")[0],
        content=content,
        names=_NAMES,
        controls=controls,
        figures=figures,
        json={
            "content": _script(content),
            "models": _script({"explorer": document.to_json(deferred=False)}),
            "items": _script(items),
        },
        bokeh=Resources(mode="inline", components=["bokeh", "bokeh-widgets"]).render(),
        stamp=stamp(list(datasets.values())),
    )


def _script(value):
    """JSON that cannot end the script element it stands in."""
    return json.dumps(value, allow_nan=False, separators=(",", ":")).replace("<", "\\u003c")


@functools.cache
def _environment():
    return Environment(
        loader=PackageLoader("lube.explorer"), autoescape=True, undefined=StrictUndefined,
        trim_blocks=True, lstrip_blocks=True,
    )  # fmt: skip
