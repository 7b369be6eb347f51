r"""Discrete Reynolds equation of a line contact, and one step towards its solution.

The scaled mass flux between two nodes is the flow that the surfaces drag along less the flow that
the pressure gradient drives,

.. math::

    Q = \bar\rho H - \frac{\bar\rho H^3}{\bar\eta \lambda} \frac{dP}{dX}, \qquad
    \lambda = \frac{12 \eta_0 v R^{*2}}{a^3 p_H}

with density and viscosity over those at ambient pressure. The gap is evaluated midway between the
nodes, where the flux is, so that neither upwinding nor smoothing is needed. The viscosity between
two nodes is taken as exponential in the pressure, for which the flux is exact (Scharfetter and
Gummel's scheme); this keeps the steep pressure spike at the outlet free of oscillations.

An oscillation of the pressure from node to node does not change the gap midway. Where the oil is
almost solid it drives no oil either, so nothing would determine it. A flow along the fifth
difference of the pressure, 0.0025 of it times a guess of the film, damps the oscillation. For a
smooth pressure this flow falls with the fifth power of the cells' size.
"""

from dataclasses import dataclass

import numpy as np

from lube.ehl.deflection import deflection_matrix
from lube.types import Array

HERTZ_LOAD = np.pi / 2.0
"""Integral of P over X of Hertz' pressure: the load."""
_DAMPING = 0.0025
"""Flow that damps oscillations of the pressure, over the film and the fifth difference of P."""


@dataclass(frozen=True)
class Flow:
    """Mass flux between the nodes, and its derivatives.

    Attributes
    ----------
    gap : numpy.ndarray, shape (n - 1,)
        H midway between the nodes.
    flux, pressure_flow : numpy.ndarray, shape (n - 1,)
        Mass flux Q, and the flow driven by pressure, with that which damps it; subtracted in Q.
    conductance : numpy.ndarray, shape (n - 1,)
        Flow driven by pressure over the difference of pressure.
    by_gap : numpy.ndarray, shape (n - 1,)
        Derivative of Q with respect to H.
    by_left, by_right : numpy.ndarray, shape (n - 1,)
        Derivatives of Q with respect to P at the left and at the right node, at constant gap.
    drag_by_gap, drag_by_node : numpy.ndarray, shape (n - 1,)
        Derivatives of the dragged flow with respect to H and to P at either node.
    """

    gap: Array
    flux: Array
    pressure_flow: Array
    conductance: Array
    by_gap: Array
    by_left: Array
    by_right: Array
    drag_by_gap: Array
    drag_by_node: Array


class DiscreteContact:
    """Reynolds' equation on a mesh.

    Parameters
    ----------
    contact : lube.ehl.line_contact.LineContact
        The contact.
    nodes : numpy.ndarray, shape (n,)
        Positions X of the nodes, rising.
    across : float, optional
        As in `lube.ehl.deflection.deflection_matrix`, for the deflection.
    is_damped : bool, optional
        Whether oscillations of the pressure are damped. Those of roughness that a coarse mesh
        hardly resolves would be, too.

    Attributes
    ----------
    damping : numpy.ndarray, shape (n - 1, n)
        Flow between the nodes that damps oscillations of the pressure, by the pressures.
    """

    def __init__(self, contact, nodes, across=0.0, is_damped=True):
        self.contact, self.nodes = contact, nodes
        self.step = np.diff(nodes)
        self.middle = 0.5 * (nodes[1:] + nodes[:-1])
        self.deflection = deflection_matrix(self.middle, nodes, across)
        # Weights of the trapezoidal rule.
        self.weight = 0.5 * (np.append(self.step, 0.0) + np.append(0.0, self.step))
        self.damping = is_damped * _DAMPING * contact.film_guess * _fifth_differences(nodes)

    def gap(self, pressure: Array, offset: float) -> Array:
        """Evaluate the scaled gap H midway between the nodes."""
        return offset + 0.5 * self.middle**2 + self.deflection @ pressure

    def flow(self, pressure: Array, offset: float) -> Flow:
        """Evaluate the mass flux between the nodes at some pressures P, shape (n,), and offset."""
        return self.flow_through(self.gap(pressure, offset), pressure)

    def flow_through(self, gap: Array, pressure: Array) -> Flow:
        """Evaluate the mass flux through a gap H, shape (n - 1,), at some pressures P."""
        density, density_slope = self.contact.density(0.5 * (pressure[1:] + pressure[:-1]))
        logarithm, log_slope = self.contact.log_viscosity(pressure)
        factor, factor_slope = _exponential_fit(0.5 * np.diff(logarithm))
        fluidity = np.exp(-0.5 * (logarithm[1:] + logarithm[:-1])) * factor
        conductance = density * gap**3 * fluidity / (self.contact.flow_number * self.step)
        driven, damping = conductance * np.diff(pressure), self.damping @ pressure
        by_density = 0.5 * density_slope * (gap - driven / density)
        return Flow(
            gap=gap,
            flux=density * gap - driven - damping,
            pressure_flow=driven + damping,
            conductance=conductance,
            by_gap=density - 3.0 * driven / gap,
            by_left=by_density + conductance + 0.5 * driven * (1 + factor_slope) * log_slope[:-1],
            by_right=by_density - conductance + 0.5 * driven * (1 - factor_slope) * log_slope[1:],
            drag_by_gap=density,
            drag_by_node=0.5 * density_slope * gap,
        )

    def newton_step(self, pressure, flow, settling_time):
        """Take one step of Newton's method towards the film after a settling time.

        The oil that leaves a node is the oil that enters it, less the oil that fills the widening
        gap in that time (the squeeze film); with an infinite time no oil does. A node is either in
        the film, where this holds, or beyond it, where the pressure is zero: the complementarity
        condition of cavitation, solved by Newton's method too.

        Returns
        -------
        tuple
            Changes of the pressures and of the offset; NaN if the equations are singular.
        """
        jacobian = np.diff(self.flux_by_pressure(flow), axis=0)
        by_offset, residual = np.diff(flow.by_gap), np.diff(flow.flux)
        if np.isfinite(settling_time):
            squeeze = 0.5 * self.weight[1:-1] / settling_time
            drag = self.drag_by_pressure(flow)
            jacobian += squeeze[:, None] * (drag[1:] + drag[:-1])
            by_offset += squeeze * (flow.drag_by_gap[1:] + flow.drag_by_gap[:-1])
        scale = np.abs(np.diagonal(jacobian, 1))
        film = np.flatnonzero(pressure[1:-1] > residual / scale)
        change = -pressure
        change[film + 1] = 0.0
        matrix = np.zeros((film.size + 1, film.size + 1))
        matrix[:-1, :-1] = jacobian[np.ix_(film, film + 1)]
        matrix[:-1, -1], matrix[-1, :-1] = by_offset[film], self.weight[film + 1]
        missing_load = HERTZ_LOAD - self.weight @ (pressure + change)
        right = np.append(-residual[film] - jacobian[film] @ change, missing_load)
        try:
            solution = np.linalg.solve(matrix, right)
        except np.linalg.LinAlgError:
            solution = np.full_like(right, np.nan)
        change[film + 1] = solution[:-1]
        return change, solution[-1]

    def flux_by_pressure(self, flow: Flow) -> Array:
        """Differentiate the mass flux by the pressures at all nodes, shape (n - 1, n)."""
        return self._dense(flow.by_gap, flow.by_left, flow.by_right) - self.damping

    def drag_by_pressure(self, flow: Flow) -> Array:
        """Differentiate the dragged flow by the pressures at all nodes, shape (n - 1, n)."""
        return self._dense(flow.drag_by_gap, flow.drag_by_node, flow.drag_by_node)

    def _dense(self, by_gap, by_left, by_right):
        """Put together the derivatives of a flux by all pressures, shape (n - 1, n)."""
        matrix = by_gap[:, None] * self.deflection
        edge = np.arange(by_gap.size)
        matrix[edge, edge] += by_left
        matrix[edge, edge + 1] += by_right
        return matrix


def _fifth_differences(nodes):
    """Fifth differences midway between the nodes, by the values at six; 0 near both ends."""
    step, cells = np.diff(nodes), np.arange(2, nodes.size - 3)[:, None]
    six = cells + np.arange(-2, 4)
    distances = nodes[six][:, :, None] - nodes[six][:, None, :] + np.eye(6)
    differences = np.zeros((step.size, nodes.size))
    differences[cells, six] = 120.0 * step[cells] ** 5 / distances.prod(axis=2)
    return differences


def _exponential_fit(half):
    """sinh(u)/u at u = half the step of ln viscosity, and the slope of its logarithm."""
    small = np.abs(half) < 1e-2
    u = np.where(small, 1.0, half)
    factor = np.where(small, 1.0 + half**2 / 6.0 + half**4 / 120.0, np.sinh(u) / u)
    return factor, np.where(small, half / 3.0 - half**3 / 45.0, 1.0 / np.tanh(u) - 1.0 / u)
