rule comparison:
    input:
        **stage_files("comparison"),
        records=ancient(record_files()),
        sources=script_sources("comparison"),
    output:
        result("comparison.nc"),
    log:
        result("logs/comparison.log"),
    benchmark:
        result("benchmarks/comparison.tsv")
    params:
        study=stage_inputs("comparison"),
    message:
        "Comparison: breakthrough probability against the contact share of each record"
    script:
        "../scripts/comparison.py"
