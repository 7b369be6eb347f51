rule film_plane:
    input:
        **stage_files("film_plane"),
        sources=script_sources("film_plane"),
    output:
        result("film_plane.nc"),
    log:
        result("logs/film_plane.log"),
    benchmark:
        result("benchmarks/film_plane.tsv")
    params:
        study=stage_inputs("film_plane"),
    message:
        "Film plane: computed film over Moes' numbers, some seconds a lubricant"
    script:
        "../scripts/film_plane.py"
