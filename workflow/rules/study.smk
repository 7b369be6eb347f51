rule resolved_study:
    """The study as one file, with the values that it takes from others."""
    input:
        FILES.study_files(),
    output:
        result("study.yaml"),
    log:
        result("logs/resolved_study.log"),
    benchmark:
        result("benchmarks/resolved_study.tsv")
    params:
        changes=config["study"]["changes"],
    message:
        "Study: {output}, with the values that it takes from others"
    script:
        "../scripts/resolved_study.py"
