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


def remove_used_lines():
    """Remove lines that a failed run left: Snakemake forgets those whose readers all finished."""
    for first in STUDY.batches:
        lines = Path(result(f"batches/roughness_{first}.nc"))
        readers = [lines.with_name(f"{kind}_{first}.nc") for kind in ("contact", "master")]
        kept = workflow.storage_settings.notemp or str(lines) in sys.argv
        if all(path.exists() for path in readers) and not kept:
            lines.unlink(missing_ok=True)
