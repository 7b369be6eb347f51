"""The figures of a study, from the cells of their notebooks: datasets, tags and captions."""

from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path

from lube.pipeline.cells import cells_of, datasets_of, python_of
from lube.pipeline.sources import from_here, script_sources
from lube.report.markdown import title_and_text
from lube.schema import ON_REQUEST
from lube.study.study import Study
from lube.types import File

FURTHER = "further-figures"
"""Chapter of a notebook that names none."""

NO_FIGURE = "no-figure"
"""Tag of a notebook that is not a figure of the study."""

_SHOWS = {
    "gaussian-lines": lambda study: study.is_sampled,
    "lines": lambda study: "line" in study.contact_model,
    "no-lines": lambda study: not study.has("contact"),
    "surfaces": lambda study: study.has("surface_response"),
    "flat-film": lambda study: study.gap.is_plain,
    "ensemble": lambda study: not study.line_spec.is_one_pair,
}
"""Tags of notebooks, each with what a study must have for the figure."""


@dataclass(frozen=True)
class Figure:
    """One notebook of the folder ``notebooks``, read before any job.

    Attributes
    ----------
    name : str
        Name of the figure and its notebook, such as ``fig02_film``.
    cells : list of dict
        What determines the figure: the types, sources and tags of the notebook's cells.
    datasets : list of str
        Kinds of the datasets that its parameters cell names.
    sources : list of str
        Files of the lube package that its cells and the script ``figure.py`` depend on, from the
        working folder.
    title, text : str
        Heading of the first cell, or else the figure's name; and the text below it, in Markdown.
    tags : list of str
        Tags of all cells.
    """

    name: str
    cells: list[dict]
    datasets: list[str]
    sources: list[str]
    title: str
    text: str
    tags: list[str]

    @property
    def target(self) -> str:
        """Target of Snakemake that makes it: ``all``, or the target that makes its dataset."""
        return next((ON_REQUEST[name] for name in self.datasets if name in ON_REQUEST), "all")

    @property
    def chapter(self) -> str:
        """Chapter of the report, from a tag such as ``chapter-oil-and-film``."""
        return [*self._tagged("chapter-"), FURTHER][0].replace("-", " ").capitalize()

    def fits(self, study: Study) -> bool:
        """Whether a study has what the figure compares.

        Parameters
        ----------
        study : Study
            The study.

        Returns
        -------
        bool
            False if the study lacks a dataset of the figure, or what a tag asks for: several levels
            or oils (``several-force``, ``several-lubricant``), Gaussian lines that can be sampled
            (``gaussian-lines``), contact of lines (``lines``), surfaces for which no line stands
            (``no-lines``), lines that stand for Gaussian surfaces (``surfaces``), contact that
            depends only on film thickness and contact width (``flat-film``), or several pairs of
            lines (``ensemble``).
        """
        if not all(study.has(name) for name in self.datasets):
            return False
        if not all(_SHOWS[tag](study) for tag in self.tags if tag in _SHOWS):
            return False
        levels = study.operating_grid.model_dump() | {"lubricant": study.lubricants}
        return all(len(levels.get(name, ())) > 1 for name in self._tagged("several-"))

    def _tagged(self, prefix):
        return [tag.removeprefix(prefix) for tag in self.tags if tag.startswith(prefix)]


def _read(notebook):
    cells, datasets = cells_of(notebook), sorted(set(datasets_of(notebook).values()))
    code = "\n".join(python_of(cell, notebook) for cell in cells if cell["type"] == "code")
    title, text = title_and_text(cells[0]["source"] if cells[0]["type"] == "markdown" else "")
    files, tags = script_sources("figure", code), _tags(cells)
    return Figure(notebook.stem, cells, datasets, files, title or notebook.stem, text, tags)


def _tags(cells):
    return [tag for cell in cells for tag in cell["tags"]]


def study_figures(study: Study, folder: File = "notebooks") -> dict[str, Figure]:
    """List the figures that a study can draw.

    Parameters
    ----------
    study : Study
        The study.
    folder : str or Path, optional
        Folder of the notebooks, from the repository on if relative.

    Returns
    -------
    dict of str to Figure
        By name, sorted; without the notebooks tagged ``no-figure``.

    Raises
    ------
    LubeError
        If a notebook is damaged, is not Python or has no parameters cell.
    """
    paths = sorted(Path(from_here(folder)).glob("*.ipynb"))
    figures = [_read(path) for path in paths if NO_FIGURE not in _tags(cells_of(path))]
    return {figure.name: figure for figure in figures if figure.fits(study)}


def made_by(target: str, figures: dict[str, Figure]) -> list[str]:
    """List the figures that a target of Snakemake makes, such as ``all`` or ``benchmark``."""
    return [name for name, figure in figures.items() if figure.target == target]


def made_on_request(figures: dict[str, Figure], folder: File, words: Iterable[str]) -> list[str]:
    """List the figures made on request that exist, or that the same run makes.

    A picture stays where a job fails or is repeated, so the list is the same in every process of a
    run. Measured times are left out: they are not results of the study.

    Parameters
    ----------
    figures : dict of str to Figure
        As from `study_figures`.
    folder : str or Path
        Folder of the study's results.
    words : iterable of str
        Words of the command, among them targets such as ``computed``.

    Returns
    -------
    list of str
        Their names.
    """
    return [
        name
        for name, figure in figures.items()
        if figure.target not in ("all", "benchmark")
        and (figure.target in words or Path(folder, f"figures/{name}.png").is_file())
    ]


def chapters(figures: dict[str, Figure]) -> dict[str, str]:
    """Return each figure's chapter of the report, with the chapter's number.

    Parameters
    ----------
    figures : dict of str to Figure
        As from `study_figures`.

    Returns
    -------
    dict of str to str
        From each figure's name to its chapter, such as ``1 Oil and film``: in the order of the
        figures, measured times last.
    """
    ordered = sorted(figures.values(), key=lambda one: (one.target == "benchmark", one.name))
    names = list(dict.fromkeys(figure.chapter for figure in ordered))
    return {name: f"{1 + names.index(one.chapter)} {one.chapter}" for name, one in figures.items()}
