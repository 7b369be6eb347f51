rule flattening:
    input:
        **stage_files("flattening"),
        sources=script_sources("flattening"),
    output:
        result("flattening.nc"),
    log:
        result("logs/flattening.log"),
    benchmark:
        result("benchmarks/flattening.tsv")
    threads: workflow.cores
    params:
        study=stage_inputs("flattening"),
    message:
        "Flattening: contact of lines that the oil has flattened, some minutes"
    script:
        "../scripts/flattening.py"
