"""The registry of stages: the one place that says what each stage depends on.

A stage makes one kind of file. Its row names the stages whose files it reads and the values of
the study that it uses. From the rows follow the inputs and parameters of the Snakemake rules,
the values recorded in every file, and the list of datasets.

To add a stage `name`, add a row here, its file in ``files.csv`` and the variables in
``variables.csv``, the script ``workflow/scripts/name.py`` and the rule ``workflow/rules/name.smk``.
"""

from dataclasses import dataclass, field


@dataclass(frozen=True)
class Stage:
    """One row of the registry.

    Attributes
    ----------
    name : str
        Name of the stage, and of its rule, script, schema table and file (``film.nc``).
    inputs : tuple of str
        Stages whose files it reads.
    values : dict
        Values of the study that it uses: from the name of each value in the file's attribute
        ``config`` to the dotted attribute of `lube.study.study.Study`, or a mapping of such.
    same_values : tuple of str
        Stages whose values it uses too, without reading their files.
    target : str
        Target of Snakemake that makes the file: ``all``, or one that is made on request only,
        such as ``areal_contact``. Files of ``benchmark`` are not results of the study.
    only_with : tuple of str
        Attributes of the study without which there is no such file.
    """

    name: str
    inputs: tuple[str, ...] = ()
    values: dict = field(default_factory=dict)
    same_values: tuple[str, ...] = ()
    target: str = "all"
    only_with: tuple[str, ...] = ()


def _cylinder(roller):
    """Values of a roller without its roughness."""
    names = ("radius", "young_modulus", "poisson_ratio")
    return {name: f"rollers.{roller}.{name}" for name in names}


_MAPPED = {"only_with": ("follows_master_map",)}
_SURFACE = ("line_spec.is_gaussian", "line_spec.is_isotropic")
_GAUGED = ("follows_master_map", "conducts")
_LINES = {"seed": "seed", "lines": "line_spec"}
_LAYER = {"reduced_modulus": "rollers.reduced_modulus", "boundary_layer": "boundary_layer"}
_CONTACT = _LAYER | {
    "slide_to_roll_ratio": "operating_grid.slide_to_roll_ratio",
    "roughness_deformation": "roughness_deformation",
}

_ROWS = (
    Stage(
        "lubricant",
        values={"lubricants": "lubricant_values", "temperature": "operating_grid.temperature"},
    ),
    Stage(
        "film",
        inputs=("lubricant",),
        values={
            "rollers": {
                "length": "rollers.length",
                "first": _cylinder("first"),
                "second": _cylinder("second"),
            },
            "reduced_radius": "rollers.reduced_radius",
            "reduced_modulus": "rollers.reduced_modulus",
            "composite_rms_roughness": "rough_rollers.composite_rms_roughness",
            "film_formulas": "film_formulas",
            "film_shape": "film_shape",
            "force": "operating_grid.force",
            "speed": "operating_grid.speed",
            "slide_to_roll_ratio": "operating_grid.slide_to_roll_ratio",
            "inlet_shear_heating": "inlet_shear_heating",
            "inlet_meniscus": "inlet_meniscus",
        },
    ),
    Stage("roughness", values=_LINES),
    Stage(
        "surface",
        values={
            "surfaces": "measured_surfaces",
            "lines": "line_spec",
            "hurst_exponent": "roughness.hurst_exponent",
        },
        only_with=("topographies",),
    ),
    Stage(
        "contact",
        inputs=("film",),
        values=_LINES | _CONTACT | {"revolutions": "revolutions"},
        same_values=("roughness",),  # each batch draws its lines itself
    ),
    Stage("tail", inputs=("film",), values=_LINES | _CONTACT),
    Stage(
        "height_distribution",
        inputs=("film",),
        values=_LINES | _LAYER,
        same_values=("roughness",),  # whose lines have other distributions here
        only_with=("line_spec.is_drawn", "follows_master_map"),
    ),
    Stage(
        "master", inputs=("film",), values=_LINES | _LAYER, same_values=("roughness",), **_MAPPED
    ),
    Stage(
        "trace",
        inputs=("film", "roughness"),
        values=_LINES | _CONTACT | {"traces": "traces", "resistivity": "resistivity"},
    ),
    Stage(
        "experiment",
        inputs=("film",),
        values={
            **_LINES,
            **_CONTACT,
            "resistivity": "resistivity",
            "length": "rollers.length",
            "rig": "rig",
            "experiment": "evaluation",
            "grid": {
                "force": "operating_grid.force",
                "speed": "operating_grid.speed",
                "temperature": "operating_grid.temperature",
            },
        },
        same_values=("roughness",),  # it draws the lines of the simulated rig's rollers
        only_with=("conducts",),
    ),
    Stage(
        "rig",
        inputs=("film",),
        values={"traces": "traces"},
        same_values=("experiment",),
        only_with=("conducts",),
    ),
    Stage("comparison", inputs=("film", "contact", "experiment"), only_with=("conducts",)),
    Stage("gauge", inputs=("master", "contact", "comparison"), only_with=_GAUGED),
    Stage(
        "areal",
        inputs=("film",),
        values=_LINES | _CONTACT | {"length": "rollers.length"},
        target="areal_contact",
        only_with=(*_SURFACE, "follows_master_map"),
    ),
    Stage(
        "areal_gauge",
        inputs=("film", "areal", "comparison", "gauge"),
        target="areal_contact",
        only_with=(*_SURFACE, *_GAUGED),
    ),
    Stage(
        "patch",
        values=_LINES | {"reduced_modulus": "rollers.reduced_modulus"},
        target="patch_contact",
        only_with=_SURFACE,
    ),
    Stage("film_profile", inputs=("lubricant",), same_values=("film",), target="computed"),
    Stage(
        "film_shape",
        inputs=("film", "film_profile"),
        values=_LINES | _LAYER,
        target="computed",
        only_with=("line_spec.is_gaussian",),
    ),
    Stage(
        "flattening",
        inputs=("film",),
        values=_LINES | _LAYER | {"realisations": "realisations"},
        target="computed",
    ),
    Stage(
        "film_plane",
        inputs=("lubricant",),
        values={"reduced_modulus": "rollers.reduced_modulus"},
        target="computed",
    ),
    Stage("constant", inputs=("lubricant", "film", "master"), target="computed", **_MAPPED),
    Stage(
        "coverage",
        values={"realisations": "realisations"},
        same_values=("contact", "master", "experiment"),
        target="benchmark",
        only_with=("conducts",),
    ),
    Stage("speed", same_values=("contact",), target="benchmark"),
    Stage("reading", target="benchmark"),
)

STAGES = {row.name: row for row in _ROWS}
"""The registry: from name to `Stage`, each after those it depends on."""

DATASETS = tuple(row.name for row in _ROWS if row.target == "all")
"""The results of a study, one file each, some of them `only_with` what the study may lack."""

ON_REQUEST = {row.name: row.target for row in _ROWS if row.target != "all"}
"""Files that are made on request only, each with the target of Snakemake that makes it."""


def forerunners(stage: str) -> tuple[str, ...]:
    """Return all stages whose values a stage depends on, directly or through others.

    Parameters
    ----------
    stage : str
        Name of the stage.

    Returns
    -------
    tuple of str
        Their names, in the order of the registry.

    Examples
    --------
    >>> forerunners("trace")
    ('lubricant', 'film', 'roughness')
    """
    direct = {*STAGES[stage].inputs, *STAGES[stage].same_values}
    found = direct.union(*(forerunners(name) for name in direct))
    return tuple(name for name in STAGES if name in found)
