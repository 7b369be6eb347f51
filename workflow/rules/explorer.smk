from lube.explorer import EXPLORED


rule explorer:
    """A page on which to move over the operating points."""
    input:
        **{kind: result(f"{kind}.nc") for kind in EXPLORED if STUDY.has(kind)},
        sources=script_sources("explorer"),
    output:
        result("explorer.html"),
    log:
        result("logs/explorer.log"),
    benchmark:
        result("benchmarks/explorer.tsv")
    message:
        "Explorer: a page on which to move over the operating points"
    script:
        "../scripts/explorer.py"
