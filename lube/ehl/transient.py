r"""Rough surfaces passing through a line contact: Reynolds' equation with time, and solid contact.

The gap is that of the elastic rollers less the heights of the roughness, which moves with the
surfaces. In the scaled variables of `lube.ehl.reynolds` and the time :math:`T = t v / a`,

.. math::

    \frac{\partial (\bar\rho H)}{\partial T} + \frac{\partial Q}{\partial X} = 0 \;
    \text{where}\; P > 0, \qquad
    H = H_0 + \frac{X^2}{2} - \frac{1}{\pi} \int (P + P_c) \ln|X - X'|\, dX' - Z, \qquad
    \int (P + P_c)\, dX = \frac{\pi}{2}

with the heights Z of both surfaces together. Where the gap would close, it is held open by a hair,
and the surfaces carry the pressure :math:`P_c \ge 0` themselves; elsewhere this pressure is zero.
So the amplitude of the roughness is not limited.
"""

from dataclasses import dataclass

import numpy as np
from scipy.linalg import lu_factor, lu_solve

from lube.ehl.line_contact import ConvergenceError, FilmProfile, on_nodes, one_blas_thread
from lube.ehl.response import resolved_part
from lube.ehl.reynolds import HERTZ_LOAD, DiscreteContact
from lube.types import Array

NODES = 20
"""Nodes per wavelength of a single wave."""
CLOSED = 1e-3
"""Gap at which the surfaces touch, over the central film of smooth rollers."""
REACH, BEYOND = 1.3, 0.15
"""How far the evenly spaced nodes extend, in half-widths: into the inlet, unless high roughness
touches farther out, and beyond the end of the film."""
_GROWTH = 1.08, 1.15
"""Growth of the cells towards the inlet, and behind the film."""
_GROWN, _SETTLED = 1.5, 4.0
"""Half-widths that the surfaces travel until a wave has grown to its height, and until the gap
repeats itself."""
_DAMPING = 1.0
"""Half-widths that the surfaces travel while oscillations of the pressure decay."""
_ENOUGH, _LARGEST, _MOST = 1e-7, 0.5, 300
"""Change of the pressure below which a time step counts as solved, largest change in one step of
Newton's method, and largest number of these steps."""
_SLOW, _CREEPING, _PATIENCE = 0.2, 1e-4, 40
"""The derivatives are formed anew if the change of the pressure exceeds the first number times the
change before. They are not if it is below the second number while the end of the film creeps from
node to node. Whenever Newton's method has taken the third number of steps, smaller ones follow."""


def passage_nodes(profile: FilmProfile, step: float, reach: float = REACH) -> Array:
    """Nodes for the passage of roughness: evenly spaced in the contact, farther apart outside.

    Parameters
    ----------
    profile : FilmProfile
        The film of smooth rollers.
    step : float
        Distance of the evenly spaced nodes over the half-width.
    reach : float, optional
        How far they extend into the inlet, in half-widths.

    Returns
    -------
    numpy.ndarray
        Positions over the half-width, from the first node of the film to its last.
    """
    first, last = int(reach / step) + 1, int((profile.film_end + BEYOND) / step) + 1
    even = step * np.arange(-first, last + 1)
    ends = zip((-1.0, 1.0), even[[0, -1]], profile.nodes[[0, -1]], _GROWTH, strict=True)
    before, behind = (_growing(step, *each) for each in ends)
    return np.concatenate([before[::-1], even, behind])


def _growing(step, side, start, end, growth):
    """Positions from a start, not included, to an end on a side, farther and farther apart."""
    length = side * end - side * start
    count = max(1, round(np.log1p(length * (growth - 1.0) / step) / np.log(growth)))
    sizes = growth ** np.arange(1, count + 1)
    return side * (side * start + length * np.cumsum(sizes) / np.sum(sizes))


class RoughPassage:
    """Film and solid contact while rough surfaces pass, one time step after the other.

    In a time step the surfaces travel from one of the evenly spaced nodes to the next at the
    entrainment speed, so a wave that moves as fast keeps its height and phase. The pressure-driven
    flow is weighted towards the end of the step, just enough to damp oscillations of the pressure;
    the scheme is of second order in time.

    Parameters
    ----------
    profile : FilmProfile
        The film of smooth rollers, from which the passage begins.
    step : float
        Distance of the evenly spaced nodes over the half-width, and the time step.
    highest : float, optional
        Height of the highest summit, scaled as the gap. The evenly spaced nodes extend as far into
        the inlet as it may touch.

    Attributes
    ----------
    pressure : numpy.ndarray, shape (n,)
        Pressure of the oil at the nodes, over Hertz' maximum pressure.
    contact_pressure, gap : numpy.ndarray, shape (n - 1,)
        Pressure of solid contact and scaled gap midway between the nodes.
    position, spacing : numpy.ndarray, shape (n - 1,)
        Positions midway between the nodes and distances of the nodes, over the half-width.
    """

    def __init__(self, profile: FilmProfile, step: float, highest: float = 0.0) -> None:
        inlet = profile.nodes[profile.nodes < -REACH]
        narrow = inlet[profile.scaled_gap(inlet) < highest]
        reach = max(REACH, -narrow.min(initial=0.0))
        smooth = on_nodes(profile, passage_nodes(profile, step, reach), is_damped=False)
        self._discrete = DiscreteContact(smooth.contact, smooth.nodes, is_damped=False)
        self.position, self.spacing = self._discrete.middle, self._discrete.step
        self._late = 0.5 * (1.0 + min(step / _DAMPING, 1.0))
        self._squeeze = 0.5 * self._discrete.weight[1:-1] / step
        self._closed = CLOSED * profile.central_gap
        # Half the pressure in a cell acts at each of its nodes.
        by_node = self._discrete.deflection
        self._by_cell = 0.5 * (by_node[:, 1:] + by_node[:, :-1])
        self._smooth = self.pressure = smooth.pressure
        self._offset, self.contact_pressure = smooth.offset, np.zeros(smooth.nodes.size - 1)
        self._flow = self._discrete.flow(smooth.pressure, smooth.offset)
        self.gap, self._film, self._factors = self._flow.gap, None, None

    @property
    def oil_load_share(self) -> float:
        """Share of the load that the oil carries."""
        return float(self._discrete.weight @ self.pressure / HERTZ_LOAD)

    def advance(self, heights: Array) -> None:
        """Solve for the next time step.

        Parameters
        ----------
        heights : numpy.ndarray, shape (n - 1,)
            Heights of both surfaces together at the end of the step, midway between the nodes,
            scaled as the gap.

        Raises
        ------
        ConvergenceError
            If the time step does not converge.
        """
        had, state = self._left_over(), self._first_guess()
        is_slow, change, largest = False, np.inf, _LARGEST
        for number in range(_MOST):
            gap, flow = self._flow_at(heights, *state)
            before, (state, change) = change, self._newton(had, gap, flow, state, is_slow, largest)
            if change < _ENOUGH or not np.isfinite(change):
                break
            is_creeping = self._moves and change < _CREEPING and number < _PATIENCE
            is_slow = change > _SLOW * before and not (is_slow or is_creeping)
            # Smaller steps, lest the set of nodes in the film cycle.
            largest = _LARGEST / (1 + number // _PATIENCE) ** 2
        if not change < _ENOUGH:
            raise ConvergenceError(
                f"{self._discrete.contact.name}: a time step of the passing roughness did not "
                f"converge: the pressure still changes by {change:.1g}"
            )
        self.pressure, self._offset, self.contact_pressure = state
        self.pressure[1:-1] *= self._film  # nearly zero outside
        _, self._flow = self._flow_at(heights, *state)
        self.gap = self._flow.gap

    def _first_guess(self):
        """Guess pressure, offset and contact pressure: the effect of roughness travels with it."""
        pressure, solid = self._smooth.copy(), np.zeros_like(self.contact_pressure)
        pressure[1:] += (self.pressure - self._smooth)[:-1]
        solid[1:] = self.contact_pressure[:-1]
        # The film ends about where it did, though the first guess has no pressure there.
        return np.where(pressure > 0.0, pressure, self.pressure), self._offset, solid

    def _flow_at(self, heights, pressure, offset, solid):
        """Gap midway between the nodes, and the flow through it, held open where it is closed."""
        gap, cells = self._discrete.gap(pressure, offset - heights), np.flatnonzero(solid)
        gap += self._by_cell[:, cells] @ solid[cells]
        return gap, self._discrete.flow_through(np.maximum(gap, self._closed), pressure)

    def _left_over(self):
        """Terms of each inner node's mass balance that belong to the beginning of a time step."""
        drag, early = self._flow.flux + self._flow.pressure_flow, 1.0 - self._late
        balance = np.diff(0.5 * drag) - early * np.diff(self._flow.pressure_flow)
        return balance - self._squeeze * (drag[1:] + drag[:-1])

    def _newton(self, had, gap, flow, state, is_slow, largest):
        """Step of Newton's method for pressure, offset and contact pressure; the largest change.

        Nodes outside the film get no oil pressure, and cells without contact no solid pressure. The
        derivatives are formed anew if the last step hardly came nearer to the solution; otherwise
        the derivatives of an earlier step, or time step, are used again.
        """
        discrete, (pressure, offset, solid) = self._discrete, state
        residual, derivatives = self._balances(had, flow)
        in_film = pressure[1:-1] > residual / np.abs(derivatives.own)
        # Complementary: a closed gap under pressure, or an open one without.
        touching = solid + self._closed - gap > 0.0
        cells = np.flatnonzero(touching | (solid != 0.0))
        if is_slow or self._factors is None:
            self._factored_film, self._factors = in_film, derivatives.factors(in_film)
        self._moves, self._film = not np.array_equal(in_film, self._film), in_film
        wanted = np.where(in_film, -residual, -pressure[1:-1])
        missing = HERTZ_LOAD - discrete.weight @ pressure - discrete.step @ solid
        closing = np.where(touching, self._closed - gap, -solid)[cells]
        change, shift, cell_change = self._changes(
            derivatives, np.append(wanted, missing), cells, touching[cells], closing
        )
        greatest = np.abs(np.append(change, cell_change)).max()
        part = largest / max(greatest, largest)
        pressure, solid = pressure.copy(), solid.copy()
        pressure[1:-1] = np.maximum(pressure[1:-1] + part * change, 0.0)
        solid[cells] += part * cell_change
        return (pressure, offset + part * shift, solid), greatest

    def _balances(self, had, flow):
        """Residuals of the mass balances of the inner nodes, and their derivatives."""
        late, drag = self._late, flow.flux + flow.pressure_flow
        # Fractions of the dragged oil in the cells behind a node and before it.
        behind, before = self._squeeze + 0.5 - late, self._squeeze - 0.5 + late
        residual = had + behind * drag[1:] + before * drag[:-1] + late * np.diff(flow.flux)
        by_gap = (
            behind * flow.drag_by_gap[1:] + late * flow.by_gap[1:],
            before * flow.drag_by_gap[:-1] - late * flow.by_gap[:-1],
        )
        drag_behind, drag_before = behind * flow.drag_by_node[1:], before * flow.drag_by_node[:-1]
        by_node = (
            drag_before - late * flow.by_left[:-1],
            drag_behind + drag_before + late * (flow.by_left[1:] - flow.by_right[:-1]),
            drag_behind + late * flow.by_right[1:],
        )
        return residual, _Derivatives(self._discrete, by_gap, by_node)

    def _changes(self, derivatives, right, cells, is_closed, closing):
        """Solve for the changes of inner pressures, offset, and solid pressure in the cells.

        The factored equations are bordered by those of the nodes that joined or left the film
        since, and by those of the cells in contact.
        """
        changed = np.flatnonzero(self._film != self._factored_film)
        columns, rows, corner = self._border(derivatives, changed, cells, is_closed)
        both = np.column_stack([right, columns])
        solved = lu_solve(self._factors, both, trans=1, check_finite=False)
        free, answers = solved[:, 0], solved[:, 1:]
        border = np.append(right[changed], closing) - rows @ free
        extra = np.linalg.solve(corner - rows @ answers, border)
        *change, shift = free - answers @ extra
        return np.array(change), shift, extra[changed.size :]

    def _border(self, derivatives, changed, cells, is_closed):
        """Columns, rows and corner that border the factored equations."""
        count, size = changed.size, changed.size + cells.size
        columns = np.zeros((self._film.size + 1, size))
        columns[changed, np.arange(count)] = 1.0
        columns[:-1, count:] = derivatives.opened(self._by_cell[:, cells])
        columns[-1, count:] = self._discrete.step[cells]
        rows, corner = np.zeros(columns.shape[::-1]), np.zeros((size, size))
        rows[np.arange(count), changed] = 1.0
        joined = self._film[changed]
        rows[:count][joined] = derivatives.rows(changed[joined])
        corner[:count][joined] = columns[changed[joined]] * (np.arange(size) >= count)
        rows[count:, :-1] = self._discrete.deflection[cells, 1:-1]
        rows[count:, -1] = 1.0
        corner[count:, count:] = self._by_cell[np.ix_(cells, cells)]
        open_again = count + np.flatnonzero(~is_closed)
        rows[open_again], corner[open_again], corner[open_again, open_again] = 0.0, 0.0, 1.0
        return columns, rows, corner


@dataclass(frozen=True)
class _Derivatives:
    """Derivatives of the balances of the inner nodes.

    Attributes
    ----------
    discrete : DiscreteContact
        The equation on its mesh.
    by_gap : tuple of numpy.ndarray
        Derivatives with respect to the gap in the cells behind the nodes and before them.
    by_node : tuple of numpy.ndarray
        Derivatives at constant gap with respect to the pressures at the nodes before, at the nodes
        themselves, and at the nodes behind.
    """

    discrete: DiscreteContact
    by_gap: tuple[Array, Array]
    by_node: tuple[Array, Array, Array]

    @property
    def own(self):
        """Derivatives with respect to the pressure at the node itself."""
        inner, deflection = np.arange(self.by_gap[0].size), self.discrete.deflection
        by_gap = self.by_gap[0] * deflection[inner + 1, inner + 1]
        return by_gap + self.by_gap[1] * deflection[inner, inner + 1] + self.by_node[1]

    def opened(self, by):
        """Differentiate with respect to changes of the gap: the columns of `by`, cell by cell."""
        return self.by_gap[0][:, None] * by[1:] + self.by_gap[1][:, None] * by[:-1]

    def rows(self, nodes):
        """Differentiate at some nodes with respect to all inner pressures and the offset."""
        behind, before = (each[nodes] for each in self.by_gap)
        rows = np.empty((nodes.size, self.by_gap[0].size + 1))
        deflection = self.discrete.deflection[:, 1:-1]
        np.multiply(behind[:, None], deflection[nodes + 1], out=rows[:, :-1])
        rows[:, :-1] += before[:, None] * deflection[nodes]
        rows[:, -1] = behind + before
        number = np.arange(nodes.size)
        for shift, values in zip((-1, 0, 1), self.by_node, strict=True):
            there = (nodes + shift >= 0) & (nodes + shift < self.by_gap[0].size)
            rows[number[there], nodes[there] + shift] += values[nodes[there]]
        return rows

    def factors(self, in_film):
        """LU factors of the transposed equations of a film and its load.

        Nodes outside the film get no pressure.
        """
        count = in_film.size
        matrix = np.zeros((count + 1, count + 1))
        matrix[:-1] = self.rows(np.arange(count))
        matrix[-1, :-1] = self.discrete.weight[1:-1]
        outside = np.flatnonzero(~in_film)
        matrix[outside], matrix[outside, outside] = 0.0, 1.0
        return lu_factor(matrix.T, overwrite_a=True, check_finite=False)


@dataclass(frozen=True)
class PassedWave:
    """A wave that has passed through the contact for so long that the gap repeats itself.

    Attributes
    ----------
    position : numpy.ndarray, shape (n,)
        Positions over the half-width.
    transfer : numpy.ndarray of complex, shape (n,)
        Component of the gap that has the wavelength and speed of the wave, over the undeformed
        wave, as from `lube.ehl.response.WaveResponse.transfer`.
    gap : numpy.ndarray, shape (steps, n)
        Scaled gap in the last period.
    oil_load_share : float
        Least share of the load that the oil carried in that period.
    """

    position: Array
    transfer: Array
    gap: Array
    oil_load_share: float


def pass_wave(
    profile: FilmProfile, wavelength: float, surface_speed: float, amplitude: float
) -> PassedWave:
    """Let a wave of the roughness of one surface pass through the contact.

    Parameters
    ----------
    profile : FilmProfile
        The film of smooth rollers.
    wavelength : float
        Wavelength over the half-width.
    surface_speed : float
        Speed of the wave over the entrainment speed, above 0.
    amplitude : float
        Amplitude over the central film.

    Returns
    -------
    PassedWave
        The gap once the wave has grown to its height and passed the contact.

    Raises
    ------
    ConvergenceError
        If a time step does not converge.
    """
    step, wavenumber = wavelength / NODES, 2.0 * np.pi / wavelength
    passage = RoughPassage(profile, step)
    height = amplitude * profile.central_gap * resolved_part(wavelength / passage.spacing)
    period = round(NODES / surface_speed)
    steps = int(_SETTLED / min(surface_speed, 1.0) / step) + period
    gaps, oil = np.empty((period, passage.position.size)), np.ones(period)
    for number in range(1, steps + 1):
        time = number * step
        grown = min(1.0, time / _GROWN)
        wave = np.cos(wavenumber * (passage.position - surface_speed * time))
        with one_blas_thread():
            passage.advance(grown * height * wave)
        gaps[number % period], oil[number % period] = passage.gap, passage.oil_load_share
    times = step * (steps - (steps - np.arange(period)) % period)
    turning = np.exp(1j * wavenumber * surface_speed * times)
    parts = np.stack([np.ones(period), turning.real, turning.imag], axis=1)
    _, cosine, sine = np.linalg.lstsq(parts, gaps, rcond=None)[0]
    phase = np.exp(-1j * wavenumber * passage.position)
    transfer = -(cosine + 1j * sine) * phase / (amplitude * profile.central_gap)
    return PassedWave(passage.position, transfer, gaps, oil.min())
