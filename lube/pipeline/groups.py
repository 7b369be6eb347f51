"""Groups of jobs that run in one cluster job, by the registry of stages, for ``profiles/slurm``."""

from lube.schema import STAGES
from lube.storage.git import ROOT

_BATCHED = {name for name, stage in STAGES.items() if stage.in_batches == "realisations"}


def job_groups() -> dict[str, str]:
    """Assign each rule with a script or a stage to a group, in which its jobs share a cluster job.

    No group depends on itself through another: the stages that the batches need come before them,
    the stages that need the batches come after, and all others neither wait for the batches nor
    delay them.

    Returns
    -------
    dict
        From rule to ``tables`` (before the batches), ``batches``, ``beside`` or ``figures``
        (after them: summaries, figures and pages).
    """
    before, after = set(_BATCHED), set(_BATCHED)
    for name, stage in reversed(STAGES.items()):
        if name in before:
            before |= set(stage.inputs)
    for name, stage in STAGES.items():
        if after.intersection(stage.inputs):
            after.add(name)
    # Rules that are not stages, such as `explorer`, follow the stages.
    scripts = {path.stem for path in ROOT.glob("workflow/scripts/*.py")} - {"stage"}
    groups = dict.fromkeys(scripts, "figures")
    groups |= {row.rule: "figures" if name in after else "beside" for name, row in STAGES.items()}
    groups |= dict.fromkeys(before.difference(_BATCHED) | {"resolved_study"}, "tables")
    return groups | {"batch": "batches", "samples": "beside"}
