rule tail:
    input:
        **stage_files("tail"),
        sources=script_sources("tail"),
    output:
        result("tail.nc"),
    log:
        result("logs/tail.log"),
    benchmark:
        result("benchmarks/tail.tsv")
    # A long job: started early, it does not keep the others waiting at the end.
    priority: 2
    params:
        study=stage_inputs("tail"),
    message:
        "Tail: probability and rate of contact at any rarity"
    script:
        "../scripts/tail.py"
