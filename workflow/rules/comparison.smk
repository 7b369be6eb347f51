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
        "Comparison: simulated breakthrough against the rig's share of time in contact"
    script:
        "../scripts/comparison.py"
