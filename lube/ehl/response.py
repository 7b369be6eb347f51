r"""Linear response of the film to the roughness: what the oil does to waves of small amplitude.

A wave of the roughness of one surface moves through the contact with that surface, at :math:`c`
times the entrainment speed. In the scaled variables of `lube.ehl.reynolds` and the time
:math:`T = t v / a` it leaves small changes :math:`\hat p(X)` and :math:`\hat h(X)` of pressure and
gap, both times :math:`\exp(-i k c T)`, which satisfy Reynolds' equation about the steady film with
its squeeze term,

.. math::

    \frac{d\hat q}{dX} = i k c\, (\bar\rho \hat h + \bar\rho' H \hat p), \qquad
    \hat h = \hat h_0 - \frac{1}{\pi} \int \hat p \ln|X - X'|\, dX' + e^{ikX}, \qquad
    \int \hat p\, dX = 0

with the change :math:`\hat q` of the mass flux. The pressure does not change where the oil begins,
nor from the end of the film on, as the motion of that end is of second order. The load is fixed:
the rollers give way by :math:`\hat h_0`.

The crests of a wave on a rough surface may lie at an angle, and the wave is
:math:`\exp(i (k_x X + k_y Y))`. Then oil also flows along the rollers, with the conductance
:math:`\zeta = \bar\rho H^3 / (\bar\eta \lambda)`, and the load does not change:

.. math::

    \frac{d\hat q}{dX} + \zeta k_y^2 \hat p = i k_x c\, (\bar\rho \hat h + \bar\rho' H \hat p),
    \qquad
    \hat h = \frac{1}{\pi} \int \hat p\, K_0(|k_y| |X - X'|)\, dX' + e^{i k_x X}
"""

import functools

import numpy as np
import scipy

from lube.ehl.deflection import deflection_matrix
from lube.ehl.line_contact import FilmProfile, on_nodes, one_blas_thread
from lube.ehl.reynolds import DiscreteContact
from lube.types import Array

POINTS_A_WAVE = 16
"""Nodes per wavelength, where the gap is not wide."""
WIDE = 6.0
"""Gap, over the central film, beyond which the mesh need not resolve the wave: such a wide gap
builds up hardly any pressure."""
_GROWTH = 0.15
"""Growth of the cells per length in the wide gap."""
_LEAST, _ENOUGH = 3.0, 8.0
"""With fewer nodes per wavelength than the first number the wave is left out; with more than the
second it has its full amplitude."""


class WaveResponse:
    """Response of a film to waves of one wavelength.

    The film is solved for again, on nodes that resolve the wave.

    Parameters
    ----------
    profile : FilmProfile
        The steady film.
    wavelength : float
        Wavelength over the half-width.
    angle : float, optional
        Angle between rolling and the direction in which the wave runs, degrees, from 0 for crests
        along the rollers to 90 for ridges along rolling.

    Attributes
    ----------
    profile : FilmProfile
        The steady film, on these nodes.
    wavelength : float
        Wavelength over the half-width.

    Raises
    ------
    lube.ehl.line_contact.ConvergenceError
        If the film does not converge on these nodes.
    """

    def __init__(self, profile: FilmProfile, wavelength: float, angle: float = 0.0) -> None:
        self.profile = _resolving(profile, wavelength / POINTS_A_WAVE)
        self.wavelength, nodes = wavelength, self.profile.nodes
        wavenumber, angle = 2.0 * np.pi / wavelength, np.radians(angle)
        self._along, self._across = wavenumber * np.cos(angle), wavenumber * np.sin(angle)
        self._discrete = DiscreteContact(profile.contact, nodes, self._across)
        self._film = np.flatnonzero(self.profile.pressure[1:-1] > 0.0)
        flux = self._discrete.flux_by_pressure(self.profile.flow)
        drag = self._discrete.drag_by_pressure(self.profile.flow)
        self._by_pressure = flux[:, self._film + 1], drag[:, self._film + 1]

    def transfer(self, surface_speed: float, position: Array, fixed_load: bool = True) -> Array:
        r"""Transfer function of the wave.

        Parameters
        ----------
        surface_speed : float
            Speed :math:`c` of the wave over the entrainment speed: 1 in pure rolling.
        position : numpy.ndarray, shape (n,)
            Positions X over the half-width, in the contact or outside.
        fixed_load : bool, optional
            Whether the rollers give way so that the load stays constant. Otherwise their distance
            stays constant, as with rollers too heavy to follow the wave. A wave at an angle does
            not change the load, so the rollers stay where they are.

        Returns
        -------
        numpy.ndarray of complex, shape (n,)
            :math:`T_k(X) = \hat h(X) \exp(-i k_x X)`: the wave in the gap over the wave of the
            undeformed surface; 1 where the oil does not change it.

        Notes
        -----
        The mass flux and the oil stored between two nodes are taken as travelling with the surface,
        :math:`\exp(i k c X)`, within a cell. So a wave that the oil carries through the contact
        keeps its height and phase on any mesh, and only the effect of pressure is approximated.
        """
        discrete, flow, film = self._discrete, self.profile.flow, self._film
        wavenumber, across, middle = self._along, self._across, discrete.middle
        follows = fixed_load and not across
        phase = 1j * wavenumber * surface_speed * np.diff(self.profile.nodes) / 2.0
        # Oil stored on either side of a node, in half a cell each, times i k c.
        ahead, behind = 1.0 - np.exp(-phase[1:]), np.exp(phase[:-1]) - 1.0

        def balance(flux, storage):
            stored = (ahead * storage[1:].T + behind * storage[:-1].T).T
            return (np.diff(flux, axis=0) - stored)[film]

        matrix = np.zeros((film.size + 1, film.size + 1), complex)
        matrix[:-1, :-1] = balance(*self._by_pressure)
        through = across**2 * flow.conductance * discrete.step**2
        matrix[:-1, :-1] += np.diag(0.5 * (through[1:] + through[:-1])[film])
        matrix[:-1, -1] = balance(flow.by_gap, flow.drag_by_gap)
        matrix[-1] = np.append(discrete.weight[film + 1], 0.0) if follows else 0.0
        matrix[-1, -1] = 0.0 if follows else 1.0
        wave = resolved_part(self.wavelength / discrete.step) * np.exp(1j * wavenumber * middle)
        right = np.append(-balance(flow.by_gap * wave, flow.drag_by_gap * wave), 0.0)
        with one_blas_thread():
            change = np.linalg.solve(matrix, right)
            deflected = deflection_matrix(position, self.profile.nodes, across)
            deflection = deflected[:, film + 1] @ change[:-1]
        return 1.0 + (change[-1] + deflection) * np.exp(-1j * wavenumber * position)


def at_wavelengths(
    wanted: Array, wavelengths: Array, transfer: Array, position: Array, angle: float = 0.0
) -> Array:
    """Interpolate a transfer function to other wavelengths.

    Its difference from 1 is interpolated by cubic splines over the logarithm of the wavelength.
    Outside the contact the phase is taken from the contact's edge: there the change of the gap
    hardly varies with the position, but the phase of the wave does.

    Parameters
    ----------
    wanted : numpy.ndarray, shape (m,)
        Other wavelengths over the half-width.
    wavelengths : numpy.ndarray, shape (n,)
        Wavelengths over the half-width, falling.
    transfer : numpy.ndarray, shape (..., n, x)
        Transfer function at these wavelengths and some positions.
    position : numpy.ndarray, shape (x,)
        Positions over the half-width.
    angle : float, optional
        Angle between rolling and the direction of the waves, degrees.

    Returns
    -------
    numpy.ndarray, shape (..., m, x)
        Transfer function. Beyond the longest wave it is that of the longest, and beyond the
        shortest it is 1.
    """
    outside = 2j * np.pi * (position - np.clip(position, -1.0, 1.0)) * np.cos(np.radians(angle))
    change = (transfer - 1.0) * np.exp(outside / wavelengths[:, None])
    spline = scipy.interpolate.CubicSpline(np.log(wavelengths[::-1]), change[..., ::-1, :], axis=-2)
    inside = np.clip(wanted, wavelengths[-1], wavelengths[0])
    found = spline(np.log(inside)) * np.exp(-outside / wanted[:, None])
    return 1.0 + (wanted >= wavelengths[-1])[:, None] * found


@functools.lru_cache(maxsize=128)  # waves of one length at all angles need the same nodes
def _resolving(profile, step):
    """Solve for a film again, with more nodes where they are further apart than a step."""
    nodes, size = profile.nodes, np.diff(profile.nodes)
    middle, gap = profile.middle, profile.flow.gap
    wide = middle[(middle < 0.0) & (gap > WIDE * profile.central_gap)]
    low, high = wide[-1] if wide.size else nodes[0], nodes[profile.end + 1]
    largest = step + _GROWTH * np.maximum(0.0, np.maximum(low - middle, middle - high))
    counts = np.ceil(size / largest * (1.0 - 1e-9)).astype(int)
    places = np.arange(counts.sum() + 1)
    return on_nodes(profile, np.interp(places, np.append(0, np.cumsum(counts)), nodes))


def resolved_part(points: Array) -> Array:
    """Fraction of its amplitude with which a wave enters the calculation on a mesh.

    On too few nodes it would look like a longer wave.

    Parameters
    ----------
    points : numpy.ndarray
        Nodes per wavelength.

    Returns
    -------
    numpy.ndarray
        The fraction, from 0 to 1.
    """
    part = np.clip((points - _LEAST) / (_ENOUGH - _LEAST), 0.0, 1.0)
    return part * part * (3.0 - 2.0 * part)
