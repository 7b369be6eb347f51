from lube.report import ON_ASSUMPTIONS, SUMMARISED
from lube.pipeline.command_line import PAPER, same_study

# Pages of the report on the study as a whole.
PAGES = {
    page: report(
        result(f"report/{page}.html"),
        category="About the study",
        caption="../report/page.rst",
        labels={"Page": page.replace("_", " ").capitalize(), "Shows": shown},
    )
    for page, shown in {
        "configuration": "every value, as written and as understood",
        "assumptions": "what the paper leaves open, and what is used instead",
        "run_times": "time and memory of every job",
    }.items()
}
# Parts of the report's start page.
PARTS = ("facts", "findings", "limits", "files", "pipeline")


rule pages:
    """Text of the report."""
    input:
        **{kind: result(f"{kind}.nc") for kind in SUMMARISED if STUDY.has(kind)},
        # Once it has been made.
        **{kind: result(f"{kind}.nc") for kind in KINDS if kind in ON_ASSUMPTIONS},
        study=FILES.study_file,
        paper=from_here(PAPER),
        docs=[from_here(f"docs/{page}.md") for page in ("limits", "assumptions", "architecture")],
        sources=script_sources("pages"),
    output:
        **{part: result(f"report/{part}.html") for part in PARTS},
        **{page: PAGES[page] for page in ("configuration", "assumptions")},
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
    """Run times of all jobs, a page of the report."""
    input:
        # All other jobs come first.
        [result(f"{kind}.nc") for kind in STUDY.datasets],
        products(ALWAYS),
        result("explorer.html"),
        sources=script_sources("times"),
    output:
        PAGES["run_times"],
    log:
        result("logs/times.log"),
    benchmark:
        result("benchmarks/times.tsv")
    params:
        jobs=FILES.benchmarks(ALWAYS),
    message:
        "Report: run times and memory of all jobs"
    script:
        "../scripts/times.py"


# A workflow that uses this one as a module makes its own report.
if not IS_MODULE:

    rule report:
        """The report, one HTML file."""
        input:
            rules.pages.output,
            rules.times.output,
            # The report shows all that rule `times` waits for, and these.
            [result(f"{kind}.nc") for kind in KINDS],
            products(EXTRA),
            [from_here(path) for path in sorted(Path(ROOT, "workflow/report").iterdir())],
        output:
            result("report.html"),
        log:
            result("logs/report.log"),
        benchmark:
            result("benchmarks/report.tsv")
        localrule: True
        params:
            snakemake=[
                *(sys.executable, "-m", "snakemake", "all", *products(EXTRA)),
                *same_study(**SOURCE),
            ],
        message:
            "Report: {output}"
        shell:
            # A second Snakemake: it reports on finished jobs, and this one is running.
            "{params.snakemake:q} --report {output:q} > {log:q} 2>&1"
