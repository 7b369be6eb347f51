"""How often the study's intervals contain the true value, for rollers that are in no ensemble.

    snakemake benchmark                                              # measures, saves and draws
    python benchmarks/bench_coverage.py [STUDY [COVERAGE.NC]]        # measures and prints

Each held-out pair of rollers makes a record at several operating points; its contact shares come
directly from the kernels. The study's own stages judge them: prediction of the share, film
thickness, factor of the pressure-viscosity coefficient, strength of the boundary layer. The true
values are known, so each interval is right or wrong. Its width is compared with the spread between
pairs, so that no interval is right merely by being wide. In one scenario fewer pairs go through the
circuit, recorded files and a manifest.

With slip a pair takes seconds, so `PAIRS` has fewer of them there; ``--pairs`` sets one number for
all. Where films have a shape, or answer the roughness, each record has a curve of its own.
"""

import argparse
import itertools
import logging
import math
import multiprocessing
import os
import tempfile
import time
from collections import defaultdict
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path

import numpy as np
import xarray as xr

from lube.contact.ensemble import gather, gather_map
from lube.contact.rough_pair import drawn, roughness_batch
from lube.contact.windows import study_windows
from lube.grid.discretise import revolution, speed_ratios
from lube.grid.operating_points import at_slip, operating_points
from lube.inference.at_records import model_at_records
from lube.inference.fits import (
    ALPHA_FACTORS,
    alpha_logits,
    fit_records,
    strength_logits,
)
from lube.inference.record_curves import map_curves, own_curves
from lube.recordings.manifest import Entry, Manifest, read_manifest
from lube.rig.simulator import simulated_revolutions
from lube.schema import LIMITS, label
from lube.stages.comparison import compare
from lube.stages.contact import contact_statistics
from lube.stages.experiment import measured_experiment
from lube.stages.film import film_table
from lube.stages.gauge import gauge_film
from lube.stages.master import contact_map
from lube.storage.netcdf import save
from lube.study.oil_properties import lubricant_table
from lube.study.study import Study, load_study

TURNS = (0.01, 0.3, 1.0, 10.4, 100.4)
SLIP = 2.0 * (1.0 - 0.9) / (1.0 + 0.9)
"""One surface 0.9 times as fast as the other: the alignments of equal rollers repeat after 10
turns, so that records of any length follow from these."""
MOTIONS = {"rolling": 0.0, "slipping": SLIP}
LEVELS = ("temperature", "speed", "force")
SMALLER = 0.8
"""Radius of the second of two unequal rollers over the first's: they repeat after 4 turns."""
SLIP_LAMBDAS = np.geomspace(1.3, 3.8, 7)
"""Operating points with slip are those with the nearest lambda ratios."""

HELD_OUT = 100_000
"""First realisation of the held-out pairs."""
PAIRS = {"rolling": 1000, "slipping": 200}
ENSEMBLES, ENSEMBLE_PAIRS = 4, 200
"""Ensembles without common realisations. Each judges its part of a scenario's pairs, so that no
figure depends on one ensemble only; and all judge these pairs, for equal rollers in rolling."""
FILES, FILE_TURNS = 30, 10.4
TOY = 8
"""Pairs of the smoke study, whose figures have no meaning."""

LEAST = 1e-3
"""Lowest probability of the operating points in the figures for all points together."""


@dataclass(frozen=True)
class Ensemble:
    """Films, contact and master map of a study with one seed; no map if its gap is not plain."""

    study: Study
    film: xr.Dataset
    contact: xr.Dataset
    master: xr.Dataset | None

    def curves(self, comparison):
        """Curves of the records of a comparison."""
        if self.master is None:
            return own_curves(self.study, comparison)
        return map_curves(self.master, comparison)


def variant(study, rollers, motion="rolling"):
    """The study with equal or unequal rollers, one film formula and one slip."""
    radius = study.rollers.first.radius * (SMALLER if rollers == "unequal" else 1.0)
    second = study.rollers.second.model_copy(update={"radius": radius})
    grid = study.operating_grid.model_copy(update={"slide_to_roll_ratio": (MOTIONS[motion],)})
    changed = {
        "rollers": study.rollers.model_copy(update={"second": second}),
        "film_formulas": ("paper",),
        "operating_grid": grid,
    }
    return study.model_copy(update=changed)


# The ensembles


def film_of(study):
    """Film table of a study's operating grid, for all `MOTIONS`."""
    grid = study.operating_grid
    oil = lubricant_table(study.lubricants, grid.temperature)
    levels = grid.force, grid.speed, study.film_formulas
    slips = {"slide_to_roll_ratio": tuple(MOTIONS.values())}
    return film_table(oil, study.rough_rollers, *levels, **slips, **study.film_model)


def make_ensembles(study, count, pool):
    """Contact and master map of the study's rollers by several seeds."""
    film = film_of(study)
    ensembles = []
    for seed in range(study.seed, study.seed + count):
        own = study.model_copy(update={"seed": seed})
        run = partial(_realisation, own, at_slip(film, 0.0))
        runs, maps = zip(*pool(run, range(study.realisations)), strict=True)
        master = gather_map(maps) if study.gap.is_plain else None
        ensembles.append(Ensemble(own, film, gather(runs, at_slip(film, 0.0)), master))
    return ensembles


def _realisation(study, film, number):
    lines = roughness_batch(study.line_spec, study.seed, [number])
    layer = study.boundary_layer
    contact = contact_statistics(lines, film, layer, gap=study.gap)
    return contact, contact_map(lines, film, layer) if study.gap.is_plain else None


# The shares of single pairs


def operating_table(film, motion, few=False):
    """Films of the operating points, over ``point``, from the smallest lambda ratio on.

    With slip there are few.
    """
    table = at_slip(film, MOTIONS[motion]).isel(film_formula=0, lubricant=0, drop=True)
    table = table.stack(point=LEVELS).reset_index("point").sortby("lambda_ratio")
    if few or motion == "slipping":
        ratios = np.log(table["lambda_ratio"].values)
        nearest = [int(np.argmin(np.abs(ratios - np.log(wanted)))) for wanted in SLIP_LAMBDAS]
        table = table.isel(point=sorted(set(nearest)))
    return table


def levels_of(table):
    """Levels of the operating points of a table, a dictionary each."""
    rows = zip(*(table[name].values.tolist() for name in LEVELS), strict=True)
    return [dict(zip(LEVELS, row, strict=True)) for row in rows]


def record_shares(study, table, slip, turns, realisation):
    """Shares of a pair's records of so many turns, shape (turns, points).

    After a cycle of alignments a pair shows the same again, so that the longest records follow
    from one cycle.
    """
    pair = drawn(study, realisation)
    turn = revolution(pair, speed_ratios(slip))
    ends = np.maximum(np.round(np.array(turns) * turn).astype(np.int64), 1)
    cycle = _cycle(pair, speed_ratios(slip)) * turn
    whole, rest = ends // cycle, ends % cycle
    marks = np.unique([0, *rest, *(cycle * (whole > 0))])
    windows = study_windows(study, table)
    between = [
        np.rint(windows.count(pair, slip, (end - begin) / turn, begin)[:, 1] * (end - begin))
        for begin, end in itertools.pairwise(marks)
    ]
    counts = np.cumsum([np.zeros(table.sizes["point"], np.int64), *between], axis=0)
    # The last mark is the cycle's end where there is a whole one.
    return (whole[:, None] * counts[-1] + counts[np.searchsorted(marks, rest)]) / ends[:, None]


def _cycle(pair, ratios):
    """Turns of the faster surface after which both lines meet as they did at first."""
    faster = 0 if ratios[0] == 1.0 else 1
    other = pair[1 - faster].size
    return other // math.gcd(round(pair[faster].size * ratios[1 - faster]), other)


def held_out_shares(study, table, motion, pairs, pool):
    """Shares of the records of held-out pairs, shape (pairs, TURNS, points)."""
    run = partial(record_shares, study, table, MOTIONS[motion], TURNS)
    return np.array(list(pool(run, range(HELD_OUT, HELD_OUT + pairs))))


# The judgement by the study


def experiment_of(study, table, motion, turns):
    """Records of one pair at all operating points, for each number of turns in turn."""
    entries = []
    for length, levels in itertools.product(turns, levels_of(table)):
        where = f"record {len(entries)}, {length:g} turns"
        # The shares of the pairs replace this probability later.
        given = {"where": where, "probability": 0.5, "slide_to_roll_ratio": MOTIONS[motion]}
        entries.append(Entry.model_construct(**given | levels))
    experiment = measured_experiment(Manifest("simulated", tuple(entries), ()), study)
    lengths = np.repeat(np.array(turns, float), table.sizes["point"])
    return experiment.assign(turns=experiment["turns"].copy(data=lengths))


def comparisons(study, ensemble, table, motion, turns=TURNS):
    """One comparison for each number of turns; the model is made for all of them at once."""
    experiment = experiment_of(study, table, motion, turns)
    model = model_of(experiment, ensemble, study)
    parts = np.split(np.arange(experiment.sizes["record"]), len(turns))
    return [
        compare(model.isel(record=part), experiment.isel(record=part), ensemble.contact)
        for part in parts
    ]


def model_of(experiment, ensemble, study):
    """The model at the records, by one ensemble."""
    study = study.model_copy(update={"seed": ensemble.study.seed})
    return model_at_records(experiment, ensemble.film, ensemble.contact, study)


def judge(ensemble, comparison, curves, shares):
    """Judge each pair's records of one length by their shares, shape (pairs, points).

    Of the result, ``probability`` and ``predicted`` are the mean over the ensemble and the width
    of the prediction, ``inside`` is whether a share is within it, and ``film``, ``alpha`` and
    ``layer`` are values with their limits, as logarithms of the lambda ratio or of the ratio to
    the truth.
    """
    one = comparison.isel(film_formula=0)
    lower, upper = (one[f"predicted_share_{side}"].values for side in ("lower", "upper"))
    strength = ensemble.study.boundary_layer.strength
    fits = {
        "alpha": (ALPHA_FACTORS, alpha_logits(curves, comparison), 1.0),
        "layer": (*strength_logits(curves, strength, comparison), strength),
    }
    everyone = np.ones((len(shares), 1))
    found = {
        "probability": everyone * one["simulated_probability"].values,
        "predicted": everyone * (upper - lower),
        "inside": (lower <= shares) & (shares <= upper),
        "film": _films(comparison, curves, shares),
    }
    for name, (tried, logits, truth) in fits.items():
        model = np.log(tried), logits.values[:, 0]
        rows = [fit_records(*model, _with_shares(one, of_pair)) for of_pair in shares]
        with np.errstate(divide="ignore"):
            found[name] = np.log(np.array(rows) / truth)
    return found


def _with_shares(comparison, shares):
    return comparison.assign(measured_share=("record", shares))


def _films(comparison, curves, shares):
    """Gauged films of all pairs, one after the other along the record dimension."""
    names = ["contact_half_width", "film_thickness", "breakthrough_probability"]
    names += ["simulated_probability", "pooled_probability", "scatter_ratio", "share_error"]
    names += ["composite_rms_roughness"]
    pairs, points = shares.shape
    everyone = comparison[names].drop_vars("record").isel(record=np.tile(range(points), pairs))
    curves = replace(curves, of_records=curves.of_records * pairs)
    gauged = gauge_film(curves, _with_shares(everyone, shares.ravel()))
    limits = [gauged[f"gauged_lambda_ratio{limit}"].values for limit in LIMITS]
    with np.errstate(divide="ignore"):
        return np.log(np.stack(limits, axis=-1)).reshape(pairs, points, 3)


def judge_all(ensembles, compared, curves, shares, pool):
    """As `judge`: each ensemble judges its part of the pairs, in several processes."""
    parts = np.array_split(shares, len(ensembles))
    jobs = [
        (*judges, part)
        for *judges, own in zip(ensembles, compared, curves, parts, strict=True)
        for part in np.array_split(own, math.ceil(len(own) / 25))
    ]
    return join(pool(judge, *zip(*jobs, strict=True)))


def join(judged):
    """Join the results of `judge` for several parts of the pairs."""
    judged = list(judged)
    return {name: np.concatenate([part[name] for part in judged]) for name in judged[0]}


# Coverage and widths


def figures(comparison, shares, judged):
    """Coverage and widths of one scenario's records of one length, as in the ``coverage`` file."""
    probability, film, inside = (judged[name] for name in ("probability", "film", "inside"))
    counted = probability.mean(axis=0) > LEAST
    held = _holds(film, np.log(comparison["lambda_ratio"].isel(film_formula=0).values))
    closed = np.isfinite(film[..., 1:]).all(axis=-1)
    beyond = np.where(shares < probability, np.inf, -np.inf)
    gauged = np.where(np.isnan(film[..., 0]), beyond, film[..., 0])
    predicted = np.median(judged["predicted"], axis=0)
    found = {
        "film_coverage": _mean(held[:, counted]),
        "closed_coverage": _mean(held[closed]),
        "one_sided_coverage": _mean(held[~closed]),
        "closed_share": _mean(closed),
        "film_width_ratio": _median(_width_ratio(film, gauged)[counted]),
        "agreement": _mean(inside[:, counted]),
        "prediction_width_ratio": _median((predicted / _spread(shares))[counted]),
        "point_film_coverage": held.mean(axis=0),
        "point_agreement": inside.mean(axis=0),
    }
    for fit in ("alpha", "layer"):
        found[f"{fit}_coverage"] = _mean(_holds(judged[fit], 0.0))
        found[f"{fit}_width_ratio"] = float(_width_ratio(judged[fit], judged[fit][:, 0]))
    return found


def _holds(interval, truth):
    return (interval[..., 1] <= truth) & (truth <= interval[..., 2])


def _mean(values):
    return np.mean(values) if values.size else np.nan


def _median(ratios):
    """Median of the finite values: a ratio is infinite where most intervals have one limit."""
    known = ratios[np.isfinite(ratios)]
    return np.median(known) if known.size else np.nan


def _spread(values):
    """Width of the central 95 % of the pairs; infinite where it has no end."""
    beyond = np.where(np.isnan(values), np.inf, values)
    lower, upper = np.quantile(beyond, [0.025, 0.975], axis=0, method="nearest")
    with np.errstate(invalid="ignore"):
        return np.where(upper > lower, upper - lower, np.nan)


def _width_ratio(interval, found):
    """Median width of the pairs' intervals over the spread of the values found."""
    with np.errstate(invalid="ignore"):
        return np.median(interval[..., 2] - interval[..., 1], axis=0) / _spread(found)


# Through circuit and files


def records_on_file(study, table, film, folder):
    """Write the records of the simulated rig, and a manifest of them."""
    film = film.isel(film_formula=0)
    rows = [{name: [level] for name, level in levels.items()} for levels in levels_of(table)]
    points = [operating_points(film.sel(row), 0.0) for row in rows]
    alike = {"data_vars": "minimal", "coords": "minimal", "compat": "override"}
    points = xr.concat(points, "operating_point", **alike)
    rows = ["file,temperature [degC],speed [rpm],force [N],pair,origin"]
    parts = defaultdict(list)
    for pair, number, part in simulated_revolutions(study, points):
        parts[pair, number].append(part.voltage(study.rig))
        if len(parts[pair, number]) == math.ceil(study.rig.revolutions):
            _write(folder / f"{pair}_{number}.nc", parts.pop((pair, number)), study.rig)
            level = [repr(points[name][number].item()) for name in LEVELS]
            rows.append(",".join([f"{pair}_{number}.nc", *level, f"{pair}", "simulated"]))
    (folder / "manifest.csv").write_text("\n".join(rows) + "\n", encoding="utf-8")
    return folder / "manifest.csv"


def _write(path, parts, rig):
    """Write a voltage record in whole steps of the converter."""
    steps = np.rint(np.concatenate(parts) / rig.resolved_voltage).astype(np.int16)
    attributes = {
        "units": "V",
        "scale_factor": rig.resolved_voltage,
        "sampling_interval": f"{1.0 / rig.sampling_rate!r} s",
    }
    xr.Dataset({"voltage": ("time", steps, attributes)}).to_netcdf(path)


def through_files(study, ensemble, table, pairs, folder):
    """Figures of some pairs whose records went through circuit, files and manifest."""
    rig = study.rig.model_copy(update={"pairs": pairs, "revolutions": FILE_TURNS, "drift": 0.0})
    study = study.model_copy(update={"rig": rig})
    manifest = read_manifest(records_on_file(study, table, ensemble.film, folder))
    experiment = measured_experiment(manifest, study)
    model = model_of(experiment, ensemble, study)
    comparison = compare(model, experiment, ensemble.contact)
    judged, shares, curves = [], [], None
    for pair in range(pairs):
        own = comparison.isel(record=comparison["pair"].values == f"{pair}")
        own = own.sortby(own["lambda_ratio"].isel(film_formula=0))
        shares.append(own["measured_share"].values)
        curves = curves or ensemble.curves(own)  # the same for all pairs
        judged.append(judge(ensemble, own, curves, shares[-1][None]))
    return own, figures(own, np.array(shares), join(judged))


# All scenarios


def measure_scenario(study, ensembles, motion, pairs, pool):
    """Figures of one scenario for each number of turns, with a comparison and all shares."""
    table = operating_table(ensembles[0].film, motion)
    shares = held_out_shares(study, table, motion, pairs, pool)
    rows = []
    made = [comparisons(study, ensemble, table, motion) for ensemble in ensembles]
    # How long the records are changes nothing in their curves.
    curves = [one.curves(own[0]) for one, own in zip(ensembles, made, strict=True)]
    for number, compared in enumerate(zip(*made, strict=True)):
        judged = judge_all(ensembles, compared, curves, shares[:, number], pool)
        rows.append(figures(compared[0], shares[:, number], judged))
        show(f"{TURNS[number]:g} turns", rows[-1])
    return rows, compared[0], shares


def measure_ensembles(study, shares, ensembles, pool):
    """Figures of the same pairs by each ensemble."""
    own, rows = shares[:ENSEMBLE_PAIRS, TURNS.index(FILE_TURNS)], []
    for number, ensemble in enumerate(ensembles):
        table = operating_table(ensemble.film, "rolling")
        compared = comparisons(study, ensemble, table, "rolling", [FILE_TURNS])
        curves = [ensemble.curves(compared[0])]
        judged = judge_all([ensemble], compared, curves, own, pool)
        rows.append(figures(compared[0], own, judged))
        show(f"ensemble {number}", rows[-1])
    return rows


def show(where, row):
    """Print the figures of one scenario and length."""
    numbers = (f"{name} {value:.3f}" for name, value in row.items() if np.ndim(value) == 0)
    print(f"  {where}: {', '.join(numbers)}", flush=True)


def measure(study, pairs, files, pool, folder):
    """Measure everything, as the ``coverage`` file of `lube.schema`."""
    found, of_ensembles = {}, None
    for rollers in ("equal", "unequal"):
        ensembles = make_ensembles(variant(study, rollers), ENSEMBLES, pool)
        for motion in MOTIONS:
            begin, name = time.perf_counter(), f"{rollers} rollers, {motion}"
            print(f"{name}, {pairs[motion]} pairs:", flush=True)
            own = variant(study, rollers, motion)
            rows, comparison, shares = measure_scenario(own, ensembles, motion, pairs[motion], pool)
            found[name] = pairs[motion], TURNS, rows, comparison
            print(f"  {time.perf_counter() - begin:.0f} s")
            if of_ensembles is None:
                of_ensembles = measure_ensembles(own, shares, ensembles, pool)
                table = operating_table(ensembles[0].film, "rolling", few=True)
                comparison, row = through_files(own, ensembles[0], table, files, folder)
                show(f"through files, {files} pairs", row)
                found[f"{name}, through files"] = files, (FILE_TURNS,), [row], comparison
    return label(_dataset(study, found, of_ensembles), "coverage")


def _dataset(study, found, of_ensembles):
    """Set all figures side by side, NaN where a scenario has no such length or point."""
    points = max(comparison.sizes["record"] for _, _, _, comparison in found.values())
    scenarios = []
    for count, turns, rows, comparison in found.values():
        one = comparison.isel(film_formula=0)
        rows = [
            xr.Dataset({n: (("point",) * np.ndim(v), v) for n, v in row.items()}) for row in rows
        ]
        rows = xr.concat(rows, xr.DataArray(list(turns), dims="record_turns", name="record_turns"))
        rows = rows.assign(
            point_lambda_ratio=("point", one["lambda_ratio"].values),
            point_probability=("point", one["simulated_probability"].values),
            pairs=count,
        ).assign_coords(point=range(one.sizes["record"]))
        scenarios.append(rows.reindex(record_turns=list(TURNS), point=range(points)))
    names = xr.DataArray(list(found), dims="scenario", name="scenario")
    dataset = xr.concat(scenarios, names)
    dataset = dataset.transpose("scenario", "record_turns", "point", missing_dims="ignore")
    for name in ("film_coverage", "agreement", "alpha_coverage", "layer_coverage"):
        dataset[f"ensemble_{name}"] = "ensemble", [row[name] for row in of_ensembles]
    return dataset.assign(
        ensemble_turns=FILE_TURNS,
        ensemble_pairs=min(ENSEMBLE_PAIRS, int(dataset["pairs"].max())),
        ensemble_realisations=study.realisations,
        least_probability=LEAST,
    ).assign_coords(ensemble=range(ENSEMBLES))


def main():
    """Measure, print and, if a file is given, save."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("study", nargs="?", default="workflow/config/paper.yaml")
    parser.add_argument("output", nargs="?")
    parser.add_argument("--pairs", type=int, help="held-out pairs of each scenario")
    options = parser.parse_args()
    # Most points of the grid have no record here, and need no warning.
    logging.getLogger("lube").setLevel(logging.ERROR)
    study = load_study(options.study)
    pairs, files = dict(PAIRS), FILES
    if options.pairs:
        pairs, files = dict.fromkeys(pairs, options.pairs), min(files, options.pairs)
    if study.name == "smoke":
        pairs, files = dict.fromkeys(pairs, TOY), TOY // 4
    beside = Path(options.output).parent if options.output else None
    spawn = multiprocessing.get_context("spawn")
    with (
        ProcessPoolExecutor(os.cpu_count(), spawn) as executor,
        tempfile.TemporaryDirectory(dir=beside) as folder,
    ):
        coverage = measure(study, pairs, files, executor.map, Path(folder))
    if options.output:
        save(coverage, options.output, "coverage", study)


if __name__ == "__main__":
    main()
