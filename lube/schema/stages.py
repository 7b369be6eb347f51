"""The registry of stages: it alone says what each stage depends on.

A stage makes one kind of file. Its row names the stages whose files it reads and the values of
the study that it uses. From the rows follow the inputs and parameters of the Snakemake rules,
the values recorded in every file, and the list of datasets.

To add a stage `name`, add a row here, its file in ``files.csv`` and the variables in
``variables.csv``, and the function `make` in ``lube/stages/name.py``.
"""

from collections.abc import Callable
from dataclasses import dataclass, field


@dataclass(frozen=True)
class Stage:
    """One row of the registry.

    Attributes
    ----------
    name : str
        Name of the stage, and of its rule, module, schema table and file (``film.nc``).
    says : str
        What it makes, in a few words, for the messages of Snakemake.
    inputs : tuple of str
        Stages whose files it reads, as far as the study has them.
    inputs_with : dict
        Further stages whose files it reads, each with the attribute of the study that asks for it.
    values : dict
        Values of the study that it uses: from the name of each value in the file's attribute
        ``config`` to the dotted attribute of `lube.study.study.Study`, or to a nested mapping.
    same_values : tuple of str
        Stages whose values it uses too, without reading their files.
    target : str
        Target of Snakemake that makes the file: ``all``, or one that is made on request only,
        such as ``areal_contact``. Files of ``benchmark`` are not results of the study.
    only_with : tuple of str
        Attributes of the study without which there is no such file.
    written : str
        Attribute of `lube.pipeline.study_files.StudyFiles` that lists those files, written by
        people, that the stage reads; none by default.
    parameters : tuple of str
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
    inputs: tuple[str, ...] = ()
    inputs_with: dict[str, str] = field(default_factory=dict)
    values: dict = field(default_factory=dict)
    same_values: tuple[str, ...] = ()
    target: str = "all"
    only_with: tuple[str, ...] = ()
    written: str = ""
    parameters: tuple[str, ...] = ()
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


def _named(attributes):
    """Values by the last parts of their dotted attributes."""
    return {attribute.rpartition(".")[2]: attribute for attribute in attributes.split()}


def _cylinder(roller):
    """Values of a roller without its roughness."""
    names = ("radius", "young_modulus", "poisson_ratio")
    return {name: f"rollers.{roller}.{name}" for name in names}


_SURFACE = ("line_spec.is_gaussian", "line_spec.has_surface")
_LINE = ("line_spec.follows_rolling",)
_LINES = {"seed": "seed", "lines": "line_spec"}
_LAYER = _named("rollers.reduced_modulus boundary_layer")
_CONTACT = _LAYER | _named("operating_grid.slide_to_roll_ratio roughness_deformation")

_ROWS = (
    Stage(
        "lubricant",
        "viscosity fits, density and pressure-viscosity coefficient",
        values={"lubricants": "lubricant_values", "temperature": "operating_grid.temperature"},
        priority=1,
    ),
    Stage(
        "film",
        "Hertz contact and film thickness over forces, speeds and temperatures",
        inputs=("lubricant",),
        values={
            "rollers": {"length": "rollers.length"}
            | {name: _cylinder(name) for name in ("first", "second")},
            **_named(
                "rollers.reduced_radius rollers.reduced_modulus "
                "rough_rollers.composite_rms_roughness film_formulas film_shape "
                "operating_grid.force operating_grid.speed operating_grid.slide_to_roll_ratio "
                "inlet_shear_heating inlet_meniscus answered_lines "
                "rough_surfaces load_sharing"
            ),
        },
        priority=1,
    ),
    Stage(
        "roughness",
        "the kept realisations, with their moments",
        values=_LINES,
        parameters=("kept_realisations",),
        only_with=_LINE,
    ),
    Stage(
        "surface",
        "spectrum and heights of the measured topographies",
        values={
            "surfaces": "measured_surfaces",
            "lines": "line_spec",
            "hurst_exponent": "roughness.hurst_exponent",
        },
        only_with=("topographies",),
        written="topography_files",
    ),
    Stage(
        "contact",
        "probabilities of all realisations and their intervals",
        inputs=("film",),
        values=_LINES | _CONTACT | _named("revolutions"),
        same_values=("roughness",),  # each batch draws its lines itself
        in_batches="realisations",
        only_with=_LINE,
    ),
    Stage(
        "surface_response",
        "response of the film to waves of a surface, at any angle, several minutes",
        inputs=("lubricant", "film"),
        values={"lines": "line_spec"} | _named("operating_grid.slide_to_roll_ratio"),
        target="computed",
        only_with=_SURFACE,
        parallel=True,
    ),
    Stage(
        "areal",
        "contact of the surfaces that the lines stand for, a minute or more",
        inputs=("film",),
        inputs_with={"surface_response": "gap.is_answered"},
        values=_LINES | _CONTACT | _named("rollers.length"),
        parameters=("has_surfaces",),
        target="areal_contact",
        only_with=(*_SURFACE, "gap.is_on_surfaces"),
        parallel=True,
    ),
    Stage(
        "surface_trace",
        "contacts of the surfaces along the rollers, at the points of the traces",
        inputs=("film",),
        inputs_with={"surface_response": "gap.is_answered"},
        values=_LINES | _CONTACT | _named("traces resistivity rig rollers.length"),
        target="areal_contact",
        only_with=(*_SURFACE, "gap.is_on_surfaces"),
        parallel=True,
    ),
    Stage(
        "tail",
        "probability and rate of contact, however rare",
        inputs=("film",),
        inputs_with={"areal": "has_surfaces"},
        values=_LINES | _CONTACT | _named("contact_model"),
        priority=2,
    ),
    Stage(
        "height_distribution",
        "probabilities by skewness and kurtosis",
        inputs=("film",),
        values=_LINES | _LAYER | _named("roughness_deformation"),
        same_values=("roughness",),  # the same lines, with other height distributions
        only_with=(*_LINE, "line_spec.is_drawn"),
        priority=2,
    ),
    Stage(
        "master",
        "map of probabilities over lambda ratio and contact width",
        inputs=("film",),
        values=_LINES | _LAYER,
        same_values=("roughness",),
        in_batches="realisations",
        only_with=(*_LINE, "gap.is_plain"),
    ),
    Stage(
        "trace",
        "contact length and resistance over one revolution",
        inputs=("film", "roughness"),
        values=_LINES | _CONTACT | _named("traces resistivity"),
        only_with=_LINE,
    ),
    Stage(
        "experiment",
        "contact shares of the rig's records",
        inputs=("film",),
        inputs_with={"surface_response": "rig_is_answered"},
        values={
            **_LINES,
            **_CONTACT,
            **_named("resistivity rollers.length rig"),
            "experiment": "evaluation",
            "grid": _named("operating_grid.force operating_grid.speed operating_grid.temperature"),
        },
        same_values=("roughness",),  # it draws the lines of the simulated rig's rollers
        only_with=("conducts", "has_records"),
        parallel="rig.has_surfaces",
        written="measured_files",
        priority=2,
    ),
    Stage(
        "rig",
        "voltage and resistance at the trace points, and contact shares by bandwidth",
        inputs=("film",),
        inputs_with={"surface_response": "rig_is_answered"},
        values=_named("traces"),
        same_values=("experiment",),
        only_with=(*_LINE, "conducts"),
        parallel="rig.has_surfaces",
    ),
    Stage(
        "surface_records",
        "contact of the surfaces at the films of the records, some minutes",
        inputs=("film", "experiment", "areal"),
        inputs_with={"surface_response": "gap.is_answered"},
        only_with=("compares_surfaces",),
        parallel=True,
    ),
    Stage(
        "comparison",
        "breakthrough probability against the contact share of each record",
        inputs=("film", "contact", "experiment"),
        inputs_with={"surface_records": "compares_surfaces"},
        values=_named("contact_model"),
        only_with=("conducts", "has_records"),
    ),
    Stage(
        "gauge",
        "films, pressure-viscosity coefficient and boundary layer from the records",
        inputs=("master", "comparison"),
        inputs_with={"surface_records": "compares_surfaces"},
        only_with=("conducts", "has_records"),
    ),
    Stage(
        "areal_gauge",
        "films gauged from the records, by contact of the surface",
        inputs=("film", "areal", "comparison", "gauge"),
        target="areal_contact",
        only_with=(*_LINE, *_SURFACE, "gap.is_plain", "conducts", "compares_lines_only"),
    ),
    Stage(
        "patch",
        "surfaces pressed against a flat, several minutes",
        values=_LINES | _named("rollers.reduced_modulus"),
        target="patch_contact",
        only_with=(*_SURFACE, "line_spec.is_isotropic"),
    ),
    Stage(
        "film_profile",
        "pressure and film across the contact, by Reynolds' equation",
        inputs=("lubricant",),
        same_values=("film",),
        target="computed",
    ),
    Stage(
        "film_response",
        "response of the film to waves of the roughness, a minute or two",
        inputs=("lubricant", "film"),
        values={"lines": "line_spec"} | _named("operating_grid.slide_to_roll_ratio"),
        target="computed",
        parallel=True,
        only_with=_LINE,
    ),
    Stage(
        "variants",
        "contact with choices of the model changed, several minutes",
        inputs=("lubricant", "film", "film_profile", "film_response", "surface_response"),
        values=_LINES | _LAYER | _named("realisations roughness_deformation rollers.length"),
        target="computed",
        parallel=True,
        only_with=_LINE,
    ),
    Stage(
        "passage",
        "passage of rough lines by the transient Reynolds equation, some ten minutes",
        inputs=("lubricant", "film_profile"),
        values=_LINES | _LAYER | {"slide_to_roll_ratio": "operating_grid.slide_to_roll_ratio"},
        target="rough_passage",
        parallel=True,
        only_with=_LINE,
    ),
    Stage(
        "indicators",
        "published indicators of lubrication, compared with the computed film",
        inputs=("lubricant", "film", "film_profile"),
        values=_named("rollers.length rough_rollers.mean_ra_roughness"),
        target="computed",
    ),
    Stage(
        "heating_plane",
        "thinning of the film by inlet heating, by every model",
        inputs=("lubricant", "film"),
        target="computed",
    ),
    Stage(
        "film_plane",
        "computed film over Moes' numbers, some seconds a lubricant",
        inputs=("lubricant",),
        values=_named("rollers.reduced_modulus"),
        target="computed",
    ),
    Stage(
        "sensitivity_responses",
        "responses of the film for random values of what is uncertain, some minutes",
        values=_LINES | _named("roughness_deformation contact_model uncertainty"),
        same_values=("film",),
        target="sensitivity",
        only_with=("is_uncertain", "is_sampled", "answers_samples", *_LINE),
        parallel=True,
    ),
    Stage(
        "sensitivity_runs",
        "probabilities for random values of what is uncertain",
        values=_LINES | _CONTACT | _named("rollers.length contact_model uncertainty"),
        same_values=("film",),
        target="sensitivity",
        only_with=("is_uncertain", "is_sampled", *_LINE),
        in_batches="samples",
    ),
    Stage(
        "sensitivity",
        "what the probability rests on, by Morris and Sobol, some minutes",
        inputs=("sensitivity_runs",),
        inputs_with={"sensitivity_responses": "answers_samples"},
        target="sensitivity",
        only_with=("is_uncertain", "is_sampled", *_LINE),
        parallel=True,
    ),
    Stage(
        "record_bands",
        "which band of the model explains each record",
        inputs=("comparison", "sensitivity_runs"),
        inputs_with={
            "surface_records": "compares_surfaces",
            "sensitivity_responses": "answers_samples",
        },
        target="sensitivity",
        only_with=("is_uncertain", "is_sampled", *_LINE, "conducts", "has_records"),
    ),
    Stage(
        "electrical",
        "what electrical meters read at every operating point, some seconds",
        inputs=("film", "contact"),
        inputs_with={"surface_response": "rig_is_answered"},
        values=_named("resistivity resistivity_range rollers.length rig")
        | {"experiment": "evaluation"},
        target="electrical",
        only_with=("is_sampled", *_LINE, "conducts"),
        parallel=True,
    ),
    Stage(
        "plan",
        "what a record at each operating point would tell",
        inputs=("lubricant", "film", "contact", "electrical", "sensitivity"),
        inputs_with={"areal": "has_surfaces", "surface_response": "answered_surfaces"},
        values=_LINES | _LAYER | _named("contact_model") | {"drift": "rig.drift"},
        target="measurement_plan",
        only_with=("is_sampled", *_LINE, "conducts"),
        parallel=True,
    ),
    Stage(
        "verification",
        "methods against theory, other methods and print, some 20 seconds",
        inputs=("lubricant",),
        values=_LINES | _LAYER,
        same_values=("film",),
        target="verification",
        only_with=("is_sampled", *_LINE),
        parallel=True,
    ),
    Stage(
        "coverage",
        "how often intervals contain the true value for new rollers, about 30 minutes",
        values=_named("realisations"),
        same_values=("contact", "master", "experiment"),
        target="benchmark",
        only_with=(*_LINE, "conducts"),
    ),
    Stage(
        "speed",
        "the study's kernels against plain versions of the same work, a few minutes",
        same_values=("contact",),
        target="benchmark",
        only_with=_LINE,
    ),
    Stage(
        "reading",
        "time to read records, against other readers of the same files, a few minutes",
        target="benchmark",
    ),
)

STAGES = {row.name: row for row in _ROWS}
"""The registry: from name to `Stage`, each after those it depends on."""

DATASETS = tuple(row.name for row in _ROWS if row.target == "all")
"""The results of a study, one file each; a study may lack some of them (`only_with`)."""

ON_REQUEST = {row.name: row.target for row in _ROWS if row.target != "all"}
"""Files that are made on request only, each with the target of Snakemake that makes it."""

TARGETS = {
    "areal_contact": "Contact of the surface that the lines stand for.",
    "patch_contact": "Squares of the isotropic surface pressed against a flat.",
    "computed": "Computed films, and contact under them.",
    "rough_passage": "Passage of rough lines, by the transient Reynolds equation.",
    "sensitivity": "What the probability of contact rests on.",
    "electrical": "What electrical meters read of the contact.",
    "measurement_plan": "What to measure next, by the sensitivity study, which is made first.",
    "verification": "The study's methods against theory, other methods and print.",
    "benchmark": "Measured times and coverage of intervals.",
}
"""The targets of Snakemake that make files on request, each with a sentence for its list."""


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
