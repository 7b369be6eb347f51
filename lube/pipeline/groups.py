"""Which jobs share a job of a cluster, by the registry of stages: for ``profiles/slurm``."""

from lube.schema import STAGES
from lube.storage.git import ROOT

_BATCHED = {name for name, stage in STAGES.items() if stage.in_batches}


def job_groups() -> dict[str, str]:
    """Assign each rule with a script or a stage to a group, in which its jobs share a cluster job.

    No group depends on itself through another: what the batches need comes before them, what
    needs them comes after, and the rest neither waits for the batches nor delays them.

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
    # Rules that are no stages, such as `explorer`, follow the stages.
    scripts = {path.stem for path in ROOT.glob("workflow/scripts/*.py")} - {"stage"}
    groups = dict.fromkeys(scripts, "figures")
    groups |= {name: "figures" if name in after else "beside" for name in STAGES}
    groups |= dict.fromkeys(before.difference(_BATCHED) | {"resolved_study"}, "tables")
    return groups | {"batch": "batches"}
