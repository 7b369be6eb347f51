"""Print which rules follow which in the shipped studies, as Snakemake plans them.

Studies with the same datasets have the same rules, so only one of them is planned. This is a
program by itself, because the Snakefile changes the process that reads it.
"""

import contextlib
import json
import os
from pathlib import Path

from snakemake.api import SnakemakeApi
from snakemake.settings import types

from lube.stages import load_study

TARGETS = "all areal_contact patch_contact computed rough_passage sensitivity".split()
TARGETS += ["electrical", "measurement_plan", "verification", "benchmark", "archive", "report"]


def followers(study):
    """Pairs of rules, of which the second reads what the first makes."""
    with SnakemakeApi(types.OutputSettings(quiet={types.Quietness.ALL})) as api:
        workflow = api.workflow(
            resource_settings=types.ResourceSettings(cores=1),
            config_settings=types.ConfigSettings(configfiles=[study]),
            snakefile=Path("Snakefile"),
        )
        plan = workflow.dag(types.DAGSettings(targets=set(TARGETS)))
        with open(os.devnull, "w") as nowhere, contextlib.redirect_stdout(nowhere):
            plan.printrulegraph()  # for the plan it makes
        dag = workflow._workflow.dag
        return {(to.rule.name, job.rule.name) for job in dag.jobs for to in dag._dependencies[job]}


if __name__ == "__main__":
    shipped = sorted(Path("workflow/config").glob("*.yaml"))
    studies = {load_study(study).datasets: study for study in shipped}.values()
    print(json.dumps({study.stem: sorted(followers(study)) for study in studies}))
