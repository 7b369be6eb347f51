"""Answers of the calculator: labelled datasets in customary units, with tables and plots."""

import html
import math
import shutil
from pathlib import Path

import numpy as np
import pandas as pd
import xarray as xr

from lube.physics.indicators import LOAD_SHARES, RESISTANCE_FORMULAS
from lube.schema import COORDINATES, FILES, LIMITS, POINT_DIMS, REGIMES

_CUSTOMARY = {
    "m": ("um", 1e6),
    "Pa": ("MPa", 1e-6),
    "Pa s": ("mPa s", 1e3),
    "m2 s-1": ("mm2 s-1", 1e6),
    "Pa-1": ("GPa-1", 1e9),
    "s": ("ms", 1e3),
    "s-1": ("h-1", 3600.0),
    **dict.fromkeys(("radius", "second_radius", "reduced_radius"), ("mm", 1e3)),
    "reduced_modulus": ("GPa", 1e-9),
}
"""By SI unit, or by variable: the customary unit, and how many of it are one SI unit."""
_SHOWN = 3
"""Points at the beginning and at the end of an answer that are shown."""
_TAIL, _ASSUMED = "by importance sampling", "5 to 95 % over what is not known exactly"
_OF_NO_FILE = pd.read_csv(Path(__file__).with_name("names.csv"))
"""Name, long name and SI unit of the variables that no file has."""


def variable_of(name: str, formula: str) -> str:
    """Name of the variable that holds another one by a published formula."""
    return f"{name}_{formula.replace('-', '_')}"


_KINDS = ("surface_trace", "film_profile", "lubricant", "trace", "film", "contact", "indicators")
_ROWS = (COORDINATES, *(FILES[kind] for kind in _KINDS))
_WORDS = {name: (row.long_name, row.units) for rows in _ROWS for name, row in rows.items()}
_WORDS |= {name: words for name, *words in _OF_NO_FILE.itertuples(index=False)}
# Variables of `tail.nc` get a prefix: some have the same names as variables of `contact.nc`.
_WORDS |= {
    f"tail_{name}": (f"{row.long_name}, {_TAIL}", row.units) for name, row in FILES["tail"].items()
}

_WORDS |= {
    f"surface_{name}": (f"{row.long_name}, on the surface", row.units)
    for kind in ("contact", "tail", "areal")
    for name, row in FILES[kind].items()
}
_FORMULAS = {
    "asperity_load_share": LOAD_SHARES,
    "rolling_resistance": ("computed", *RESISTANCE_FORMULAS),
}
"""Variables of `indicators.nc` that an answer has once for each formula."""

_WORDS |= {
    variable_of(name, one): (f"{_WORDS[name][0]}, {one}", _WORDS[name][1])
    for name, formulas in _FORMULAS.items()
    for one in formulas
}

_WORDS |= {
    f"assumed_{name}": (f"{words}, {_ASSUMED}", si)
    for name, (words, si) in _WORDS.items()
    if f"assumed_{name}" not in _WORDS and not name.endswith(LIMITS[1:])
}


class _Plots(xr.Dataset.plot):
    """Plots of xarray, such as ``plot.scatter``; a call of the object itself draws the answer."""

    __slots__ = ()

    def __call__(self, x=None, y=None):
        # Matplotlib is slow to import.
        from lube.calculator.drawing import draw

        return draw(self._ds, x, y)


class Answer(xr.Dataset):
    """An answer: a dataset of xarray that is also a table and a plot.

    Selections, copies and pickles of it are answers, too. A saved answer is loaded as a plain
    dataset; ``Answer(dataset.data_vars, dataset.coords, dataset.attrs)`` makes it an answer again.

    Examples
    --------
    >>> answer = Answer({"film_thickness": ("force", [1.0, 0.9], {"units": "um"})})
    >>> answer.isel(force=[0]).table()
       force  film_thickness [um]
    0      0                  1.0
    """

    __slots__ = ()

    def __repr__(self) -> str:
        """Show the values of the first and last points with their units, and the remarks."""
        if not (tables := self._in_words()):
            return super().__repr__()
        sizes = ", ".join(f"{name} {size}" for name, size in self.sizes.items())
        lines = [f"<Answer: {sizes}>" if sizes else "<Answer>"]
        width = shutil.get_terminal_size().columns
        lines += [one.to_string(header=False, line_width=width) for one in tables]
        return "\n".join([*lines, self.attrs.get("remarks", "")]).rstrip()

    def _repr_html_(self) -> str:
        """Show the same in a notebook, above the dataset."""
        lines = [one.to_html(header=False) for one in self._in_words()]
        remarks = self.attrs.get("remarks", "").splitlines()
        lines += [f"<p>{html.escape(line)}</p>" for line in remarks]
        return "\n".join([*lines, super()._repr_html_()])

    @property
    def plot(self) -> _Plots:
        """Draw the answer: ``plot()``, or ``plot(x=..., y=...)``.

        Counted probabilities have their 95 % intervals, and sampled ones are a curve. They are
        drawn over ``x``: force, speed or temperature, by default the one with most values. A duty
        cycle is drawn along its points, named by its first column of labels, and a profile across
        the contact. For other answers the film is drawn, or the variable ``y``.

        The result is the axes of Matplotlib. The plots of xarray, such as ``plot.scatter``, work
        as well.
        """
        return _Plots(self)

    def table(self) -> pd.DataFrame:
        """Make a plain table with one row for each point.

        Returns
        -------
        pandas.DataFrame
            Columns are named with their units, such as ``force [N]``. The single realisations and
            the values of a whole duty cycle are left out.
        """
        return _frame(self._points()).rename(columns=self._header)

    def _points(self):
        """Values of the points, without single realisations and values of a whole duty cycle."""
        return self.drop_vars(self._whole()).drop_dims("realisation", errors="ignore")

    def _whole(self):
        """Names of the values of a whole duty cycle."""
        return [name for name in self if str(name).startswith("whole_")]

    def _in_words(self):
        """Make texts of the points, and of a whole duty cycle if it is one, a row a variable."""
        parts = self._points(), self[self._whole()].reset_coords(drop=True)
        return [self._texts(one) for one in parts if one.data_vars and 0 not in one.sizes.values()]

    def _texts(self, points):
        """Make texts of values, with their limits in brackets; names get their units."""
        ends = [*range(_SHOWN), *range(-_SHOWN, 0)]
        is_long = math.prod(points.sizes.values()) > len(ends)
        if is_long and len(points.sizes) == 1:
            frame = _frame(points.isel(dict.fromkeys(points.sizes, ends)))
        else:
            frame = _frame(points).iloc[ends if is_long else slice(None)]
        frame = frame.apply(self._digits)
        limits = {
            name: [f"{name}".removesuffix("_mean") + end for end in LIMITS[1:]]
            for name in frame
            if f"{name}_mean" not in frame
        }
        limits = {name: each for name, each in limits.items() if set(each) <= set(frame)}
        for name, (lower, upper) in limits.items():
            frame[name] += " (" + frame[lower] + " to " + frame[upper] + ")"
        frame = frame.drop(columns=[one for each in limits.values() for one in each])
        texts = frame.rename(columns=self._header).T
        if is_long:
            texts.insert(_SHOWN, "more", "...")
        return texts

    def _digits(self, column):
        """Texts of a column: four digits, more of operating conditions, which are often given."""
        is_given = column.name in self.coords or column.name in POINT_DIMS
        form = "{:.10g}" if is_given else "{:.4g}"
        is_number = pd.api.types.is_float_dtype(column)
        return column.map(form.format if is_number else str)

    def _header(self, name):
        units = self[name].attrs.get("units", "")
        return name if units in ("", "1") else f"{name} [{units}]"


def _frame(points):
    """Table with a row for each point."""
    frame = (points if points.sizes else points.expand_dims("point")).to_dataframe()
    return frame.reset_index(drop=not points.sizes)


def described(results: xr.Dataset) -> Answer:
    """Convert results to customary units, and label them.

    Parameters
    ----------
    results : xarray.Dataset
        Variables of the ``lubricant``, ``film``, ``contact`` or ``trace`` file, in SI units.

    Returns
    -------
    Answer
        Films and lengths in um, pressures in MPa; each variable with ``units`` and
        ``long_name``, the regime in words.

    Examples
    --------
    >>> described(xr.Dataset({"film_thickness": 1.07e-6})).film_thickness.attrs["units"]
    'um'
    """
    found = Answer(results.data_vars, results.coords, results.attrs)
    for name in results.variables:
        # A limit without a row in the tables takes the labels of its variable.
        known = name if name in _WORDS else name.removesuffix("_lower").removesuffix("_upper")
        if known not in _WORDS:
            continue
        (long_name, si), values = _WORDS[known], results[name].values
        units, factor = _CUSTOMARY.get(known, _CUSTOMARY.get(si, (si, None)))
        if factor is not None:
            values = factor * values
        elif name == "regime":
            values = np.array(REGIMES)[values]
        labels = {"long_name": long_name, "units": units or ""}
        found[name] = xr.Variable(results[name].dims, values, labels)
    return found
