rule batch:
    input:
        film=result("film.nc"),
        sources=script_sources("batch"),
    output:
        **{
            kind: result(f"batches/{kind}_{{first}}.nc")
            for kind in ("contact", "master")
            if STUDY.has(kind)
        },
    log:
        result("logs/batch_{first}.log"),
    benchmark:
        result("benchmarks/batch_{first}.tsv")
    # The summary and most figures wait for them.
    priority: 1
    params:
        study=stage_inputs("contact", "master"),
        realisations=batch_limits,
    message:
        "Batch: realisations {params.realisations[0]} to {params.realisations[1]} at all operating points"
    script:
        "../scripts/batch.py"
