from lube.explorer import explored


rule explorer:
    """A page that shows any operating point of the study."""
    input:
        **{kind: result(f"{kind}.nc") for kind in explored(STUDY, KINDS)},
        sources=script_sources("explorer"),
    output:
        result("explorer.html"),
    log:
        result("logs/explorer.log"),
    benchmark:
        result("benchmarks/explorer.tsv")
    message:
        "Explorer: a page that shows any operating point of the study"
    script:
        "../scripts/explorer.py"
