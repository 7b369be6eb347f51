rule contact_batch:
    input:
        film=result("film.nc"),
        lines=result("batches/roughness_{first}.nc"),
        sources=script_sources("contact_batch"),
    output:
        result("batches/contact_{first}.nc"),
    log:
        result("logs/contact_{first}.log"),
    benchmark:
        result("benchmarks/contact_{first}.tsv")
    # Before further lines are drawn: so the batches on disk stay few.
    priority: 1
    params:
        study=stage_inputs("contact"),
        realisations=batch_limits,
    message:
        "Contact: realisations {params.realisations[0]} to {params.realisations[1]} at all operating points"
    script:
        "../scripts/contact_batch.py"


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
