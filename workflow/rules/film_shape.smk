rule film_shape:
    input:
        **stage_files("film_shape"),
        sources=script_sources("film_shape"),
    output:
        result("film_shape.nc"),
    log:
        result("logs/film_shape.log"),
    benchmark:
        result("benchmarks/film_shape.tsv")
    threads: workflow.cores
    params:
        study=stage_inputs("film_shape"),
    message:
        "Film shape: contact under flat films and the computed one, some minutes"
    script:
        "../scripts/film_shape.py"
