rule lubricant:
    input:
        # Their values are parameters; another title, which is none, makes nothing again.
        records=ancient(record_files()),
        sources=script_sources("lubricant"),
    output:
        result("lubricant.nc"),
    log:
        result("logs/lubricant.log"),
    benchmark:
        result("benchmarks/lubricant.tsv")
    priority: 1
    params:
        study=stage_inputs("lubricant"),
    message:
        "Lubricant: viscosity fits, density and pressure-viscosity coefficient"
    script:
        "../scripts/lubricant.py"
