"""The figures of a study, from their notebooks' cells: what each needs and what it says."""

import functools
from dataclasses import dataclass
from pathlib import Path

from lube.report.markdown import title_and_text
from lube.schema import MEASURED
from lube.study.study import Study
from lube.workflow.cells import cells_of, datasets_of, python_of
from lube.workflow.sources import script_sources, sources

FURTHER = "further-figures"
"""Chapter of a notebook that names none."""


@dataclass(frozen=True)
class Figure:
    """One notebook of the folder ``notebooks``, read before any job.

    Attributes
    ----------
    notebook : Path
        The notebook. Its name, such as ``fig02_film``, is the figure's.
    """

    notebook: Path

    @property
    def name(self) -> str:
        """Name of the figure."""
        return self.notebook.stem

    @functools.cached_property
    def cells(self) -> list[dict]:
        """Cells reduced to what decides on the figure: kinds, sources and tags."""
        return cells_of(self.notebook)

    @functools.cached_property
    def datasets(self) -> list[str]:
        """Kinds of the datasets that its parameters cell names."""
        return sorted(set(datasets_of(self.notebook).values()))

    @property
    def measured(self) -> bool:
        """Whether it shows measured times; such a figure is made on request only."""
        return not set(self.datasets).isdisjoint(MEASURED)

    @functools.cached_property
    def sources(self) -> list[str]:
        """Files of the lube package that its cells and the script ``figure.py`` depend on."""
        code = (python_of(cell, self.notebook) for cell in self.cells if cell["type"] == "code")
        return sorted({*sources("\n".join(code)), *script_sources("figure")})

    @property
    def title(self) -> str:
        """Heading of its first cell, in Markdown; without one, its name."""
        return self._words[0] or self.name

    @property
    def text(self) -> str:
        """Text of its first cell below the heading, in Markdown."""
        return self._words[1]

    @property
    def chapter(self) -> str:
        """Chapter of the report, from a tag such as ``chapter-oil-and-film``."""
        words = [*self._tagged("chapter-"), FURTHER][0]
        return words.replace("-", " ").capitalize()

    def fits(self, study: Study) -> bool:
        """Tell whether a study has what the figure compares.

        Parameters
        ----------
        study : Study
            The study.

        Returns
        -------
        bool
            False if a tag such as ``several-force`` asks for several levels where the study
            has one.
        """
        levels = study.operating_grid.model_dump()
        return all(len(levels.get(name, ())) > 1 for name in self._tagged("several-"))

    @functools.cached_property
    def _words(self):
        first = self.cells[:1]
        return title_and_text("".join(c["source"] for c in first if c["type"] == "markdown"))

    def _tagged(self, prefix):
        tags = [tag for cell in self.cells for tag in cell["tags"]]
        return [tag.removeprefix(prefix) for tag in tags if tag.startswith(prefix)]


def study_figures(study: Study, folder: str | Path = "notebooks") -> dict[str, Figure]:
    """List the figures that a study can draw.

    Parameters
    ----------
    study : Study
        The study.
    folder : str or Path, optional
        Folder of the notebooks.

    Returns
    -------
    dict of str to Figure
        By name, sorted.

    Raises
    ------
    LubeError
        If a notebook is damaged, is not Python or has no parameters cell.
    """
    figures = [Figure(path) for path in sorted(Path(folder).glob("*.ipynb"))]
    for figure in figures:
        # Read now, so that a mistake is reported before any job.
        figure.datasets, figure.sources  # noqa: B018
    return {figure.name: figure for figure in figures if figure.fits(study)}


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
    ordered = sorted(figures.values(), key=lambda figure: (figure.measured, figure.name))
    names = list(dict.fromkeys(figure.chapter for figure in ordered))
    return {name: f"{1 + names.index(one.chapter)} {one.chapter}" for name, one in figures.items()}
