rule reading:
    input:
        script=from_here("tests/benchmarks/bench_records.py"),
        study=ancient(result("study.yaml")),
        records=record_files(),
        sources=script_sources("tests/benchmarks/bench_records.py"),
    output:
        result("reading.nc"),
    log:
        result("logs/reading.log"),
    benchmark:
        result("benchmarks/reading.tsv")
    # All cores, so that no other job disturbs the measurement.
    threads: workflow.cores
    params:
        study=stage_inputs("reading"),
        python=sys.executable,
    message:
        "Reading: time to read records, against other readers of the same files, a few minutes"
    shell:
        "{params.python:q} {input.script} {input.study:q} {output} 2>&1 | tee {log}"
