# The figures of the study, read from their notebooks before any job.
from lube.report.markdown import plain, to_html
from lube.study.metadata import PAPER as PAPER_TITLE
from lube.workflow.figure_list import chapters, made_by, study_figures

with one_line_errors():
    FIGURES = study_figures(STUDY)

# Others are made on request only, such as `snakemake benchmark`.
ARCHIVED = made_by("all", FIGURES)
CHAPTERS = chapters(FIGURES)

products = FILES.products

if not IS_MODULE:
    # Snakemake itself reads its targets later.
    FILES.check_targets(sys.argv[1:])


def in_report(path):
    """Show a picture in the report, in its figure's chapter, with its notebook's words."""
    return report(
        path,
        caption="../report/figure.rst",
        category=lambda wildcards: CHAPTERS[wildcards.figure],
        labels=lambda wildcards: {
            "Figure": wildcards.figure.split("_")[0],
            "Shows": plain(FIGURES[wildcards.figure].title),
            # The report shows the alphabetically first one and offers the other.
            "Format": "PNG" if path.endswith("png") else "pdf",
        },
    )


# Values for the report's templates.
config["report"] = {
    "study": STUDY.name,
    "title": STUDY.title,
    "summary": STUDY.about.summary,
    "paper": PAPER_TITLE,
    "folder": result("report"),
    "captions": {name: to_html(figure.text) for name, figure in FIGURES.items()},
}
