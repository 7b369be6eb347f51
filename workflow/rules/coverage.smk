rule coverage:
    input:
        script=from_here("tests/benchmarks/bench_coverage.py"),
        study=ancient(result("study.yaml")),
        records=record_files(),
        sources=script_sources("tests/benchmarks/bench_coverage.py"),
    output:
        result("coverage.nc"),
    log:
        result("logs/coverage.log"),
    benchmark:
        result("benchmarks/coverage.tsv")
    # It uses all cores itself.
    threads: workflow.cores
    params:
        study=stage_inputs("coverage"),
        python=sys.executable,
    message:
        "Coverage: how often intervals contain the true value for new pairs of rollers, about 30 minutes"
    shell:
        "{params.python:q} {input.script} {input.study:q} {output} 2>&1 | tee {log}"
