# Mixed lubrication of rough rollers: the whole study. See README.md.


include: "workflow/rules/common.smk"


# The report of another Snakefile begins with a page of its own.
if not IS_MODULE:

    report: "workflow/report/study.rst"


include: "workflow/rules/notebooks.smk"
include: "workflow/rules/study.smk"
include: "workflow/rules/lubricant.smk"
include: "workflow/rules/film.smk"
include: "workflow/rules/roughness.smk"
include: "workflow/rules/surface.smk"
include: "workflow/rules/batch.smk"
include: "workflow/rules/contact.smk"
include: "workflow/rules/tail.smk"
include: "workflow/rules/areal.smk"
include: "workflow/rules/patch.smk"
include: "workflow/rules/film_plane.smk"
include: "workflow/rules/constant.smk"
include: "workflow/rules/film_profile.smk"
include: "workflow/rules/film_shape.smk"
include: "workflow/rules/flattening.smk"
include: "workflow/rules/height_distribution.smk"
include: "workflow/rules/master.smk"
include: "workflow/rules/experiment.smk"
include: "workflow/rules/comparison.smk"
include: "workflow/rules/gauge.smk"
include: "workflow/rules/areal_gauge.smk"
include: "workflow/rules/figure.smk"
include: "workflow/rules/speed.smk"
include: "workflow/rules/reading.smk"
include: "workflow/rules/coverage.smk"
include: "workflow/rules/explorer.smk"
include: "workflow/rules/report.smk"
include: "workflow/rules/archive.smk"


rule all:
    default_target: True
    input:
        [result(f"{kind}.nc") for kind in STUDY.datasets],
        products(ALWAYS),
        result("explorer.html"),
        [result(f"report/{page}.html") for page in ("configuration", "assumptions", "run_times")],
    message:
        f"Done: datasets, figures, executed notebooks and explorer.html are in {RESULTS}"


rule areal_contact:
    input:
        products(made_by("areal_contact", FIGURES)),
    message:
        f"Done: areal.nc, areal_gauge.nc and their figures are in {RESULTS}"


rule patch_contact:
    input:
        products(made_by("patch_contact", FIGURES)),
    message:
        f"Done: patch.nc and its figure are in {RESULTS}"


rule computed:
    input:
        products(made_by("computed", FIGURES)),
    message:
        f"Done: the computed films, what they do to contact, and their figures are in {RESULTS}"


rule benchmark:
    input:
        products(made_by("benchmark", FIGURES)),
    message:
        f"Done: measured times and their figures are in {RESULTS}"
