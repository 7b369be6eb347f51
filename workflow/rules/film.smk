rule film:
    input:
        **stage_files("film"),
        sources=script_sources("film"),
    output:
        result("film.nc"),
    log:
        result("logs/film.log"),
    benchmark:
        result("benchmarks/film.tsv")
    priority: 1
    params:
        study=stage_inputs("film"),
    message:
        "Film: Hertz contact and film thickness over forces, speeds and temperatures"
    script:
        "../scripts/film.py"
