"""What the answers are: labelled datasets, which are also tables and plots."""

import pandas as pd
import xarray as xr


class _Plots(xr.Dataset.plot):
    """The plots of xarray, such as ``plot.scatter``, and the one of an answer."""

    __slots__ = ()

    def __call__(self, x=None, y=None):
        # Matplotlib is slow to import.
        from lube.calculator.drawing import draw

        return draw(self._ds, x, y)


class Answer(xr.Dataset):
    """An answer: a dataset of xarray that is also a table and a plot.

    Selections, copies and pickles of it are answers, too. A file gives a plain dataset back, which
    ``Answer(dataset.data_vars, dataset.coords, dataset.attrs)`` makes an answer again.

    Examples
    --------
    >>> answer = Answer({"film_thickness": ("force", [1.0, 0.9], {"units": "um"})})
    >>> answer.isel(force=[0]).table()
       force  film_thickness [um]
    0      0                  1.0
    """

    __slots__ = ()

    @property
    def plot(self) -> _Plots:
        """Draw the answer: ``plot()``, or ``plot(x=..., y=...)``.

        Probabilities come with their 95 % intervals and, as a curve, by importance sampling. They
        are over ``x``: force, speed or temperature, by default the one with most values. A duty
        cycle is drawn along its points, with its first column of labels; a profile across the
        contact; other answers by their film, or by the variable ``y``.

        The result is the axes of Matplotlib. The plots of xarray are there as well, such as
        ``plot.scatter``.
        """
        return _Plots(self)

    def table(self) -> pd.DataFrame:
        """Make a plain table with one row for each point.

        Returns
        -------
        pandas.DataFrame
            Columns are named with their units, such as ``force [N]``. The single realisations, and
            the values of a whole duty cycle, are left out.
        """
        left = [
            name
            for name, variable in self.variables.items()
            if "realisation" in variable.dims or name.startswith("whole_")
        ]
        rows = self.drop_vars(left)
        frame = (rows if rows.sizes else rows.expand_dims("point")).to_dataframe()
        frame = frame.reset_index(drop=not rows.sizes)
        return frame.rename(columns={name: self._header(name) for name in frame.columns})

    def _header(self, name):
        units = self[name].attrs.get("units", "")
        return name if units in ("", "1") else f"{name} [{units}]"
