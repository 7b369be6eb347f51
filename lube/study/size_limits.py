"""Refuse a study whose results do not fit a workstation, before anything is computed."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from lube.errors import StudyError

if TYPE_CHECKING:
    from lube.study.study import Study

MOST_NUMBERS = 10**9
"""Largest array, in numbers: 8 GB."""

MOST_POINTS = 2**24
"""Largest number of points around a roller: 19 nm apart on the paper's rollers."""

MOST_BATCHES = 10_000
"""Largest number of batches of realisations: Snakemake plans four jobs for each."""

FOLDED_NUMBERS = 10_000
"""Approximate length of what is kept of each record: its folded revolution and its trace."""


def check_sizes(study: Study) -> None:
    """Refuse a study that a workstation cannot hold, or Snakemake not plan.

    Parameters
    ----------
    study : Study
        The study, its parts checked.

    Raises
    ------
    StudyError
        Which key, the size it leads to, the largest size allowed.
    """
    second = study.line_spec.points[1]
    if second > MOST_POINTS:
        raise StudyError(
            f"rollers.second.radius: its line has {second:.3g} points, need {MOST_POINTS} at most"
        )
    if len(study.batches) > MOST_BATCHES:
        least = math.ceil(study.realisations / MOST_BATCHES)
        raise StudyError(
            f"batch_size: got {study.batch_size} for {study.realisations} realisations, need at "
            f"least {least}: {MOST_BATCHES} batches at most"
        )
    for key, what, numbers in _arrays(study):
        if numbers > MOST_NUMBERS:
            raise StudyError(f"{key}: {what} take {numbers:.3g} numbers, need 1e9 at most")


def _arrays(study):
    """Key that decides, name and length of each large array."""
    rig, grid, points = study.rig, study.operating_grid, study.line_spec.points
    pair = 2 * max(points)
    levels = (grid.force, grid.speed, grid.temperature, study.slips, study.lubricants)
    tables = math.prod(map(len, levels))
    slowest_turn = 60.0 / min(grid.speed) * max(points) / points[0]
    samples = rig.sampling_rate * slowest_turn
    batch = min(study.batch_size, study.realisations)
    combinations = tables * len(study.film_formulas) * study.realisations
    rig_key = "rig.revolutions" if rig.drift > 0.0 else "rig.pairs"
    return [
        ("kept_realisations", "their lines", pair * len(study.kept_realisations)),
        ("batch_size", "the lines of a batch", pair * batch),
        (rig_key, "the lines of the rig", pair * len(study.rig_realisations)),
        ("traces", "the traces", max(points) * len(study.traces)),
        ("rig.sampling_rate", "its samples of the traces", samples * len(study.traces)),
        ("operating_grid", "its combinations in all realisations", combinations),
        ("rig.pairs", "its folded records", tables * rig.pairs * FOLDED_NUMBERS),
    ]
