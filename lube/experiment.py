"""The experiment stage: the share of time that the rig's resistance lies below a threshold.

Records are measured ones, or those of a simulated rig, never both: a file says which in its
coordinate ``origin``.
"""

import logging

import numpy as np
import xarray as xr

from lube.errors import DataError
from lube.evaluation import record_counter, share_interval
from lube.levels import level_index, levels_told
from lube.points import operating_points
from lube.recordings import open_recording
from lube.rig import SimulatedRig
from lube.schema import EXPERIMENT_DIMS, FILES, LIMITS, label
from lube.shares import limited

log = logging.getLogger(__name__)

SATURATED = 0.001
"""Share of a record's samples at the amplifier's limits from which on it is refused."""


def simulated_experiment(lines, film, study):
    """Let a simulated rig record all operating points, and evaluate what it logs.

    The films are those of the film table's first formula.

    Parameters
    ----------
    lines : xarray.Dataset
        A ``roughness_batch`` dataset of the rig's own realisations, one a revolution.
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
    records = [_SimulatedRecord(point, study, lines.attrs["q_min"]) for point in points]
    for number, revolution in SimulatedRig(lines, study, points).revolutions():
        records[number].add(revolution)
    rows = {point: record.row() for point, record in zip(points, records, strict=True)}
    return _experiment(rows, film, study, "simulated")


def measured_experiment(manifest, film, study):
    """Evaluate measured records, as far as they can be used.

    Parameters
    ----------
    manifest : Manifest
        From `lube.manifest.read_manifest`.
    film : xarray.Dataset
        A ``film`` dataset, whose levels are the study's.
    study : Study
        Its rig, which tells a voltage's resistance, and its evaluation of records.

    Returns
    -------
    xarray.Dataset
        The ``experiment`` file of `lube.schema`; what could not be used stands, a line each, in
        its attribute ``refused``.

    Raises
    ------
    DataError
        If no record can be used.
    """
    table = film.isel(film_formula=0)  # of which only contact width and speed are used
    points = [point for slip in study.slips for point in operating_points(table, slip)]
    point_at = {tuple(point.levels.values()): point for point in points}
    rows, refused = {}, list(manifest.refused)
    for entry in manifest.entries:
        try:
            point = point_at[_levels(entry, film, study)]
            if point in rows:
                raise DataError(f"{entry.where}: its operating point has a record already")
            rows[point] = _measured_row(entry, point, study)
        except DataError as error:
            refused.append(str(error))
    for line in refused:
        log.warning("Refused: %s", line)
    if not rows:
        raise DataError(f"no record can be used; the first: {refused[0] if refused else 'none'}")
    return _experiment(rows, film, study, manifest.origin, refused)


class _SimulatedRecord:
    """What the simulated rig logs at one operating point, counted as it comes."""

    def __init__(self, point, study, q_min):
        self._point, self._study, self._q_min = point, study, q_min
        self._interval = 1.0 / study.rig.sampling_rate
        self._whole = self._counter(study.experiment)
        self._alone = []  # share and limits of each revolution, a record of its own
        self._touched = self._steps = 0

    def _counter(self, experiment):
        return record_counter(experiment, self._study.rig, "voltage", self._interval)

    def add(self, revolution):
        voltage = revolution.voltage(self._study.rig)
        self._whole.add(voltage)
        self._alone.append(self._compared_share(voltage))
        self._touched += np.count_nonzero(revolution.contact)
        self._steps += revolution.contact.size

    def _compared_share(self, voltage):
        """Share below the compared threshold, and its limits."""
        experiment = self._study.experiment
        thresholds = {"thresholds": (experiment.threshold,)}
        counter = self._counter(experiment.model_copy(update=thresholds))
        counter.add(voltage)
        duration = counter.samples * self._interval
        return np.ravel(_shares(counter, duration, self._point, self._q_min))

    def row(self):
        return (
            _row(self._whole, self._interval, self._point, self._q_min, "simulated")
            | {"true_contact_share": self._touched / self._steps}
            | limited("revolution_share", np.transpose(self._alone))
        )


def _levels(entry, film, study):
    """Levels of the study that an entry of a manifest names."""
    given = {
        "lubricant": entry.lubricant or study.lubricants[0].name,
        "slide_to_roll_ratio": entry.slide_to_roll_ratio,
        **{name: getattr(entry, name) for name in ("temperature", "speed", "force")},
    }
    if given["slide_to_roll_ratio"] is None:
        given["slide_to_roll_ratio"] = study.rig_slip
    return tuple(_level(entry.where, name, given[name], film, study) for name in EXPERIMENT_DIMS)


def _level(where, name, value, film, study):
    levels = study.slips if name == "slide_to_roll_ratio" else film[name].values.tolist()
    index = level_index(levels, value)
    if index is None:
        raise DataError(
            f"{where}: {name}: got {value}, need one of the study's: {levels_told(levels)}"
        )
    return levels[index]


def _measured_row(entry, point, study):
    """Row of one entry of a manifest: of its record, or of the share that it tells."""
    return _told_row(entry, study) if entry.file is None else _recorded_row(entry, point, study)


def _told_row(entry, study):
    # Evaluated elsewhere, at the threshold that is compared: there alone it stands.
    at = np.array(study.experiment.thresholds) == study.experiment.threshold
    told = (entry.probability, entry.lower, entry.upper)
    shares = [np.where(at, np.nan if share is None else share, np.nan) for share in told]
    return limited("contact_share", shares) | {"record": entry.where}


def _recorded_row(entry, point, study):
    recording = open_recording(
        entry.file, entry.sampling_interval, entry.channel, entry.unit, entry.gain, entry.offset
    )
    interval = recording.sampling_interval
    counter = record_counter(study.experiment, study.rig, recording.quantity, interval)
    limit = study.rig.amplifier_range if recording.quantity == "voltage" else np.inf
    saturated = 0
    for piece in recording.pieces():
        counter.add(piece)
        saturated += np.count_nonzero(np.abs(piece) >= limit)
    if saturated > SATURATED * counter.samples:
        raise DataError(
            f"{entry.file}: {saturated / counter.samples:.1%} of its samples are at or beyond "
            f"{limit:g} V, rig.amplifier_range: the record is saturated"
        )
    return _row(counter, interval, point, study.line_spec.q_min, entry.file.name)


def _row(counter, interval, point, q_min, record):
    """Share, interval and origin of one record."""
    duration = counter.samples * interval
    return limited("contact_share", _shares(counter, duration, point, q_min)) | {
        "record": record,
        "duration": duration,
        "sampling_interval": interval,
    }


def _shares(counter, duration, point, q_min):
    """Share below each threshold, and the limits of its interval, each of shape (K,)."""
    # Windows a longest wavelength apart share no roughness.
    reach = 2.0 * point.contact_half_width + 2.0 * np.pi / q_min
    windows = max(duration * point.slower_speed / reach, 1.0)
    return share_interval(counter.below, counter.sizes, windows)


def _experiment(rows, film, study, origin, refused=()):
    """Put rows, a dict by operating point, where they belong on the study's coordinates."""
    dataset = _empty(film, study, max(_revolutions(row) for row in rows.values()))
    for point, row in rows.items():
        index = tuple(dataset.get_index(name).get_loc(at) for name, at in point.levels.items())
        for name, value in row.items():
            dataset[name].values[index] = value
    dataset["record"] = dataset["record"].astype(str)
    dataset = dataset.set_coords("duration").assign_coords(origin=origin)
    dataset = dataset.assign_attrs(refused="\n".join(refused))
    dataset["comparison_threshold"] = study.experiment.threshold
    return label(dataset, "experiment")


def _revolutions(row):
    return np.size(row.get("revolution_share", np.nan))


def _empty(film, study, revolutions):
    """Dataset of an experiment without a record."""
    coords = {"slide_to_roll_ratio": np.array(study.slips)}
    coords |= {name: film[name].values for name in EXPERIMENT_DIMS[1:]}
    coords |= {"threshold": np.array(study.experiment.thresholds)}
    sizes = {name: values.size for name, values in coords.items()} | {"revolution": revolutions}
    numbers = ["true_contact_share", "duration", "sampling_interval"]
    numbers += [f"{of}_share{limit}" for of in ("contact", "revolution") for limit in LIMITS]
    variables = {}
    for name in (*numbers, "record"):
        dims = FILES["experiment"][name].dims
        fill, kind = ("", object) if name == "record" else (np.nan, float)
        variables[name] = (dims, np.full([sizes[dim] for dim in dims], fill, kind))
    return xr.Dataset(variables, coords)
