# The figures of the study, read from their notebooks before any job.
from lube.report.markdown import plain, to_html
from lube.schema import STAGES, SUMMARIES, TARGETS
from lube.study.metadata import PAPER as PAPER_TITLE
from lube.pipeline.figure_list import chapters, made_by, made_on_request, study_figures

with one_line_errors():
    FIGURES = study_figures(STUDY)

# The words of the command. Of another workflow's command only files, and this one's rules by their
# names there.
WORDS = sys.argv[1:]
if IS_MODULE:
    NAMES = [*TARGETS, *(stage.rule for stage in STAGES.values())]
    NAMES = {workflow.modifier.modify_rulename(name): name for name in NAMES}
    WORDS = [NAMES.get(word, word) for word in WORDS if word in NAMES or os.sep in word]

# Other figures are made on request only, for example by `snakemake computed`. Report and archive
# have those that were made, and keep them up to date; bare `snakemake` leaves them alone.
ALWAYS = made_by("all", FIGURES)
EXTRA = made_on_request(FIGURES, RESULTS, WORDS)
KINDS = {kind for name in EXTRA for kind in FIGURES[name].datasets}
KINDS = sorted(KINDS.union(STUDY.datasets_in(RESULTS)))
CHAPTERS = chapters(FIGURES)

products = FILES.products

# The targets are checked here because Snakemake reads them later.
FILES.check_targets(WORDS, FIGURES)


def in_report(path):
    """Show a picture in the report, in its figure's chapter, with its notebook's words."""
    return report(
        path,
        caption="../report/figure.rst",
        category=lambda wildcards: CHAPTERS[wildcards.figure],
        labels=lambda wildcards: {
            "Figure": wildcards.figure.split("_")[0],
            "Shows": plain(FIGURES[wildcards.figure].title),
            # The report shows the format that is first in the alphabet and offers the other.
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
    "extra": {kind: SUMMARIES[kind] for kind in KINDS if kind not in STUDY.datasets},
    "captions": {name: to_html(figure.text) for name, figure in FIGURES.items()},
}
