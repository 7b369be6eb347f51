rule surface:
    input:
        topographies=FILES.topography_files(),
        sources=script_sources("surface"),
    output:
        result("surface.nc"),
    log:
        result("logs/surface.log"),
    benchmark:
        result("benchmarks/surface.tsv")
    params:
        study=stage_inputs("surface"),
    message:
        "Surface: spectrum and heights of the measured topographies"
    script:
        "../scripts/surface.py"
