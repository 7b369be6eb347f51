rule constant:
    input:
        **stage_files("constant"),
        sources=script_sources("constant"),
    output:
        result("constant.nc"),
    log:
        result("logs/constant.log"),
    benchmark:
        result("benchmarks/constant.tsv")
    params:
        study=stage_inputs("constant"),
    message:
        "Constant: contact by Eq. 3 as printed, by its source and by the computed film"
    script:
        "../scripts/constant.py"
