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
        "Master map: probabilities over lambda ratio and contact width"
    script:
        "../scripts/master.py"
