"""The simulated twin-disc rig: from the metal contact of its rollers to the logged voltage.

Its rollers are realisations that no simulation of the study uses: lines, or surfaces over the whole
length of the rollers. One pair runs all operating points, turn after turn, as on a real rig. If the
study says so, several pairs run one after the other, and the roughness drifts from revolution to
revolution.

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
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from functools import cache, partial

import numpy as np
import xarray as xr

from lube.contact.rough_pair import RoughPair, drawn
from lube.contact.surface_revolution import revolution_contact
from lube.contact.windows import study_windows
from lube.grid.discretise import revolution, speed_ratios
from lube.grid.operating_points import surface_speeds
from lube.kernels.circuit import sampled_voltage
from lube.physics.electrical import contact_resistance, film_capacitance
from lube.study.line_spec import LineSpec
from lube.study.rig_settings import Rig
from lube.study.study import Study
from lube.types import Array, Pair, Ratios

log = logging.getLogger(__name__)

LONGEST_STEP = 0.25
"""Longest time in which the circuit is taken to change little, over the filter's time constant."""
MOST_PARTS = 32
"""Most parts of a time step, for the sake of memory where the filter is far faster."""
TOGETHER = 16
"""Number of operating points whose contact of lines at all time steps is in memory at once."""
_MOTION = "entrainment_speed", "slide_to_roll_ratio"


def simulated_revolutions(
    study: Study, points: xr.Dataset, threads: int | None = None
) -> Iterator[tuple[int, int, "Revolution"]]:
    """Run all pairs of the rig's rollers, each at all operating points.

    Parameters
    ----------
    study : Study
        Its rig, the rig's rollers, boundary layer, resistivity and seed.
    points : xarray.Dataset
        Over operating_point, from `lube.grid.operating_points.operating_points`; all of one
        slide-to-roll ratio.
    threads : int, optional
        Threads that draw surfaces; they do not change the results.

    Yields
    ------
    pair : int
        Index of the pair of rollers.
    number : int
        Index of the operating point.
    revolution : Revolution
        The next revolution of this pair at this point.
    """
    of_pairs = np.reshape(study.rig_realisations, (study.rig.pairs, -1)).tolist()
    count = points.sizes["operating_point"]
    each = [points.isel(operating_point=number) for number in range(count)]
    speeds = [[point[name].item() for name in _MOTION] for point in each]
    for pair, numbers in enumerate(of_pairs):
        if study.rig.has_surfaces:
            runs = _surface_runs(study, points, numbers[0], threads)
        else:
            runs = _line_runs(study, points, numbers)
        for begin, step, turns in runs:
            for turn, contacts in enumerate(turns):
                for number, contact in enumerate(contacts, begin):
                    seed = (study.seed, numbers[0], number + 1, turn)
                    time_step = step / max(surface_speeds(*speeds[number]))
                    yield pair, number, recorded(contact, each[number], study, seed, time_step)
            log.info("simulated rig: pair %d, %d operating points", pair + 1, number + 1)


def _surface_runs(study, points, number, threads):
    """As `_line_runs`, of surfaces at all operating points."""
    spec = study.line_spec
    lengths = revolution_contact(RoughPair.of(study), points, number, threads)
    steps = lengths.shape[1]
    parts = (lengths[:, : max(round(part * steps), 1)] for part in _parts(study))
    turns = ((whole_points(each, spec) for each in part) for part in parts)
    yield 0, spec.points[0] * spec.spacing / steps, turns


def whole_points(length: Array, spec: LineSpec) -> Array:
    """Lengths of contact, m, as whole grid points of the lines, int32, one at least in contact."""
    return np.maximum(np.rint(length / spec.spacing), length > 0.0).astype(np.int32)


def _parts(study):
    """Part of each turn that the rig runs: only the last may be less than 1."""
    return np.minimum(study.rig.revolutions - np.arange(study.rig.turns), 1.0)


def _line_runs(study, points, numbers):
    """Yield the first of some operating points, the way in a time step, m, and turns of lines."""
    drawn_once = cache(partial(drawn, study))
    for begin in range(0, points.sizes["operating_point"], TOGETHER):
        some = points.isel(operating_point=slice(begin, begin + TOGETHER))
        yield begin, study.line_spec.spacing, _turns(study, some, map(drawn_once, numbers))


def _turns(study, points, pairs):
    """Grid points in contact at all time steps of each turn, at some operating points."""
    slip, windows = points["slide_to_roll_ratio"][0].item(), study_windows(study, points)
    ratios = speed_ratios(slip)
    for turn, pair in enumerate(drifting_rollers(study, pairs)):
        steps = revolution(pair, ratios)
        if not turn or not repeats(study, ratios):
            contacts = windows.trace(pair, slip, turn * steps)
        yield contacts[:, : max(round(_parts(study)[turn] * steps), 1)]


def drifting_rollers(study: Study, pairs: Iterable[Pair]) -> Iterator[Pair]:
    """Yield a pair of rollers, whose roughness may drift, for each of its revolutions.

    Parameters
    ----------
    study : Study
        Its rig.
    pairs : iterable of tuple of numpy.ndarray
        The lines of this pair, and new ones for each further revolution if the roughness drifts.

    Yields
    ------
    tuple of numpy.ndarray
        The two lines, int32 height steps.
    """
    drift, pairs = study.rig.drift, iter(pairs)
    kept, renewed = math.sqrt(1.0 - drift), math.sqrt(drift)
    pair = next(pairs)
    for turn in range(study.rig.turns):
        if turn and drift > 0.0:  # this fraction of the variance of the heights is new
            both = zip(pair, next(pairs), strict=True)
            pair = tuple(np.rint(kept * old + renewed * new).astype(np.int32) for old, new in both)
        yield pair


def recorded(
    contact: Array, point: xr.Dataset, study: Study, seed: tuple[int, ...], time_step: float
) -> "Revolution":
    """Take contact at an operating point for what the rig records.

    Parameters
    ----------
    contact : numpy.ndarray
        Shape (T,), int32, length of contact at each time step, grid points of the lines.
    point : xarray.Dataset
        The operating point.
    study : Study
        Its rollers, oil between them and resistivity.
    seed : tuple of int
        Seed of the noise.
    time_step : float
        Time between two steps, s.

    Returns
    -------
    Revolution
        Contact with the circuit that it closes.
    """
    film, half_width = (point[name].item() for name in ("film_thickness", "contact_half_width"))
    length, permittivity = study.rollers.length, study.rig.oil_permittivity
    capacitance = film_capacitance(film, half_width, length, permittivity)
    spot_resistance = study.resistivity / study.line_spec.spacing
    return Revolution(contact, time_step, spot_resistance, capacitance, seed)


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


@dataclass(frozen=True)
class Revolution:
    """One revolution of the simulated rig at one operating point.

    Attributes
    ----------
    contact : numpy.ndarray
        Shape (T,), int32, grid points in metal contact at each time step.
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
    time_step: float
    spot_resistance: float
    capacitance: float
    seed: tuple[int, ...]

    def voltage(self, rig: Rig) -> Array:
        r"""Log the revolution with a rig's circuit.

        The noise has the same seed for every rig, so it differs between rigs by a factor only.

        With :math:`w` points in contact, conductance :math:`G = 1 / R_c + 1 / R_{leak}` and
        :math:`R = R_s + R_l`, the voltage over the gap approaches

        .. math:: u_\infty = \frac{U}{1 + R G}

        and in a time step the distance to this value decreases by the factor
        :math:`\exp(-\Delta t (G + 1 / R) / C)`. Long time steps are divided, so that the filter
        follows what happens within them.

        Parameters
        ----------
        rig : Rig
            Circuit, amplifier and sampling.

        Returns
        -------
        numpy.ndarray
            Shape (samples,), float64, V, whole steps of the converter.
        """
        limit, rate = rig.amplifier_range, 2.0 * np.pi * rig.bandwidth
        parts = min(max(math.ceil(self.time_step * rate / LONGEST_STEP), 1), MOST_PARTS)
        contact, time_step = np.repeat(self.contact, parts), self.time_step / parts
        points = np.arange(contact.max() + 1)
        feed = rig.series_resistance + rig.lead_resistance
        conductance = 1.0 / contact_resistance(points, self.spot_resistance)
        conductance += 1.0 / rig.leak_resistance
        targets = rig.bias_voltage / (1.0 + feed * conductance)
        decays = np.exp(-time_step * (conductance + 1.0 / feed) / self.capacitance)
        gain = rig.series_resistance / feed
        offset = rig.bias_voltage * (1.0 - gain)
        filter_decay = np.exp(-rate * time_step)
        steps_per_sample = 1.0 / (rig.sampling_rate * time_step)
        samples = int(self.contact.size * self.time_step * rig.sampling_rate) or 1
        voltage = sampled_voltage(
            contact, targets, decays, gain, offset, limit, filter_decay, steps_per_sample, samples
        )
        generator = np.random.default_rng(self.seed)
        voltage += rig.noise * generator.standard_normal(voltage.size, np.float32)
        steps = np.rint(voltage / rig.resolved_voltage)
        most = 2 ** (rig.resolution - 1)
        return np.clip(steps, -most, most - 1) * rig.resolved_voltage
