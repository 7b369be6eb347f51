rule comparison:
    input:
        **stage_files("comparison"),
        records=record_files(),
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
        "Comparison: breakthrough probabilities against the contact shares of the records"
    script:
        "../scripts/comparison.py"
