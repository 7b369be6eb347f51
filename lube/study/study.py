"""A study: its values, checked as a whole before anything is computed.

The models below are the only description of the configuration. The documented table of keys
follows from their JSON schema and the one-line errors from their validators.
`Study.stage_inputs` gives the values that a stage depends on, so that a change re-runs only that
stage and those after it.
"""

from operator import attrgetter
from pathlib import Path
from typing import Annotated, Any

from pydantic import Field, StrictInt, WithJsonSchema, field_validator, model_validator
from pydantic_core import to_jsonable_python

from lube import types
from lube.errors import StudyError, located, shown
from lube.grid.gap import Gap
from lube.grid.levels import SAME, level_index
from lube.schema.stages import ON_REQUEST, STAGES, forerunners
from lube.study.field_types import Slug, StrictModel, each_once, quantity_or_words, validate
from lube.study.line_spec import LineSpec
from lube.study.lubricant_record import LubricantRecord, load_record
from lube.study.metadata import About
from lube.study.operating_grid import OperatingGrid, TracePoint
from lube.study.resolve import resolved_content, with_paths
from lube.study.rig_checks import check_rig
from lube.study.rig_settings import RIG_REALISATIONS, Experiment, Rig
from lube.study.roller_lines import band_in_words, line_spec
from lube.study.roller_topography import RollerTopography
from lube.study.rollers import INSULATOR, ROLLERS, BoundaryLayer, RollerPair, Roughness
from lube.study.size_limits import check_sizes
from lube.study.uncertainty import FilmFormula, Uncertainty
from lube.units import with_unit


class Study(StrictModel):
    """A whole study, checked, in SI units (except rpm and degC)."""

    name: Slug
    """results go to results/<name>"""
    about: About = Field(default_factory=About)
    """title, authors and licence"""
    seed: Annotated[StrictInt, Field(ge=0, le=2**63 - 1)]
    """seed of all random numbers"""
    realisations: Annotated[StrictInt, Field(ge=1, le=RIG_REALISATIONS)]
    """number of pairs of roughness lines"""
    revolutions: Annotated[StrictInt, Field(ge=1, le=1000)]
    """revolutions of the roller with the faster surface; equal rollers without slip repeat
    themselves after one
    """
    batch_size: Annotated[StrictInt, Field(ge=1, le=RIG_REALISATIONS)]
    """realisations per job; changes no result"""
    kept_realisations: tuple[Annotated[StrictInt, Field(ge=0)], ...]
    """realisations whose lines stay in roughness.nc, 0 among them"""
    rollers: RollerPair
    lubricants: Annotated[
        tuple[LubricantRecord, ...],
        Field(min_length=1),
        WithJsonSchema({"form": "records", "format": "list of names or paths"}),
    ]
    """names of shipped records, or paths of your own YAML records"""
    film_formulas: tuple[FilmFormula, ...] = Field(min_length=1)
    """names from the registry of film formulas"""
    film_shape: types.FilmShape = "flat"
    """flat, and cut off at the edges of the contact, as in the paper; or computed by Reynolds'
    equation, with the gap outside the contact
    """
    inlet_shear_heating: types.InletHeating = "none"
    """how heating of the oil at the inlet thins the film, the more so the more the rollers slip: by
    the formula of Zhu and Cheng (1988) or that of Wilson and Sheu (1983), which differ with slip,
    or by the equation behind the latter
    """
    inlet_meniscus: Annotated[float | str, quantity_or_words("m", "none", "^none$")] = "none"
    """distance of the oil's meniscus before the line of centres, more than the half-width of the
    contact; without it the contact is fully flooded
    """
    load_sharing: types.LoadSharing = "none"
    """none, the oil carries the whole load, as in the paper; or iterated, the asperities of the
    rollers' surfaces carry a share of it, and the film is that of the rest
    """
    operating_grid: OperatingGrid
    roughness: Roughness
    roughness_deformation: types.RoughnessDeformation = "none"
    """none, as in the paper; computed, the oil deforms each wave of the roughness by the linear
    response of Reynolds' equation about the computed film; or venner-1997, the oil flattens long
    waves by the formula of Venner et al., for pure rolling and Moes' load numbers above 20
    """
    contact_model: tuple[types.ContactModel, ...] = Field(("line",), min_length=1)
    """line, as in the paper; surface, the rough surface that the line stands for, over the length
    of the rollers; or a list of both. Rollers whose ridges run along rolling have no such line, and
    need [surface]
    """
    boundary_layer: BoundaryLayer
    resistivity: Annotated[float | str, quantity_or_words("ohm*m", INSULATOR, f"^{INSULATOR}$")]
    """resistivity of the rollers' material (Eq. 1); insulator, if either does not conduct, so that
    there is neither a resistance nor a rig
    """
    traces: tuple[TracePoint, ...] = Field(min_length=1)
    """operating points recorded over one revolution"""
    rig: Rig = Field(default_factory=Rig)
    """the simulated rig, and the drift assumed for measured records"""
    experiment: Experiment = Field(default_factory=Experiment)
    """records of the rig and their evaluation"""
    uncertainty: Uncertainty | None = None
    """what is not known exactly, for the sensitivity study"""

    _each_once = field_validator("kept_realisations", "film_formulas", "contact_model")(each_once)

    @property
    def title(self) -> str:
        """Title of the results: as given, or else one with the study's name."""
        return self.about.title or f"Mixed lubrication study {self.name}"

    @property
    def line_spec(self) -> LineSpec:
        """What determines the roughness lines of this study."""
        return line_spec(self.rollers, self.roughness, max(self.operating_grid.force))

    @property
    def band(self) -> str:
        """Band of wavelengths of the roughness, in words."""
        return band_in_words(self.rollers, self.roughness, self.line_spec)

    @property
    def rough_rollers(self) -> RollerPair:
        """The rollers, with the rms heights that their lines have."""
        return self.rollers.with_rms_heights(self.line_spec.rms_height)

    @property
    def inlet_model(self) -> dict[str, Any]:
        """What the study assumes of the inlet, as arguments of `lube.grid.films.film_at`."""
        meniscus = None if self.inlet_meniscus == "none" else self.inlet_meniscus
        return {"inlet_shear_heating": self.inlet_shear_heating, "inlet_meniscus": meniscus}

    @property
    def film_model(self) -> dict[str, Any]:
        """What the study assumes of its films, as arguments of `lube.stages.film.film_table`."""
        return {
            "with_shape": self.film_shape != "flat",
            **self.inlet_model,
            "answered_lines": self.answered_lines,
            "rough_surfaces": self.rough_surfaces,
            "load_sharing": self.load_sharing,
        }

    @property
    def rough_surfaces(self) -> LineSpec | None:
        """Lines that stand for surfaces, where the load on their asperities is asked for."""
        return self.line_spec if self.has_surfaces or self.load_sharing != "none" else None

    @property
    def topographies(self) -> dict[str, RollerTopography]:
        """Measured topographies, by roller."""
        found = {name: getattr(self.rollers, name).topography for name in ROLLERS}
        return {name: topography for name, topography in found.items() if topography}

    @property
    def measured_surfaces(self) -> dict[str, dict]:
        """What each topography is and how it is used, by roller."""
        return {name: one.content for name, one in self.topographies.items()}

    @property
    def conducts(self) -> bool:
        """Whether contact of the rollers has an electrical resistance."""
        return self.resistivity != INSULATOR

    @property
    def is_uncertain(self) -> bool:
        """Whether anything on which the probability depends is stated as not known exactly."""
        return self.uncertainty is not None and bool(self.uncertainty.factors())

    @property
    def answers_samples(self) -> bool:
        """Whether the oil answers the roughness in samples of the sensitivity study."""
        given = self.uncertainty and self.uncertainty.roughness_deformation
        return "computed" in (given.choices if given else (self.roughness_deformation,))

    @property
    def resistivity_range(self) -> tuple[float, float] | None:
        """How far the resistivity may deviate, over its value; None if that is not stated."""
        given = self.uncertainty and self.uncertainty.resistivity
        return given.range if given else None

    @property
    def has_records(self) -> bool:
        """Whether there are records: measured, or of a simulated rig, with lines or surfaces."""
        simulated = self.line_spec.follows_rolling or self.rig.has_surfaces
        return self.experiment.manifest is not None or simulated

    @property
    def lubricant_values(self) -> list[dict]:
        """The lubricant records as plain data, without their titles: they change no result."""
        return [record.model_dump(exclude={"title"}) for record in self.lubricants]

    @property
    def gap(self) -> Gap:
        """How film and roughness make up the gap."""
        return Gap(self.film_shape, self.roughness_deformation)

    @property
    def answered_lines(self) -> LineSpec | None:
        """The roughness lines, if the oil answers them."""
        return self.line_spec if self.gap.is_answered else None

    @property
    def answered_surfaces(self) -> LineSpec | None:
        """Lines that stand for surfaces, if contact of these is asked for and the oil answers."""
        return self.line_spec if self.has_surfaces and self.gap.is_answered else None

    @property
    def has_surfaces(self) -> bool:
        """Whether contact of surfaces is asked for."""
        return "surface" in self.contact_model

    @property
    def compares_surfaces(self) -> bool:
        """Whether records are compared with surfaces; of a simulated rig, if it has surfaces."""
        of_surfaces = self.experiment.manifest is not None or self.rig.has_surfaces
        return self.has_surfaces and self.conducts and of_surfaces

    @property
    def rig_is_answered(self) -> bool:
        """Whether the oil answers the surfaces of the simulated rig's rollers."""
        return self.rig.has_surfaces and self.gap.is_answered

    @property
    def compares_lines_only(self) -> bool:
        """Whether records are compared with lines alone."""
        return not self.compares_surfaces

    @property
    def is_sampled(self) -> bool:
        """Whether rare contact can be sampled: lines that are Gaussian, and not flattened."""
        return self.line_spec.is_gaussian and not self.gap.is_flattened

    @property
    def readings(self) -> dict[str, dict]:
        """Argument of `load_study` that saves it from reading large topographies again."""
        drawn = [one for one in self.topographies.values() if not one.is_line]
        return {"readings": {one.key: one.reading for one in drawn}}

    @property
    def datasets(self) -> tuple[str, ...]:
        """Names of the study's results, one file each."""
        return tuple(self.made_by("all"))

    def made_by(self, target: str) -> list[str]:
        """Names of the study's files that a target of Snakemake makes, such as ``computed``."""
        return [name for name, row in STAGES.items() if row.target == target and self.has(name)]

    def datasets_in(self, folder: types.File) -> list[str]:
        """Names of the study's results, and of those made on request that a folder holds.

        Some of the latter are made in every run, since results or the explorer are made from them.
        """
        needed = {"surface_trace"} if self.has_surfaces else set()
        needed = needed.union(*map(self.forerunners, self.datasets))
        made = needed.union(path.stem for path in Path(folder).glob("*.nc"))
        extra = [name for name, target in ON_REQUEST.items() if target != "benchmark"]
        return [*self.datasets, *(name for name in extra if name in made and self.has(name))]

    def inputs_of(self, stage: str) -> tuple[str, ...]:
        """Names of the stages whose files a stage reads, of those that the study has."""
        row = STAGES[stage]
        asked = (name for name, what in row.inputs_with.items() if attrgetter(what)(self))
        return (*(name for name in row.inputs if self.has(name)), *asked)

    def forerunners(self, stage: str) -> tuple[str, ...]:
        """Names of all stages whose values a stage depends on in this study."""
        return forerunners(stage, lambda attribute: attrgetter(attribute)(self))

    def has(self, stage: str) -> bool:
        """Whether the study has all that a stage needs."""
        return not self.lacks(stage)

    def lacks(self, stage: str) -> list[str]:
        """List what a stage needs (`only_with`) and the study does not have."""
        return [name for name in STAGES[stage].only_with if not attrgetter(name)(self)]

    def is_parallel(self, stage: str) -> bool:
        """Whether a job of a stage uses all cores."""
        parallel = STAGES[stage].parallel
        return attrgetter(parallel)(self) if isinstance(parallel, str) else parallel

    @property
    def batches(self) -> range:
        """First realisation of each batch."""
        return range(0, self.realisations, self.batch_size)

    def batch(self, first: int) -> range:
        """Realisations of the batch that begins with `first`."""
        return range(first, min(first + self.batch_size, self.realisations))

    @property
    def slips(self) -> tuple[float, ...]:
        """Levels of the slide-to-roll ratio."""
        return self.operating_grid.slide_to_roll_ratio

    @property
    def rig_realisations(self) -> range:
        """Realisations of the simulated rig's rollers.

        One for each pair and, if the roughness drifts, one more for each further revolution.
        """
        drawn = self.rig.turns if self.rig.drift > 0.0 else 1
        return range(RIG_REALISATIONS, RIG_REALISATIONS + self.rig.pairs * drawn)

    def check_window(self, force: float, key: str = "operating_grid.force") -> None:
        """Refuse a force whose contact is finer than the grid or wider than a roller's perimeter.

        A force whose contact extends to the meniscus of the oil is refused, too.

        Parameters
        ----------
        force : float
            Normal force, N.
        key : str, optional
            Where the study gives it.

        Raises
        ------
        StudyError
            With the contact width, and what is needed.
        """
        half_width = self.rollers.contact_half_width(force)
        self.line_spec.check_width(2.0 * half_width, f"{key}: the contact at {force:g} N")
        meniscus = self.inlet_model["inlet_meniscus"]
        if meniscus is not None and meniscus <= half_width:
            needed = f"need more than {with_unit(half_width, 'm')}, the half-width of the contact"
            came = f"inlet_meniscus: got {with_unit(meniscus, 'm')}"
            raise StudyError(f"{came}, {needed} at {force:g} N ({key})")

    def check_surfaces(self, spec: LineSpec, force: float) -> None:
        """Refuse lines whose surfaces the model cannot bring into contact.

        Parameters
        ----------
        spec : LineSpec
            The study's lines, or lines that deviate.
        force : float
            Largest force, N.

        Raises
        ------
        LubeError
            As from `lube.study.surface_checks.check_surfaces`.
        """
        from lube.study.surface_checks import check_surfaces  # which loads scipy

        width = 2.0 * self.rollers.contact_half_width(force)
        with located("contact_model: surface"):
            check_surfaces(spec, self.rollers.length, width, self.gap)

    def check_conductivity(self, needed: str) -> None:
        """Refuse heating at the inlet of an oil whose thermal conductivity is not known.

        Parameters
        ----------
        needed : str
            Beginning of the message, such as ``got choices, need``; the conductivity follows.

        Raises
        ------
        StudyError
            With the name of the first such lubricant.
        """
        for record in self.lubricants:
            if record.thermal_conductivity is None and not record.viscosity.coolprop_fluid:
                raise StudyError(
                    f"inlet_shear_heating: {needed} the thermal_conductivity of the lubricant "
                    f"{record.name}"
                )

    @property
    def evaluation(self) -> dict:
        """Settings of the experiment; for the manifest only whether there is one.

        Measured files are identified by their contents, not by their paths.
        """
        return self.experiment.model_dump() | {"manifest": self.experiment.manifest is not None}

    def stage_inputs(self, stage: str) -> dict:
        """Return the values of the study that a stage depends on, as plain data.

        Parameters
        ----------
        stage : str
            Its name in `lube.schema.STAGES`, such as ``film``.

        Returns
        -------
        dict
            Plain values, fit for JSON. They are parameters of the stage's Snakemake rules: a
            change reruns the stages that use it.
        """
        values = STAGES[stage].values.items()
        return {name: to_jsonable_python(attrgetter(what)(self)) for name, what in values}

    def origin(self, stage: str) -> dict:
        """Return all values that determine a stage's result, including those of its forerunners.

        Parameters
        ----------
        stage : str
            As in `stage_inputs`.

        Returns
        -------
        dict
            From stage to its values: the attribute ``config`` of the stage's file.
        """
        return {name: self.stage_inputs(name) for name in (*self.forerunners(stage), stage)}

    @model_validator(mode="after")
    def _check_levels(self):
        each_once(tuple(record.name for record in self.lubricants))
        with located("operating_grid.temperature", ValueError):
            for record in self.lubricants:
                record.check_temperatures(self.operating_grid.temperature)
        with located(kind=ValueError):
            if self.inlet_shear_heating != "none":
                self.check_conductivity(f"got {self.inlet_shear_heating}, need none, or")
            for force in self.operating_grid.force:
                self.check_window(force)
            check_sizes(self)
            for ratio in self.slips:
                self.gap.check_slip(ratio)
            if "line" in self.contact_model:
                self.line_spec.check_follows_rolling()
            if self.has_surfaces:
                self.check_surfaces(self.line_spec, max(self.operating_grid.force))
            elif self.load_sharing != "none":
                from lube.surfaces.rare_contact import check_stands_for_surface  # loads scipy

                with located(f"load_sharing: got {self.load_sharing}, need none"):
                    check_stands_for_surface(self.line_spec)
        return self

    @model_validator(mode="after")
    def _check_traces(self):
        if 0 not in self.kept_realisations or max(self.kept_realisations) >= self.realisations:
            raise ValueError(
                f"kept_realisations: got {shown(self.kept_realisations)}, need 0, which the traces "
                f"use, and none above {self.realisations - 1}"
            )
        if self.line_spec.is_one_pair and self.realisations > 1:
            raise ValueError(
                f"realisations: got {self.realisations}, need 1: both lines are measured, so there "
                "is one pair"
            )
        # All traces share one time axis, whose step is set by the faster surface.
        if len({(point["speed"], point["slide_to_roll_ratio"]) for point in self.trace_points}) > 1:
            raise ValueError("traces: got several speeds or slide-to-roll ratios, need one for all")
        return self

    @model_validator(mode="after")
    def _check_rig(self):
        with located(kind=ValueError):
            check_rig(self)
        return self

    @property
    def trace_points(self) -> list[dict]:
        """Operating point of each trace: a dict from coordinate to level."""
        return [self._trace_point(number, point) for number, point in enumerate(self.traces)]

    def _trace_point(self, number, point):
        """Level of each variable at a trace: the named one, by default the study's first."""
        available = dict(self.operating_grid) | {
            "lubricant": [record.name for record in self.lubricants],
            "film_formula": self.film_formulas,
        }
        found = {}
        for variable in TracePoint.model_fields:
            wanted, given = getattr(point, variable), available[variable]
            index = 0 if wanted is None else level_index(given, wanted, SAME)
            if index is None:
                unit = {"force": " N", "speed": " rpm", "temperature": " degC"}.get(variable, "")
                raise ValueError(
                    f"traces.{number}.{variable}: got {wanted}{unit}, need one of the study's: "
                    f"{', '.join(map(str, given))}{unit}; a study that gives no traces has its "
                    "base's"
                )
            found[variable] = given[index]
        return found


def load_study(
    path: types.File, changes: dict | None = None, readings: dict[str, dict] | None = None
) -> Study:
    """Read and check a study.

    Parameters
    ----------
    path : str or Path
        YAML file of the study; it may be based on another, see `lube.study.resolve`.
    changes : dict, optional
        Values to change, nested as in the file, as Snakemake's ``--config`` gives them.
        They must contain a new ``name``.
    readings : dict, optional
        From `Study.readings`: what was read of the topographies that it names.

    Returns
    -------
    Study
        The whole study, with its lubricant records.

    Raises
    ------
    StudyError
        Which key, what came, what is needed.
    RecordError
        If a lubricant record that the study names cannot be used.
    """
    folder = Path(path).parent
    content = with_paths(resolved_content(path, changes), lambda name: str(folder / name))
    if isinstance(content.get("lubricants"), list):
        with located(f"{path}: lubricants"):
            records = tuple(map(load_record, content["lubricants"]))
        content = content | {"lubricants": records}
    study = validate(Study, content, path, StudyError, readings)
    manifest = study.experiment.manifest
    if manifest is not None and not Path(manifest).is_file():
        raise StudyError(f"{path}: experiment.manifest: got {manifest}, need a file that exists")
    return study
