rule figure:
    """A figure, drawn by its notebook."""
    input:
        # A saved notebook makes the figure again only if its cells have changed, not its outputs.
        notebook=ancient(from_here("notebooks/{figure}.ipynb")),
        datasets=lambda wildcards: [
            result(f"{kind}.nc") for kind in FIGURES[wildcards.figure].datasets
        ],
        sources=lambda wildcards: FIGURES[wildcards.figure].sources,
    output:
        # The old figure stays until the new one is complete.
        in_report(update(result("figures/{figure}.png"))),
        in_report(update(result("figures/{figure}.pdf"))),
        notebook=update(result("notebooks/{figure}.ipynb")),
        # Snakemake removes this file before the job, and without it the old figure is out of date.
        origin=result("figures/{figure}.json"),
    log:
        result("logs/{figure}.log"),
    benchmark:
        result("benchmarks/{figure}.tsv")
    wildcard_constraints:
        figure="|".join(FIGURES),
    params:
        cells=lambda wildcards: digest(FIGURES[wildcards.figure].cells),
    message:
        "Figure: {wildcards.figure}"
    script:
        "../scripts/figure.py"


onerror:
    # A picture without its origin must not count as up to date, even if it is the only target. Dated
    # 1970, it is older than the rule's inputs.
    for figure in FIGURES:
        if not Path(result(f"figures/{figure}.json")).exists():
            for product in map(Path, products([figure])):
                if product.exists():
                    os.utime(product, (0, 0))
