"""Contact windows: what meets at some operating points, and how often it touches.

The film of a window is flat and ends at the edges of the contact, or has the shape of the computed
one. The lines reach the gap as drawn, or the oil flattens their long waves.
"""

import copy

import numpy as np
import scipy.fft
import xarray as xr

from lube.contact.window_films import window_films
from lube.grid.discretise import (
    Layer,
    LineGrid,
    layer_factor_of,
    revolution,
    speed_ratios,
    whole_numbers,
)
from lube.grid.gap import PLAIN, Gap
from lube.kernels.motion import surface_position
from lube.kernels.shaped import shaped_statistics, shaped_trace
from lube.kernels.strips import strip_statistics, strip_trace
from lube.kernels.whole_runs import whole_run_steps
from lube.physics.flattening import amplitude_ratio
from lube.surfaces.rare_contact import rare_contact, rare_contact_under
from lube.surfaces.synthetic import LineSpecLike
from lube.types import Array, Pair, Values

WINDOWS_PER_WIDTH = 10
"""Windows per width of the contact, under a film that is not flat. More hardly reduce the scatter
between realisations, since neighbouring windows see nearly the same."""


class ContactWindows:
    """Contact windows of some operating points, on which contact is counted or sampled.

    An index, such as ``windows[known]``, selects some of the operating points.

    Parameters
    ----------
    grid : LineGrid
        Grid of the lines.
    film : xarray.Dataset
        With ``film_thickness`` and ``contact_half_width``, m, over any dimensions, and
        ``reduced_modulus``, Pa. With ``film_profile`` the film has the computed shape, else it is
        flat and ends at the edges of the contact.
    boundary_layer : Layer
        The boundary layer.
    gap : Gap, optional
        How film and roughness make up the gap; by default flat films, and lines as drawn.
    weaker : float or numpy.ndarray, optional
        How many times weaker than `boundary_layer` the layer is, at all points or at each.

    Attributes
    ----------
    shape : tuple of int
        Lengths of the dimensions of ``film_thickness`` and of those that the half-width has alone;
        the operating points are in their order.
    thickness : numpy.ndarray, shape (P,)
        Film thickness, height steps, NaN where it is not known.
    half_windows : numpy.ndarray, shape (P,)
        Points on either side of the contact's centre.
    unknown : numpy.ndarray of bool, shape (P,)
        Where the film is not known.
    """

    def __init__(
        self,
        grid: LineGrid,
        film: xr.Dataset,
        boundary_layer: Layer,
        gap: Gap = PLAIN,
        weaker: Values = 1.0,
    ) -> None:
        self._gap = gap
        names = ["film_thickness", "contact_half_width"]
        # Where more than film and width decides on contact, Moes' numbers tell the points apart.
        names += ["moes_load", "moes_material"] if not gap.is_plain else []
        spread = xr.broadcast(*(film[name] for name in names))
        self.shape = spread[0].shape
        thickness, half_width, *moes = (each.values.ravel() for each in spread)
        self._grid, self._contacts = grid, np.stack([half_width, *moes], axis=1)
        self.thickness, self.unknown = thickness / grid.height_step, np.isnan(thickness)
        self._films, self.half_windows = whole_numbers(thickness, half_width, grid)
        self._shapes = np.full(thickness.size, None)
        if gap.has_shape:
            self._shapes[:] = window_films(film, grid)
            self.unknown |= [shape is None for shape in self._shapes]
        factor = layer_factor_of(grid, film["reduced_modulus"].item(), boundary_layer)
        self._factors = factor * np.broadcast_to(weaker, thickness.shape)

    def __getitem__(self, points: Array | slice) -> "ContactWindows":
        some = copy.copy(self)
        names = ("_films", "_shapes", "_contacts", "_factors")
        for name in (*names, "thickness", "half_windows", "unknown"):
            setattr(some, name, getattr(self, name)[points])
        some.shape = some.unknown.shape
        return some

    @property
    def size(self) -> int:
        """Number of operating points."""
        return self.unknown.size

    @property
    def keys(self) -> list[tuple]:
        """What decides on contact at each point: where it is the same, contact is the same."""
        columns = self._films, self.half_windows, self._factors, *self._contacts.T[1:]
        return list(zip(*(column.tolist() for column in columns), strict=True))

    def distinct(self) -> tuple["ContactWindows", Array]:
        """Return each different point once, and the index among these of every point."""
        numbers = {}
        inverse = np.array([numbers.setdefault(key, len(numbers)) for key in self.keys], int)
        return self[np.unique(inverse, return_index=True)[1]], inverse

    def count(self, pair: Pair, slip: float = 0.0, turns: float = 1.0, begin: int = 0) -> Array:
        """Count contact on a pair of lines.

        Parameters
        ----------
        pair : tuple of numpy.ndarray
            Two lines, int32 height steps.
        slip : float, optional
            Slide-to-roll ratio; the default is pure rolling.
        turns : float, optional
            Revolutions of the roller with the faster surface; a single time step at least. Under a
            film that is not flat only some of the time steps are looked at.
        begin : int, optional
            First time step.

        Returns
        -------
        numpy.ndarray
            Means over the time steps, shape (P, 4): share with contact, share with a broken
            boundary layer, broken points, and overlap (height steps); NaN where the film is not
            known.
        """
        ratios = speed_ratios(slip)
        steps = max(round(turns * revolution(pair, ratios)), 1)
        pair = _begun(pair, ratios, begin)
        run = self._under_shaped_films if self._gap.has_shape else self._under_flat_films
        counts = np.empty((self.size, 4))
        is_general = not self._gap.is_plain
        if is_general and ratios[0] == ratios[1] and pair[0].size == pair[1].size:
            pair = pair[0] + pair[1], np.zeros(1, np.int32)  # one line passes the contact
        for lines, factor, here in self._in_contact(pair):
            counts[here] = run(lines, ratios, steps, here, factor)
        counts[self.unknown] = np.nan
        return counts

    def trace(self, pair: Pair, slip: float = 0.0, begin: int = 0) -> Array:
        """Count the points with a broken boundary layer at every time step of a revolution.

        Parameters
        ----------
        pair, slip, begin
            As in `count`; every time step is looked at.

        Returns
        -------
        numpy.ndarray
            Shape (P, steps), int32; 0 where the film is not known.
        """
        ratios = speed_ratios(slip)
        steps = revolution(pair, ratios)
        broken = np.zeros((self.size, steps), np.int32)
        for lines, factor, here in self._in_contact(_begun(pair, ratios, begin)):
            if not self._gap.has_shape:
                films = self._films[here], self.half_windows[here]
                broken[here] = strip_trace(lines, ratios, steps, *films, factor)
                continue
            for point in here[~self.unknown[here]]:
                film = self._shapes[point].below(_highest(lines))
                motion = lines, ratios, steps, steps
                broken[point] = shaped_trace(*motion, film.film, film.before, factor)[:, 1]
        return broken

    def count_uncut(self, pair: Pair) -> Array:
        """Count breakthroughs of whole segments, of which a part lies in the window.

        Elsewhere the edges of the window cut segments, and the parts inside are judged.

        Parameters
        ----------
        pair : tuple of numpy.ndarray
            Two lines, int32 height steps, that roll without slip. If they differ in length, the
            second is continued until the first ends.

        Returns
        -------
        numpy.ndarray
            Share of the time steps with a broken boundary layer under flat films, shape (P,); NaN
            where the film is not known.
        """
        line = pair[0] + np.resize(pair[1], pair[0].size)
        shares = np.full(self.size, np.nan)
        for (one,), factor, here in self._in_contact((line,)):
            films = self._films[here], self.half_windows[here]
            shares[here] = whole_run_steps(one, *films, factor) / line.size
        return np.where(self.unknown, np.nan, shares)

    def sample(self, spec: LineSpecLike, seed: int, number: int) -> Pair:
        """Estimate probabilities and rates at any rarity, on one pair of Gaussian lines.

        Parameters
        ----------
        spec, seed, number
            As in `lube.surfaces.rare_contact.draw_pair`.

        Returns
        -------
        windows, runs : numpy.ndarray
            As of `lube.surfaces.rare_contact.rare_contact`, shapes (2, P) and (10, P); under films
            that are not flat as of `lube.surfaces.rare_contact.rare_contact_under`, shapes (2, P)
            and (4, P), NaN where the film is not known.
        """
        if not self._gap.has_shape:
            widths = 2 * self.half_windows + 1
            return rare_contact(spec, seed, number, self.thickness, widths, self._factors)
        films = [shape.film.astype(float) for shape in self._shapes[~self.unknown]]
        factors = self._factors[~self.unknown]
        found = rare_contact_under(spec, seed, number, films, factors)
        windows, runs = (np.full((len(each), self.size), np.nan) for each in found)
        windows[:, ~self.unknown], runs[:, ~self.unknown] = found
        return windows, runs

    def _in_contact(self, pair):
        """Yield the lines, flattened if need be, the layer's factor, and points with both alike."""
        if not self._gap.is_flattened:
            for factor in np.unique(self._factors):
                yield pair, factor, np.flatnonzero(self._factors == factor)
            return
        waves = [Waves(line, self._grid) for line in pair]
        contacts, inverse = np.unique(self._contacts, axis=0, return_inverse=True)
        for number, contact in enumerate(contacts):
            lines = tuple(one.flattened(*contact) for one in waves)
            for factor in np.unique(self._factors[inverse.ravel() == number]):
                alike = (inverse.ravel() == number) & (self._factors == factor)
                yield lines, factor, np.flatnonzero(alike)

    def _under_flat_films(self, lines, ratios, steps, points, factor):
        films = np.stack([self._films[points], self.half_windows[points]])
        (films, half_windows), inverse = np.unique(films, axis=1, return_inverse=True)
        if lines[1].size == 1:
            lines = lines[0], np.zeros_like(lines[0])  # read faster than point after point
        counts = strip_statistics(lines, ratios, steps, films, half_windows, factor)
        return (counts / steps)[inverse.ravel()]

    def _under_shaped_films(self, lines, ratios, steps, points, factor):
        known = ~self.unknown[points]
        reached = [self._shapes[point].below(_highest(lines)) for point in points[known]]
        strides = np.maximum(1, (2 * self.half_windows[points[known]] + 1) // WINDOWS_PER_WIDTH)
        begin = np.cumsum([0, *(one.film.size for one in reached)])
        joined = np.concatenate([np.zeros(0, np.int64), *(one.film for one in reached)])
        centres = np.array([one.before for one in reached], np.int64)
        counts = np.full((points.size, 4), np.nan)
        counts[known] = shaped_statistics(
            lines, ratios, steps, -(-steps // strides), (joined, begin, centres), factor
        )
        return counts


def _begun(pair, ratios, begin):
    """Lines as they lie at a time step."""
    if not begin:
        return pair
    positions = (surface_position(begin, ratio) for ratio in ratios)
    return tuple(np.roll(line, -at) for line, at in zip(pair, positions, strict=True))


def _highest(lines):
    return lines[0].max() + lines[1].max()


class Waves:
    """Waves of a line, each of which the oil can flatten.

    Parameters
    ----------
    line : numpy.ndarray
        Heights, shape (N,), height steps.
    grid : LineGrid
        Grid of the line. Waves shorter than those of its band, of the rounding to whole height
        steps, are left out.
    """

    def __init__(self, line: Array, grid: LineGrid) -> None:
        step = 2.0 * np.pi / (line.size * grid.spacing)
        last = int(grid.q_max / step * (1.0 + 1e-9))
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
