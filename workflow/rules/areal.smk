rule areal:
    input:
        **stage_files("areal"),
        sources=script_sources("areal"),
    output:
        result("areal.nc"),
    log:
        result("logs/areal.log"),
    benchmark:
        result("benchmarks/areal.tsv")
    threads: workflow.cores
    params:
        study=stage_inputs("areal"),
    message:
        "Areal: contact of the surfaces that the lines stand for, several minutes"
    script:
        "../scripts/areal.py"
