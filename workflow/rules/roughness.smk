rule roughness:
    input:
        sources=script_sources("roughness"),
    output:
        result("roughness.nc"),
    log:
        result("logs/roughness.log"),
    benchmark:
        result("benchmarks/roughness.tsv")
    params:
        study=stage_inputs("roughness"),
        realisations=STUDY.kept_realisations,
    message:
        "Roughness: the kept realisations, with their moments"
    script:
        "../scripts/roughness.py"
