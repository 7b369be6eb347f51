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

import numpy as np

from lube.ehl.line_contact import ConvergenceError, FilmProfile, on_nodes
from lube.ehl.reynolds import HERTZ_LOAD, DiscreteContact
from lube.types import Array

CLOSED = 1e-3
"""Gap at which the surfaces touch, over the central film of smooth rollers."""
REACH, BEYOND = 1.3, 0.15
"""How far the even nodes reach, in half-widths: into the inlet, and beyond the end of the film."""
_GROWTH = 1.08, 1.15
"""Growth of the cells towards the inlet, and behind the film."""
_DAMPING = 1.0
"""Half-widths that the surfaces travel while what rings in the pressure decays."""
_ENOUGH, _LARGEST, _MOST = 1e-7, 0.5, 300
"""Change of the pressure at which a time step is solved, the largest in a step of Newton's method, and
the most of these."""


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
        before = self._flow
        # What the roughness does to the pressure travels with it: a first guess.
        pressure, solid = self._smooth.copy(), np.zeros_like(self.contact_pressure)
        pressure[1:] += (self.pressure - self._smooth)[:-1]
        solid[1:] = self.contact_pressure[:-1]
        state, touching = (np.maximum(pressure, 0.0), self._offset, solid), solid > 0.0
        for _ in range(_MOST):
            raw = self._raw_gap(heights, *state)
            flow = self._flow_at(heights, raw, *state)
            state, change = self._newton(before, flow, raw, touching, state)
            gap = self._raw_gap(heights, *state)
            # Complementary: a closed gap under pressure, or none.
            again = state[2] + (self._closed - gap) > 0.0
            if change < _ENOUGH and np.array_equal(again, touching):
                break
            touching = again
        else:
            raise ConvergenceError(
                f"{self._discrete.contact.name}: a time step of roughness that "
                f"passes did not converge: the pressure changes by {change:.1g}"
            )
        self.pressure, self._offset, self.contact_pressure = state
        self._flow = self._flow_at(heights, gap, *state)
        self.gap = self._flow.gap

    def _raw_gap(self, heights, pressure, offset, solid):
        return self._discrete.gap(pressure, offset - heights) + self._by_cell @ solid

    def _flow_at(self, heights, raw, pressure, offset, solid):
        """Flow through the gap, which is not let closer than closed."""
        opened = np.maximum(raw, self._closed) - raw
        return self._discrete.flow(pressure, offset - heights + self._by_cell @ solid + opened)

    def _newton(self, before, flow, raw, touching, state):
        """Step of Newton's method for pressure, offset and contact pressure; the largest change."""
        discrete, (pressure, offset, solid) = self._discrete, state
        late = 0.5 * (1.0 + min(self._step / _DAMPING, 1.0))
        squeeze = 0.5 * discrete.weight[1:-1] / self._step

        def balance(drag, driven, part):
            """What leaves a node less what enters, and what is stored there."""
            leaving = np.diff(0.5 * drag, axis=0) - np.diff(part * driven, axis=0)
            return leaving, (squeeze * (drag[1:] + drag[:-1]).T).T

        def change_of(drag, driven):
            return sum(balance(drag, driven, late))

        leaves, stored = balance(flow.flux + flow.pressure_flow, flow.pressure_flow, late)
        left, had = balance(before.flux + before.pressure_flow, before.pressure_flow, 1.0 - late)
        residual = leaves + left + stored - had
        drag_by_gap = flow.drag_by_gap
        driven_by_gap = drag_by_gap - flow.by_gap
        dragged = discrete.drag_by_pressure(flow)
        jacobian = change_of(dragged, dragged - discrete.flux_by_pressure(flow))
        cells, inner = np.flatnonzero(touching), np.arange(pressure.size - 2)
        film = np.flatnonzero(pressure[1:-1] > residual / np.abs(jacobian[inner, inner + 1]))
        n, m = film.size, cells.size
        change, cell_change = -pressure, -solid
        change[film + 1], cell_change[cells] = 0.0, 0.0
        by_solid = self._by_cell[:, cells]
        matrix = np.zeros((n + 1 + m, n + 1 + m))
        matrix[:n, :n] = jacobian[np.ix_(film, film + 1)]
        matrix[:n, n] = change_of(drag_by_gap, driven_by_gap)[film]
        columns = drag_by_gap[:, None] * by_solid, driven_by_gap[:, None] * by_solid
        matrix[:n, n + 1 :] = change_of(*columns)[film]
        matrix[n, :n], matrix[n, n + 1 :] = discrete.weight[film + 1], discrete.step[cells]
        matrix[n + 1 :, :n] = discrete.deflection[np.ix_(cells, film + 1)]
        matrix[n + 1 :, n], matrix[n + 1 :, n + 1 :] = 1.0, by_solid[cells]
        solid_moved = self._by_cell @ cell_change
        moved = discrete.deflection @ change + solid_moved
        by_cells = change_of(drag_by_gap * solid_moved, driven_by_gap * solid_moved)
        load = discrete.weight @ (pressure + change) + discrete.step @ (solid + cell_change)
        right = -np.concatenate(
            [
                (residual + jacobian @ change + by_cells)[film],
                [load - HERTZ_LOAD],
                (raw + moved - self._closed)[cells],
            ]
        )
        solution = np.linalg.solve(matrix, right)
        change[film + 1], cell_change[cells] = solution[:n], solution[n + 1 :]
        largest = max(np.abs(change).max(), np.abs(cell_change).max())
        part = min(1.0, _LARGEST / largest)
        pressure = np.maximum(pressure + part * change, 0.0)
        return (pressure, offset + part * solution[n], solid + part * cell_change), largest
