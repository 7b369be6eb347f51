"""How large the results of a study get, told before anything is computed."""

import math

from lube.errors import StudyError

MOST_NUMBERS = 10**9
"""Numbers held at once, at most: 8 GB."""

MOST_POINTS = 2**24
"""Points around a roller, at most: 19 nm apart on the paper's rollers."""

MOST_BATCHES = 10_000
"""Batches of realisations, at most: Snakemake plans four jobs for each."""

FOLDED_NUMBERS = 10_000
"""Numbers kept of each record, about: its folded revolution and its trace."""


def check_sizes(study):
    """Refuse a study that no workstation can hold or plan.

    Parameters
    ----------
    study : Study
        The study, its parts checked.

    Raises
    ------
    StudyError
        Which key, what it would take, what is allowed.
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
    """Key that decides, name and length of the large arrays, the longest of each kind."""
    rig, grid = study.rig, study.operating_grid
    points = study.line_spec.points
    pair, levels = 2 * max(points), (grid.force, grid.speed, grid.temperature, study.slips)
    tables = math.prod(map(len, levels)) * len(study.lubricants)
    slowest_turn = 60.0 / min(grid.speed) * max(points) / points[0]
    samples = rig.sampling_rate * slowest_turn
    batch = min(study.batch_size, study.realisations)
    return [
        ("kept_realisations", "their lines", pair * len(study.kept_realisations)),
        ("batch_size", "the lines of a batch", pair * batch),
        (
            "rig.revolutions" if rig.drift > 0.0 else "rig.pairs",
            "the lines of the rig",
            pair * len(study.rig_realisations),
        ),
        ("traces", "the traces", max(points) * len(study.traces)),
        ("rig.sampling_rate", "its samples of the traces", samples * len(study.traces)),
        ("experiment.debounce", "its samples", rig.sampling_rate * study.experiment.debounce),
        (
            "operating_grid",
            "its combinations in all realisations",
            tables * len(study.film_formulas) * study.realisations,
        ),
        ("rig.pairs", "its folded records", tables * rig.pairs * FOLDED_NUMBERS),
    ]
