rule contact:
    input:
        film=result("film.nc"),
        batches=batches_of("contact"),
        sources=script_sources("contact"),
    output:
        result("contact.nc"),
    log:
        result("logs/contact.log"),
    benchmark:
        result("benchmarks/contact.tsv")
    message:
        "Contact: probabilities of all realisations and their intervals"
    script:
        "../scripts/contact.py"


rule trace:
    input:
        **stage_files("trace"),
        sources=script_sources("trace"),
    output:
        result("trace.nc"),
    log:
        result("logs/trace.log"),
    benchmark:
        result("benchmarks/trace.tsv")
    params:
        study=stage_inputs("trace"),
    message:
        "Trace: contact length and resistance over one revolution"
    script:
        "../scripts/trace.py"
