rule height_distribution:
    input:
        **stage_files("height_distribution"),
        sources=script_sources("height_distribution"),
    output:
        result("height_distribution.nc"),
    log:
        result("logs/height_distribution.log"),
    benchmark:
        result("benchmarks/height_distribution.tsv")
    # A long job: started early, it does not keep the others waiting at the end.
    priority: 2
    params:
        study=stage_inputs("height_distribution"),
    message:
        "Height distribution: probabilities by skewness and kurtosis"
    script:
        "../scripts/height_distribution.py"
