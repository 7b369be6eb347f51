"""``lube new``: write a commented study for given rollers and oils, based on the paper's."""

import json
import os
import re
from collections.abc import Mapping, Sequence
from contextlib import ExitStack
from pathlib import Path

from lube.commands.run import repository
from lube.errors import DataError, LubeError, located, shown
from lube.pipeline.command_line import PAPER
from lube.report.pages import render
from lube.storage.files import write_text
from lube.study.lubricant_record import is_record_path
from lube.study.rollers import LONGEST_WAVELENGTH, SHORTEST_WAVELENGTH, grid_points
from lube.study.schema_files import schema_line
from lube.study.study import load_study
from lube.types import File
from lube.units import parse_quantity

OF_ROLLERS = {"radius": "m", "roughness": "m"}
"""Options for one or two numbers with a unit, and the kind of unit."""

OF_GRID = {"force": "N", "speed": "rpm", "temperature": "degC"}
"""Options for levels with a unit, and the kind of unit."""

_RADIUS = ["50"], "mm"  # of the paper's rollers

_NUMBER = r"[+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?(?:/\d+)?"
_NUMBERS = re.compile(rf"((?:{_NUMBER},?\s+)*{_NUMBER})\s*(1/\w+|[^\d\s/,.].*)")


def new_study(
    path: File,
    quantities: Mapping[str, str],
    oils: Sequence[str] = (),
    realisations: int | None = None,
    records: File | None = None,
) -> list[Path]:
    """Write a study, and a list of records to fill in.

    Parameters
    ----------
    path : str or Path
        YAML file to write; its stem is the study's name. Its folder is created if needed.
    quantities : dict of str to str
        Numbers with a unit, such as ``100 200 N``, for any of `OF_ROLLERS` and `OF_GRID`.
    oils : sequence of str, optional
        Names of shipped lubricant records, or paths of records.
    realisations : int, optional
        Number of pairs of roughness lines.
    records : str or Path, optional
        List of measured records, CSV; if the file is missing, an empty list is written.

    Returns
    -------
    list of Path
        The files that were written, the study first.

    Raises
    ------
    LubeError
        If the study's file exists, or the study cannot be carried out; then no new file is left.
    """
    path = Path(path)
    if path.suffix not in (".yaml", ".yml"):
        raise LubeError(f"got {path}, need the name of a .yaml file")
    if path.exists():
        raise DataError(f"{path}: exists already, need a new name")
    folder = path.resolve().parent
    numbers = {name: _numbers(name, text) for name, text in quantities.items()}
    texts = {
        "base": os.path.relpath(repository(folder) / PAPER, folder),
        "oils": [os.path.relpath(oil, folder) if is_record_path(oil) else oil for oil in oils],
        "records": records and os.path.relpath(records, folder),
    }
    (radius, *_), unit = numbers.get("radius", _RADIUS)
    waves = {"longest": LONGEST_WAVELENGTH, "shortest": SHORTEST_WAVELENGTH}
    lengths = (parse_quantity(one, "m") for one in (f"{radius} {unit}", SHORTEST_WAVELENGTH))
    text = render(
        "study.yaml",
        **{name: text and json.dumps(text, ensure_ascii=False) for name, text in texts.items()},
        **waves | {"schema": schema_line("study", path), "path": path, "name": path.stem},
        points=grid_points(*lengths),
        numbers=numbers,
        realisations=realisations,
    )
    return _written(path, text, None if records is None else Path(records))


def _numbers(option, text):
    """Split ``100, 200 N`` into numbers and unit, as they are written."""
    match = _NUMBERS.fullmatch(text.strip())
    if match is None:
        needed = "need numbers with a unit, and spaces between them, as in `1.5 2 mm`"
        raise LubeError(f"--{option}: got {shown(text)}, {needed}")
    values, units = match[1].replace(",", " ").split(), match[2]
    if option in OF_ROLLERS and len(values) > 2:
        raise LubeError(f"--{option}: got {shown(text)}, need one number, or one for each roller")
    with located(f"--{option}"):
        for value in values:
            parse_quantity(f"{value} {units}", (OF_ROLLERS | OF_GRID)[option])
    return values, units


def _written(path, text, records):
    """Write the files and check the study; if it is refused, no new file is left."""
    texts = {path: text}
    if records is not None and not records.exists():
        texts.setdefault(records, render("records.csv"))
    with ExitStack() as written:
        for file, content in texts.items():
            write_text(file, content)
            written.callback(file.unlink)
        load_study(path)
        written.pop_all()
    return [*texts]
