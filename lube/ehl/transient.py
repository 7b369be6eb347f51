r"""Rough surfaces passing through a line contact: Reynolds' equation with time, and solid contact.

The gap is that of the elastic rollers less the heights of the roughness, which moves with the
surfaces. In the scaled variables of `lube.ehl.reynolds` and the time :math:`T = t v / a`,

.. math::

    \frac{\partial (\bar\rho H)}{\partial T} + \frac{\partial Q}{\partial X} = 0 \;
    \text{where}\; P > 0, \qquad
    H = H_0 + \frac{X^2}{2} - \frac{1}{\pi} \int (P + P_c) \ln|X - X'|\, dX' - Z, \qquad
    \int (P + P_c)\, dX = \frac{\pi}{2}

with the heights Z of both surfaces together. Where the gap would close, it stays open by a hair,
and the surfaces carry the pressure :math:`P_c \ge 0` themselves. Elsewhere that is zero. So the
amplitude of the roughness may be any.
"""

from dataclasses import dataclass

import numpy as np

from lube.ehl.line_contact import ConvergenceError, FilmProfile, on_nodes, one_blas_thread
from lube.ehl.response import resolved_part
from lube.ehl.reynolds import HERTZ_LOAD, DiscreteContact
from lube.types import Array

CLOSED = 1e-3
"""Gap at which the surfaces touch, over the central film of smooth rollers."""
REACH, BEYOND = 1.3, 0.15
"""How far the even nodes reach, in half-widths: into the inlet, and beyond the end of the film."""
_GROWTH = 1.08, 1.15
"""Growth of the cells towards the inlet, and behind the film."""
_GROWN, _SETTLED = 1.5, 4.0
"""Half-widths that the surfaces travel until a wave has its height, and until the gap repeats."""
_DAMPING = 1.0
"""Half-widths that the surfaces travel while what rings in the pressure decays."""
_ENOUGH, _LARGEST, _MOST = 1e-7, 0.5, 300
"""Change of the pressure at which a time step is solved, the largest in a step of Newton's method,
and the most of these."""


def passage_nodes(profile: FilmProfile, step: float) -> Array:
    """Nodes for the passage of roughness: even in the contact, farther apart outside.

    Parameters
    ----------
    profile : FilmProfile
        The film of smooth rollers.
    step : float
        Distance of the even nodes over the half-width.

    Returns
    -------
    numpy.ndarray
        Positions over the half-width, from the first to the last of the film's own nodes.
    """
    first, last = int(REACH / step) + 1, int((profile.film_end + BEYOND) / step) + 1
    even = step * np.arange(-first, last + 1)
    before, behind = (
        side * _growing(side * start, side * end, step, growth)
        for side, start, end, growth in zip(
            (-1.0, 1.0), even[[0, -1]], profile.nodes[[0, -1]], _GROWTH, strict=True
        )
    )
    return np.concatenate([before[::-1], even, behind])


def _growing(start, end, step, growth):
    """Places from a start, not included, to an end, farther and farther apart."""
    count = max(1, round(np.log1p((end - start) * (growth - 1.0) / step) / np.log(growth)))
    sizes = growth ** np.arange(1, count + 1)
    return start + (end - start) * np.cumsum(sizes) / np.sum(sizes)


class RoughPassage:
    """Film and solid contact while rough surfaces pass, one time step after the other.

    In a time step the surfaces travel from one of the even nodes to the next at the entrainment
    speed, so a wave that moves as fast keeps its height and phase. What the pressure drives is
    taken mostly at the end of the step, by as little as damps the pressure; the scheme is of second
    order in time.

    Parameters
    ----------
    profile : FilmProfile
        The film of smooth rollers, from which the passage begins.
    step : float
        Distance of the even nodes over the half-width, and the time step.

    Attributes
    ----------
    pressure : numpy.ndarray, shape (n,)
        Pressure of the oil at the nodes, over Hertz' maximum pressure.
    contact_pressure, gap : numpy.ndarray, shape (n - 1,)
        Pressure of solid contact and scaled gap midway between the nodes.
    """

    def __init__(self, profile: FilmProfile, step: float) -> None:
        smooth = on_nodes(profile, passage_nodes(profile, step))
        self._discrete = DiscreteContact(smooth.contact, smooth.nodes)
        self._offset, self._step = smooth.offset, step
        self._late = 0.5 * (1.0 + min(step / _DAMPING, 1.0))
        self._closed = CLOSED * profile.central_gap
        # Of the pressure in a cell, half acts at either node.
        by_node = self._discrete.deflection
        self._by_cell = 0.5 * (by_node[:, 1:] + by_node[:, :-1])
        self._smooth = self.pressure = smooth.pressure
        self.contact_pressure = np.zeros(smooth.nodes.size - 1)
        self._flow = self._discrete.flow(smooth.pressure, smooth.offset)
        self.gap = self._flow.gap

    @property
    def position(self) -> Array:
        """Positions midway between the nodes, over the half-width."""
        return self._discrete.middle

    @property
    def spacing(self) -> Array:
        """Distances of the nodes, over the half-width."""
        return self._discrete.step

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
            With the pressure's last change.
        """
        had = self._balance(_drag(self._flow), self._flow.pressure_flow, 1.0 - self._late, -1.0)
        state = self._first_guess()
        touching = state[2] > 0.0
        for _ in range(_MOST):
            state, change = self._newton(had, heights, touching, state)
            gap = self._gap(heights, *state)
            # Complementary: a closed gap under pressure, or an open one without.
            again = state[2] + self._closed - gap > 0.0
            solved = change < _ENOUGH and np.array_equal(again, touching)
            if solved or not np.isfinite(change):
                break
            touching = again
        if not solved:
            raise ConvergenceError(
                f"{self._discrete.contact.name}: roughness that passes did not converge in a time "
                f"step: the pressure changes by {change:.1g}"
            )
        self.pressure, self._offset, self.contact_pressure = state
        self._flow = self._flow_through(gap, heights, *state)
        self.gap = self._flow.gap

    def _first_guess(self):
        """Pressure, offset and contact pressure: what roughness does to them travels with it."""
        pressure, solid = self._smooth.copy(), np.zeros_like(self.contact_pressure)
        pressure[1:] += (self.pressure - self._smooth)[:-1]
        solid[1:] = self.contact_pressure[:-1]
        return np.maximum(pressure, 0.0), self._offset, solid

    def _gap(self, heights, pressure, offset, solid):
        """Gap midway between the nodes, which may be less than closed before it has converged."""
        return self._discrete.gap(pressure, offset - heights) + self._by_cell @ solid

    def _flow_through(self, gap, heights, pressure, offset, solid):
        """Flow through a gap, closed where it is less than that."""
        opened = np.maximum(gap, self._closed) - gap
        return self._discrete.flow(pressure, offset - heights + self._by_cell @ solid + opened)

    def _balance(self, drag, driven, part, stored=1.0):
        """Oil that leaves a node less what enters, by a part of the driven flow, and is stored."""
        squeeze = stored * 0.5 * self._discrete.weight[1:-1] / self._step
        storing = (squeeze * (drag[1:] + drag[:-1]).T).T
        return np.diff(0.5 * drag, axis=0) - np.diff(part * driven, axis=0) + storing

    def _newton(self, had, heights, touching, state):
        """Step of Newton's method for pressure, offset and contact pressure; the largest change.

        As in `lube.ehl.reynolds`, with a squeeze film of one time step. Nodes outside the film get
        no pressure of the oil, cells without contact none of the solids.
        """
        discrete, (pressure, offset, solid) = self._discrete, state
        gap = self._gap(heights, *state)
        flow = self._flow_through(gap, heights, *state)
        residual = had + self._balance(_drag(flow), flow.pressure_flow, self._late)
        by_gap = flow.drag_by_gap, flow.drag_by_gap - flow.by_gap
        dragged = discrete.drag_by_pressure(flow)
        driven = dragged - discrete.flux_by_pressure(flow)
        jacobian = self._balance(dragged, driven, self._late)
        inner = np.arange(pressure.size - 2)
        film = np.flatnonzero(pressure[1:-1] > residual / np.abs(jacobian[inner, inner + 1]))
        cells = np.flatnonzero(touching)

        def by_opening(opening):
            """Change of the balance as the gap opens, per column."""
            columns = ((each * opening.T).T for each in by_gap)
            return self._balance(*columns, self._late)[film]

        change, cell_change = -pressure, -solid
        change[film + 1], cell_change[cells] = 0.0, 0.0
        released = self._by_cell @ cell_change
        load = discrete.weight @ (pressure + change) + discrete.step @ (solid + cell_change)
        opened = discrete.deflection @ change + released
        right = -np.concatenate(
            [
                (residual + jacobian @ change)[film] + by_opening(released),
                [load - HERTZ_LOAD],
                (gap + opened - self._closed)[cells],
            ]
        )
        one, deflection = np.ones_like(gap), discrete.deflection[:, film + 1]
        matrix = np.block(
            [
                [
                    jacobian[np.ix_(film, film + 1)],
                    by_opening(one)[:, None],
                    by_opening(self._by_cell[:, cells]),
                ],
                [discrete.weight[film + 1], 0.0, discrete.step[cells]],
                [deflection[cells], one[cells, None], self._by_cell[np.ix_(cells, cells)]],
            ]
        )
        try:
            solution = np.linalg.solve(matrix, right)
        except np.linalg.LinAlgError:
            solution = np.full_like(right, np.nan)
        change[film + 1], cell_change[cells] = np.split(np.delete(solution, film.size), [film.size])
        largest = np.abs(np.append(change, cell_change)).max()
        part = _LARGEST / max(largest, _LARGEST)
        pressure = np.maximum(pressure + part * change, 0.0)
        offset += part * solution[film.size]
        return (pressure, offset, solid + part * cell_change), largest


@dataclass(frozen=True)
class PassedWave:
    """A wave that has passed through the contact for so long that the gap repeats itself.

    Attributes
    ----------
    position : numpy.ndarray, shape (n,)
        Positions over the half-width.
    transfer : numpy.ndarray of complex, shape (n,)
        Its part of the gap that has its wavelength and speed, over the undeformed wave, as of
        `lube.ehl.response.WaveResponse`.
    gap : numpy.ndarray, shape (steps, n)
        Scaled gap in the last period.
    oil_load_share : float
        Least share of the load that the oil carried in that time.
    """

    position: Array
    transfer: Array
    gap: Array
    oil_load_share: float


def pass_wave(
    profile: FilmProfile,
    wavelength: float,
    surface_speed: float,
    amplitude: float,
    nodes: int = 20,
) -> PassedWave:
    """Let a wave of the roughness of one surface pass through the contact.

    Parameters
    ----------
    profile : FilmProfile
        The film of smooth rollers.
    wavelength : float
        Over the half-width.
    surface_speed : float
        Speed of the wave over the entrainment speed, above 0.
    amplitude : float
        Over the central film.
    nodes : int, optional
        Nodes in a wavelength.

    Returns
    -------
    PassedWave
        The gap once the wave has grown to its height and passed the contact.

    Raises
    ------
    ConvergenceError
        If a time step is not solved.
    """
    step, wavenumber = wavelength / nodes, 2.0 * np.pi / wavelength
    passage = RoughPassage(profile, step)
    height = amplitude * profile.central_gap * resolved_part(wavelength / passage.spacing)
    period = round(nodes / surface_speed)
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


def _drag(flow):
    """Oil that the surfaces drag, or that is in the gap."""
    return flow.flux + flow.pressure_flow
