"""Refuse a study whose results do not fit a workstation, before anything is computed."""

import math
from typing import TYPE_CHECKING

from lube.errors import StudyError

if TYPE_CHECKING:
    from lube.study.study import Study

MOST_NUMBERS = 10**9
"""Largest array, in numbers: 8 GB."""

MOST_SAMPLES = 10**8
"""Most samples of a turn at the points of the traces: the rig's records of it take some GB."""

LEAST_POINTS, MOST_POINTS = 64, 2**26
"""Least and largest number of points around a roller; the latter are 5 nm apart on the paper's."""

MOST_BATCHES = 10_000
"""Largest number of batches of realisations: Snakemake plans a job for each."""

FOLDED_NUMBERS = 10_000
"""Approximate count of numbers kept for each record: its folded revolution and its trace."""


def check_sizes(study: "Study") -> None:
    """Refuse a study too large for a workstation's memory or for Snakemake to plan.

    Parameters
    ----------
    study : Study
        The study, its parts checked.

    Raises
    ------
    StudyError
        Which key, the size it leads to, the largest size allowed.
    """
    rig, grid, points = study.rig, study.operating_grid, study.line_spec.points
    pair = 2 * max(points)
    levels = (grid.force, grid.speed, grid.temperature, study.slips, study.lubricants)
    tables = math.prod(map(len, levels))
    slowest_turn = 60.0 / min(grid.speed) * max(points) / points[0]
    samples = rig.sampling_rate * slowest_turn * len(study.traces)
    batch = min(study.batch_size, study.realisations)
    combinations = tables * len(study.film_formulas) * study.realisations
    rig_key = "rig.revolutions" if rig.drift > 0.0 else "rig.pairs"
    sizes = [  # key that decides it, number, what it counts, limit
        ("batch_size", len(study.batches), "batches", MOST_BATCHES),
        ("kept_realisations", pair * len(study.kept_realisations), "heights", MOST_NUMBERS),
        ("batch_size", pair * batch, "heights in a batch", MOST_NUMBERS),
        (rig_key, pair * len(study.rig_realisations), "heights of the rig", MOST_NUMBERS),
        ("rig.sampling_rate", samples, "samples of the traces", MOST_SAMPLES),
        ("operating_grid", combinations, "combinations in all realisations", MOST_NUMBERS),
        ("rig.pairs", tables * rig.pairs * FOLDED_NUMBERS, "folded samples", MOST_NUMBERS),
    ]
    for key, number, what, most in sizes:
        if number > most:
            raise StudyError(f"{key}: {number:.6g} {what}, need {most:.6g} at most")
