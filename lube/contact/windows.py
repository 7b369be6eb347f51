"""Contact windows: what meets at some operating points, and how often it touches.

The film of a window is flat and ends at the edges of the contact, or has the shape of the computed
one. The lines reach the gap as drawn, or the oil flattens or answers their waves.
"""

import copy

import numpy as np
import xarray as xr

from lube.contact.waves import Waves, answered_window, answers_at, longest_answers
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
from lube.kernels.shaped import (
    BLOCK_SHIFT,
    Window,
    as_drawn,
    means_of,
    node_count,
    phase_of,
    shaped_trace,
)
from lube.kernels.strips import strip_statistics, strip_trace
from lube.kernels.whole_runs import whole_run_steps
from lube.study.study import Study
from lube.surfaces.rare_contact import RarePair, UnevenWindow, rare_contact, rare_contact_under
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
        if gap.is_answered:  # and with slip the answer to the longest wave
            spread = xr.broadcast(*spread, *longest_answers(film))
        thickness, half_width, *others = (each.values.ravel() for each in spread)
        self._grid, self._contacts = grid, np.stack([half_width, *others], axis=1)
        self.thickness, self.unknown = thickness / grid.height_step, np.isnan(thickness)
        self._films, self.half_windows = whole_numbers(thickness, half_width, grid)
        self._shapes = np.full(thickness.size, None)
        if gap.has_shape:
            self._shapes[:] = window_films(film, grid)
            self.unknown |= [shape is None for shape in self._shapes]
        self._answers = np.full((thickness.size, 2), None)
        if gap.is_answered:
            answers, _ = xr.broadcast(answers_at(film, gap.has_shape), spread[0])
            self._answers = answers.transpose(*spread[0].dims, "roller").values.reshape(-1, 2)
            self.unknown |= [answer is None for answer in self._answers[:, 0]]
        factor = layer_factor_of(grid, film["reduced_modulus"].item(), boundary_layer)
        self._factors = factor * np.broadcast_to(weaker, thickness.shape)
        self._numbers, self._places = np.arange(thickness.size), {}

    def __getitem__(self, points: Array | slice) -> "ContactWindows":
        some = copy.copy(self)
        names = ("_films", "_shapes", "_answers", "_contacts", "_factors", "_numbers")
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
            Revolutions of the roller with the faster surface; a single time step at least. In
            uneven windows only some of the time steps are looked at.
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
        pair, counts = _begun(pair, ratios, begin), np.full((self.size, 4), np.nan)
        are_alike = all(first is second for first, second in self._answers)
        is_one = ratios[0] == ratios[1] and pair[0].size == pair[1].size and are_alike
        if is_one and not self._gap.is_plain:
            pair = pair[0] + pair[1], np.zeros(1, np.int32)  # one line passes the contact
        if self._gap.is_uniform:
            for lines, factor, here in self._under_flat_films(pair):
                counts[here] = self._strips(lines, ratios, steps, here, factor)
            counts[self.unknown] = np.nan
            return counts
        for points, surfaces, window in self._meetings(pair):
            stride = max(1, (2 * self.half_windows[points[0]] + 1) // WINDOWS_PER_WIDTH)
            motion = ratios, steps, -(-steps // stride)
            found = shaped_trace(surfaces, *motion, window, self._factors[points])
            counts[points] = means_of(found)
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
        pair = _begun(pair, ratios, begin)
        if self._gap.is_uniform:
            for lines, factor, here in self._under_flat_films(pair):
                films = self._films[here], self.half_windows[here]
                broken[here] = strip_trace(lines, ratios, steps, *films, factor)
            return broken
        for points, surfaces, window in self._meetings(pair):
            found = shaped_trace(surfaces, ratios, steps, steps, window, self._factors[points])
            broken[points] = found[..., 1]
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
        for (one,), factor, here in self._under_flat_films((line,)):
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
            As of `lube.surfaces.rare_contact.rare_contact`, shapes (2, P) and (10, P); in uneven
            windows as of `lube.surfaces.rare_contact.rare_contact_under`, shapes (2, P) and (4, P),
            NaN where the film is not known.
        """
        if self._gap.is_uniform:
            widths = 2 * self.half_windows + 1
            return rare_contact(spec, seed, number, self.thickness, widths, self._factors)
        known = np.flatnonzero(~self.unknown)
        places = [self._place(point, spec) for point in known]
        pair = RarePair(spec, seed, number, max((one.film.size for one in places), default=1))
        waves = [Waves(line, self._grid) for line in pair.lines] if self._gap.is_answered else []
        nothing = np.zeros((2, 0), np.float32)
        filtered = (
            [wave.filtered(one) for wave, one in zip(waves, self._answers[point], strict=True)]
            if waves
            else (nothing, nothing)
            for point in known
        )
        found = rare_contact_under(pair, places, filtered, self._factors[known])
        windows, runs = (np.full((len(each), self.size), np.nan) for each in found)
        windows[:, known], runs[:, known] = found
        return windows, runs

    def _place(self, point, spec):
        """Contact window of a point, in which lines are sampled."""
        if not self._gap.is_answered:
            return UnevenWindow(self._shapes[point].film.astype(float))
        key = self._numbers[point]
        if key not in self._places:
            shape = self._shapes[point]
            film, before = (shape.film, shape.before) if shape else self._reached([point], 0)
            film = np.ravel(film).astype(float)
            self._places[key] = answered_window(spec, film, before, tuple(self._answers[point]))
        return self._places[key]

    def _in_contact(self, pair):
        """Yield the lines, flattened if need be, and the points at which they are the same."""
        if not self._gap.is_flattened:
            yield pair, np.arange(self.size)
            return
        waves = [Waves(line, self._grid) for line in pair]
        contacts, inverse = np.unique(self._contacts, axis=0, return_inverse=True)
        for number, contact in enumerate(contacts):
            lines = tuple(one.flattened(*contact) for one in waves)
            yield lines, np.flatnonzero(inverse.ravel() == number)

    def _under_flat_films(self, pair):
        """Yield lines, a layer's factor, and the points at which both are the same."""
        for lines, here in self._in_contact(pair):
            for factor in np.unique(self._factors[here]):
                yield lines, factor, here[self._factors[here] == factor]

    def _strips(self, lines, ratios, steps, points, factor):
        films = np.stack([self._films[points], self.half_windows[points]])
        (films, half_windows), inverse = np.unique(films, axis=1, return_inverse=True)
        if lines[1].size == 1:
            lines = lines[0], np.zeros_like(lines[0])  # read faster than point after point
        counts = strip_statistics(lines, ratios, steps, films, half_windows, factor)
        return (counts / steps)[inverse.ravel()]

    def _meetings(self, pair):
        """Yield known points of one window, with the surfaces and the window that meet there."""
        for lines, here in self._in_contact(pair):
            drawn = [as_drawn(line) for line in lines]
            highest = sum(line.max() for line in lines)
            known = here[~self.unknown[here]]
            if not self._gap.is_answered:
                for point in known:
                    films, before = self._reached([point], highest)
                    yield [point], tuple(drawn), Window(films, before, BLOCK_SHIFT)
                continue
            waves = [Waves(line, self._grid) for line in lines]
            alike = {}
            for point in known:
                alike.setdefault(tuple(map(id, self._answers[point])), []).append(point)
            for points in alike.values():
                yield points, *self._answered(points, drawn, waves, highest)

    def _answered(self, points, drawn, waves, highest):
        """Surfaces that the oil answers, and the window of points at which it answers alike."""
        answers = self._answers[points[0]]
        filtered = [wave.filtered(one) for wave, one in zip(waves, answers, strict=True)]
        for answer, lines in zip(answers, filtered, strict=True):
            highest += np.sum(np.abs(answer.shapes) * np.abs(lines).max(axis=0), axis=1).max()
        shift = answers[0].shift(self._grid.spacing)
        window = Window(*self._reached(points, highest), shift)
        nodes = (np.arange(node_count(window)) << shift) - phase_of(window)
        position = (window.before - nodes) * (self._grid.spacing / answers[0].half_width)
        both = zip(drawn, filtered, answers, strict=True)
        return tuple(
            surface._replace(filtered=lines, shapes=answer.at(position)) if lines.any() else surface
            for surface, lines, answer in both
        ), window

    def _reached(self, points, highest):
        """Films over the window of some points as far as a height reaches, and points before."""
        if not self._gap.has_shape:
            half_window = self.half_windows[points[0]]
            return np.repeat(self._films[points, None], 2 * half_window + 1, axis=1), half_window
        shapes = self._shapes[points]
        reached = [shape.below(highest) for shape in shapes]
        before = max(one.before for one in reached)
        behind = max(one.film.size - one.before for one in reached)
        part = [shape.film[shape.before - before : shape.before + behind] for shape in shapes]
        return np.array(part), before


def study_windows(study: Study, film: xr.Dataset, weaker: Values = 1.0) -> ContactWindows:
    """Contact windows of the films of a study, such as those at the records."""
    return ContactWindows(study.line_spec, film, study.boundary_layer, study.gap, weaker)


def _begun(pair, ratios, begin):
    """Lines as they lie at a time step."""
    if not begin:
        return pair
    positions = (surface_position(begin, ratio) for ratio in ratios)
    return tuple(np.roll(line, -at) for line, at in zip(pair, positions, strict=True))
