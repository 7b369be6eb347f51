"""How often the study's intervals hold the truth, for rollers that no ensemble has seen.

    snakemake benchmark                                              # measures, saves and draws
    python tests/benchmarks/bench_coverage.py [STUDY [COVERAGE.NC]]  # measures and tells

Each pair of rollers makes a record at several operating points, its shares of contact straight
from the kernels. What reads real records judges them: prediction of the share, film, factor of
the pressure-viscosity coefficient, strength of the boundary layer. The truth is known, so that
each interval is right or wrong; and its width is held against the spread between pairs, so that
none is right by being wide. In another part fewer pairs go the whole way, through circuit, files
and manifest.

With slip a pair takes seconds, so `PAIRS` has fewer of them there; ``--all`` takes as many.
"""

import argparse
import itertools
import logging
import math
import multiprocessing
import os
import tempfile
import time
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass
from functools import partial
from pathlib import Path

import netCDF4
import numpy as np
import xarray as xr

from lube.grid.discretise import layer_factor_of, revolution, speed_ratios, whole_numbers
from lube.grid.operating_points import operating_points
from lube.kernels.motion import surface_position
from lube.kernels.strips import strip_statistics
from lube.recordings.manifest import Entry, Manifest, read_manifest
from lube.rig.at_records import model_at_records
from lube.rig.fits import ALPHA_FACTORS, alpha_logits, fit_records, strength_logits, study_strength
from lube.rig.simulator import SimulatedRig
from lube.schema import LIMITS, label
from lube.stages.comparison import compare
from lube.stages.contact import contact_map, contact_statistics
from lube.stages.ensemble import gather, gather_map
from lube.stages.experiment import measured_experiment
from lube.stages.film import film_at_records, film_table
from lube.stages.gauge import gauge_film
from lube.stages.lubricant import lubricant_table
from lube.stages.roughness import roughness_batch
from lube.storage.netcdf import save
from lube.study.study import load_study
from lube.surfaces.synthetic import draw_realisation, line_attributes

TURNS = (0.01, 0.3, 1.0, 10.4, 100.4)
SLIP = 2.0 * (1.0 - 0.9) / (1.0 + 0.9)
"""One surface 0.9 times as fast as the other: equal rollers are back where they began in 10 turns,
and so any number of turns follows from these."""
MOTIONS = {"rolling": 0.0, "slipping": SLIP}
SMALLER = 0.8
"""Radius of the second of two unequal rollers over the first's: they are back in 4 turns."""
SCENARIOS = [(rollers, motion) for motion in MOTIONS for rollers in ("equal", "unequal")]
SLIP_LAMBDAS = np.geomspace(1.3, 3.8, 7)
"""Operating points with slip are those with the nearest lambda ratios."""

HELD_OUT = 100_000
"""First realisation of the pairs that no ensemble has seen."""
PAIRS = {"rolling": 1000, "slipping": 200}
ENSEMBLES, ENSEMBLE_PAIRS = 4, 200
"""Ensembles that share no realisation. Each judges its part of a scenario's pairs, so that no
figure is the luck of one ensemble; and all judge these pairs, for equal rollers in rolling."""
FILES, FILE_TURNS = 30, 10.4
TOY = 8
"""Pairs of the smoke study, whose figures mean nothing."""

LEAST = 1e-3
"""Probability above which the figures for all points together are taken."""


@dataclass(frozen=True)
class Ensemble:
    """What a study knows of its rollers: films, contact and master map."""

    seed: int
    film: xr.Dataset
    contact: xr.Dataset
    master: xr.Dataset


def variant(study, rollers, motion="rolling"):
    """The study with equal or unequal rollers, one film formula and one slip."""
    first = study.rollers.first
    radius = first.radius * (SMALLER if rollers == "unequal" else 1.0)
    second = study.rollers.second.model_copy(update={"radius": radius})
    grid = study.operating_grid.model_copy(update={"slide_to_roll_ratio": (MOTIONS[motion],)})
    changed = {
        "rollers": study.rollers.model_copy(update={"second": second}),
        "film_formulas": ("paper",),
        "operating_grid": grid,
    }
    return study.model_copy(update=changed)


# What the study knows


def film_of(study):
    """Film table of a study's operating grid."""
    grid = study.operating_grid
    oil = lubricant_table(study.lubricants, grid.temperature)
    return film_table(oil, study.rollers, grid.force, grid.speed, study.film_formulas)


def make_ensembles(study, count, pool):
    """Ensembles of the study's rollers by as many seeds, which share no realisation."""
    return [make_ensemble(study, study.seed + number, pool) for number in range(count)]


def make_ensemble(study, seed, pool):
    """Contact and master map of the study's realisations by one seed."""
    film = film_of(study)
    wanted = [(study, film, seed, number) for number in range(study.realisations)]
    runs, maps = zip(*pool(_realisation, wanted), strict=True)
    return Ensemble(seed, film, gather(runs, film), gather_map(maps))


def _realisation(job):
    study, film, seed, number = job
    lines = roughness_batch(study.line_spec, seed, [number])
    layer = study.boundary_layer
    return contact_statistics(lines, film, layer), contact_map(lines, film, layer)


# What single pairs show


def operating_table(film, motion):
    """Levels, films and widths of the operating points, a column each."""
    table = film.isel(film_formula=0, lubricant=0, drop=True)
    names = ["film_thickness", "contact_half_width", "lambda_ratio"]
    frame = table[names].to_dataframe().reset_index().sort_values("lambda_ratio")
    if motion == "slipping":
        ratios = np.log(frame["lambda_ratio"].values)
        nearest = [int(np.argmin(np.abs(ratios - np.log(wanted)))) for wanted in SLIP_LAMBDAS]
        frame = frame.iloc[sorted(set(nearest))]
    return frame


def record_shares(study, table, slip, turns, realisation):
    """Shares of a pair's records of so many turns, shape (turns, points).

    A pair that is back where it began shows the same again, so that its longest records follow
    from one such cycle.
    """
    pair = draw_realisation(study.line_spec, study.seed, realisation)
    ratios = speed_ratios(slip)
    turn = revolution(pair, ratios)
    ends = np.maximum(np.round(np.array(turns) * turn).astype(np.int64), 1)
    cycle = _cycle(pair, ratios) * turn
    whole, rest = ends // cycle, ends % cycle
    marks = np.unique([0, *rest, *(cycle * (whole > 0))])
    counts = counts_up_to(study, pair, ratios, table, marks)
    # The last mark is the cycle's end where there is a whole one.
    return (whole[:, None] * counts[-1] + counts[np.searchsorted(marks, rest)]) / ends[:, None]


def _cycle(pair, ratios):
    """Turns of the faster surface after which both lines meet as they did at first."""
    faster = 0 if ratios[0] == 1.0 else 1
    other = pair[1 - faster].size
    return other // math.gcd(round(pair[faster].size * ratios[1 - faster]), other)


def counts_up_to(study, pair, ratios, table, marks):
    """Steps in contact up to each of some marks, the first of them 0, shape (marks, points)."""
    lines = xr.Dataset(attrs=line_attributes(study.line_spec))
    factor = layer_factor_of(lines, study.rollers.reduced_modulus, study.boundary_layer)
    points = whole_numbers(table["film_thickness"], table["contact_half_width"], lines)
    counts = np.zeros((marks.size, len(table)), np.int64)
    for number, (begin, end) in enumerate(itertools.pairwise(marks), start=1):
        begun = [
            np.roll(line, -surface_position(begin, ratio))
            for line, ratio in zip(pair, ratios, strict=True)
        ]
        run = strip_statistics(*begun, ratios, end - begin, *points, factor)
        counts[number] = counts[number - 1] + run[:, 1]
    return counts


def held_out_shares(study, table, motion, pairs, pool):
    """Shares of the records of pairs that no ensemble has seen, shape (pairs, TURNS, points)."""
    run = partial(record_shares, study, table, MOTIONS[motion], TURNS)
    return np.array(list(pool(run, range(HELD_OUT, HELD_OUT + pairs))))


# What the study makes of them


def experiment_of(study, table, motion, turns):
    """Records of one pair at all operating points, each of so many turns; their shares follow."""
    entries = [
        Entry.model_construct(
            where=f"{turns:g} turns, point {number}",
            probability=0.5,
            slide_to_roll_ratio=MOTIONS[motion],
            **{name: float(row[name]) for name in ("force", "speed", "temperature")},
        )
        for number, row in enumerate(table.to_dict("records"))
    ]
    experiment = measured_experiment(Manifest("simulated", tuple(entries), ()), study)
    experiment["turns"] = experiment["turns"].copy(data=np.full(len(entries), turns))
    return experiment


def comparisons(study, ensemble, table, motion, turns=TURNS):
    """One comparison for each number of turns; the model is made for all of them at once."""
    experiments = [experiment_of(study, table, motion, each) for each in turns]
    joined = xr.concat(experiments, "record", data_vars="minimal", join="exact")
    own = study.model_copy(update={"seed": ensemble.seed})
    model = model_of(joined, ensemble, own)
    parts = np.split(np.arange(joined.sizes["record"]), len(turns))
    return [
        compare(model.isel(record=part), joined.isel(record=part), ensemble.contact)
        for part in parts
    ]


def model_of(experiment, ensemble, study):
    """What an ensemble knows of some records."""
    oils = lubricant_table(study.lubricants, np.unique(experiment["temperature"]))
    films = film_at_records(experiment, oils, study.rollers, study.film_formulas)
    return model_at_records(films, experiment, ensemble.film, ensemble.contact, study)


def judge(ensemble, comparison, shares):
    """What the study makes of each pair's records of one length.

    Parameters
    ----------
    ensemble : Ensemble
        What it knows.
    comparison : xarray.Dataset
        The model at these records.
    shares : numpy.ndarray
        Shape (pairs, points).

    Returns
    -------
    dict of str to numpy.ndarray
        ``probability`` and ``predicted``, the mean over the ensemble and the width of the
        prediction, and ``inside``, whether a share is within it, shape (pairs, points); ``film``
        with its limits, as logarithms of the lambda ratio, shape (pairs, points, 3); ``alpha``
        and ``layer`` with theirs, as logarithms of their ratio to the truth, shape (pairs, 3).
    """
    one = comparison.isel(film_formula=0)
    lower, upper = (one[f"predicted_share_{side}"].values for side in ("lower", "upper"))
    strength = strength_logits(ensemble.master, ensemble.contact, comparison)
    fits = {
        "alpha": (ALPHA_FACTORS, alpha_logits(ensemble.master, comparison), 1.0),
        "layer": (*strength, study_strength(ensemble.contact)),
    }
    everyone = np.ones((len(shares), 1))
    found = {
        "probability": everyone * one["simulated_probability"].values,
        "predicted": everyone * (upper - lower),
        "inside": (lower <= shares) & (shares <= upper),
        "film": _films(ensemble, comparison, shares),
    }
    for name, (tried, logits, truth) in fits.items():
        model = np.log(tried), logits.values[:, 0]
        rows = [fit_records(*model, _with_shares(one, of_pair)) for of_pair in shares]
        with np.errstate(divide="ignore"):
            found[name] = np.log(np.array(rows) / truth)
    return found


def _with_shares(comparison, shares):
    return comparison.assign(measured_share=("record", shares))


def _films(ensemble, comparison, shares):
    """Gauged films of all pairs, one after the other along the record dimension."""
    names = ["contact_half_width", "scatter_ratio", "share_error", "composite_rms_roughness"]
    pairs, points = shares.shape
    everyone = comparison[names].drop_vars("record").isel(record=np.tile(range(points), pairs))
    gauged = gauge_film(ensemble.master, _with_shares(everyone, shares.ravel()))
    limits = [gauged[f"gauged_lambda_ratio{limit}"].values for limit in LIMITS]
    with np.errstate(divide="ignore"):
        return np.log(np.stack(limits, axis=-1)).reshape(pairs, points, 3)


def judge_all(ensembles, compared, shares, pool):
    """As `judge`: each ensemble judges its part of the pairs, shared out among processes."""
    jobs = [
        (ensemble, comparison, part)
        for ensemble, comparison, own in zip(
            ensembles, compared, np.array_split(shares, len(ensembles)), strict=True
        )
        for part in np.array_split(own, math.ceil(len(own) / 25))
    ]
    return join(pool(judge, *zip(*jobs, strict=True)))


def join(judged):
    """Join what `judge` says of several parts of the pairs."""
    judged = list(judged)
    return {name: np.concatenate([part[name] for part in judged]) for name in judged[0]}


# How often it is right


def figures(comparison, shares, judged):
    """Coverage and widths of one scenario's records of one length.

    Returns
    -------
    dict of str to float or numpy.ndarray
        Variables of the ``coverage`` file; those over points as arrays.
    """
    one = comparison.isel(film_formula=0)
    probability = judged["probability"]
    counted = probability.mean(axis=0) > LEAST
    film, inside = judged["film"], judged["inside"]
    held = _holds(film, np.log(one["lambda_ratio"].values))
    closed = np.isfinite(film[..., 1:]).all(axis=-1)
    beyond = np.where(shares < probability, np.inf, -np.inf)
    gauged = np.where(np.isnan(film[..., 0]), beyond, film[..., 0])
    predicted = np.median(judged["predicted"], axis=0)
    return {
        "film_coverage": _mean(held[:, counted]),
        "closed_coverage": _mean(held[closed]),
        "one_sided_coverage": _mean(held[~closed]),
        "closed_share": _mean(closed),
        "film_width_ratio": _middle(_width_ratio(film, gauged)[counted]),
        "agreement": _mean(inside[:, counted]),
        "prediction_width_ratio": _middle((predicted / _spread(shares))[counted]),
        **{
            name: value
            for fit in ("alpha", "layer")
            for name, value in (
                (f"{fit}_coverage", _mean(_holds(judged[fit], 0.0))),
                (f"{fit}_width_ratio", float(_width_ratio(judged[fit], judged[fit][:, 0]))),
            )
        },
        "point_film_coverage": held.mean(axis=0),
        "point_agreement": inside.mean(axis=0),
    }


def _holds(limited, truth):
    return (limited[..., 1] <= truth) & (truth <= limited[..., 2])


def _mean(values):
    return np.mean(values) if values.size else np.nan


def _middle(ratios):
    """Median of those that are numbers: there is none where most intervals have one limit."""
    known = ratios[np.isfinite(ratios)]
    return np.median(known) if known.size else np.nan


def _spread(values):
    """Width of what holds 95 % of the pairs in its middle; infinite where it has no end."""
    beyond = np.where(np.isnan(values), np.inf, values)
    lower, upper = np.quantile(beyond, [0.025, 0.975], axis=0, method="nearest")
    with np.errstate(invalid="ignore"):
        return np.where(upper > lower, upper - lower, np.nan)


def _width_ratio(limited, found):
    """Median width of the pairs' intervals over the spread of what they found."""
    with np.errstate(invalid="ignore"):
        return np.median(limited[..., 2] - limited[..., 1], axis=0) / _spread(found)


# Through circuit and files


def records_on_file(study, table, folder):
    """Let the simulated rig write its records, and a manifest that names them."""
    points = [
        point
        for row in table.to_dict("records")
        for point in operating_points(_film_of(study, row), 0.0)
    ]
    lines = roughness_batch(study.line_spec, study.seed, study.rig_realisations)
    rows = ["file,force [N],speed [rpm],temperature [degC],pair,origin"]
    for pair, number, part in SimulatedRig(lines, study, points).revolutions():
        name = f"{pair}_{number}.nc"
        if not (folder / name).exists():
            level = [
                f"{points[number].levels[each]!r}" for each in ("force", "speed", "temperature")
            ]
            rows.append(",".join([name, *level, f"{pair}", "simulated"]))
        _append(folder / name, part.voltage(study.rig), study.rig)
    (folder / "manifest.csv").write_text("\n".join(rows) + "\n", encoding="utf-8")
    return folder / "manifest.csv"


def _film_of(study, row):
    oil = lubricant_table(study.lubricants[:1], [row["temperature"]])
    levels = [row["force"]], [row["speed"]]
    return film_table(oil, study.rollers, *levels, study.film_formulas).isel(film_formula=0)


def _append(path, voltage, rig):
    """Append whole steps of the converter to a record."""
    with netCDF4.Dataset(path, "a" if path.exists() else "w") as file:
        if "voltage" not in file.variables:
            file.createDimension("time", None)
            variable = file.createVariable("voltage", "i2", ("time",), chunksizes=(2**16,))
            told = {"units": "V", "scale_factor": rig.resolved_voltage}
            variable.setncatts(told | {"sampling_interval": f"{1.0 / rig.sampling_rate!r} s"})
        variable = file["voltage"]
        variable.set_auto_maskandscale(False)
        begin = variable.size
        steps = np.rint(voltage / rig.resolved_voltage).astype(np.int16)
        variable[begin : begin + steps.size] = steps


def through_files(study, ensemble, table, pairs, folder):
    """Figures of some pairs whose records went through circuit, files and manifest."""
    rig = study.rig.model_copy(update={"pairs": pairs, "revolutions": FILE_TURNS, "drift": 0.0})
    study = study.model_copy(update={"rig": rig})
    manifest = read_manifest(records_on_file(study, table, folder))
    experiment = measured_experiment(manifest, study)
    model = model_of(experiment, ensemble, study)
    comparison = compare(model, experiment, ensemble.contact)
    judged, shares = [], []
    for pair in range(pairs):
        own = comparison.isel(record=comparison["pair"].values == f"{pair}")
        own = own.sortby(own["lambda_ratio"].isel(film_formula=0))
        shares.append(own["measured_share"].values)
        judged.append(judge(ensemble, own, shares[-1][None]))
    return own, figures(own, np.array(shares), join(judged))


# The whole


def scenario_name(rollers, motion):
    """Name of a scenario, as a reader takes it."""
    return f"{rollers} rollers, {motion}"


def measure_scenario(study, ensembles, rollers, motion, pairs, pool):
    """Figures of one scenario, one row for each number of turns, and its points."""
    begin = time.perf_counter()
    study = variant(study, rollers, motion)
    table = operating_table(ensembles[0].film, motion)
    shares = held_out_shares(study, table, motion, pairs, pool)
    ran = time.perf_counter()
    rows = []
    made = [comparisons(study, ensemble, table, motion) for ensemble in ensembles]
    for number, compared in enumerate(zip(*made, strict=True)):
        judged = judge_all(ensembles, compared, shares[:, number], pool)
        rows.append(figures(compared[0], shares[:, number], judged))
        tell(f"{scenario_name(rollers, motion)}, {TURNS[number]:g} turns", pairs, rows[-1])
    now = time.perf_counter()
    print(f"{scenario_name(rollers, motion)}: runs {ran - begin:.0f} s, judged {now - ran:.0f} s")
    return rows, compared[0], shares


def measure_ensembles(study, shares, ensembles, pool):
    """Figures of the same pairs by each ensemble."""
    study = variant(study, "equal")
    at, rows = TURNS.index(FILE_TURNS), []
    for number, ensemble in enumerate(ensembles):
        table = operating_table(ensemble.film, "rolling")
        compared = comparisons(study, ensemble, table, "rolling", [FILE_TURNS])
        judged = judge_all([ensemble], compared, shares[:ENSEMBLE_PAIRS, at], pool)
        rows.append(figures(compared[0], shares[:ENSEMBLE_PAIRS, at], judged))
        tell(f"ensemble {number}", len(shares[:ENSEMBLE_PAIRS]), rows[-1])
    return rows


def tell(where, pairs, row):
    """Print the figures of one scenario and length."""
    print(
        f"{where}, {pairs} pairs: film {row['film_coverage']:.3f} "
        f"(closed {row['closed_coverage']:.3f}, {row['closed_share']:.0%} of all, one-sided "
        f"{row['one_sided_coverage']:.3f}), width {row['film_width_ratio']:.2f}; agreement "
        f"{row['agreement']:.3f}, width {row['prediction_width_ratio']:.2f}; alpha "
        f"{row['alpha_coverage']:.3f}, width {row['alpha_width_ratio']:.2f}; layer "
        f"{row['layer_coverage']:.3f}, width {row['layer_width_ratio']:.2f}",
        flush=True,
    )


def measure(study, pairs, files, pool, folder):
    """Measure everything, as the ``coverage`` file of `lube.schema`."""
    found, of_ensembles = {}, None
    for rollers in ("equal", "unequal"):
        ensembles = make_ensembles(variant(study, rollers), ENSEMBLES, pool)
        for motion in MOTIONS:
            rows, comparison, shares = measure_scenario(
                study, ensembles, rollers, motion, pairs[motion], pool
            )
            found[scenario_name(rollers, motion)] = pairs[motion], TURNS, rows, comparison
            if of_ensembles is None:
                of_ensembles = measure_ensembles(study, shares, ensembles, pool)
                first, equal = ensembles[0], variant(study, "equal")
                table = operating_table(first.film, "slipping")  # the fewer points
                own, row = through_files(equal, first, table, files, folder)
                name = f"{scenario_name(rollers, motion)}, through files"
                tell(name, files, row)
                found[name] = files, (FILE_TURNS,), [row], own
    return label(_dataset(study, found, of_ensembles), "coverage")


def _dataset(study, found, of_ensembles):
    """Set all figures side by side, NaN where a scenario has no such length or point."""
    points = max(comparison.sizes["record"] for _, _, _, comparison in found.values())
    scenarios = []
    for count, turns, rows, comparison in found.values():
        one = comparison.isel(film_formula=0).drop_vars("record").rename(record="point")
        one = one.reset_coords(drop=True).assign_coords(point=range(one.sizes["point"]))
        rows = [
            xr.Dataset({n: (("point",) * np.ndim(v), v) for n, v in row.items()}) for row in rows
        ]
        rows = xr.concat(rows, xr.DataArray(list(turns), dims="record_turns", name="record_turns"))
        rows["point_lambda_ratio"] = one["lambda_ratio"]
        rows["point_probability"] = one["simulated_probability"]
        rows["pairs"] = count
        scenarios.append(rows.drop_attrs().reindex(record_turns=list(TURNS), point=range(points)))
    names = xr.DataArray(list(found), dims="scenario", name="scenario")
    dataset = xr.concat(scenarios, names).assign_attrs({})
    dataset = dataset.transpose("scenario", "record_turns", "point", missing_dims="ignore")
    for name in ("film_coverage", "agreement", "alpha_coverage", "layer_coverage"):
        dataset[f"ensemble_{name}"] = "ensemble", [row[name] for row in of_ensembles]
    dataset["ensemble_turns"] = FILE_TURNS
    dataset["ensemble_pairs"] = min(ENSEMBLE_PAIRS, int(dataset["pairs"].max()))
    dataset["ensemble_realisations"], dataset["least_probability"] = study.realisations, LEAST
    return dataset.assign_coords(ensemble=range(ENSEMBLES), point=range(points))


def main():
    """Measure, tell and, if asked to, save."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("study", nargs="?", default="workflow/config/paper.yaml")
    parser.add_argument("output", nargs="?")
    parser.add_argument("--all", action="store_true", help="as many pairs with slip as without")
    options = parser.parse_args()
    # Records stand at chosen points only, and no warning is needed of the others.
    logging.getLogger("lube").setLevel(logging.ERROR)
    study = load_study(options.study)
    pairs, files = dict(PAIRS), FILES
    if options.all:
        pairs["slipping"] = pairs["rolling"]
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
