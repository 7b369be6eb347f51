rule film_profile:
    input:
        **stage_files("film_profile"),
        sources=script_sources("film_profile"),
    output:
        result("film_profile.nc"),
    log:
        result("logs/film_profile.log"),
    benchmark:
        result("benchmarks/film_profile.tsv")
    params:
        study=stage_inputs("film_profile"),
    message:
        "Film profile: pressure and film across the contact, by Reynolds' equation"
    script:
        "../scripts/film_profile.py"
