# Mixed lubrication of rough rollers: the whole study. See README.md.


include: "workflow/rules/common.smk"


# The report of another Snakefile begins with a page of its own.
if not IS_MODULE:

    report: "workflow/report/study.rst"


include: "workflow/rules/notebooks.smk"
include: "workflow/rules/study.smk"
include: "workflow/rules/stages.smk"
include: "workflow/rules/figure.smk"
include: "workflow/rules/explorer.smk"
include: "workflow/rules/report.smk"
include: "workflow/rules/archive.smk"


rule all:
    """All datasets, figures and pages of the study."""
    default_target: True
    input:
        [result(f"{kind}.nc") for kind in STUDY.datasets],
        products(ALWAYS),
        result("explorer.html"),
        [result(f"report/{page}.html") for page in PAGES],
    message:
        f"Done: datasets, figures, executed notebooks and explorer.html are in {RESULTS}"


# Targets made on request; bare `snakemake` leaves them alone.
for target, says in TARGETS.items():

    rule:
        name:
            target
        input:
            FILES.made_by(target, FIGURES),
        message:
            f"Done: {', '.join(f'{kind}.nc' for kind in STUDY.made_by(target))}, with figures, in {RESULTS}"

    list(workflow.rules)[-1].docstring = says
