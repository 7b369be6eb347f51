"""What all figures share: style, colours, axis labels from attributes, saving.

Colours are those of Okabe and Ito, which readers with any colour vision can tell apart. The levels
of an ordered quantity get colours from a colour map whose lightness changes steadily.
"""

import re
import textwrap
from collections.abc import Iterable, Sequence
from itertools import cycle
from pathlib import Path
from typing import Any

import matplotlib.pyplot as plt
import numpy as np
import numpy.typing as npt
import xarray as xr
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.axis import Axis
from matplotlib.figure import Figure
from matplotlib.layout_engine import ConstrainedLayoutEngine
from matplotlib.markers import CARETDOWN, CARETLEFT, CARETRIGHT, CARETUP
from matplotlib.ticker import FuncFormatter, LogLocator, MaxNLocator, NullFormatter, NullLocator

from lube.pipeline.stamps import stamp
from lube.schema import COORDINATES
from lube.storage.files import written_whole
from lube.units import SYMBOLS, convert

COLOURS = {
    "black": "#000000",
    "orange": "#E69F00",
    "sky": "#56B4E9",
    "green": "#009E73",
    "blue": "#0072B2",
    "vermilion": "#D55E00",
    "purple": "#CC79A7",
    "grey": "#7F7F7F",
}
EDGE_MARK = "edge-mark"
"""Group identifier of the marks that `mark_outside` draws."""
_AROUND = "around"
"""Group identifier of the marks around points."""

NOT_POINTS = ("None", "none", "", " ", "_", "|")
"""Markers that are not points: no marker, and the caps of bars."""

MARKERS = ("o", "s", "^", "D", "v", "P", "X", "*")

# Coordinates of an operating point besides force, speed and temperature, with the words before
# their values.
_OTHER_COORDINATES = {
    "lubricant": "",
    "film_formula": "film formula ",
    "slide_to_roll_ratio": "slide-to-roll ratio ",
    "contact_model": "contact of the ",
}

_STAMP_STRIP = 0.12  # height of the stamp below everything else, inches
_FOOTNOTE_LINE = 130  # characters that fit below a figure
_MOST_LABELS = 9  # on a logarithmic axis
_CHARACTER = 0.07  # width of a character of a tick label, inches
_SPACE_BEFORE_UNIT = re.compile(r"(?<=\d) (?=\D)|(?<=[)>]) |(?<=pair) ")  # or after (a), > or pair


def use_style() -> None:
    """Set the style of the figures drawn from now on.

    Parameters of Matplotlib that the style does not name keep the user's values; the workflow
    executes notebooks with Matplotlib's defaults for these.
    """
    plt.style.use("lube.plots")


def in_units(array: xr.DataArray, units: str) -> xr.DataArray:
    """Convert a labelled array for an axis.

    Parameters
    ----------
    array : xarray.DataArray
        With its unit in the attribute ``units``, such as ``m2 s-1``.
    units : str
        The unit wanted, in the same notation, such as ``mm2 s-1``.

    Returns
    -------
    xarray.DataArray
        The converted array, with the new unit in its attributes.

    Examples
    --------
    >>> import xarray as xr
    >>> from lube import plots
    >>> film = xr.DataArray(2e-6, attrs={"units": "m", "long_name": "film thickness"})
    >>> plots.in_units(film, "um").item()
    2.0
    """
    factor = convert(1.0, array.attrs["units"], units)
    return (array * factor).assign_attrs(array.attrs | {"units": units})


def axis_label(array: xr.DataArray, symbol: str | None = None) -> str:
    """Axis label from the attributes of an array: its name, symbol and unit.

    Parameters
    ----------
    array : xarray.DataArray
        With the attributes ``long_name`` and ``units``.
    symbol : str, optional
        Symbol to add, such as ``$h_0$``.

    Returns
    -------
    str
        Such as ``Film thickness $h_0$ (µm)``.

    Examples
    --------
    >>> import xarray as xr
    >>> from lube import plots
    >>> film = xr.DataArray(2.0, attrs={"units": "um", "long_name": "film thickness"})
    >>> plots.axis_label(film, "$h_0$")
    'Film thickness $h_0$ (µm)'
    """
    name = array.attrs["long_name"]
    units = array.attrs.get("units", "1")
    unit = None if units == "1" else f"({SYMBOLS.get(units, units)})"
    return " ".join(word for word in (name[0].upper() + name[1:], symbol, unit) if word)


def level_colours(levels: npt.ArrayLike) -> dict[float, np.ndarray]:
    """Colours for the levels of an ordered quantity, light to dark.

    Parameters
    ----------
    levels : array_like
        The levels, rising.

    Returns
    -------
    dict
        From level to colour, as red, green, blue and opacity.
    """
    values = np.asarray(levels).tolist()
    shades = plt.get_cmap("viridis_r")(np.linspace(0.15, 0.95, len(values)))
    return dict(zip(values, shades, strict=True))


def level_markers(levels: npt.ArrayLike) -> dict[float, str]:
    """Markers for the levels of a quantity, from level to marker."""
    return dict(zip(np.asarray(levels).tolist(), cycle(MARKERS), strict=False))


def level_name(value: float, units: str) -> str:
    """Level of an operating variable as text: ``86 r/min``, ``112.5 N``, ``40.5 °C``."""
    is_near_whole = abs(value - round(value)) <= 0.004 * abs(value)
    is_short = value != round(value) and float(f"{value:.4g}") == value
    digits = ".4g" if is_short else ".0f" if is_near_whole else ".3g"
    return f"{value:{digits}} {SYMBOLS.get(units, units)}"


def point_name(point: xr.Dataset | xr.DataArray, *variables: str) -> str:
    """Operating point as text: ``800 N, 100 r/min, 40 °C``.

    Parameters
    ----------
    point : xarray.Dataset or xarray.DataArray
        With scalar coordinates.
    *variables : str
        Coordinates to name; force, speed and temperature if none is given.

    Returns
    -------
    str
        The levels with their units.
    """
    names = variables or ("force", "speed", "temperature")
    return ", ".join(level_name(point[name].item(), COORDINATES[name].units) for name in names)


def other_names(points: xr.Dataset) -> list[str]:
    """Operating points as text: what differs besides force, speed and temperature.

    Parameters
    ----------
    points : xarray.Dataset
        With the dimension ``operating_point``.

    Returns
    -------
    list of str
        For each operating point its lubricant, film formula and slide-to-roll ratio, where these
        are not the same for all, such as ``n-dodecane``; empty where they are.
    """
    columns = [
        [f"{word}{_written(value)}" for value in points[name].values]
        for name, word in _OTHER_COORDINATES.items()
        if name in points.coords and np.unique(points[name]).size > 1
    ]
    rows = zip(*columns, strict=True) if columns else [()] * points.sizes["operating_point"]
    return [", ".join(words) for words in rows]


def _written(value):
    """Return a name, or a number without superfluous zeros."""
    return f"{value:g}" if isinstance(value, float) else value


def rig_name(dataset: xr.Dataset) -> str:
    """Rig that produced some records, as text: ``simulated rig, 1 pair of rollers``.

    Parameters
    ----------
    dataset : xarray.Dataset
        An ``experiment``, ``comparison`` or ``gauge`` dataset.

    Returns
    -------
    str
        Whether it is measured or simulated, its number of pairs of rollers, and the drift of their
        roughness if it is not zero.
    """
    pairs, drift = dataset["pairs"].item(), dataset["drift"].item()
    words = [f"{dataset['origin'].item()} rig", f"{pairs} pair{'s' * (pairs != 1)} of rollers"]
    words += [f"drift {drift:g} per revolution"] * (drift > 0.0)
    return ", ".join(words)


def record_name(record: xr.Dataset, pairs: int = 1) -> str:
    """Record as text: its name, and its conditions in a second line.

    Parameters
    ----------
    record : xarray.Dataset
        One record, with its conditions and the coordinate ``origin``.
    pairs : int, optional
        Number of pairs of rollers in the dataset; if there are several, the record's is named.

    Returns
    -------
    str
        Such as ``run1.nc (list.csv: line 2), pair A`` and ``1603 N, 100 r/min, 80 °C``; for a
        simulated record the conditions alone.
    """
    name = record["record"].item() if record["origin"].item() == "measured" else ""
    words = [name] * bool(name) + [f"pair {record['pair'].item()}"] * (pairs > 1)
    return "\n".join([", ".join(words)] * bool(words) + [point_name(record)])


def level_groups(
    records: xr.Dataset, name: str
) -> list[tuple[str, np.ndarray | str, str, xr.Dataset]]:
    """Group records by the study's level that they are at, with a style for each level.

    Parameters
    ----------
    records : xarray.Dataset
        With the dimension ``record``.
    name : str
        Operating variable, such as ``force``.

    Returns
    -------
    list of tuple
        For each level, rising, its name, colour, marker and records; at the end the records that
        are not at a level, if there are any.
    """
    near = records[f"{name}_level"].values
    levels = np.unique(near[np.isfinite(near)])
    colours, markers = level_colours(levels), level_markers(levels)
    units = COORDINATES[name].units
    groups = [
        (level_name(level, units), colour, markers[level], records.isel(record=near == level))
        for level, colour in colours.items()
    ]
    if np.isnan(near).any():
        other = records.isel(record=np.isnan(near))
        groups.append(("not at a level", COLOURS["black"], "X", other))
    return groups


def footnote(figure: Figure, *shown: xr.Dataset | xr.DataArray) -> None:
    """Write below a figure which lubricant, film formula, slip and contact model it shows.

    Parameters
    ----------
    figure : matplotlib.figure.Figure
        The figure, in constrained layout.
    *shown : xarray.Dataset or xarray.DataArray
        What the figure shows; all values of a coordinate are written.
    """
    parts = []
    for name, word in _OTHER_COORDINATES.items():
        values = [np.ravel(one[name]) for one in shown if name in one.coords]
        if values:
            different = np.unique(np.concatenate(values)).tolist()
            parts.append(word + ", ".join(map(_written, different)))
    # An empty line leaves room for the stamp.
    line = textwrap.fill(" · ".join(parts), _FOOTNOTE_LINE) + "\n"
    figure.supxlabel(line, x=0.99, ha="right", fontsize=6.5, color="#5F5F5F")


def plain_log_ticks(axis: Axis, numbers: Sequence[int] = (1, 2, 5)) -> None:
    """Label a logarithmic axis with plain numbers: 20, 50, 100 instead of powers of ten.

    Parameters
    ----------
    axis : matplotlib.axis.Axis
        The axis, on a logarithmic scale, with its final limits.
    numbers : sequence of int, optional
        Multiples of the powers of ten that get a label. On an axis too short for two of them,
        evenly spaced round numbers get one; on an axis of many powers, or one along which labels
        would overlap, the powers alone.
    """
    low, high = sorted(axis.get_view_interval())
    axis.set_major_locator(LogLocator(subs=numbers))
    shown = [tick for tick in axis.get_majorticklocs() if low <= tick <= high]
    panel, inches = axis.axes, _CHARACTER * sum(len(f"{tick:g} ") for tick in shown)
    width = panel.get_window_extent().width / panel.figure.dpi
    if len(shown) > _MOST_LABELS or (axis.axis_name == "x" and inches > width):
        axis.set_major_locator(LogLocator())
        shown = [tick for tick in axis.get_majorticklocs() if low <= tick <= high]
    if len(shown) < 2:
        axis.set_major_locator(MaxNLocator(5, steps=[1, 2, 5, 10]))
        axis.set_minor_locator(NullLocator())
    axis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
    axis.set_minor_formatter(NullFormatter())


def log_ticks(axis: Axis) -> None:
    """Label a logarithmic axis by powers of ten, or by plain numbers if it spans few of them.

    Parameters
    ----------
    axis : matplotlib.axis.Axis
        The axis, on a logarithmic scale, with its final limits.
    """
    low, high = sorted(axis.get_view_interval())
    if high < 100 * low:
        plain_log_ticks(axis)
    else:
        axis.set_minor_formatter(NullFormatter())


def legend_above(
    figure: Figure, panels: Iterable[Axes], title: str | None = None, **more: Artist
) -> None:
    """Write one legend above all panels, in as many columns as fit the figure.

    Parameters
    ----------
    figure : matplotlib.figure.Figure
        The figure, in constrained layout.
    panels : iterable of matplotlib.axes.Axes
        Panels whose labelled lines the legend explains; a label of several lines appears once.
        Without any label there is no legend.
    title : str, optional
        Title of the legend.
    **more : matplotlib.artist.Artist
        Further entries by their labels.
    """
    entries = {}
    for panel in panels:
        for handle, label in zip(*panel.get_legend_handles_labels(), strict=True):
            entries.setdefault(label, handle)
    entries |= more
    look = {"loc": "outside upper center", "title": title, "columnspacing": 1.4}
    for rows in range(1, len(entries) + 1):
        columns = -(-len(entries) // rows)
        legend = figure.legend(entries.values(), entries.keys(), ncols=columns, **look)
        if legend.get_window_extent().width < figure.bbox.width or rows == len(entries):
            return
        legend.remove()


def legend_over(panel: Axes, title: str | None = None) -> None:
    """Write the legend of one panel above it, beside its letter, where it covers nothing.

    Parameters
    ----------
    panel : matplotlib.axes.Axes
        The panel, in a figure in constrained layout.
    title : str, optional
        Title of the legend.
    """
    entries = len(panel.get_legend_handles_labels()[1])
    panel.legend(
        title=title,
        loc="lower right",
        bbox_to_anchor=(1.0, 1.0),
        ncols=entries if entries < 4 else -(-entries // 2),
        fontsize="small",
        title_fontsize="small",
        borderaxespad=0.2,
        columnspacing=0.9,
        handlelength=1.2,
        handletextpad=0.4,
    )


def panel_letters(axes: Iterable[Axes]) -> None:
    """Write (a), (b), ... in front of the titles of a figure's panels.

    Parameters
    ----------
    axes : iterable of matplotlib.axes.Axes
        The panels in reading order; rows of panels may be nested.
    """
    for letter, panel in zip("abcdefghijklmnop", np.ravel(list(axes)), strict=False):
        panel.set_title(f"({letter}) {panel.get_title(loc='left')}".strip(), loc="left")


def around(marker: str) -> dict[str, Any]:
    """Style of a black mark around points, such as those of `lube.grid.model_limits.doubts`."""
    size = {"D": 6, "*": 9}.get(marker, 7)
    look = {"mfc": "none", "mec": "black", "mew": 0.7, "ms": size}
    return {"linestyle": "none", "marker": marker, "gid": _AROUND} | look


def lone_points(y: np.ndarray) -> np.ndarray:
    """Keep the points of a curve that no line reaches, as no neighbour is known.

    Parameters
    ----------
    y : array_like
        One-dimensional.

    Returns
    -------
    numpy.ndarray
        The values, NaN where a neighbour is not NaN.

    Examples
    --------
    >>> lone_points([1.0, 2.0, np.nan, 3.0, np.nan]).tolist()
    [nan, nan, nan, 3.0, nan]
    """
    unknown = np.pad(np.isnan(y), 1, constant_values=True)
    return np.where(unknown[:-2] & unknown[2:], y, np.nan)


def interval_bars(
    axes: Axes, x: np.ndarray, mean: np.ndarray, lower: np.ndarray, upper: np.ndarray, **style
) -> None:
    """Draw probabilities with their intervals.

    On a logarithmic scale an estimate of zero has no point; an arrow hangs from its upper limit
    instead.

    Parameters
    ----------
    axes : matplotlib.axes.Axes
        Axes whose scale is already set.
    x, mean, lower, upper : numpy.ndarray
        One-dimensional, of equal length.
    **style
        ``color``, ``marker``, ``label`` and so on, as for `Axes.errorbar`.
    """
    seen = (mean > 0.0) | (axes.get_yscale() == "linear")
    bars = np.where(seen, [mean - lower, upper - mean], 0.0)
    axes.errorbar(x, np.where(seen, mean, np.nan), yerr=bars, capsize=2, elinewidth=1.0, **style)
    limited = ~seen & (np.asarray(upper) > 0.0)  # the upper limit may underflow to 0 as well
    at, limits = np.asarray(x)[limited], np.asarray(upper)[limited]
    arrows = {"uplims": True, "linestyle": "none", "capsize": 2.5, "elinewidth": 1.0}
    axes.errorbar(at, limits, yerr=0.5 * limits, color=style.get("color"), **arrows)


def probability_limits(*panels: Axes, least: float = 0.0) -> None:
    """Set the upper end of probability axes just above the largest value shown, at most 1.

    Points at either end are not clipped.

    Parameters
    ----------
    *panels : matplotlib.axes.Axes
        Panels with all their points, which get the same limits.
    least : float, optional
        The lower limit; on a logarithmic scale above 0.

    Examples
    --------
    >>> import matplotlib.pyplot as plt
    >>> from lube import plots
    >>> _, axes = plt.subplots()
    >>> _ = axes.plot([40, 60, 80], [0.0, 0.4, 0.98], "o")
    >>> plots.probability_limits(axes)
    >>> [float(end) for end in axes.get_ylim()]
    [0.0, 1.0]
    """
    highest = max([one.dataLim.ymax for one in panels if one.dataLim.ymax > 0.0], default=1.0)
    for panel in panels:
        room = 1.05 if panel.get_yscale() == "linear" else 1.5
        # Without autoscaling: on a logarithmic scale all values may be 0.
        panel.set(autoscaley_on=False, ylim=(least, min(room * highest, 1.0)))
        for line in [line for line in panel.lines if line.get_marker() not in NOT_POINTS]:
            below = (np.asarray(line.get_ydata(), float) < least).any()
            line.set(clip_on=bool(below), in_layout=False)


def mark_outside(*panels: Axes) -> None:
    """Mark at the panels' edges the points that lie beyond them.

    Each point gets a triangle of its colour, filled or hollow as its marker, at the nearest
    position on the edge, directed at the point. Marks around points, as by `around`, move to the
    edge with them. The edge cuts no marker of a line whose points all lie within.

    Parameters
    ----------
    *panels : matplotlib.axes.Axes
        Panels with all their points, drawn by `Axes.plot` or `Axes.errorbar` with a marker, and
        with final limits.

    Examples
    --------
    >>> import matplotlib.pyplot as plt
    >>> from lube import plots
    >>> _, axes = plt.subplots()
    >>> _ = axes.plot([1, 2, 3], [0.5, 7.0, 0.2], "o"), axes.set_ylim(0, 1)
    >>> plots.mark_outside(axes)
    >>> axes.lines[-1].get_xydata().tolist()
    [[2.0, 1.0]]
    """
    edge_mark = {"linestyle": "none", "clip_on": False, "gid": EDGE_MARK, "zorder": 4}
    for panel in panels:
        (left, right), (low, high) = panel.get_xbound(), panel.get_ybound()
        for line in [line for line in panel.lines if line.get_marker() not in NOT_POINTS]:
            x, y = np.asarray(line.get_data(), float)
            if line.get_gid() == _AROUND:
                line.set(data=(x.clip(left, right), y.clip(low, high)), clip_on=False)
                continue
            beyond = {
                CARETUP: y > high,
                CARETDOWN: y < low,
                CARETRIGHT: (x > right) & (low <= y) & (y <= high),
                CARETLEFT: (x < left) & (low <= y) & (y <= high),
            }
            outside = any(there.any() for there in beyond.values())
            line.set(clip_on=outside, in_layout=False)
            for marker, there in beyond.items():
                if there.any():
                    at = x[there].clip(left, right), y[there].clip(low, high)
                    face = line.get_markerfacecolor()
                    panel.plot(*at, marker=marker, color=line.get_color(), mfc=face, **edge_mark)


def save_figure(figure: Figure, stem: str | Path | None, *shown: xr.Dataset) -> None:
    """Stamp a figure with its origin; save it as PNG and PDF, the same bytes each time.

    In Jupyter the saved picture then appears below the cell.

    Parameters
    ----------
    figure : matplotlib.figure.Figure
        Figure to save; in constrained layout, as `use_style` sets it, the stamp gets a strip below
        everything else.
    stem : str or Path or None
        Path without suffix. With None, as in a notebook that is run by hand, nothing is written:
        Jupyter shows the figure itself below the cell.
    *shown : xarray.Dataset
        What the figure shows, as loaded, or selections of it.

    Raises
    ------
    DataError
        As from `lube.pipeline.stamps.stamp`, or if a file cannot be written.
    """
    # Imported here because only notebooks need it, and the plots of answers work without it.
    from IPython import get_ipython
    from IPython.display import Image, display

    line = stamp(shown)
    _write_below(figure, line)
    _fold_labels(figure)
    if stem is None:
        return
    # The layout is final, and computing it again takes as long as drawing the picture. The engine
    # "none" would leave a placeholder, with which Matplotlib draws every picture twice.
    with plt.rc_context({"figure.constrained_layout.use": False, "figure.autolayout": False}):
        figure.set_layout_engine(None)
        # Without clock time or software version, so that the bytes are the same each time.
        for suffix, metadata in {
            "png": {"Software": None, "Description": line},
            "pdf": {"CreationDate": None, "Producer": None, "Subject": line},
        }.items():
            with written_whole(f"{stem}.{suffix}") as part:
                figure.savefig(part, format=suffix, metadata=metadata)
    if get_ipython() is not None:
        plt.close(figure)  # or Jupyter would draw it once more
        display(Image(filename=f"{stem}.png", retina=True))


def _fold_labels(figure):
    """Break titles and axis labels that are longer than their panels into several lines."""
    # Folded labels leave the panels less room, so all are measured again. A label that is still too
    # long is folded anew from its own lines: folding its parts would leave single words.
    engine = figure.get_layout_engine()
    whole: dict[plt.Text, str] = {}
    for _ in range(3):
        if engine is not None:
            engine.execute(figure)
        long = [one for axes in figure.axes for one in _long_labels(axes)]
        for text, excess in long:
            label = whole.setdefault(text, text.get_text())
            text.set_text(_folded(label, max(map(len, text.get_text().splitlines())) / excess))
        if not long:
            return
    if engine is not None:
        engine.execute(figure)


def _long_labels(axes):
    """Title and labels of a panel that are longer than it, and by which factor."""
    panel = axes.get_window_extent()
    title = axes.set_title(axes.get_title(loc="left"), loc="left")
    for text, side in ((title, "width"), (axes.xaxis.label, "width"), (axes.yaxis.label, "height")):
        excess = getattr(text.get_window_extent(), side) / getattr(panel, side)
        if excess > 1.0:
            yield text, excess


def _folded(label, width):
    """Fold a label into lines of as many characters; numbers keep their units."""
    lines = _SPACE_BEFORE_UNIT.sub("\N{NO-BREAK SPACE}", label).splitlines()
    # One character less, because not all are equally wide.
    width = max(int(width) - 1, 1)
    folded = "\n".join(textwrap.fill(line, width) for line in lines)
    return folded.replace("\N{NO-BREAK SPACE}", " ")


def _write_below(figure, line):
    """Write a small line into a strip below a figure."""
    strip = _STAMP_STRIP / figure.get_figheight()
    free = not figure.get_supxlabel()  # a footnote would leave room for the line
    if free and isinstance(figure.get_layout_engine(), ConstrainedLayoutEngine):
        figure.get_layout_engine().set(rect=(0.0, strip, 1.0, 1.0 - strip))
    figure.text(0.006, 0.25 * strip, line, fontsize=5, color="#8A8A8A", va="bottom")
