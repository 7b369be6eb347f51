# Chapter of the report that holds its pages.
ABOUT_THE_STUDY = "About the study"
TEMPLATES = [from_here(path) for path in sorted(Path(ROOT, "lube/report/templates").iterdir())]


rule pages:
    input:
        film=result("film.nc"),
        contact=result("contact.nc"),
        experiment=result("experiment.nc"),
        comparison=result("comparison.nc"),
        study=FILES.study_file,
        docs=[from_here(f"docs/{page}.md") for page in ("limits", "assumptions", "architecture")],
        templates=TEMPLATES,
        sources=script_sources("pages"),
    output:
        facts=result("report/facts.html"),
        findings=result("report/findings.html"),
        limits=result("report/limits.html"),
        files=result("report/files.html"),
        pipeline=result("report/pipeline.html"),
        configuration=report(
            result("report/configuration.html"),
            category=ABOUT_THE_STUDY,
            caption="../report/page.rst",
            labels={
                "Page": "Configuration",
                "Shows": "every number, as written and as understood",
            },
        ),
        assumptions=report(
            result("report/assumptions.html"),
            category=ABOUT_THE_STUDY,
            caption="../report/page.rst",
            labels={
                "Page": "Assumptions",
                "Shows": "what the paper leaves open, and what was filled in",
            },
        ),
    log:
        result("logs/pages.log"),
    benchmark:
        result("benchmarks/pages.tsv")
    params:
        study=digest(STUDY.model_dump(mode="json")),
    message:
        "Report: the study's numbers, results, configuration and assumptions"
    script:
        "../scripts/pages.py"


rule times:
    input:
        # When all else is done.
        [result(f"{kind}.nc") for kind in DATASETS],
        products(ARCHIVED),
        templates=TEMPLATES,
        sources=script_sources("times"),
    output:
        report(
            result("report/run_times.html"),
            category=ABOUT_THE_STUDY,
            caption="../report/page.rst",
            labels={"Page": "Run times", "Shows": "time and memory of every job"},
        ),
    log:
        result("logs/times.log"),
    benchmark:
        result("benchmarks/times.tsv")
    params:
        jobs=FILES.benchmarks(ARCHIVED),
    message:
        "Report: run times and memory of all jobs"
    script:
        "../scripts/times.py"
