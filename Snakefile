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
        [result(f"report/{page}.html") for page in ("configuration", "assumptions", "run_times")],
    message:
        f"Done: datasets, figures, executed notebooks and explorer.html are in {RESULTS}"


rule areal_contact:
    """Contact of the surface that the lines stand for."""
    input:
        products(made_by("areal_contact", FIGURES)),
    message:
        f"Done: areal.nc, surface_trace.nc, areal_gauge.nc and their figures are in {RESULTS}"


rule patch_contact:
    """Squares of the isotropic surface pressed against a flat."""
    input:
        products(made_by("patch_contact", FIGURES)),
    message:
        f"Done: patch.nc and its figure are in {RESULTS}"


rule computed:
    """Computed films, and contact under them."""
    input:
        products(made_by("computed", FIGURES)),
    message:
        f"Done: the computed films, contact under them, and their figures are in {RESULTS}"


rule rough_passage:
    """Rough lines that pass through the contact, by the transient Reynolds equation."""
    input:
        products(made_by("rough_passage", FIGURES)),
    message:
        f"Done: passage.nc and its figure are in {RESULTS}"


rule sensitivity:
    """What the probability of contact rests on."""
    input:
        products(made_by("sensitivity", FIGURES)),
        [result("record_bands.nc")] if STUDY.has("record_bands") else [],
    message:
        f"Done: sensitivity.nc and its figure are in {RESULTS}"


rule electrical:
    """What electrical meters read of the contact."""
    input:
        products(made_by("electrical", FIGURES)),
    message:
        f"Done: electrical.nc and its figure are in {RESULTS}"


rule measurement_plan:
    """What to measure next, by the sensitivity study, which is made first."""
    input:
        products(made_by("measurement_plan", FIGURES)),
    message:
        f"Done: plan.nc and its figure are in {RESULTS}"


rule verification:
    """The study's methods against theory, other methods and print."""
    input:
        products(made_by("verification", FIGURES)),
    message:
        f"Done: verification.nc and its figure are in {RESULTS}"


rule benchmark:
    """Measured times and coverage of intervals."""
    input:
        products(made_by("benchmark", FIGURES)),
    message:
        f"Done: measured times and their figures are in {RESULTS}"
