"""The contact model at some operating points, ready to run on any pair of lines.

The film is flat and ends at the edges of the contact, or has the shape of the computed one. The
lines are as drawn, or the oil flattens their long waves.
"""

import numpy as np
import scipy.fft
import xarray as xr

from lube.grid.discretise import Layer, layer_factor_of, whole_numbers
from lube.grid.window_films import window_films
from lube.kernels.shaped import shaped_statistics, shaped_trace
from lube.kernels.strips import strip_statistics, strip_trace
from lube.physics.flattening import amplitude_ratio
from lube.types import Array, Pair, Ratios

WINDOWS_PER_WIDTH = 10
"""Windows per width of the contact, under a film that is not flat. More hardly reduce the scatter
between realisations, since neighbouring windows see nearly the same."""


class ContactRuns:
    """Operating points at which pairs of lines meet.

    Parameters
    ----------
    lines : xarray.Dataset
        A ``roughness`` or ``roughness_batch`` dataset, for its attributes.
    film : xarray.Dataset
        With ``film_thickness`` and ``contact_half_width``, m, over any dimensions, and
        ``reduced_modulus``, Pa. With ``film_profile`` the film has the computed shape, else it is
        flat and ends at the edges of the contact.
    boundary_layer : Layer
        The boundary layer.
    flattened : bool, optional
        Whether the oil flattens the lines; `film` then has ``moes_load`` and ``moes_material``.

    Attributes
    ----------
    unknown : numpy.ndarray of bool
        Where the film is not known, in the order of ``film_thickness``.
    """

    def __init__(
        self, lines: xr.Dataset, film: xr.Dataset, boundary_layer: Layer, flattened: bool = False
    ) -> None:
        names = ["film_thickness", "contact_half_width"]
        names += ["moes_load", "moes_material"] if flattened else []
        spread = xr.broadcast(*(film[name] for name in names))
        thickness, half_width, *moes = (each.values.ravel() for each in spread)
        self._films, self._half_windows = whole_numbers(thickness, half_width, lines)
        self._shapes = window_films(film, lines)[0] if "film_profile" in film else None
        self.unknown = np.isnan(thickness)
        if self._shapes is not None:
            self.unknown |= [shape is None for shape in self._shapes]
        self._contacts = np.stack([half_width, *moes], axis=1) if flattened else None
        self._lines = lines
        self._factor = layer_factor_of(lines, film["reduced_modulus"].item(), boundary_layer)

    def statistics(
        self, pair: Pair, ratios: Ratios, steps: int, points: Array | None = None
    ) -> Array:
        """Means over the time steps.

        Parameters
        ----------
        pair : tuple of numpy.ndarray
            Two lines, int32 height steps.
        ratios : tuple of float
            From `lube.grid.discretise.speed_ratios`.
        steps : int
            Number of time steps. Under a film that is not flat only some of them are looked at.
        points : numpy.ndarray of int, optional
            Operating points, in the order of ``film_thickness`` over its dimensions and then those
            of the half-width alone; by default all.

        Returns
        -------
        numpy.ndarray
            Shape (points, 4): share with contact, share with a broken boundary layer, broken
            points, and overlap (height steps); NaN where the film is not known.
        """
        points = np.arange(self._films.size) if points is None else points
        run = self._under_flat_films if self._shapes is None else self._under_shaped_films
        counts = np.empty((points.size, 4))
        flat_and_drawn = self._shapes is None and self._contacts is None
        if not flat_and_drawn and ratios[0] == ratios[1] and pair[0].size == pair[1].size:
            pair = pair[0] + pair[1], np.zeros(1, np.int32)  # one line passes the contact
        for lines, here in self._in_contact(pair, points):
            counts[here] = run(lines, ratios, steps, points[here])
        counts[self.unknown[points]] = np.nan
        return counts

    def trace(self, pair: Pair, ratios: Ratios, steps: int) -> Array:
        """Count the points with a broken boundary layer at every time step.

        Parameters
        ----------
        pair, ratios, steps
            As in `statistics`; every time step is looked at.

        Returns
        -------
        numpy.ndarray
            Shape (operating points, steps), int32; 0 where the film is not known.
        """
        points = np.arange(self._films.size)
        broken = np.zeros((points.size, steps), np.int32)
        for lines, here in self._in_contact(pair, points):
            if self._shapes is None:
                films = self._films[here], self._half_windows[here]
                broken[here] = strip_trace(lines, ratios, steps, *films, self._factor)
                continue
            for point in here[~self.unknown[here]]:
                film = self._shapes[point].below(_highest(lines))
                motion = lines, ratios, steps, steps
                broken[point] = shaped_trace(*motion, film.film, film.before, self._factor)[:, 1]
        return broken

    def _in_contact(self, pair, points):
        """Pairs of lines as they are in the contact, each with the places of its points."""
        if self._contacts is None:
            yield pair, np.arange(points.size)
            return
        waves = [Waves(line, self._lines) for line in pair]
        contacts, inverse = np.unique(self._contacts[points], axis=0, return_inverse=True)
        for number, contact in enumerate(contacts):
            lines = tuple(one.flattened(*contact) for one in waves)
            yield lines, np.flatnonzero(inverse.ravel() == number)

    def _under_flat_films(self, lines, ratios, steps, points):
        films = np.stack([self._films[points], self._half_windows[points]])
        (films, half_windows), inverse = np.unique(films, axis=1, return_inverse=True)
        if lines[1].size == 1:
            lines = lines[0], np.zeros_like(lines[0])  # read faster than point after point
        counts = strip_statistics(lines, ratios, steps, films, half_windows, self._factor)
        return (counts / steps)[inverse.ravel()]

    def _under_shaped_films(self, lines, ratios, steps, points):
        known = ~self.unknown[points]
        reached = [self._shapes[point].below(_highest(lines)) for point in points[known]]
        strides = np.maximum(1, (2 * self._half_windows[points[known]] + 1) // WINDOWS_PER_WIDTH)
        begin = np.cumsum([0, *(one.film.size for one in reached)])
        joined = np.concatenate([np.zeros(0, np.int64), *(one.film for one in reached)])
        centres = np.array([one.before for one in reached], np.int64)
        counts = np.full((points.size, 4), np.nan)
        counts[known] = shaped_statistics(
            lines, ratios, steps, -(-steps // strides), (joined, begin, centres), self._factor
        )
        return counts


def _highest(lines):
    return lines[0].max() + lines[1].max()


class Waves:
    """Waves of a line, each of which the oil can flatten.

    Parameters
    ----------
    line : numpy.ndarray
        Heights, shape (N,), height steps.
    lines : xarray.Dataset
        The ``roughness`` or ``roughness_batch`` dataset of the line, for its attributes. Waves
        shorter than those of its band, of the rounding to whole height steps, are left out.
    """

    def __init__(self, line: Array, lines: xr.Dataset) -> None:
        step = 2.0 * np.pi / (line.size * lines.attrs["spacing"])
        last = int(np.max(lines.attrs["q_max"]) / step * (1.0 + 1e-9))
        self._size = line.size
        self._waves = scipy.fft.rfft(line.astype(float))[1 : last + 1]
        self._wavelength = 2.0 * np.pi / (step * np.arange(1, last + 1))

    def flattened(self, half_width: float, moes_load: float, moes_material: float) -> Array:
        """Heights of the flattened line.

        Parameters
        ----------
        half_width : float
            Half-width of the contact, m.
        moes_load, moes_material : float
            M and L.

        Returns
        -------
        numpy.ndarray
            Shape (N,), int32 height steps.
        """
        kept = amplitude_ratio(self._wavelength / half_width, moes_load, moes_material)
        spectrum = np.zeros(self._size // 2 + 1, complex)
        spectrum[1 : kept.size + 1] = self._waves * kept
        line = scipy.fft.irfft(spectrum, self._size, overwrite_x=True)
        return np.rint(line).astype(np.int32)
