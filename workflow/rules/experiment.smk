rule rig:
    input:
        **stage_files("rig"),
        sources=script_sources("rig"),
    output:
        result("rig.nc"),
    log:
        result("logs/rig.log"),
    benchmark:
        result("benchmarks/rig.tsv")
    params:
        study=stage_inputs("rig"),
    message:
        "Rig: voltage and resistance at the trace points, and what narrower bands would show"
    script:
        "../scripts/rig.py"


rule experiment:
    input:
        **stage_files("experiment"),
        records=measured_files(),
        sources=script_sources("experiment"),
    output:
        result("experiment.nc"),
    log:
        result("logs/experiment.log"),
    benchmark:
        result("benchmarks/experiment.tsv")
    # The longest job: started early, it runs beside the others.
    priority: 2
    params:
        study=stage_inputs("experiment"),
    message:
        "Experiment: share of time with contact, from the rig's records"
    script:
        "../scripts/experiment.py"
