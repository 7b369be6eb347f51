"""The registry of stages: it alone says what each stage depends on.

A stage makes one kind of file. Its row, a section of ``stages.toml``, names the stages whose files
it reads and the values of the study that it uses. From the rows follow the inputs and parameters of
the Snakemake rules, the values recorded in every file, and the list of datasets.

To add a stage `name`, add its row to ``stages.toml``, its file to ``files.csv`` and the variables
to ``variables.csv``, and the function `make` in ``lube/stages/name.py``.
"""

import tomllib
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from pathlib import Path


@dataclass(frozen=True)
class Stage:
    """One row of the registry.

    Attributes
    ----------
    name : str
        Name of the stage, and of its rule, module, schema table and file (``film.nc``).
    says : str
        What it makes, in a few words, for the messages of Snakemake.
    inputs : sequence of str
        Stages whose files it reads, as far as the study has them.
    inputs_with : dict
        Further stages whose files it reads, each with the attribute of the study that asks for it.
    values : dict
        Values of the study that it uses: from the name of each value in the file's attribute
        ``config`` to the dotted attribute of `lube.study.study.Study`.
    same_values : sequence of str
        Stages whose values it uses too, without reading their files.
    target : str
        Target of Snakemake that makes the file: ``all``, or one that is made on request only,
        such as ``areal_contact``. Files of ``benchmark`` are not results of the study.
    only_with : sequence of str
        Attributes of the study without which there is no such file.
    written : str
        Attribute of `lube.pipeline.study_files.StudyFiles` that lists those files, written by
        people, that the stage reads; none by default.
    parameters : sequence of str
        Further attributes of the study that the file depends on; its ``config`` leaves them out.
    priority : int
        Jobs of a higher priority are started first.
    parallel : bool or str
        Whether a job uses all cores, or the attribute of the study with which it does; one of
        ``benchmark`` always does.
    in_batches : str
        Whether it joins batches, and of what: ``realisations`` or ``samples``.
    """

    name: str
    says: str
    inputs: Sequence[str] = ()
    inputs_with: dict[str, str] = field(default_factory=dict)
    values: dict[str, str] = field(default_factory=dict)
    same_values: Sequence[str] = ()
    target: str = "all"
    only_with: Sequence[str] = ()
    written: str = ""
    parameters: Sequence[str] = ()
    priority: int = 0
    parallel: bool | str = False
    in_batches: str = ""

    @property
    def rule(self) -> str:
        """Name of its rule, other than that of its target."""
        return self.name if self.name != self.target else f"{self.name}_file"

    @property
    def message(self) -> str:
        """Message of its jobs."""
        return f"{self.name.replace('_', ' ').capitalize()}: {self.says}"


_TABLES = tomllib.loads(Path(__file__).with_suffix(".toml").read_text(encoding="utf-8"))


def _named(values):
    """Map the name of each value to its attribute, groups resolved."""
    found = {}
    for value in values:
        name, _, attribute = value.rpartition("=")
        if value in _TABLES["groups"]:
            found |= _named(_TABLES["groups"][value])
        else:
            found[name or attribute.rpartition(".")[2]] = attribute
    return found


STAGES = {
    name: Stage(name, **row | {"values": _named(row.get("values", ()))})
    for name, row in _TABLES["stages"].items()
}
"""The registry: from name to `Stage`, each after those it depends on."""

CONDITIONS: dict[str, str] = _TABLES["conditions"]
"""What a study needs for the stages that are `only_with` it, in words."""

TARGETS: dict[str, str] = _TABLES["targets"]
"""The targets of Snakemake that make files on request, each with a sentence for its list."""

DATASETS = tuple(row.name for row in STAGES.values() if row.target == "all")
"""The results of a study, one file each; a study may lack some of them (`only_with`)."""

ON_REQUEST = {row.name: row.target for row in STAGES.values() if row.target != "all"}
"""Files that are made on request only, each with the target of Snakemake that makes it."""


def forerunners(stage: str, asks: Callable[[str], bool] = lambda _: True) -> tuple[str, ...]:
    """Return all stages whose values a stage depends on, directly or through others.

    Parameters
    ----------
    stage : str
        Name of the stage.
    asks : callable, optional
        Whether a study has an attribute that asks for further inputs (`Stage.inputs_with`). By
        default it has all of them.

    Returns
    -------
    tuple of str
        Their names, in the order of the registry.

    Examples
    --------
    >>> forerunners("trace")
    ('lubricant', 'film', 'roughness')
    """
    row = STAGES[stage]
    asked = (name for name, attribute in row.inputs_with.items() if asks(attribute))
    direct = {*row.inputs, *row.same_values, *asked}
    found = direct.union(*(forerunners(name, asks) for name in direct))
    return tuple(name for name in STAGES if name in found)
