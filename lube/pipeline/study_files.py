"""The files of one study as the Snakemake rules name them: results, inputs and fingerprints."""

import contextlib
import hashlib
import json
import os
import sys
from collections.abc import Iterable, Iterator, Mapping
from pathlib import Path

from lube.errors import LubeError, located
from lube.pipeline.figure_files import origin, products
from lube.pipeline.figure_list import Figure, made_by
from lube.schema import CONDITIONS, STAGES
from lube.study.resolve import study_files
from lube.study.study import Study
from lube.study.uncertainty import SAMPLE_BATCHES, check_uncertainty
from lube.types import File, Files


@contextlib.contextmanager
def one_line_errors() -> Iterator[None]:
    """End Snakemake with one line if the study cannot start; also a decorator."""
    try:
        yield
    except LubeError as error:
        sys.exit(f"The study cannot start. {error}")


def digest(content: object) -> str:
    """Return a fingerprint of plain data; as a parameter of a rule, its change reruns the rule."""
    return hashlib.sha256(json.dumps(content, sort_keys=True).encode()).hexdigest()


def input_paths(files: Files) -> list[str]:
    """List files relative to the working folder, so that the repository can be moved.

    Parameters
    ----------
    files : iterable of str or Path
        Files that a study names.

    Returns
    -------
    list of str
        Their paths, sorted, without repetition.
    """
    return sorted({os.path.relpath(file) for file in files})


class StudyFiles:
    """Paths and fingerprints of one study, for the rules.

    Parameters
    ----------
    study : Study
        The study.
    path : str or Path
        Its YAML file.
    changes : dict
        Values that ``--config`` changes.
    """

    def __init__(self, study: Study, path: File, changes: dict):
        self.study, self.path, self.changes = study, path, changes
        self.folder = f"results/{study.name}"

    @property
    def study_file(self) -> str:
        """The study as a file: as written or, with changes by ``--config``, as resolved."""
        return self.result("study.yaml") if self.changes else str(self.path)

    def study_files(self) -> list[str]:
        """List the file of the study and those it is based on."""
        return input_paths(study_files(self.path))

    def result(self, name: str) -> str:
        """Return the path of a result, such as ``film.nc``."""
        return f"{self.folder}/{name}"

    def stage_inputs(self, *stages: str) -> str:
        """Return a fingerprint of the values that a job takes from the study itself.

        Parameters
        ----------
        *stages : str
            Names in `lube.schema.STAGES` of the stages that the job computes.

        Returns
        -------
        str
            The fingerprint of the values that the stages use, and of the creators that files name.
        """
        names = set(stages)
        for name in (name for stage in stages for name in STAGES[stage].same_values):
            # The job does not read these stages' files, so their forerunners' values count too.
            names |= {*self.study.forerunners(name), name}
        values = [self.study.stage_inputs(name) for name in STAGES if name in names]
        own = (name for stage in stages for name in STAGES[stage].parameters)
        values += [getattr(self.study, name) for name in own]
        return digest([*values, self.study.about.in_files])

    def written_files(self, stage: str) -> list[str]:
        """List the files, written by people, that a stage reads besides the study."""
        attribute = STAGES[stage].written
        return getattr(self, attribute)() if attribute else []

    def batches_of(self, stage: str) -> list[str]:
        """Return the files of a stage's batches, such as ``batches/contact_0.nc``, if any."""
        numbers = {"realisations": self.study.batches, "samples": range(SAMPLE_BATCHES), "": ()}
        of_stage = numbers[STAGES[stage].in_batches]
        return [self.result(f"batches/{stage}_{number}.nc") for number in of_stage]

    def batch_limits(self, wildcards: object) -> tuple[int, int]:
        """Return the first and last realisation of the batch that begins with a wildcard."""
        batch = self.study.batch(int(wildcards.first))
        return batch[0], batch[-1]

    def record_files(self) -> list[str]:
        """List the files of the study's lubricant records."""
        return input_paths(file for record in self.study.lubricants for file in record.files)

    @one_line_errors()
    def measured_files(self) -> list[str]:
        """List the manifest and those measured records that exist; none for a simulated rig."""
        manifest = self.study.experiment.manifest
        if manifest is None:
            return []
        from lube.recordings.manifest import read_manifest

        entries = read_manifest(manifest).entries
        return input_paths([manifest, *(entry.file for entry in entries if entry.file)])

    def topography_files(self) -> list[str]:
        """List the files of the measured topographies."""
        return input_paths(one.file for one in self.study.topographies.values())

    def products(self, figures: Iterable[str]) -> list[str]:
        """List the files that the jobs of some figures make: pictures, origin, notebook."""
        names = (name for figure in figures for name in (*products(figure), origin(figure)))
        return [self.result(name) for name in names]

    def made_by(self, target: str, figures: dict[str, Figure]) -> list[str]:
        """List the files that a target made on request asks for: results, and figures with theirs.

        Parameters
        ----------
        target : str
            Such as ``areal_contact``.
        figures : dict of str to Figure
            The study's figures by name.

        Returns
        -------
        list of str
            Their paths. A result may have no figure in this study.
        """
        results = [self.result(f"{kind}.nc") for kind in self.study.made_by(target)]
        return results + self.products(made_by(target, figures))

    def benchmarks(self, figures: Iterable[str]) -> dict[str, list[str]]:
        """List the benchmark files of all jobs, by the steps of the study.

        Parameters
        ----------
        figures : iterable of str
            Names of the study's figures.

        Returns
        -------
        dict of str to list of str
            From the step's name in the report to its files.
        """
        steps = {stage: [stage] for stage in self.study.datasets_in(self.folder)}
        steps |= {"figures": list(figures), "explorer": ["explorer"]}
        if self.study.has("contact"):
            batches = [f"batch_{first}" for first in self.study.batches]
            steps = {"batches of realisations": batches} | steps
        file = "benchmarks/{}.tsv".format
        return {step: [self.result(file(job)) for job in jobs] for step, jobs in steps.items()}

    @one_line_errors()
    def check_targets(self, targets: Iterable[str], figures: Mapping[str, Figure]) -> None:
        """End Snakemake with one line if it is asked for something that the study lacks.

        Parameters
        ----------
        targets : iterable of str
            Words of the command, among them rules such as ``areal_contact``, or files.
        figures : dict of str to Figure
            The study's figures by name.
        """
        for target in targets:
            asked = self._stages_of(target, figures)
            of_target = [name for name, row in STAGES.items() if row.target == target]
            # Of several files, the one that needs the least more.
            lacking = min(filter(None, map(self.study.lacks, asked)), key=len, default=())
            if lacking and not any(map(self.study.has, of_target)):  # else it makes another file
                needed = " and ".join(CONDITIONS[name] for name in lacking)
                raise LubeError(f"{self.path}: got the target {target}, need {needed}")
            made = filter(self.study.has, {*asked}.union(*map(self.study.forerunners, asked)))
            if any("is_uncertain" in STAGES[stage].only_with for stage in made):
                with located(f"{self.path}: uncertainty"):
                    check_uncertainty(self.study)

    def _stages_of(self, target, figures):
        """List the stages whose files a target names, or draws."""
        path = os.path.normpath(target)
        asked = (one for name, one in figures.items() if path in self.products([name]))
        drawn = {kind for figure in asked for kind in figure.datasets}
        return [
            name
            for name, row in STAGES.items()
            if path in (row.rule, row.target, self.result(f"{name}.nc"), *self.batches_of(name))
            or name in drawn
        ]

    def refused_records(self) -> str | None:
        """Say in one line which records were refused, and why; None if none was.

        Simulated records are refused where the film is unknown.
        """
        experiment = Path(self.result("experiment.nc"))
        if not experiment.exists():
            return None
        from lube.inference.study_shares import refused_in_one_line
        from lube.storage.netcdf import load

        with contextlib.suppress(LubeError):  # a file of an older version, not made by this run
            return refused_in_one_line(load(experiment, "experiment"))
        return None
