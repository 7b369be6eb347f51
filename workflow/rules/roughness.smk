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


rule roughness_batch:
    input:
        sources=script_sources("roughness_batch"),
    output:
        temp(result("batches/roughness_{first}.nc")),
    log:
        result("logs/roughness_{first}.log"),
    benchmark:
        result("benchmarks/roughness_{first}.tsv")
    params:
        study=stage_inputs("roughness"),
        realisations=batch_limits,
    message:
        "Roughness: realisations {params.realisations[0]} to {params.realisations[1]}"
    script:
        "../scripts/roughness_batch.py"
