"""The experiment stage: the share of time that the rig's resistance lies below a threshold.

Records are measured ones, or those of a simulated rig, never both: a file says which in its
coordinate ``origin``. Each record stands at its own operating conditions; the level of the
study that it is near is a label beside them.
"""

import logging
from dataclasses import dataclass, replace

import numpy as np
import xarray as xr

from lube.errors import DataError, LubeError
from lube.grid.discretise import speed_ratios
from lube.grid.levels import level_near
from lube.grid.operating_points import operating_points, surface_speeds
from lube.physics.electrical import resistance_from_voltage
from lube.recordings.reader import open_recording
from lube.rig.contact_share import folded_counts, record_counter, share_interval
from lube.rig.simulator import SimulatedRig
from lube.rig.study_shares import levels_named, limited
from lube.schema import LIMITS, label
from lube.statistics.folding import CLEAR, PHASES, SPAN, fold
from lube.statistics.one_pair import distinct_alignments
from lube.study.lubricant_record import check_temperatures

log = logging.getLogger(__name__)

SATURATED = 0.001
"""Share of a record's samples at the amplifier's limits from which on it is refused."""

TRACE_SAMPLES = 4096
"""Samples kept of the first revolution of a record: of a longer one the extremes of stretches."""

LEVELS = ("force", "speed", "temperature")


@dataclass(frozen=True)
class Conditions:
    """Operating conditions of a record.

    Attributes
    ----------
    force, speed, temperature : float
        N, rpm and degC.
    lubricant : str
        Name of the lubricant.
    slide_to_roll_ratio : float
        (v1 - v2) / v, with the surface speeds and their mean v.
    pair : str
        Label of the pair of rollers.
    tolerances : dict of str to float
        How far force, speed and temperature may be from a level, N, rpm and K.
    """

    force: float
    speed: float
    temperature: float
    lubricant: str
    slide_to_roll_ratio: float
    pair: str
    tolerances: dict


def simulated_experiment(lines, film, study):
    """Let a simulated rig record all operating points, and evaluate what it logs.

    The films are those of the film table's first formula.

    Parameters
    ----------
    lines : xarray.Dataset
        A ``roughness_batch`` dataset of the rig's own realisations, `Study.rig_realisations`.
    film : xarray.Dataset
        A ``film`` dataset.
    study : Study
        Its rig, evaluation of records, boundary layer, rollers and seed.

    Returns
    -------
    xarray.Dataset
        The ``experiment`` file of `lube.schema`, of the origin ``simulated``.
    """
    points = operating_points(film.isel(film_formula=0), study.rig_slip)
    records = {
        (pair, number): _Record(_conditions_of(point, pair, study), study)
        for pair in range(study.rig.pairs)
        for number, point in enumerate(points)
    }
    for pair, number, revolution in SimulatedRig(lines, study, points).revolutions():
        records[pair, number].add_revolution(revolution)
    rows = [record.row(_name(record.conditions, study)) for record in records.values()]
    return _experiment(rows, study, "simulated")


def measured_experiment(manifest, study):
    """Evaluate measured records, as far as they can be used.

    Parameters
    ----------
    manifest : Manifest
        From `lube.recordings.manifest.read_manifest`.
    study : Study
        Its rig, which tells a voltage's resistance, its rollers, and its evaluation of records.

    Returns
    -------
    xarray.Dataset
        The ``experiment`` file of `lube.schema`. Its attribute ``refused`` names what could not
        be used and why, ``remarks`` what was corrected, a line each.

    Raises
    ------
    DataError
        If no record can be used.
    """
    rows, refused, remarks = [], list(manifest.refused), []
    for entry in manifest.entries:
        try:
            rows.append(_measured_row(entry, study, remarks))
        except LubeError as error:
            refused.append(str(error))
    for line in refused:
        log.warning("Refused: %s", line)
    for line in remarks:
        log.warning("%s", line)
    if not rows:
        raise DataError(f"no record can be used; the first: {refused[0] if refused else 'none'}")
    return _experiment(rows, study, manifest.origin, refused, remarks)


def _conditions_of(point, pair, study):
    """Conditions of a simulated record: exactly those of its operating point."""
    return Conditions(**point.levels, pair=str(pair + 1), tolerances=_tolerances(point, study))


def _tolerances(conditions, study, entry=None):
    """How far conditions may be from a level, N, rpm and K: as a manifest says, or the study."""
    of_study = {
        "force": study.experiment.force_tolerance * conditions.force,
        "speed": study.experiment.speed_tolerance * conditions.speed,
        "temperature": study.experiment.temperature_tolerance,
    }
    given = {name: entry and getattr(entry, f"{name}_tolerance") for name in LEVELS}
    return {name: given[name] or of_study[name] for name in LEVELS}


def _name(conditions, study):
    """Name of a simulated record: its operating point, and its pair if there are several."""
    words = [levels_named({name: getattr(conditions, name) for name in LEVELS})]
    words += [conditions.lubricant] * (len(study.lubricants) > 1)
    words += [f"pair {conditions.pair}"] * (study.rig.pairs > 1)
    return ", ".join(words)


def _conditions(entry, study):
    """Conditions of a measured record, refused where the study's model says nothing of them."""
    slip = entry.slide_to_roll_ratio
    found = Conditions(
        **{name: getattr(entry, name) for name in LEVELS},
        lubricant=entry.lubricant or study.lubricants[0].name,
        slide_to_roll_ratio=study.rig_slip if slip is None else slip,
        pair=entry.pair or "1",
        tolerances=_tolerances(entry, study, entry),
    )
    oils = {record.name: record for record in study.lubricants}
    if found.lubricant not in oils:
        raise DataError(
            f"{entry.where}: lubricant: got {found.lubricant}, need one of the study's: "
            f"{', '.join(oils)}"
        )
    try:
        check_temperatures(oils[found.lubricant], [found.temperature])
        study.check_window(found.force)
    except LubeError as error:
        raise DataError(f"{entry.where}: {error}") from None
    return found


def _measured_row(entry, study, remarks):
    """Row of one entry of a manifest: of its recording, or of the share that it states."""
    conditions = _conditions(entry, study)
    if entry.file is None:
        return _stated_row(entry, conditions, study)
    recording = open_recording(
        entry.file, entry.sampling_interval, entry.channel, entry.unit, entry.gain, entry.offset
    )
    record = _Record(conditions, study, recording.quantity, recording.sampling_interval)
    limit = study.rig.amplifier_range if recording.quantity == "voltage" else np.inf
    saturated = 0
    for piece in recording.pieces():
        record.add(piece)
        saturated += np.count_nonzero(np.abs(piece) >= limit)
    if saturated > SATURATED * record.samples:
        raise DataError(
            f"{entry.file}: {saturated / record.samples:.1%} of its samples are at or beyond "
            f"{limit:g} V, rig.amplifier_range: the record is saturated"
        )
    return record.row(_record_name(entry), remarks)


def _record_name(entry):
    return entry.where if entry.file is None else f"{entry.file.name} ({entry.where})"


def _stated_row(entry, conditions, study):
    """Row of a share that was evaluated elsewhere, at the threshold that is compared."""
    at = np.array(study.experiment.thresholds) == study.experiment.threshold
    stated = (entry.probability, entry.lower, entry.upper)
    shares = [np.where(at, np.nan if share is None else share, np.nan) for share in stated]
    row = _labelled(conditions, study) | {"record": _record_name(entry)}
    return row | limited("contact_share", shares) | {"turns": 1.0, "share_error": 0.0}


def _labelled(conditions, study):
    """Conditions of a record, and the levels of the study that they mean."""
    row = {name: getattr(conditions, name) for name in (*LEVELS, *_LABELS)}
    for name in LEVELS:
        levels = getattr(study.operating_grid, name)
        found = level_near(levels, row[name], conditions.tolerances[name])
        row[f"{name}_level"] = np.nan if found is None else found
    return row


_LABELS = ("lubricant", "slide_to_roll_ratio", "pair")


class _Record:
    """One record of the rig, counted as it comes."""

    def __init__(self, conditions, study, quantity="voltage", interval=None):
        self.conditions, self._study, self._quantity = conditions, study, quantity
        self._interval = interval or 1.0 / study.rig.sampling_rate
        self._counter = record_counter(study.experiment, study.rig, quantity, self._interval)
        self._first, self._touched, self._steps = [], 0, 0
        self._wanted = max(round(self._period() / self._interval), 1)

    @property
    def _ratios(self):
        return speed_ratios(self.conditions.slide_to_roll_ratio)

    def _lasting(self):
        """Time steps that a revolution of either roller lasts, without one at rest.

        In a time step the faster surface passes one grid point. The first of them is timed: the
        first roller, unless it is at rest.
        """
        sizes = zip(self._study.line_spec.points, self._ratios, strict=True)
        return [size / ratio for size, ratio in sizes if ratio > 0.0]

    def _period(self):
        """Time of a revolution of the timed roller, by the speed."""
        conditions, points = self.conditions, self._study.line_spec.points
        faster = max(surface_speeds(conditions.speed, conditions.slide_to_roll_ratio))
        return 60.0 / faster * (self._lasting()[0] / points[0])

    @property
    def samples(self):
        return self._counter.samples

    def add(self, values):
        """Count the next samples, V or ohm; for the trace somewhat over a revolution is kept."""
        wanted = round((1.0 + SPAN) * self._wanted)
        missing = wanted - sum(part.size for part in self._first)
        if missing > 0:
            self._first.append(np.array(values[:missing], float))
        self._counter.add(values)

    def add_revolution(self, revolution):
        """Count a revolution of the simulated rig."""
        self.add(revolution.voltage(self._study.rig))
        self._touched += np.count_nonzero(revolution.contact)
        self._steps += revolution.contact.size

    def row(self, name, remarks=None):
        """Evaluate the record: shares, how it repeats, its trace."""
        below, sizes = self._counter.below, self._counter.sizes
        block = float(sizes[0]) * self._interval
        at = self._study.experiment.thresholds.index(self._study.experiment.threshold)
        folded = fold(below[at] / sizes, block, self._period())
        clear = folded.repeatability >= CLEAR
        speed_ratio = self._period() / folded.period if clear else np.nan
        self._believe(speed_ratio, name, remarks)
        duration = self.samples * self._interval
        turns = duration / folded.period * self._turns_a_turn()
        around = [folded_counts(below, sizes, block, each) for each in self._periods(folded.period)]
        around = around if duration > folded.period else []
        shares = share_interval(below, sizes, self._windows(turns), around)
        return {
            **_labelled(self.conditions, self._study),
            **limited("contact_share", shares),
            "record": name,
            "duration": duration,
            "sampling_interval": self._interval,
            "turns": turns,
            "revolution_period": folded.period,
            "repeatability": folded.repeatability,
            "speed_ratio": speed_ratio,
            "share_error": folded.share_error if self._repeats() else 0.0,
            "folded_share": folded.profile,
            "folded_deviation": folded.deviation,
            **self._trace(folded.period),
            **({"true_contact_share": self._touched / self._steps} if self._steps else {}),
        }

    def _believe(self, speed_ratio, name, remarks):
        """Correct a speed that the record's own repetition contradicts."""
        conditions = self.conditions
        speed = conditions.speed * speed_ratio
        apart = abs(speed - conditions.speed) > conditions.tolerances["speed"]
        if remarks is None or not apart:
            return
        remarks.append(
            f"{name}: its speed is stated as {conditions.speed:.6g} rpm, but it repeats itself at "
            f"{speed:.6g} rpm, which is believed"
        )
        self.conditions = replace(conditions, speed=speed)

    def _repeats(self):
        """Whether each revolution is the same as the one before, but for electrical noise."""
        alike = len(set(self._study.line_spec.points)) == 1
        rolling = self.conditions.slide_to_roll_ratio == 0.0
        return alike and rolling and self._study.rig.drift == 0.0

    def _turns_a_turn(self):
        """Revolutions of the roller with the faster surface in one of the timed roller."""
        faster = 0 if self._ratios[0] == 1.0 else 1
        return self._lasting()[0] / self._study.line_spec.points[faster]

    def _periods(self, period):
        """List the times of a revolution of either roller that turns; one if both are the same."""
        lasting = self._lasting()
        return sorted({period * each / lasting[0] for each in lasting})

    def _windows(self, turns):
        """Windows in the record that share no roughness."""
        spec, conditions = self._study.line_spec, self.conditions
        reach = 2.0 * self._study.rollers.contact_half_width(conditions.force)
        reach = (reach + 2.0 * np.pi / spec.q_min) / spec.spacing
        ratios = self._ratios
        faster = 0 if ratios[0] == 1.0 else 1
        shift = round(spec.points[faster] * ratios[1 - faster])
        seen = min(turns, distinct_alignments(turns, shift, spec.points[1 - faster], reach))
        return max(seen * spec.points[faster] * min(ratios) / reach, 1.0)

    def _trace(self, period):
        """Resistance over the first revolution, thinned to its extremes."""
        values = np.concatenate(self._first)[: max(round(period / self._interval), 1)]
        if self._quantity == "voltage":
            values = resistance_from_voltage(values, self._study.rig)
        times, values = _thinned(values, self._interval)
        return {"trace_time": times, "trace_resistance": values}


def _thinned(values, interval):
    """At most `TRACE_SAMPLES` times and values; of equal stretches the least and the greatest."""
    times = np.full(TRACE_SAMPLES, np.nan)
    kept = times.copy()
    if values.size <= TRACE_SAMPLES:
        times[: values.size], kept[: values.size] = interval * np.arange(values.size), values
        return times, kept
    edges = np.arange(TRACE_SAMPLES // 2 + 1) * values.size // (TRACE_SAMPLES // 2)
    least, greatest = (each.reduceat(values, edges[:-1]) for each in (np.minimum, np.maximum))
    kept[0::2], kept[1::2] = least, greatest
    times[0::2], times[1::2] = interval * edges[:-1], interval * 0.5 * (edges[:-1] + edges[1:])
    return times, kept


_SIZES = {
    **{f"contact_share{limit}": "threshold" for limit in LIMITS},
    **dict.fromkeys(("folded_share", "folded_deviation"), "phase"),
    **dict.fromkeys(("trace_time", "trace_resistance"), "trace_sample"),
}
_TEXTS = ("record", "lubricant", "pair")
_NUMBERS = (
    *LEVELS,
    *(f"{name}_level" for name in LEVELS),
    *("slide_to_roll_ratio", "true_contact_share", "duration", "sampling_interval", "turns"),
    *("revolution_period", "repeatability", "speed_ratio", "share_error"),
)
_COORDINATES = (*_NUMBERS[:7], "duration", "lubricant", "pair", "record")


def _experiment(rows, study, origin, refused=(), remarks=()):
    """Set the rows of all records one below the other."""
    sizes = {
        "threshold": len(study.experiment.thresholds),
        "phase": PHASES,
        "trace_sample": TRACE_SAMPLES,
    }
    variables = {name: ("record", [row[name] for row in rows]) for name in _TEXTS}
    for name in _NUMBERS:
        variables[name] = "record", np.array([row.get(name, np.nan) for row in rows], float)
    for name, dim in _SIZES.items():
        missing = np.full(sizes[dim], np.nan)
        values = np.array([row.get(name, missing) for row in rows])
        variables[name] = ("record", dim), values
    dataset = xr.Dataset(
        variables,
        coords={
            "threshold": np.array(study.experiment.thresholds),
            "phase": (np.arange(PHASES) + 0.5) / PHASES,
            "origin": origin,
        },
        attrs={"refused": "\n".join(refused), "remarks": "\n".join(remarks)},
    )
    dataset["comparison_threshold"] = study.experiment.threshold
    dataset["drift"], dataset["pairs"] = study.rig.drift, len(set(dataset["pair"].values))
    return label(dataset.set_coords(_COORDINATES), "experiment")
