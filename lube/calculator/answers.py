"""Answers of the calculator: labelled datasets in customary units, with tables and plots."""

import html
import shutil
from pathlib import Path

import numpy as np
import pandas as pd
import xarray as xr

from lube.physics.indicators import LOAD_SHARES, RESISTANCE_FORMULAS
from lube.schema import COORDINATES, FILES, LIMITS, REGIMES

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
        """Show every value of the first and last points with its unit, and the remarks."""
        if self._is_empty:
            return super().__repr__()
        sizes = ", ".join(f"{name} {size}" for name, size in self.sizes.items())
        lines = [f"<Answer: {sizes}>" if sizes else "<Answer>"]
        width = shutil.get_terminal_size().columns
        lines += [one.to_string(header=False, line_width=width) for one in self._in_words()]
        return "\n".join([*lines, self.attrs.get("remarks", "")]).rstrip()

    def _repr_html_(self) -> str:
        """Show the same in a notebook, above the dataset."""
        if self._is_empty:
            return super()._repr_html_()
        lines = [one.to_html(header=False) for one in self._in_words()]
        lines += [
            f"<p>{html.escape(line)}</p>" for line in self.attrs.get("remarks", "").split("\n")
        ]
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
        return self._rows().rename(columns=self._header)

    def _rows(self):
        """Make the table, with names without units."""
        whole = [name for name in self if name.startswith("whole_")]
        rows = self.drop_vars(whole).drop_dims("realisation", errors="ignore")
        frame = (rows if rows.sizes else rows.reset_coords().expand_dims("point")).to_dataframe()
        return frame.reset_index(drop=not rows.sizes)

    @property
    def _is_empty(self):
        return not self.variables or 0 in self.sizes.values()

    def _in_words(self):
        """Make texts of the points, and of a whole duty cycle if it is one, a row a variable."""
        rows = self._rows()
        has_more = len(rows) > 2 * _SHOWN
        if has_more:
            rows = pd.concat([rows.head(_SHOWN), rows.tail(_SHOWN)])
        points = self._with_limits(rows)
        if has_more:
            points.insert(_SHOWN, "more", "...")
        whole = {name: [self[name].item()] for name in self if name.startswith("whole_")}
        return [points, self._with_limits(pd.DataFrame(whole))] if whole else [points]

    def _with_limits(self, frame):
        """Make texts of values, with their limits in brackets; names get their units."""
        digits = frame.map(_digits)
        limits = {name: [name.removesuffix("_mean") + end for end in LIMITS[1:]] for name in frame}
        limits = {name: ends for name, ends in limits.items() if set(ends) <= set(frame)}
        for name, (lower, upper) in limits.items():
            digits[name] += " (" + digits[lower] + " to " + digits[upper] + ")"
        digits = digits.drop(columns=[one for ends in limits.values() for one in ends])
        return digits.rename(columns=self._header).T

    def _header(self, name):
        units = self[name].attrs.get("units", "")
        return name if units in ("", "1") else f"{name} [{units}]"


def _digits(value):
    """Four digits of a number, or any other value as it is."""
    return f"{value:.4g}" if isinstance(value, float) else str(value)


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
