"""Draw the figures of an archive again from its own content and compare them."""

from collections.abc import Iterator
from pathlib import Path

from lube.errors import DataError
from lube.pipeline.figures import paths_for, read_origin
from lube.pipeline.notebooks import execute_notebook
from lube.types import File


def redraw(folder: File, target: File, figures: list[str]) -> Iterator[tuple[str, bool]]:
    """Draw figures of an archive again, from its datasets and notebooks alone.

    Parameters
    ----------
    folder : str or Path
        The archive, from `lube.archive.verify.unpacked`.
    target : str or Path
        Folder for the new figures, outside the archive.
    figures : list of str
        Names of the figures, such as ``fig02_film``; all figures if the list is empty.

    Yields
    ------
    str, bool
        Name of a file, such as ``fig02_film.png``, and whether it equals the archived one, byte
        for byte.

    Raises
    ------
    LubeError
        If there is no such figure, or its notebook cannot be executed.
    """
    folder, target = Path(folder).resolve(), Path(target).resolve()
    if target.is_relative_to(folder) or target.is_file():
        raise DataError(f"got {target} for the new figures, need a folder outside the archive")
    archived = sorted(path.stem for path in (folder / "figures").glob("*.png"))
    for figure in figures:
        if figure not in archived:
            raise DataError(f"got {figure}, need a figure of the archive: {', '.join(archived)}")
    datasets = list((folder / "data").glob("*.nc"))
    for figure in figures or archived:
        notebook = folder / "code/notebooks" / f"{figure}.ipynb"
        parameters = {**paths_for(notebook, datasets), "figure": str(target / figure)}
        changes = read_origin(figure, folder)["drawn_by"]
        # The notebook imports the archived code, not an installed one.
        execute_notebook(notebook, target / notebook.name, parameters, changes, folder / "code")
        for name in (f"{figure}.png", f"{figure}.pdf"):
            old, new = folder / "figures" / name, target / name
            yield name, old.is_file() and old.read_bytes() == new.read_bytes()
