def record_files():
    """Files of the study's lubricant records, told from here so that the tree can be moved."""
    files = {file for record in STUDY.lubricants for file in record.files}
    return sorted(os.path.relpath(file) for file in files)


rule lubricant:
    input:
        records=record_files(),
        sources=script_sources("lubricant"),
    output:
        result("lubricant.nc"),
    log:
        result("logs/lubricant.log"),
    benchmark:
        result("benchmarks/lubricant.tsv")
    params:
        study=stage_inputs("lubricant"),
    message:
        "Lubricant: viscosity fits, density and pressure-viscosity coefficient"
    script:
        "../scripts/lubricant.py"
