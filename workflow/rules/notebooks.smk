# What the figures' notebooks depend on and say, read from their cells before any job.
import functools

from lube.workflow.cells import cells_of, datasets_of, python_of
from lube.report.markdown import plain, title_and_text, to_html


@functools.cache
def notebook_cells(figure):
    """Cells of a figure's notebook, reduced to what decides on it; outputs do not."""
    check_name(f"notebooks/{figure}.ipynb")
    return cells_of(f"notebooks/{figure}.ipynb")


def figure_datasets(figure):
    """Datasets that a notebook names in its parameters cell, such as `"../film.nc"`."""
    kinds = datasets_of(f"notebooks/{figure}.ipynb").values()
    return sorted({result(f"{kind}.nc") for kind in kinds})


def wanted(figure):
    """Whether a figure has something to show: a tag `several-force` asks for several forces."""
    tags = [tag for cell in notebook_cells(figure) for tag in cell["tags"]]
    needed = [tag.removeprefix("several-") for tag in tags if tag.startswith("several-")]
    levels = STUDY.operating_grid.model_dump()
    return all(len(levels.get(name, ())) > 1 for name in needed)


def figure_sources(figure):
    """Files of the lube package that a figure depends on, by its notebook or its script."""
    cells = [cell for cell in notebook_cells(figure) if cell["type"] == "code"]
    code = "\n".join(python_of(cell, f"notebooks/{figure}.ipynb") for cell in cells)
    return sorted({*sources(code), *script_sources("figure")})


def figure_text(figure):
    """Title and text of a figure, in Markdown, from its notebook's first cell."""
    first = notebook_cells(figure)[:1]
    text = "".join(cell["source"] for cell in first if cell["type"] == "markdown")
    title, text = title_and_text(text)
    return title or figure, text


def figure_chapter(figure):
    """Chapter of the report that a figure stands in, by its tag such as `chapter-oil-and-film`."""
    tags = [tag for cell in notebook_cells(figure) for tag in cell["tags"]]
    named = [tag.removeprefix("chapter-") for tag in tags if tag.startswith("chapter-")]
    return " ".join((named or ["further-figures"])[0].split("-")).capitalize()


def chapter(wildcards):
    """A figure's chapter with its number: the report sorts by it, as the figures are numbered."""
    name = figure_chapter(wildcards.figure)
    return f"{1 + CHAPTERS.index(name)} {name}"


def in_report(path):
    """Show a file of a figure in the report, among its chapter, with its notebook's words."""
    return report(
        path,
        caption="../report/figure.rst",
        category=chapter,
        labels=lambda wildcards: {
            "Figure": wildcards.figure.split("_")[0],
            "Shows": plain(figure_text(wildcards.figure)[0]),
            # The report shows the first by the alphabet, and lets switch to the other.
            "Format": "PNG" if path.endswith("png") else "pdf",
        },
    )


with told_in_one_line():
    FIGURES = sorted(path.stem for path in Path("notebooks").glob("*.ipynb") if wanted(path.stem))
    FIGURE_DATASETS = {figure: figure_datasets(figure) for figure in FIGURES}
    FIGURE_SOURCES = {figure: figure_sources(figure) for figure in FIGURES}
    FIGURE_CELLS = {figure: digest(notebook_cells(figure)) for figure in FIGURES}
    # Figures of measured times are made when asked for.
    TIMINGS = [
        figure
        for figure in FIGURES
        if not {Path(path).stem for path in FIGURE_DATASETS[figure]}.isdisjoint(MEASURED)
    ]
    ARCHIVED = [figure for figure in FIGURES if figure not in TIMINGS]
    # In the order of their figures, measured times last.
    CHAPTERS = list(
        dict.fromkeys(map(figure_chapter, sorted(FIGURES, key=lambda one: (one in TIMINGS, one))))
    )

# What the report's templates are given.
config["report"] = {
    "study": STUDY.name,
    "folder": result("report"),
    "captions": {figure: to_html(figure_text(figure)[1]) for figure in FIGURES},
}


def products(figures):
    """Files made of some figures: pictures, of what they were drawn, and executed notebooks."""
    for figure in figures:
        yield from (result(f"figures/{figure}.{suffix}") for suffix in ("png", "pdf", "json"))
        yield result(f"notebooks/{figure}.ipynb")


def benchmarks_of_steps():
    """Files with time and memory of all jobs, by the steps of the study."""
    steps = {"batches of realisations": [f"batch_{first}" for first in STUDY.batches]}
    steps |= {kind: [kind] for kind in DATASETS}
    steps["figures"] = [figure for figure in FIGURES if figure not in TIMINGS]
    return {step: [result(f"benchmarks/{job}.tsv") for job in jobs] for step, jobs in steps.items()}
