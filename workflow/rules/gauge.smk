rule gauge:
    input:
        **stage_files("gauge"),
        sources=script_sources("gauge"),
    output:
        result("gauge.nc"),
    log:
        result("logs/gauge.log"),
    benchmark:
        result("benchmarks/gauge.tsv")
    params:
        study=stage_inputs("gauge"),
    message:
        "Gauge: films, pressure-viscosity coefficient and boundary layer from the records"
    script:
        "../scripts/gauge.py"
