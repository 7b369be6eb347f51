rule master_batch:
    input:
        film=result("film.nc"),
        lines=result("batches/roughness_{first}.nc"),
        sources=script_sources("master_batch"),
    output:
        result("batches/master_{first}.nc"),
    log:
        result("logs/master_{first}.log"),
    benchmark:
        result("benchmarks/master_{first}.tsv")
    # As of the contact batches: the lines on disk stay few.
    priority: 1
    params:
        study=stage_inputs("master"),
        realisations=batch_limits,
    message:
        "Master curve: realisations {params.realisations[0]} to {params.realisations[1]} over all films and windows"
    script:
        "../scripts/master_batch.py"


rule master:
    input:
        film=result("film.nc"),
        batches=batches_of("master"),
        sources=script_sources("master"),
    output:
        result("master.nc"),
    log:
        result("logs/master.log"),
    benchmark:
        result("benchmarks/master.tsv")
    message:
        "Master curve: probability over lambda ratio and contact width"
    script:
        "../scripts/master.py"
