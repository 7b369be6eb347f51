rule speed:
    input:
        script=from_here("tests/benchmarks/bench_speed.py"),
        study=ancient(result("study.yaml")),
        records=record_files(),
        sources=script_sources("tests/benchmarks/bench_speed.py"),
    output:
        result("speed.nc"),
    log:
        result("logs/speed.log"),
    benchmark:
        result("benchmarks/speed.tsv")
    # All cores, so that no other job disturbs the measurement.
    threads: workflow.cores
    params:
        study=stage_inputs("speed"),
        python=sys.executable,
    message:
        "Speed: the study's kernels against plain versions of the same work, a few minutes"
    shell:
        "{params.python:q} {input.script} {input.study:q} {output} 2>&1 | tee {log}"
