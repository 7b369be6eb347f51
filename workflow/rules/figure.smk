rule figure:
    input:
        # Saving a notebook with its outputs must not make the figure again; its code must.
        notebook=ancient("notebooks/{figure}.ipynb"),
        datasets=lambda wildcards: figure_datasets(wildcards.figure),
        sources=lambda wildcards: sources("\n".join(notebook_code(wildcards.figure))),
    output:
        multiext(result("figures/{figure}"), ".png", ".pdf"),
        notebook=result("notebooks/{figure}.ipynb"),
    log:
        result("logs/{figure}.log"),
    benchmark:
        result("benchmarks/{figure}.tsv")
    params:
        code=lambda wildcards: notebook_digest(wildcards.figure),
    message:
        "Figure: {wildcards.figure}"
    script:
        "../scripts/figure.py"
