# A rule for each stage, as the registry `lube.schema.stages` says; its function is in `lube/stages`.
from lube.schema import STAGES

for stage in STAGES.values():
    if stage.target != "benchmark":

        rule:
            name:
                stage.rule
            input:
                **{kind: result(f"{kind}.nc") for kind in STUDY.inputs_of(stage.name)},
                batches=FILES.batches_of(stage.name),
                written=FILES.written_files(stage.name),
                # Their values are parameters. A title is not a parameter, so a new one makes nothing again.
                records=ancient(FILES.record_files()),
                sources=stage_sources(stage.name),
            output:
                result(f"{stage.name}.nc"),
            log:
                result(f"logs/{stage.name}.log"),
            benchmark:
                result(f"benchmarks/{stage.name}.tsv")
            priority: stage.priority
            threads: workflow.cores if STUDY.is_parallel(stage.name) else 1
            params:
                study=FILES.stage_inputs(stage.name),
            message:
                stage.message
            script:
                "../scripts/stage.py"

    else:

        rule:
            name:
                stage.rule
            input:
                script=from_here(f"benchmarks/bench_{stage.name}.py"),
                study=ancient(result("study.yaml")),
                records=FILES.record_files(),
                sources=script_sources(f"benchmarks/bench_{stage.name}.py"),
            output:
                result(f"{stage.name}.nc"),
            log:
                result(f"logs/{stage.name}.log"),
            benchmark:
                result(f"benchmarks/{stage.name}.tsv")
            # All cores, so that no other job disturbs the measurement.
            threads: workflow.cores
            params:
                study=FILES.stage_inputs(stage.name),
                python=sys.executable,
            message:
                stage.message
            shell:
                "{params.python:q} {input.script} {input.study:q} {output} 2>&1 | tee {log}"

    # In a module of another workflow the rule's name has a prefix.
    list(workflow.rules)[-1].docstring = stage.message


if STUDY.has("contact"):

    rule batch:
        """Batches of realisations, which contact and master map join."""
        input:
            film=result("film.nc"),
            sources=script_sources("batch"),
        output:
            **{
                kind: result(f"batches/{kind}_{{first}}.nc")
                for kind in ("contact", "master")
                if STUDY.has(kind)
            },
        log:
            result("logs/batch_{first}.log"),
        benchmark:
            result("benchmarks/batch_{first}.tsv")
        # The summary and most figures wait for them.
        priority: 1
        params:
            study=FILES.stage_inputs("contact", "master"),
            realisations=FILES.batch_limits,
        message:
            "Batch: realisations {params.realisations[0]} to {params.realisations[1]} at all operating points"
        script:
            "../scripts/batch.py"


if STUDY.has("sensitivity_runs"):

    rule samples:
        """Batches of samples of all that is uncertain, which the sensitivity study joins."""
        input:
            **{kind: result(f"{kind}.nc") for kind in ("sensitivity_responses",) if STUDY.has(kind)},
            # Their values are parameters.
            records=ancient(FILES.record_files()),
            sources=script_sources("samples"),
        output:
            result("batches/sensitivity_runs_{number}.nc"),
        log:
            result("logs/samples_{number}.log"),
        benchmark:
            result("benchmarks/samples_{number}.tsv")
        params:
            study=FILES.stage_inputs("sensitivity_runs"),
        message:
            "Samples: batch {wildcards.number} of random values of what is uncertain, some minutes"
        script:
            "../scripts/samples.py"
