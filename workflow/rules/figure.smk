rule figure:
    input:
        # Saving a notebook with its outputs must not make the figure again; its cells must.
        notebook=ancient("notebooks/{figure}.ipynb"),
        datasets=lambda wildcards: FIGURE_DATASETS[wildcards.figure],
        sources=lambda wildcards: FIGURE_SOURCES[wildcards.figure],
    output:
        in_report(result("figures/{figure}.png")),
        in_report(result("figures/{figure}.pdf")),
        notebook=result("notebooks/{figure}.ipynb"),
    log:
        result("logs/{figure}.log"),
    benchmark:
        result("benchmarks/{figure}.tsv")
    wildcard_constraints:
        figure="|".join(FIGURES),
    params:
        cells=lambda wildcards: FIGURE_CELLS[wildcards.figure],
    message:
        "Figure: {wildcards.figure}"
    script:
        "../scripts/figure.py"
