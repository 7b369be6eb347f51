rule archive:
    input:
        written=lambda wildcards: archived_texts(),
        datasets=[result(f"{kind}.nc") for kind in DATASETS],
        products=products(ARCHIVED),
    output:
        zip=result(f"archive/{STUDY.name}.zip"),
        sums=result(f"archive/{STUDY.name}/SHA256SUMS"),
    log:
        result("logs/archive.log"),
    benchmark:
        result("benchmarks/archive.tsv")
    params:
        about=digest(STUDY.about.model_dump(mode="json")),
        results=RESULTS,
        kinds=DATASETS,
        figures=ARCHIVED,
        folder=result(f"archive/{STUDY.name}"),
    message:
        "Archive: {output.zip}, and the same as a folder beside it"
    script:
        "../scripts/archive.py"


rule verify:
    # Nothing is made anew for it: what is there is checked as it is.
    params:
        archive=result(f"archive/{STUDY.name}"),
        python=sys.executable,
    message:
        "Verify: {params.archive}"
    shell:
        "{params.python:q} -m lube.command verify {params.archive:q}"
