"""The simulated twin-disc rig: from the metal contact of its rollers to the logged voltage.

Its rollers are realisations that no simulation of the study uses. One pair runs all operating
points, turn after turn, as on a real rig. If the study says so, several pairs follow each other,
and the roughness drifts from revolution to revolution.

A bias voltage drives a current through a series resistor, the leads and the contact. The film
around the contact is a capacitor, and a leak is parallel to it. An amplifier of finite range
measures the voltage over leads and contact; its output is low-pass filtered, sampled, and rounded
to the steps of the converter.

    bias --[ series ]--+--[ leads ]--+-- contact --+
                       |             +-- leak -----+-- ground
                   amplifier         +-- film -----+
"""

import logging
import math
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
import xarray as xr

from lube.contact.windows import ContactWindows
from lube.grid.discretise import LineGrid, line_pair, revolution, speed_ratios
from lube.grid.operating_points import OperatingPoint
from lube.kernels.circuit import sampled_voltage
from lube.physics.electrical import contact_resistance, film_capacitance
from lube.study.rig_settings import Rig
from lube.study.study import Study
from lube.types import Array, Ratios

log = logging.getLogger(__name__)

TOGETHER = 16
"""Operating points whose contact at all time steps is in memory at once."""


class SimulatedRig:
    """A twin-disc rig that runs its own rollers at given operating points.

    Parameters
    ----------
    lines : xarray.Dataset
        A ``roughness_batch`` dataset of `Study.rig_realisations`.
    study : Study
        Its rig, boundary layer, rollers, resistivity and seed.
    points : list of OperatingPoint
        From `lube.grid.operating_points.operating_points`; all of one slide-to-roll ratio.
    """

    def __init__(self, lines: xr.Dataset, study: Study, points: list[OperatingPoint]) -> None:
        self._lines, self._study, self._points = lines, study, points
        self._slip = points[0].slide_to_roll_ratio
        self._ratios = speed_ratios(self._slip)

    def revolutions(self) -> Iterator[tuple[int, int, "Revolution"]]:
        """Run all pairs of rollers, each at all operating points.

        Yields
        ------
        pair : int
            Index of the pair of rollers.
        number : int
            Index of the operating point.
        revolution : Revolution
            The next revolution of this pair at this point.
        """
        rig, realisations = self._study.rig, self._lines["realisation"].values
        for pair, drawn in enumerate(np.split(realisations, rig.pairs)):
            for begin in range(0, len(self._points), TOGETHER):
                numbers = range(begin, min(begin + TOGETHER, len(self._points)))
                for turn, contacts in enumerate(self._turns(drawn, numbers)):
                    for number, contact in zip(numbers, contacts, strict=True):
                        seed = (self._study.seed, int(drawn[0]), number + 1, turn)
                        yield pair, number, self._revolution(contact, number, seed)
                log.info("simulated rig: pair %d, %d operating points", pair + 1, numbers.stop)

    def _turns(self, drawn, numbers):
        """Grid points in contact at all time steps of each turn, at some operating points."""
        rig, windows = self._study.rig, self._windows(numbers)
        for turn, pair in enumerate(self._rollers(drawn)):
            steps = revolution(pair, self._ratios)
            if not turn or not repeats(self._study, self._ratios):
                contacts = windows.trace(pair, self._slip, turn * steps)
            part = min(rig.revolutions - turn, 1.0)
            yield contacts[:, : max(round(part * steps), 1)]

    def _rollers(self, drawn):
        """Lines of a pair of rollers in each of its revolutions."""
        drift = self._study.rig.drift
        pair = line_pair(self._lines, drawn[0])
        for turn in range(math.ceil(self._study.rig.revolutions)):
            if turn and drift > 0.0:
                pair = tuple(
                    _renewed(old, new, drift)
                    for old, new in zip(pair, line_pair(self._lines, drawn[turn]), strict=True)
                )
            yield pair

    def _windows(self, numbers):
        """Contact windows of some operating points."""
        rows = [self._points[number].row for number in numbers]
        film = xr.concat(rows, "operating_point", coords="minimal", compat="override", join="exact")
        alike = ["reduced_modulus", "reduced_radius", "composite_rms_roughness"]
        film = film.assign(rows[0][alike])
        layer, gap = self._study.boundary_layer, self._study.gap
        return ContactWindows(LineGrid.of(self._lines), film, layer, gap)

    def _revolution(self, contact, number, seed):
        study, point, spacing = self._study, self._points[number], self._lines.attrs["spacing"]
        capacitance = film_capacitance(
            point.film_thickness,
            point.contact_half_width,
            study.rollers.length,
            study.rig.oil_permittivity,
        )
        time_step, resistance = spacing / point.faster_speed, study.resistivity / spacing
        return Revolution(contact, point, time_step, resistance, capacitance, seed)


def repeats(study: Study, ratios: Ratios) -> bool:
    """Whether each revolution is the same as the one before, except for electrical noise.

    Parameters
    ----------
    study : Study
        Its lines and the drift of their roughness.
    ratios : tuple of float
        From `lube.grid.discretise.speed_ratios`.

    Returns
    -------
    bool
        True for equal rollers that roll without slip and do not drift.
    """
    first, second = study.line_spec.points
    return first == second and ratios[0] == ratios[1] and study.rig.drift == 0.0


def _renewed(line, other, drift):
    """Replace a share of a line's variance by that of another line; int32 height steps."""
    kept, new = math.sqrt(1.0 - drift), math.sqrt(drift)
    return np.rint(kept * line + new * other).astype(np.int32)


@dataclass(frozen=True)
class Revolution:
    """One revolution of the simulated rig at one operating point.

    Attributes
    ----------
    contact : numpy.ndarray
        Shape (T,), int32, grid points in metal contact at each time step.
    point : OperatingPoint
        The operating point.
    time_step : float
        Time between two steps, s.
    spot_resistance : float
        Contact resistance of one grid point, rho / dx, ohm (paper, Eq. 1).
    capacitance : float
        Capacitance C of the film, F.
    seed : tuple of int
        Seed of the noise.
    """

    contact: Array
    point: OperatingPoint
    time_step: float
    spot_resistance: float
    capacitance: float
    seed: tuple[int, ...]

    def voltage(self, rig: Rig) -> Array:
        r"""Log the revolution with a rig's circuit; the noise differs between rigs by a factor.

        With :math:`w` points in contact, conductance :math:`G = 1 / R_c + 1 / R_{leak}` and
        :math:`R = R_s + R_l`, the voltage over the gap approaches

        .. math:: u_\infty = \frac{U}{1 + R G}

        and in a time step the distance to it decreases by the factor
        :math:`\exp(-\Delta t (G + 1 / R) / C)`.

        Parameters
        ----------
        rig : Rig
            Circuit, amplifier and sampling.

        Returns
        -------
        numpy.ndarray
            Shape (samples,), float64, V, whole steps of the converter.
        """
        points = np.arange(self.contact.max() + 1)
        feed = rig.series_resistance + rig.lead_resistance
        conductance = 1.0 / contact_resistance(points, self.spot_resistance)
        conductance += 1.0 / rig.leak_resistance
        targets = rig.bias_voltage / (1.0 + feed * conductance)
        decays = np.exp(-self.time_step * (conductance + 1.0 / feed) / self.capacitance)
        gain = rig.series_resistance / feed
        voltage = sampled_voltage(
            self.contact,
            targets,
            decays,
            gain,
            rig.bias_voltage * (1.0 - gain),
            rig.amplifier_range,
            np.exp(-2.0 * np.pi * rig.bandwidth * self.time_step),
            1.0 / (rig.sampling_rate * self.time_step),
            int(self.contact.size * self.time_step * rig.sampling_rate) or 1,
        )
        generator = np.random.default_rng(self.seed)
        voltage += rig.noise * generator.standard_normal(voltage.size, np.float32)
        steps = np.rint(voltage / rig.resolved_voltage)
        most = 2 ** (rig.resolution - 1)
        return np.clip(steps, -most, most - 1) * rig.resolved_voltage
