rule archive:
    input:
        written=FILES.archived_texts,
        datasets=[result(f"{kind}.nc") for kind in DATASETS],
        products=products(ARCHIVED),
    output:
        # Replaced when the new ones are whole, not taken away before.
        zip=update(result(f"archive/{STUDY.name}.zip")),
        sums=update(result(f"archive/{STUDY.name}/SHA256SUMS")),
        # This one goes first: an archive that stays of a failed job would pass for new without it.
        zip_sum=result(f"archive/{STUDY.name}.zip.sha256"),
    log:
        result("logs/archive.log"),
    benchmark:
        result("benchmarks/archive.tsv")
    params:
        about=digest(STUDY.about.model_dump(mode="json")),
        code=FILES.code_state,
        kinds=DATASETS,
        figures=ARCHIVED,
    message:
        "Archive: {output.zip}, and the same as a folder beside it"
    script:
        "../scripts/archive.py"


rule verify:
    # Nothing is made anew for it: what is there is checked as it is. Nor is anything kept of it
    # but a log, so that it is done each time.
    log:
        result("logs/verify.log"),
    params:
        archive=result(f"archive/{STUDY.name}"),
        python=sys.executable,
    message:
        "Verify: {params.archive}"
    shell:
        "{params.python:q} -m lube.cli verify {params.archive:q} 2>&1 | tee {log}"
