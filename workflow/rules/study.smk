rule resolved_study:
    """The study with all that it is based on, as one file."""
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
        "Study: {output}, with all that it is based on"
    script:
        "../scripts/resolved_study.py"
