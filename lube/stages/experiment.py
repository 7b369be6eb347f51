"""The experiment stage: the contact shares of measured or simulated records.

All records of a file are measured, or all are simulated, as its coordinate ``origin`` says. The
operating conditions are those of each record; the study's levels near them are labels.
"""

import logging

import numpy as np
import xarray as xr

from lube.errors import DataError, LubeError
from lube.grid.discretise import speed_ratios
from lube.grid.film_responses import with_surface_responses
from lube.grid.levels import rolling
from lube.grid.operating_points import known_films, levels_at, operating_points
from lube.inference.study_shares import levels_named
from lube.recordings.manifest import Manifest, read_manifest
from lube.recordings.usable import lubricant_of, open_entry, unsaturated_pieces
from lube.rig.record import LEVELS, TRACE_SAMPLES, Conditions, Record
from lube.rig.simulator import repeats, simulated_revolutions
from lube.schema import AT_RECORDS, FILES, label, values_with_limits, with_dims
from lube.statistics.folding import CLEAR, PHASES, SPAN
from lube.study.study import Study
from lube.types import Datasets
from lube.units import with_unit

log = logging.getLogger(__name__)

FAR = 10.0
"""A record whose force or speed is so many times outside the study's levels is remarked on."""


def make(study: Study, inputs: Datasets, threads: int = 1) -> xr.Dataset:
    """Make ``experiment.nc``; see `lube.stages`."""
    if study.experiment.manifest:
        return measured_experiment(read_manifest(study.experiment.manifest), study)
    return simulated_experiment(with_surface_responses(inputs), study, threads)


# Simulated records


def simulated_experiment(film: xr.Dataset, study: Study, threads: int = 1) -> xr.Dataset:
    """Let the simulated rig record all operating points, and evaluate its records.

    The film thicknesses are those of the film table's first formula.

    Parameters
    ----------
    film : xarray.Dataset
        A ``film`` dataset; with its responses if the oil answers surfaces on the rig.
    study : Study
        Its rig and the rig's rollers, evaluation of records, boundary layer and seed.
    threads : int, optional
        Threads that draw surfaces; they do not change the results.

    Returns
    -------
    xarray.Dataset
        The ``experiment`` file of `lube.schema`, of the origin ``simulated``. Its attribute
        ``refused`` has a line for each operating point whose film is not known.

    Raises
    ------
    DataError
        If no film is known.
    """
    every = operating_points(film.isel(film_formula=0), rolling(study.slips))
    known = known_films(every, study.gap).values
    unknown = [levels_at(every, number) for number in np.flatnonzero(~known)]
    refused = [f"{_name_of_point(one, 0, study)}: the film is not known" for one in unknown]
    points = every.isel(operating_point=known)
    levels = [levels_at(points, number) for number in range(points.sizes["operating_point"])]
    exact = dict.fromkeys(LEVELS, 0.0)
    records = {
        (pair, number): Record(Conditions(**here, pair=str(pair + 1), tolerances=exact), study)
        for pair in range(study.rig.pairs)
        for number, here in enumerate(levels)
    }
    for pair, number, revolution in simulated_revolutions(study, points, threads):
        records[pair, number].add_revolution(revolution)
    rows = [
        record.evaluate() | {"record": _name_of_point(levels[number], pair, study)}
        for (pair, number), record in records.items()
    ]
    return _dataset(rows, study, "simulated", refused)


def _name_of_point(levels, pair, study):
    """Operating point, and lubricant and pair if there are several."""
    words = [levels_named({name: levels[name] for name in LEVELS})]
    words += [levels["lubricant"]] * (len(study.lubricants) > 1)
    words += [f"pair {pair + 1}"] * (study.rig.pairs > 1)
    return ", ".join(words)


# Measured records


def measured_experiment(manifest: Manifest, study: Study) -> xr.Dataset:
    """Evaluate measured records.

    Parameters
    ----------
    manifest : Manifest
        From `lube.recordings.manifest.read_manifest`.
    study : Study
        Its rig, which relates voltage and resistance, its rollers and its evaluation of records.

    Returns
    -------
    xarray.Dataset
        The ``experiment`` file of `lube.schema`. Its attribute ``refused`` has a line for each
        record that cannot be used, ``remarks`` one for each that was corrected or may be mistaken.

    Raises
    ------
    DataError
        If no record can be used.
    """
    rows, refused, remarks = evaluated_records(manifest, study)
    return _dataset(rows, study, manifest.origin, refused, remarks)


def evaluated_records(manifest: Manifest, study: Study) -> tuple[list[dict], list[str], list[str]]:
    """Evaluate the records of a list.

    Parameters
    ----------
    manifest : Manifest
        From `lube.recordings.manifest.read_manifest`.
    study : Study
        Its rig, which relates voltage and resistance, its rollers and its evaluation of records.

    Returns
    -------
    rows : list of dict
        Values of each record that can be used, by the variables' names in the ``experiment`` file.
    refused : list of str
        A line for each record that cannot be used.
    remarks : list of str
        A line for each record that was corrected or may be mistaken.
    """
    rows, refused, remarks = [], list(manifest.refused), []
    for entry in manifest.entries:
        try:
            rows.append(_row_of_entry(entry, study, remarks))
        except LubeError as error:
            refused.append(str(error))
    if restless := [row["record"] for row in rows if _changes_by_the_turn(row, study)]:
        remarks.append(
            f"{_first_of(restless)}: rollers of one size without slip repeat themselves by the "
            f"turn, but here none is seen to, at any speed within {100.0 * SPAN:g} % of the one "
            "stated: the speed may be wrong, or the roughness changes (rig.drift)"
        )
    remarks += _far_outside(rows, study)
    passages = [(row, _passage_time(row, study)) for row in rows]
    if short := [(row, time) for row, time in passages if row.get("duration", np.inf) < time]:
        (row, time), names = short[0], [row["record"] for row, _ in short]
        remarks.append(
            f"{_first_of(names)}: {with_unit(row['duration'], 's', 3)} long, but the rollers need "
            f"{with_unit(time, 's', 3)} to move by the width of the contact: so short a record "
            "shows whether they touch at one place, and not how often"
        )
    return rows, refused, remarks


def _far_outside(rows, study):
    """Yield a remark on records whose force or speed is far from the study's."""
    for name, unit in (("force", "N"), ("speed", "rpm")):
        levels = getattr(study.operating_grid, name)
        least, most = min(levels), max(levels)
        if far := [row for row in rows if row[name] < least / FAR or row[name] > most * FAR]:
            names = [row["record"] for row in far]
            yield (
                f"{_first_of(names)}: the {name} is {with_unit(far[0][name], unit)}, but the "
                f"study's are from {with_unit(least, unit)} to {with_unit(most, unit)}: its unit "
                "may be wrong"
            )


def _first_of(names):
    """First of some records, and the number of the others."""
    return names[0] + (f" and {len(names) - 1} more" if len(names) > 1 else "")


def _passage_time(row, study):
    """Time in which the rollers move by the width of the contact at a record, s."""
    rollers = study.rollers
    speed = 2.0 * np.pi * rollers.first.radius * row["speed"] / 60.0
    return 2.0 * rollers.contact_half_width(row["force"]) / speed


def _changes_by_the_turn(row, study):
    """Whether a record does not repeat itself by the turn, although its rollers should."""
    # A stated share, and a record of one turn, have no repeatability.
    changes = row.get("repeatability", np.nan) < CLEAR
    return changes and repeats(study, speed_ratios(row["slide_to_roll_ratio"]))


def _row_of_entry(entry, study, remarks):
    """Evaluate an entry of the manifest, a recording or a stated share."""
    conditions = _conditions_of_entry(entry, study)
    if entry.file is None:
        return _stated_row(entry, conditions, study)
    name, recording = f"{entry.file.name} ({entry.where})", open_entry(entry)
    record = Record(conditions, study, recording.quantity, recording.sampling_interval)
    for piece in unsaturated_pieces(recording, study):
        record.add(piece)
    row = record.evaluate(correct_speed=True)
    if row["speed"] != conditions.speed:
        remarks.append(
            f"{name}: its speed is stated as {conditions.speed:.6g} rpm, but it repeats itself at "
            f"{row['speed']:.6g} rpm, which is used instead"
        )
    always = np.array(study.experiment.thresholds)[row["contact_share"] == 1.0]
    if recording.quantity == "voltage" and always.size:
        remarks.append(
            f"{name}: reads as contact all the time by thresholds from "
            f"{with_unit(always[0], 'ohm')} on, which it also does if the recorder cuts its "
            "voltage off, or if its bias voltage is less than rig.bias_voltage, "
            f"{with_unit(study.rig.bias_voltage, 'V')}"
        )
    return row | {"record": name}


def _conditions_of_entry(entry, study):
    """Conditions of a measured record; refused where the study's model is not defined."""
    slip, of_study = entry.slide_to_roll_ratio, study.experiment
    return Conditions(
        **{name: getattr(entry, name) for name in LEVELS},
        lubricant=lubricant_of(entry, study),
        slide_to_roll_ratio=rolling(study.slips) if slip is None else slip,
        pair=entry.pair or "1",
        tolerances={
            "force": entry.force_tolerance or of_study.force_tolerance * entry.force,
            "speed": entry.speed_tolerance or of_study.speed_tolerance * entry.speed,
            "temperature": entry.temperature_tolerance or of_study.temperature_tolerance,
        },
    )


def _stated_row(entry, conditions, study):
    """Row of a share that was evaluated elsewhere, at the threshold that is compared."""
    at = np.array(study.experiment.thresholds) == study.experiment.threshold
    stated = (entry.probability, entry.lower, entry.upper)
    shares = [np.where(at, np.nan if share is None else share, np.nan) for share in stated]
    row = conditions.labelled(study) | values_with_limits("contact_share", shares)
    return row | {"record": entry.where, "turns": 1.0, "share_error": 0.0}


# The dataset


def _dataset(rows, study, origin, refused, remarks=()):
    """Dataset of all records' rows, NaN where a row has no value; refusals are logged."""
    for line in (*(f"Refused: {line}" for line in refused), *remarks):
        log.warning("%s", line)
    if not rows:
        first = refused[0] if refused else "none"
        raise DataError(f"no record can be used, need one at least; the first: {first}")
    thresholds = np.array(study.experiment.thresholds)
    sizes = {"threshold": thresholds.size, "phase": PHASES, "trace_sample": TRACE_SAMPLES}
    levels = {"threshold": thresholds, "phase": (np.arange(PHASES) + 0.5) / PHASES}
    values = {
        "record": [row["record"] for row in rows],
        "origin": origin,
        "comparison_threshold": study.experiment.threshold,
        "drift": study.rig.drift,
        "pairs": len({row["pair"] for row in rows}),
    }
    for name, variable in FILES["experiment"].items():
        if variable.dims[:1] == ("record",):
            missing = np.full([sizes[dim] for dim in variable.dims[1:]], np.nan)
            found = [row.get(name, missing) for row in rows]
            values[name] = np.array(found, {"f": float, "U": str}[variable.kind])
    notes = {"refused": "\n".join(refused), "remarks": "\n".join(remarks)}
    dataset = xr.Dataset(with_dims("experiment", values), levels, notes)
    return label(dataset.set_coords(("origin", *AT_RECORDS)), "experiment")
