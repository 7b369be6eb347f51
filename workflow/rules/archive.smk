from lube.archive.inputs import archived_texts
from lube.storage.git import changed_code, commit, commit_date


rule archive:
    """The archive of the study, to be published with a paper."""
    input:
        written=lambda wildcards: archived_texts(FILES),
        datasets=[result(f"{kind}.nc") for kind in KINDS],
        products=products([*ALWAYS, *EXTRA]),
        explorer=result("explorer.html"),
    output:
        # An old archive stays until the new one is complete.
        zip=update(result(f"archive/{STUDY.name}.zip")),
        sums=update(result(f"archive/{STUDY.name}/SHA256SUMS")),
        # Snakemake removes this file before the job, and without it an old archive is out of date.
        zip_sum=result(f"archive/{STUDY.name}.zip.sha256"),
    log:
        result("logs/archive.log"),
    benchmark:
        result("benchmarks/archive.tsv")
    params:
        about=digest(STUDY.about.model_dump(mode="json")),
        code=lambda wildcards: [commit(), commit_date(), changed_code()],
        figures=[*ALWAYS, *EXTRA],
    message:
        "Archive: {output.zip}, and the same as a folder beside it"
    script:
        "../scripts/archive.py"


rule verify:
    """Check the archive as it is."""

    # It has no inputs, so the archive is checked as it is, and no outputs, so it runs each time.
    log:
        result("logs/verify.log"),
    params:
        archive=result(f"archive/{STUDY.name}"),
        python=sys.executable,
    message:
        "Verify: {params.archive}"
    shell:
        "{params.python:q} -m lube.cli verify {params.archive:q} 2>&1 | tee {log}"
