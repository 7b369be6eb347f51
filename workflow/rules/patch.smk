rule patch:
    input:
        **stage_files("patch"),
        sources=script_sources("patch"),
    output:
        result("patch.nc"),
    log:
        result("logs/patch.log"),
    benchmark:
        result("benchmarks/patch.tsv")
    params:
        study=stage_inputs("patch"),
    message:
        "Patch: surfaces pressed against a flat, several minutes"
    script:
        "../scripts/patch.py"
