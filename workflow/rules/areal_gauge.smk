rule areal_gauge:
    input:
        **stage_files("areal_gauge"),
        sources=script_sources("areal_gauge"),
    output:
        result("areal_gauge.nc"),
    log:
        result("logs/areal_gauge.log"),
    benchmark:
        result("benchmarks/areal_gauge.tsv")
    params:
        study=stage_inputs("areal_gauge"),
    message:
        "The gauge by the surface: films from the records"
    script:
        "../scripts/areal_gauge.py"
