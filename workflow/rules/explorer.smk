EXPLORED = [
    kind
    for kind in ("lubricant", "film", "contact", "tail", "master", "trace", "comparison")
    if STUDY.has(kind)
]


rule explorer:
    """A page on which to move over the operating points."""
    input:
        **{kind: result(f"{kind}.nc") for kind in EXPLORED},
        sources=script_sources("explorer"),
    output:
        result("explorer.html"),
    log:
        result("logs/explorer.log"),
    benchmark:
        result("benchmarks/explorer.tsv")
    params:
        kinds=EXPLORED,
    message:
        "Explorer: a page on which to move over the operating points"
    script:
        "../scripts/explorer.py"
