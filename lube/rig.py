"""The simulated rig: from the metallic contact of its own rollers to the voltage that it logs.

Its rollers are of realisations that no simulation uses, and each of its revolutions shows
another roughness, as if the rollers had been moved against one another in between.

A bias voltage drives a current through a series resistor, the leads and the contact. The film
around the contact is a capacitor, and some current leaks past it. An amplifier of finite range
looks at the voltage over leads and contact; what it gives is low-pass filtered, sampled, and
rounded to the steps of the converter.

    bias --[ series ]--+--[ leads ]--+-- contact --+
                       |             +-- leak -----+-- ground
                   amplifier         +-- film -----+
"""

import logging
from dataclasses import dataclass

import numpy as np

from lube.kernels.circuit import sampled_voltage
from lube.kernels.strips import strip_trace
from lube.points import OperatingPoint
from lube.resistance import contact_resistance, film_capacitance
from lube.steps import layer_factor_of, line_pair, revolution, speed_ratios, whole_numbers

log = logging.getLogger(__name__)

TOGETHER = 16
"""Operating points whose contact at all time steps is held at once: a matter of memory."""


class SimulatedRig:
    """A rig that runs its own rollers at some operating points.

    Parameters
    ----------
    lines : xarray.Dataset
        A ``roughness_batch`` dataset of the rig's own realisations, one a revolution.
    study : Study
        Its boundary layer, rollers, resistivity and seed.
    points : list of OperatingPoint
        From `lube.points.operating_points`; all of one slide-to-roll ratio.
    """

    def __init__(self, lines, study, points):
        self._lines, self._study, self._points = lines, study, points

    def revolutions(self):
        """Run all revolutions, each at all operating points.

        Yields
        ------
        number : int
            Which of the operating points.
        revolution : Revolution
            What happens there.
        """
        realisations = self._lines["realisation"].values.tolist()
        for count, realisation in enumerate(realisations, start=1):
            for number, contact in enumerate(self._contacts(realisation)):
                yield number, self._revolution(contact, realisation, number)
            log.info("simulated rig: revolution %d of %d", count, len(realisations))

    def _contacts(self, realisation):
        """Points in metallic contact at all time steps of one revolution, place by place."""
        first = self._points[0]
        pair, ratios = line_pair(self._lines, realisation), speed_ratios(first.slide_to_roll_ratio)
        steps = revolution(pair, ratios)
        factor = layer_factor_of(self._lines, first.reduced_modulus, self._study.boundary_layer)
        for begin in range(0, len(self._points), TOGETHER):
            some = self._points[begin : begin + TOGETHER]
            films, half_windows = whole_numbers(
                [point.film_thickness for point in some],
                [point.contact_half_width for point in some],
                self._lines,
            )
            yield from strip_trace(*pair, ratios, steps, films, half_windows, factor)

    def _revolution(self, contact, realisation, number):
        point, spacing = self._points[number], self._lines.attrs["spacing"]
        return Revolution(
            contact,
            point,
            time_step=spacing / point.faster_speed,
            spot_resistance=self._study.resistivity / spacing,
            length=self._study.rollers.length,
            seed=(self._study.seed, realisation, number + 1),
        )


@dataclass(frozen=True)
class Revolution:
    """One revolution of a simulated rig at one operating point.

    Attributes
    ----------
    contact : numpy.ndarray
        Shape (T,), int32, points in metallic contact at each time step.
    point : OperatingPoint
        The operating point.
    time_step : float
        Time between two steps, s.
    spot_resistance : float
        Contact resistance of one point, rho / dx, ohm (paper, Eq. 1).
    length : float
        Length L' of the line contact, m.
    seed : tuple of int
        What the noise hangs on.
    """

    contact: np.ndarray
    point: OperatingPoint
    time_step: float
    spot_resistance: float
    length: float
    seed: tuple

    def voltage(self, rig):
        """Log the revolution with a rig's circuit; all have the same noise but for its size.

        Parameters
        ----------
        rig : Rig
            Circuit, amplifier and sampling.

        Returns
        -------
        numpy.ndarray
            Shape (samples,), V.
        """
        capacitance = film_capacitance(
            self.point.film_thickness,
            self.point.contact_half_width,
            self.length,
            rig.oil_permittivity,
        )
        generator = np.random.default_rng(np.random.SeedSequence(self.seed))
        return logged_voltage(
            self.contact, self.time_step, self.spot_resistance, capacitance, rig, generator
        )


def logged_voltage(contact, time_step, spot_resistance, capacitance, rig, generator):
    """Record that the rig logs of a contact that is known at every time step.

    Parameters
    ----------
    contact : numpy.ndarray
        Shape (T,), points in metallic contact at each time step.
    time_step : float
        Time between two steps, s.
    spot_resistance : float
        Contact resistance of one point, rho / dx, ohm (paper, Eq. 1).
    capacitance : float
        Of the film, F.
    rig : Rig
        Circuit, amplifier and sampling.
    generator : numpy.random.Generator
        Source of the noise.

    Returns
    -------
    numpy.ndarray
        Shape (samples,), float64, V, whole steps of the converter.
    """
    points = np.arange(contact.max() + 1)
    feed = rig.series_resistance + rig.lead_resistance
    conductance = 1.0 / contact_resistance(points, spot_resistance) + 1.0 / rig.leak_resistance
    targets = rig.bias_voltage / (1.0 + feed * conductance)
    memories = np.exp(-time_step * (conductance + 1.0 / feed) / capacitance)
    gain = rig.series_resistance / feed
    voltage = sampled_voltage(
        contact,
        targets,
        memories,
        gain,
        rig.bias_voltage * (1.0 - gain),
        rig.amplifier_range,
        np.exp(-2.0 * np.pi * rig.bandwidth * time_step),
        1.0 / (rig.sampling_rate * time_step),
        int(contact.size * time_step * rig.sampling_rate) or 1,
    )
    voltage += rig.noise * generator.standard_normal(voltage.size, np.float32)
    steps = np.rint(voltage / rig.resolved_voltage)
    most = 2 ** (rig.resolution - 1)
    return np.clip(steps, -most, most - 1) * rig.resolved_voltage
