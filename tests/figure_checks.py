"""What a reader would complain about in a figure: colliding text, covered or missing points.

A figure is checked as it is saved: drawn once more after its layout is final.
"""

import itertools
import os
from contextlib import contextmanager
from unittest.mock import patch

import matplotlib
import matplotlib.pyplot as plt
import numpy as np
from matplotlib.backends.backend_agg import FigureCanvasAgg, RendererAgg
from matplotlib.collections import LineCollection, PathCollection, PolyCollection
from matplotlib.legend import Legend
from matplotlib.patches import Rectangle
from matplotlib.path import Path
from matplotlib.transforms import Affine2D, Bbox

from lube.pipeline.cells import cells_of, datasets_of
from lube.pipeline.stamps import DRAWN_BY
from lube.plots import EDGE_MARK, NOT_POINTS

MARGIN = 1.0
"""Pixels by which boxes may overlap or stick out: the rounding of glyphs."""


def draw(notebook, paths, stem=None):
    """Run the cells of a figure's notebook on datasets, and return the figure it leaves open.

    Parameters
    ----------
    notebook : Path
        The notebook.
    paths : dict
        From the kind of each dataset to its path.
    stem : Path, optional
        Path without suffix at which the notebook saves the figure.
    """
    plt.close("all")
    names = {}
    given = {parameter: str(paths[kind]) for parameter, kind in datasets_of(notebook).items()}
    given["figure"] = stem
    with matplotlib.rc_context():
        matplotlib.rcdefaults()
        matplotlib.use("Agg")
        for cell in cells_of(notebook):
            if cell["type"] == "code":
                # As when the workflow draws: the notebook does not look for results by itself.
                with patch.dict(os.environ, {DRAWN_BY: "figure_checks"}):
                    exec(compile(cell["source"], str(notebook), "exec"), names)
            if "parameters" in cell["tags"]:
                names |= given
        (number,) = plt.get_fignums()
        figure = plt.figure(number)
        FigureCanvasAgg(figure).draw()
    return figure


def faults(figure):
    """List all faults of a figure, a line each."""
    canvas = FigureCanvasAgg(figure)
    canvas.draw()
    with _recorded_text() as texts:
        canvas.draw()
    return [
        *_colliding(texts),
        *_clipped(texts, figure.bbox),
        *(fault for axes in figure.axes for fault in _long_labels(axes)),
        *_covering_legends(figure),
        *(fault for axes in figure.axes for fault in _covering_words(axes)),
        *(fault for axes in figure.axes for fault in _points_outside(axes)),
        *(fault for axes in figure.axes for fault in _cut_points(axes)),
        *_unlettered(figure),
    ]


# Text


@contextmanager
def _recorded_text():
    """Record each line of text that is drawn, with its box in pixels."""
    texts, original = [], RendererAgg.draw_text

    def draw_text(self, gc, x, y, s, prop, angle, ismath=False, mtext=None):
        if s.strip():
            width, height, descent = self.get_text_width_height_descent(s, prop, ismath)
            box = Bbox.from_bounds(0, -descent, width, height)
            place = Affine2D().rotate_deg(angle).translate(x, self.height - y)
            texts.append((s, box.transformed(place)))
        original(self, gc, x, y, s, prop, angle, ismath, mtext)

    RendererAgg.draw_text = draw_text
    try:
        yield texts
    finally:
        RendererAgg.draw_text = original


def _overlap(one, other):
    """Whether two boxes share more than a margin in both directions."""
    return (
        min(one.x1, other.x1) - max(one.x0, other.x0) > MARGIN
        and min(one.y1, other.y1) - max(one.y0, other.y0) > MARGIN
    )


def _colliding(texts):
    for (one, its_box), (other, other_box) in itertools.combinations(texts, 2):
        if _overlap(its_box, other_box):
            yield f"text {one!r} overlaps {other!r}"


def _clipped(texts, edge):
    for text, box in texts:
        beyond = max(edge.x0 - box.x0, box.x1 - edge.x1, edge.y0 - box.y0, box.y1 - edge.y1)
        if beyond > MARGIN:
            yield f"text {text!r} is cut by the figure's edge"


def _long_labels(axes):
    """Titles wider than their panel, and axis labels longer than their axis."""
    panel = axes.get_window_extent()
    titles = [axes.title, axes._left_title, axes._right_title]
    across = [(text, panel.width) for text in (*titles, axes.xaxis.label)]
    for text, most in (*across, (axes.yaxis.label, panel.height)):
        box = text.get_window_extent()
        long = box.height if text is axes.yaxis.label else box.width
        if axes.get_visible() and text.get_text().strip() and long > most + MARGIN:
            yield f"label {text.get_text()!r} is longer than its panel ({long / most:.2f} times)"


# Legends


def _covering_legends(figure):
    for legend in figure.findobj(Legend):
        words = [text.get_text() for text in legend.get_texts()]
        if not any(word.strip() for word in words):
            yield "a legend is empty"
        for axes in figure.axes:
            box = Bbox.intersection(legend.get_window_extent(), axes.get_window_extent())
            # Within the legend's own margin nothing is hidden.
            pad = legend.borderpad * legend._fontsize * figure.dpi / 72.0
            if box is None or min(box.width, box.height) <= 2 * pad:
                continue
            if any(path.intersects_bbox(box.padded(-pad), filled) for path, filled in _data(axes)):
                yield f"the legend {words} covers data"


def _data(axes):
    """Everything that an axes shows of its data, as paths in pixels, and whether they are filled:
    lines, points, error bars, bands and bars."""
    for line in axes.lines:
        if not line.get_visible() or not _in_data_coordinates(line, axes):
            continue
        points = line.get_transform().transform(np.column_stack(line.get_data()).astype(float))
        if line.get_linestyle() not in NOT_POINTS:
            # Pieces of whole numbers: a gap in a line must not be bridged.
            for piece in _pieces(points):
                yield Path(piece), False
        if _has_markers(line):
            yield from _dots(points, line.get_markersize() * axes.figure.dpi / 72.0)
    for collection in axes.collections:
        if not collection.get_visible() or not _in_data_coordinates(collection, axes):
            continue
        if isinstance(collection, PathCollection):
            yield from _dots(_places(collection), 4.0)
        elif isinstance(collection, LineCollection | PolyCollection):
            transform = collection.get_transform()
            for path in collection.get_paths():
                yield path.transformed(transform), isinstance(collection, PolyCollection)
    for shape in axes.patches:
        if isinstance(shape, Rectangle) and shape.get_visible():
            yield shape.get_path().transformed(shape.get_transform()), True


def _in_data_coordinates(artist, axes):
    """Whether both its coordinates are data: an `axhline` is not."""
    if isinstance(artist, PathCollection):
        return artist.get_offset_transform().contains_branch(axes.transData)
    return all(artist.get_transform().contains_branch_seperately(axes.transData))


def _has_markers(line):
    return line.get_marker() not in NOT_POINTS and line.get_gid() != EDGE_MARK


def _pieces(points):
    finite = np.isfinite(points).all(axis=1)
    ends = np.flatnonzero(np.diff(finite)) + 1
    for piece, known in zip(np.split(points, ends), np.split(finite, ends), strict=True):
        if piece.size and known.all():
            yield piece


def _dots(points, size):
    for x, y in points[np.isfinite(points).all(axis=1)]:
        yield Path.circle((x, y), size / 2), True


# Points


def _places(collection):
    offsets = np.ma.filled(collection.get_offsets().astype(float), np.nan)
    return collection.get_offset_transform().transform(offsets)


def _points_of(axes):
    """Places in pixels of all points drawn with a marker."""
    found = [np.empty((0, 2))]
    for line in axes.lines:
        if line.get_visible() and _has_markers(line) and _in_data_coordinates(line, axes):
            values = np.column_stack(line.get_data()).astype(float)
            found.append(line.get_transform().transform(values))
    for collection in axes.collections:
        if isinstance(collection, PathCollection) and _in_data_coordinates(collection, axes):
            found.append(_places(collection))
    places = np.concatenate(found)
    return places[np.isfinite(places).all(axis=1)]


def _name(axes):
    return axes.get_title(loc="left") or axes.get_ylabel()


def _points_outside(axes):
    """Points that lie outside the panel and have no mark at its edge."""
    panel = axes.get_window_extent()
    marks = [line.get_xydata() for line in axes.lines if line.get_gid() == EDGE_MARK]
    marks = [axes.transData.transform(places) for places in marks]
    missing = 0
    for place in _points_of(axes):
        nearest = np.clip(place, panel.min, panel.max)
        marked = any((np.abs(places - nearest).max(axis=1) < MARGIN).any() for places in marks)
        missing += np.abs(nearest - place).max() > MARGIN and not marked
    if missing:
        yield f"{missing} points lie outside panel {_name(axes)!r}, without a mark at its edge"


def _cut_points(axes):
    """Points so near an edge of the panel that it cuts their markers nearly in half.

    A line with other points beyond the panel has to be cut.
    """
    panel, cut = axes.get_window_extent(), 0
    for line in axes.lines:
        if line.get_visible() and _has_markers(line) and line.get_clip_on():
            places = line.get_transform().transform(np.column_stack(line.get_data()).astype(float))
            room = np.minimum(places - panel.min, panel.max - places).min(axis=1)
            quarter = line.get_markersize() / 4.0 * axes.figure.dpi / 72.0
            if not (room < -MARGIN).any():
                cut += np.count_nonzero(room < quarter)
    if cut:
        yield f"{cut} points are cut by the edge of panel {_name(axes)!r}"


def _covering_words(axes):
    """Words within the panel that lie on points."""
    places = _points_of(axes)
    for text in axes.texts:
        box = text.get_window_extent()
        if text.get_text().strip() and text.get_visible() and box.count_contains(places):
            yield f"text {text.get_text()!r} covers points"


# Panels


def _unlettered(figure):
    panels = [one for one in figure.axes if one.get_visible() and one.get_label() != "<colorbar>"]
    for panel in panels:
        title = panel.get_title(loc="left")
        if len(panels) > 1 and not (title.startswith("(") and title[2:3] == ")"):
            yield f"panel {title or panel.get_ylabel()!r} has no letter"
        if panel.axison and not (panel.has_data() or panel.texts):
            yield f"panel {title!r} is empty"
