"""The experiment stage: the contact shares of measured or simulated records.

All records of a file are measured, or all are simulated, as its coordinate ``origin`` says. Each
record has its own operating conditions; the study's levels near them are labels.
"""

import logging
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
import xarray as xr

from lube.contact.rough_pair import roughness_batch
from lube.errors import DataError, LubeError
from lube.grid.levels import rolling
from lube.grid.operating_points import OperatingPoint, operating_points
from lube.inference.study_shares import levels_named
from lube.recordings.manifest import Entry, Manifest, read_manifest
from lube.recordings.usable import lubricant_of, open_entry, unsaturated_pieces
from lube.rig.record import LEVELS, TRACE_SAMPLES, Conditions, Record
from lube.rig.simulator import SimulatedRig
from lube.schema import LIMITS, label, values_with_limits
from lube.statistics.folding import PHASES
from lube.study.study import Study
from lube.types import Datasets

log = logging.getLogger(__name__)


def make(study: Study, inputs: Datasets, threads: int = 1) -> xr.Dataset:
    """Make ``experiment.nc``; see `lube.stages`."""
    if study.experiment.manifest:
        return measured_experiment(read_manifest(study.experiment.manifest), study)
    lines = roughness_batch(study.line_spec, study.seed, study.rig_realisations)
    return simulated_experiment(lines, inputs["film"], study)


# Simulated records


def simulated_experiment(lines: xr.Dataset, film: xr.Dataset, study: Study) -> xr.Dataset:
    """Let the simulated rig record all operating points, and evaluate its records.

    The film thicknesses are those of the film table's first formula.

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
        The ``experiment`` file of `lube.schema`, of the origin ``simulated``. Its attribute
        ``refused`` has a line for each operating point whose film is not known.

    Raises
    ------
    DataError
        If no film is known.
    """
    every = operating_points(film.isel(film_formula=0), rolling(study.slips))
    points = [point for point in every if point.is_known]
    refused = [
        f"{_name_of_point(_conditions_of_point(point, 0, study), study)}: the film is not known"
        for point in every
        if not point.is_known
    ]
    _log_refused(refused)
    if not points:
        raise DataError(f"no record can be simulated; the first: {refused[0]}")
    records = {
        (pair, number): Record(_conditions_of_point(point, pair, study), study)
        for pair in range(study.rig.pairs)
        for number, point in enumerate(points)
    }
    for pair, number, revolution in SimulatedRig(lines, study, points).revolutions():
        records[pair, number].add_revolution(revolution)
    rows = [
        record.evaluate() | {"record": _name_of_point(record.conditions, study)}
        for record in records.values()
    ]
    return _dataset(rows, study, "simulated", refused)


def _log_refused(refused: Sequence[str]) -> None:
    for line in refused:
        log.warning("Refused: %s", line)


def _conditions_of_point(point: OperatingPoint, pair: int, study: Study) -> Conditions:
    """Conditions of a simulated record, which are exactly those of its operating point."""
    return Conditions(**point.levels, pair=str(pair + 1), tolerances=_tolerances(point, study))


def _name_of_point(conditions: Conditions, study: Study) -> str:
    """Operating point, and lubricant and pair if there are several."""
    words = [levels_named({name: getattr(conditions, name) for name in LEVELS})]
    words += [conditions.lubricant] * (len(study.lubricants) > 1)
    words += [f"pair {conditions.pair}"] * (study.rig.pairs > 1)
    return ", ".join(words)


def _tolerances(conditions: OperatingPoint | Entry, study: Study) -> dict[str, float]:
    """Largest distances from a level, N, rpm and K: of a manifest's entry, else of the study."""
    of_study = {
        "force": study.experiment.force_tolerance * conditions.force,
        "speed": study.experiment.speed_tolerance * conditions.speed,
        "temperature": study.experiment.temperature_tolerance,
    }
    return {
        name: getattr(conditions, f"{name}_tolerance", None) or of_study[name] for name in LEVELS
    }


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
        record that cannot be used, ``remarks`` one for each that was corrected.

    Raises
    ------
    DataError
        If no record can be used.
    """
    rows, refused, remarks = [], list(manifest.refused), []
    for entry in manifest.entries:
        try:
            rows.append(_row_of_entry(entry, study, remarks))
        except LubeError as error:
            refused.append(str(error))
    _log_refused(refused)
    for line in remarks:
        log.warning("%s", line)
    if not rows:
        raise DataError(f"no record can be used; the first: {refused[0] if refused else 'none'}")
    return _dataset(rows, study, manifest.origin, refused, remarks)


def _row_of_entry(entry: Entry, study: Study, remarks: list[str]) -> dict[str, Any]:
    """Evaluate an entry of the manifest, a recording or a stated share."""
    conditions = _conditions_of_entry(entry, study)
    if entry.file is None:
        return _stated_row(entry, conditions, study)
    name = f"{entry.file.name} ({entry.where})"
    row = _measured_record(entry, conditions, study).evaluate(correct_speed=True)
    if row["speed"] != conditions.speed:
        remarks.append(
            f"{name}: its speed is stated as {conditions.speed:.6g} rpm, but it repeats itself at "
            f"{row['speed']:.6g} rpm, which is used instead"
        )
    return row | {"record": name}


def _conditions_of_entry(entry: Entry, study: Study) -> Conditions:
    """Conditions of a measured record; refused where the study's model is not defined."""
    slip = entry.slide_to_roll_ratio
    return Conditions(
        **{name: getattr(entry, name) for name in LEVELS},
        lubricant=lubricant_of(entry, study),
        slide_to_roll_ratio=rolling(study.slips) if slip is None else slip,
        pair=entry.pair or "1",
        tolerances=_tolerances(entry, study),
    )


def _measured_record(entry: Entry, conditions: Conditions, study: Study) -> Record:
    """Read the recording of an entry; refused if it is saturated."""
    recording = open_entry(entry)
    record = Record(conditions, study, recording.quantity, recording.sampling_interval)
    for piece in unsaturated_pieces(recording, study):
        record.add(piece)
    return record


def _stated_row(entry: Entry, conditions: Conditions, study: Study) -> dict[str, Any]:
    """Row of a share that was evaluated elsewhere, at the threshold that is compared."""
    at = np.array(study.experiment.thresholds) == study.experiment.threshold
    stated = (entry.probability, entry.lower, entry.upper)
    shares = [np.where(at, np.nan if share is None else share, np.nan) for share in stated]
    row = conditions.labelled(study) | values_with_limits("contact_share", shares)
    return row | {"record": entry.where, "turns": 1.0, "share_error": 0.0}


# The dataset

_ARRAYS = {
    **{f"contact_share{limit}": "threshold" for limit in LIMITS},
    **dict.fromkeys(("folded_share", "folded_deviation"), "phase"),
    **dict.fromkeys(("trace_time", "trace_resistance"), "trace_sample"),
}
_TEXTS = ("record", "lubricant", "pair")
_CONDITIONS = (*LEVELS, *(f"{name}_level" for name in LEVELS), "slide_to_roll_ratio")
_NUMBERS = [
    *_CONDITIONS,
    *"true_contact_share duration sampling_interval turns".split(),
    *"revolution_period repeatability speed_ratio share_error".split(),
]


def _dataset(
    rows: Sequence[Mapping[str, Any]],
    study: Study,
    origin: str,
    refused: Sequence[str] = (),
    remarks: Sequence[str] = (),
) -> xr.Dataset:
    """Dataset of all records' rows; NaN where a row has no value."""
    thresholds = np.array(study.experiment.thresholds)
    sizes = {"threshold": thresholds.size, "phase": PHASES, "trace_sample": TRACE_SAMPLES}
    variables = {name: ("record", [row[name] for row in rows]) for name in _TEXTS}
    for name in _NUMBERS:
        variables[name] = "record", np.array([row.get(name, np.nan) for row in rows], float)
    for name, dim in _ARRAYS.items():
        missing = np.full(sizes[dim], np.nan)
        variables[name] = ("record", dim), np.array([row.get(name, missing) for row in rows])
    dataset = xr.Dataset(
        variables,
        {"threshold": thresholds, "phase": (np.arange(PHASES) + 0.5) / PHASES, "origin": origin},
        {"refused": "\n".join(refused), "remarks": "\n".join(remarks)},
    )
    dataset["comparison_threshold"] = study.experiment.threshold
    dataset["drift"], dataset["pairs"] = study.rig.drift, len(set(dataset["pair"].values))
    return label(dataset.set_coords((*_CONDITIONS, "duration", *_TEXTS)), "experiment")
