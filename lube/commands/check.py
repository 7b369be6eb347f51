"""``lube check``: check a study and its list of records without running it."""

import math
import os
from collections.abc import Sequence
from contextlib import suppress

import pandas as pd
import xarray as xr

from lube.commands.run import repository
from lube.errors import LubeError, StudyError, located
from lube.grid.plausibility import overview, remarks
from lube.pipeline.command_line import changes_of, study_of_command
from lube.pipeline.study_files import StudyFiles
from lube.report.pages import count, render
from lube.stages.film import make as make_film
from lube.stages.tail import why_counted
from lube.study.oil_properties import lubricant_table
from lube.study.resolve import merged
from lube.study.text_files import read_yaml
from lube.study.uncertainty import check_uncertainty, spoken
from lube.types import File


def check_study(path: File, entries: Sequence[str] = ()) -> tuple[list[str], list[str]]:
    """Check a study as the workflow does, without running it.

    The summary has what an engineer looks at first, and remarks on values that may be mistakes.

    Parameters
    ----------
    path : str or Path
        YAML file of the study.
    entries : sequence of str, optional
        Changes ``key=value``, as in Snakemake's ``--config``.

    Returns
    -------
    summary : list of str
        Lines on what the study will compute.
    refused : list of str
        A line for each measured record that cannot be used.

    Raises
    ------
    LubeError
        If the study cannot be carried out.
    """
    study, arguments = study_of_command([path], changes_of(entries))
    folder = StudyFiles(study, **arguments).folder
    counts = {name: len(levels) for name, levels in study.operating_grid}
    counts["lubricant"] = len(study.lubricants)
    points = math.prod(counts.values())
    usable, total, refused, of_records = _records(study)
    film, spec, rollers = _film(study), study.line_spec, study.rough_rollers
    summary = render(
        "check.txt",
        study=study,
        points=points,
        factors=[count(number, spoken(name)) for name, number in counts.items() if number > 1],
        films=overview(film, spec, rollers),
        usable=usable,
        total=total,
        folder=folder,
        minutes=_minutes(study, points),
        cores=os.cpu_count(),
        last_run=_last_run(folder),
        notes=[
            *remarks(film, spec, rollers, study.contact_model),
            *_own_remarks(path, study, arguments["changes"]),
            *of_records,
        ],
    )
    return summary.splitlines(), refused


def _film(study):
    """Film table by the study's first formula at every slip, without the oil's answer to lines."""
    some = {"film_formulas": study.film_formulas[:1], "roughness_deformation": "none"}
    oils = lubricant_table(study.lubricants, study.operating_grid.temperature)
    film = make_film(study.model_copy(update=some), {"lubricant": oils})
    slips = xr.DataArray(list(study.slips), dims="slide_to_roll_ratio")
    return film.map(lambda variable: variable.broadcast_like(slips))


def _own_remarks(path, study, changes):
    """List what the study takes from its base, why contact is counted, and unsuitable ranges."""
    content = read_yaml(path, StudyError)
    base, own = content.get("based_on"), merged(content, changes)
    if base and study.about.creators and "creators" not in (own.get("about") or ()):
        names = "; ".join(one.name for one in study.about.creators)
        yield f"about.creators: {base} names {names}; put in your own"
    if reason := why_counted(study.line_spec, study.gap):
        yield reason
    if not study.has("sensitivity"):
        return
    try:
        with located("no sensitivity study is possible: uncertainty"):
            check_uncertainty(study)
    except LubeError as error:
        yield str(error)
    own = own.get("uncertainty") or ()
    names = [spoken(one.name) for one in study.uncertainty.factors() if one.name not in own]
    if base and names:
        given = f"the ranges and choices of {', '.join(names)}"
        yield f"uncertainty: {base} gives {given}; replace those that are not yours"


def _minutes(study, points):
    """Estimate the time of a run from that of the paper's study.

    A million points of a line take some 0.7 ms at an operating point in pure rolling, or 0.1 s
    where the oil answers them, and 0.9 s at a slide-to-roll ratio of 1. The answer to lines takes
    1.5 s at each point. Surfaces take 2 s at each point, or 9 s where the oil answers them, and
    three times as long again for a curve at each record. Those of the rig, with five grid points in
    the shortest wave, take 60 ns for each grid point, or 300 ns, and the other jobs, most of all
    figures, 90 s.
    """
    size = study.roughness.points / 1e6
    rolling = 0.1 if study.gap.is_answered else 7e-4
    slips = sum(rolling + 0.9 * abs(ratio) for ratio in study.slips) / len(study.slips)
    runs = points * len(study.film_formulas) * slips
    seconds = 90.0 + 1.5 * points * study.gap.is_answered
    if study.has("contact"):
        seconds += study.realisations * size * (0.3 + runs)
    if study.has_surfaces:
        each = 9.0 if study.gap.is_answered else 2.0
        seconds += points * each * (6.0 if study.compares_surfaces else 1.0)
    if study.rig.has_surfaces:
        spec, length = study.line_spec, study.rollers.length
        spacing = min(line.shortest_wavelength for line in spec.lines) / 5.0
        each = 3e-7 if study.gap.is_answered else 6e-8
        seconds += each * study.rig.pairs * spec.travel * length / spacing**2
    return max(1, round(seconds / 60.0 / os.cpu_count()))


def _records(study):
    """Evaluate the measured records as a run does.

    Returns the numbers of those that can be used and of all, a line for each that cannot, and
    remarks on the others.
    """
    manifest = study.experiment.manifest
    if manifest is None or not study.has("experiment"):
        return 0, 0, [], []
    from lube.recordings.manifest import read_manifest
    from lube.stages.experiment import evaluated_records

    rows, refused, notes = evaluated_records(read_manifest(manifest), study)
    total = len(rows) + len(refused)
    if not rows:
        refused.append(f"{manifest}: no record can be used, need at least one usable record")
    return len(rows), total, refused, notes


def _last_run(results):
    """Say how long the jobs of the study's last run took, by Snakemake's benchmarks."""
    files = []
    with suppress(LubeError):  # without a clone there is no run
        files = list((repository() / results).glob("benchmarks/*.tsv"))
    if not files:
        return "none, so its time is not known"
    seconds = sum(pd.read_csv(file, sep="\t")["s"][0] for file in files)
    return f"{len(files)} jobs took {seconds / 60.0:.1f} min, one after the other"
