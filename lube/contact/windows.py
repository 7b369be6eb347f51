"""Contact windows: film and rough lines at some operating points, and how often the lines touch.

The film of a window is flat and ends at the edges of the contact, or has the shape of the computed
film. The lines enter the gap as drawn, or the oil flattens or answers their waves.
"""

import copy
import functools

import numpy as np
import xarray as xr

from lube.contact.answered_windows import answered_windows, rms_along
from lube.contact.waves import Waves, answers_at, longest_answers
from lube.contact.window_films import WindowFilm, window_films
from lube.errors import StudyError
from lube.grid.discretise import LineGrid, layer_factor_of, revolution, speed_ratios, whole_numbers
from lube.grid.gap import PLAIN, Gap
from lube.kernels.motion import surface_position
from lube.kernels.runs import BLOCK_SHIFT
from lube.kernels.shaped import Window, as_drawn, means_of, node_count, phase_of, shaped_trace
from lube.kernels.strips import strip_statistics, strip_trace
from lube.kernels.whole_runs import whole_run_steps
from lube.study.rollers import BoundaryLayer
from lube.study.study import Study
from lube.surfaces.rare_contact import (
    RarePair,
    UnevenWindow,
    rare_contact,
    rare_contact_under,
    sum_of_lines,
)
from lube.surfaces.synthetic import LineSpecLike
from lube.threads import on_threads
from lube.types import Array, Pair, Values

WINDOWS_PER_WIDTH = 10
"""Windows per contact width if the window is not uniform. More windows hardly reduce the scatter
between realisations, since neighbouring windows see nearly the same points."""
NO_SLIPS = np.empty((1, 0))
FLATTENED = (
    "roughness_deformation: got venner-1997, need none or computed: lines that a formula flattens "
    "cannot be sampled, and the formula is wrong below M = 20"
)


class ContactWindows:
    """Contact windows of some operating points, on which contact is counted or sampled.

    An index, such as ``windows[known]``, selects some of the operating points.

    Parameters
    ----------
    grid : LineGrid
        Grid of the lines.
    film : xarray.Dataset
        With ``film_thickness`` and ``contact_half_width``, m, over any dimensions, and
        ``reduced_modulus``, Pa; for a film with a shape also ``film_profile``, for lines that the
        oil answers also its response.
    boundary_layer : BoundaryLayer
        The boundary layer.
    gap : Gap, optional
        How film and roughness make up the gap; by default flat films, and lines as drawn.
    weaker : float or numpy.ndarray, optional
        How many times weaker than `boundary_layer` the layer is, at all points or at each.

    Attributes
    ----------
    thickness : numpy.ndarray, shape (P,)
        Film thickness, height steps, NaN where it is not known. The operating points are in the
        order of the dimensions of ``film_thickness`` and of those that the half-width has alone.
    half_windows : numpy.ndarray, shape (P,)
        Points on either side of the contact's centre.
    unknown : numpy.ndarray of bool, shape (P,)
        Where the film is not known.
    """

    def __init__(
        self,
        grid: LineGrid,
        film: xr.Dataset,
        boundary_layer: BoundaryLayer,
        gap: Gap = PLAIN,
        weaker: Values = 1.0,
    ) -> None:
        self._grid, self._gap, self._places = grid, gap, {}
        names = ["film_thickness", "contact_half_width"]
        # If contact depends on more than film and width, points are distinguished by Moes' numbers
        # and, with slip, by the answer to the longest wave.
        names += ["moes_load", "moes_material"] if not gap.is_plain else []
        longest = longest_answers(film) if gap.is_answered else []
        spread = xr.broadcast(*(film[name] for name in names), *longest)
        thickness, half_width, *others = (each.values.ravel() for each in spread)
        self._contacts = np.stack([half_width, *others], axis=1)
        self.thickness, self.unknown = thickness / grid.height_step, np.isnan(thickness)
        self._films, self.half_windows = whole_numbers(thickness, half_width, grid)
        if gap.has_shape:
            self._shapes = window_films(film, grid)
            self.unknown |= [shape is None for shape in self._shapes]
        self._answers = np.full((thickness.size, 2), None)
        if gap.is_answered:
            answers, _ = xr.broadcast(answers_at(film, gap.has_shape), spread[0])
            self._answers = answers.transpose(*spread[0].dims, "roller").values.reshape(-1, 2)
            self.unknown |= [answer is None for answer in self._answers[:, 0]]
        factor = layer_factor_of(grid, film["reduced_modulus"].item(), boundary_layer)
        self._factors = factor * np.broadcast_to(weaker, thickness.shape)

    def __getitem__(self, points: Array | slice) -> "ContactWindows":
        some = copy.copy(self)
        for name, values in vars(self).items():
            if isinstance(values, np.ndarray):
                setattr(some, name, values[points])
        return some

    @property
    def size(self) -> int:
        """Number of operating points."""
        return self.unknown.size

    @property
    def keys(self) -> list[tuple]:
        """Numbers that determine contact at each point: contact is equal where they are equal."""
        columns = self._films, self.half_windows, self._factors, *self._contacts.T[1:]
        return list(zip(*(column.tolist() for column in columns), strict=True))

    def distinct(self) -> tuple[Array, Array]:
        """Find the first of each set of equal points, and the set of every point."""
        first = {}
        equal = [first.setdefault(key, point) for point, key in enumerate(self.keys)]
        return np.unique(np.array(equal, int), return_inverse=True)

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
            uneven windows contact is counted at some of the time steps only.
        begin : int, optional
            First time step.

        Returns
        -------
        numpy.ndarray
            Shape (P, 4): share of time with contact, share of time with a broken boundary layer,
            and the means over time of broken points and overlap (height steps); NaN where the film
            is not known.
        """
        first, inverse = self.distinct()
        if first.size < self.size:
            return self[first].count(pair, slip, turns, begin)[inverse]
        ratios = speed_ratios(slip)
        steps = max(round(turns * revolution(pair, ratios)), 1)
        pair, counts = _begun(pair, ratios, begin), np.full((self.size, 4), np.nan)
        are_alike = all(first is second for first, second in self._answers)
        is_one = ratios[0] == ratios[1] and pair[0].size == pair[1].size and are_alike
        if is_one and not self._gap.is_plain:
            pair = pair[0] + pair[1], np.zeros(1, np.int32)  # one line passes the contact
        if self._gap.is_uniform:
            for here, lines, films in self._under_flat_films(pair):
                if lines[1].size == 1:
                    lines = lines[0], np.zeros_like(lines[0])  # faster than wrapping at one point
                counts[here] = strip_statistics(lines, ratios, steps, *films) / steps
            counts[self.unknown] = np.nan
            return counts
        for points, surfaces, window in self._meetings(pair):
            stride = max(1, (2 * self.half_windows[points[0]] + 1) // WINDOWS_PER_WIDTH)
            found = shaped_trace(
                surfaces, ratios, steps, -(-steps // stride), window, self._factors[points]
            )
            counts[points] = means_of(found)
        return counts

    def trace(self, pair: Pair, slip: float = 0.0, begin: int = 0) -> Array:
        """Count the points with a broken boundary layer at every time step of a revolution.

        Parameters
        ----------
        pair, slip, begin
            As in `count`, but contact is counted at every time step.

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
            for here, lines, films in self._under_flat_films(pair):
                broken[here] = strip_trace(lines, ratios, steps, *films)
            return broken
        for points, surfaces, window in self._meetings(pair):
            found = shaped_trace(surfaces, ratios, steps, steps, window, self._factors[points])
            broken[points] = found[..., 1]
        return broken

    def count_uncut(self, pair: Pair) -> Array:
        """Count breakthroughs of uncut segments, if any part of them lies in the window.

        In `count` the edges of the window cut segments, and the parts inside are judged.

        Parameters
        ----------
        pair : tuple of numpy.ndarray
            Two lines, int32 height steps, that roll without slip. If they differ in length, the
            second is continued until the first ends.

        Returns
        -------
        numpy.ndarray
            Share of time with a broken boundary layer under flat films, shape (P,); NaN where the
            film is not known.
        """
        line = pair[0] + np.resize(pair[1], pair[0].size)
        shares = np.full(self.size, np.nan)
        for here, (one,), films in self._under_flat_films((line,)):
            shares[here] = whole_run_steps(one, *films) / line.size
        return np.where(self.unknown, np.nan, shares)

    def sample(self, spec: LineSpecLike, seed: int, number: int, slips: Array = NO_SLIPS) -> Pair:
        """Estimate probabilities and rates at any rarity, on one pair of Gaussian lines.

        Parameters
        ----------
        spec, seed, number
            As in `lube.surfaces.rare_contact.draw_pair`.
        slips : numpy.ndarray, optional
            Slide-to-roll ratios at which breakthroughs are counted in uneven windows, shape (P, S).

        Returns
        -------
        windows, runs : numpy.ndarray
            As from `lube.surfaces.rare_contact.rare_contact`, shapes (2, P) and (10, P). In uneven
            windows as from `lube.surfaces.rare_contact.rare_contact_under`, shapes (2, P) and
            (1 + S, P), NaN where the film is not known.

        Raises
        ------
        StudyError
            If a formula flattens the lines.
        """
        if self._gap.is_flattened:
            raise StudyError(FLATTENED)
        if self._gap.is_uniform:
            widths = 2 * self.half_windows + 1
            return rare_contact(spec, seed, number, self.thickness, widths, self._factors)
        known = np.flatnonzero(~self.unknown)
        # Points to which the oil answers alike follow one another, so that lines are filtered once.
        known = known[np.argsort([id(one) for one in self._answers[known, 0]], kind="stable")]
        places = [self._place(point, spec) for point in known]
        pair = RarePair(spec, seed, number, max((one.film.size for one in places), default=1))
        waves = [Waves(line, self._grid) for line in pair.lines]

        @functools.lru_cache(maxsize=1)
        def filtered_by(*answers):
            return _filtered(waves, answers)

        filtered = (filtered_by(*answers) for answers in self._answers[known])
        ratios = np.reshape([speed_ratios(slip) for slip in slips.flat], (*slips.shape, 2))
        ratios = np.broadcast_to(ratios, (self.size, *ratios.shape[1:]))[known]
        found = rare_contact_under(pair, places, filtered, self._factors[known], ratios)
        windows, runs = (np.full((len(each), self.size), np.nan) for each in found)
        windows[:, known], runs[:, known] = found
        return windows, runs

    def on_pairs(
        self, spec: LineSpecLike, seed: int, pairs: int, threads: int | None = None
    ) -> Array:
        """Estimate probabilities at any rarity on some pairs, shape (pairs, 2, P); see `sample`."""
        found = on_threads(lambda number: self.sample(spec, seed, number)[0], range(pairs), threads)
        return np.array(found)

    def gaps(self, spec: LineSpecLike) -> list[Pair]:
        """Find the mean gap and the rms height of the roughness in it, across each contact.

        Parameters
        ----------
        spec : LineSpecLike
            Parameters of the lines.

        Returns
        -------
        list of tuple of numpy.ndarray
            Both at even positions from edge to edge of each contact, m, or one value for all
            positions; NaN where the film is not known.
        """
        rms, _ = sum_of_lines(spec, 1)
        gaps = (self._gap_at(point, spec, rms) for point in range(self.size))
        return [(film * spec.height_step, rough * spec.height_step) for film, rough in gaps]

    def _gap_at(self, point, spec, rms):
        if self.unknown[point]:
            return np.nan, np.nan
        if self._gap.is_plain:
            return self.thickness[point], np.asarray(rms)
        window, half_window = self._window([point]), self.half_windows[point]
        film, ratio = window.film[0], np.ones(window.film.shape[1])
        if self._gap.is_answered:
            ratio = rms_along(spec, film.size, window.before, self._answers[point])
        inside = slice(window.before - half_window, window.before + half_window + 1)
        return film[inside], rms * ratio[inside]

    def _place(self, point, spec):
        """Contact window of an operating point, in which lines are sampled."""
        key = self._films[point], *self._contacts[point]
        if key not in self._places:
            window, make = self._window([point]), UnevenWindow
            if self._gap.is_answered:
                answers = tuple(self._answers[point])
                make = answered_windows(spec, window.film.size, window.before, answers)
            self._places[key] = make(window.film[0].astype(float))
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
        """Yield points with equal lines and layer, the lines, and films, half-windows, factor."""
        for lines, some in self._in_contact(pair):
            for factor in np.unique(self._factors[some]):
                here = some[self._factors[some] == factor]
                yield here, lines, (self._films[here], self.half_windows[here], factor)

    def _meetings(self, pair):
        """Yield points with the same window and a known film, the surfaces, and the window."""
        for lines, here in self._in_contact(pair):
            drawn = [as_drawn(line) for line in lines]
            waves = [Waves(line, self._grid) for line in lines] if self._gap.is_answered else []
            alike = {}
            for point in here[~self.unknown[here]]:
                key = tuple(self._answers[point]) if waves else point
                alike.setdefault(key, []).append(point)
            for points in alike.values():
                yield points, *self._meeting(points, drawn, waves)

    def _meeting(self, points, drawn, waves):
        """Both surfaces, with the answers of the oil if there are any, and the points' window."""
        answers = self._answers[points[0]] if waves else []
        filtered = _filtered(waves, answers)
        highest = highest_drawn = sum(surface.line.max() for surface in drawn)
        for answer, lines in zip(answers, filtered, strict=True):
            highest += np.sum(np.abs(answer.shapes) * np.abs(lines).max(axis=0), axis=1).max()
        shift = answers[0].shift(self._grid.spacing) if waves else BLOCK_SHIFT
        reached = self._window(points)
        if self._gap.has_shape:
            # What the oil adds is far lower than this sum, and at the ends no line is so high.
            reached = reached.below(min(highest, max(highest_drawn, reached.at_ends)))
        # For another layout in memory Numba would compile the kernel once more.
        window = Window(np.ascontiguousarray(reached.film), reached.before, shift)
        nodes = (np.arange(node_count(window)) << shift) - phase_of(window)
        surfaces = list(drawn)
        for roller, (lines, answer) in enumerate(zip(filtered, answers, strict=True)):
            if lines.any():
                shapes = answer.at_points(window.before - nodes, self._grid.spacing)
                surfaces[roller] = drawn[roller]._replace(filtered=lines, shapes=shapes)
        return tuple(surfaces), window

    def _window(self, points):
        """Films of some points that have the same window."""
        if self._gap.has_shape:
            shapes = self._shapes[points]
            return WindowFilm(np.stack([one.film for one in shapes]), shapes[0].before)
        half_window = self.half_windows[points[0]]
        films = np.repeat(self._films[points, None], 2 * half_window + 1, axis=1)
        return WindowFilm(films, half_window)


def study_windows(study: Study, film: xr.Dataset, weaker: Values = 1.0) -> ContactWindows:
    """Contact windows of the films of a study, such as those at the records."""
    return ContactWindows(study.line_spec, film, study.boundary_layer, study.gap, weaker)


def _begun(pair, ratios, begin):
    """Lines of a pair, turned to their position at a time step."""
    positions = (surface_position(begin, ratio) for ratio in ratios)
    return tuple(np.roll(line, -at) for line, at in zip(pair, positions, strict=True))


def _filtered(waves, answers):
    """Two lines, each filtered by the answer of the oil to it."""
    return [wave.filtered(answer) for wave, answer in zip(waves, answers, strict=True)]
