"""Experiments with given contact shares, for tests of the stages that use them."""

import numpy as np
import xarray as xr
from studies import OIL

from lube.inference.at_records import model_at_records
from lube.schema import label, values_with_limits, with_dims
from lube.statistics.folding import PHASES

THRESHOLDS = np.array([10.0, 100.0, 1000.0])
CURVE_RATIOS = np.geomspace(0.3, 4.0, 40)
"""Lambda ratios of the curves of `made_up_surfaces`."""
LAYER_STRENGTHS = 4e13 * np.array([1.0, 4.0, 10.0, 30.0])
"""Strengths of boundary layers on these surfaces, the weakest the study's, Pa/m."""
LAYER_BREAKS = np.array([1.0, 0.9, 0.5, 0.1])
"""Probability of breakthrough with each, over that with the study's."""
SURFACE_WINDOWS = 400
"""Independent trials in a revolution of these surfaces."""


def experiment_of(shares, force, speed, temperature, **values):
    """Records with given shares below 100 ohm; half as much below 10, the same below 1000.

    By default they are of one revolution in pure rolling, of one pair of rollers, and each is
    assigned to the levels equal to its conditions.
    """
    count = len(shares)
    conditions = {"force": force, "speed": speed, "temperature": temperature}
    records = {f"{name}_level": level for name, level in conditions.items()} | {
        "record": [f"record {number}" for number in range(count)],
        "true_contact_share": np.asarray(shares),
        "share_error": 0.0,
        "lubricant": OIL,
        "slide_to_roll_ratio": 0.0,
        "speed_ratio": 1.0,
        "pair": "1",
        "duration": 1.0,
        "turns": 1.0,
        "revolution_period": 1.0,
        "repeatability": 1.0,
        "sampling_interval": 1e-5,
    }
    records |= conditions | values
    variables = {
        name: ("record", np.broadcast_to(value, count).copy()) for name, value in records.items()
    }
    below = np.asarray(shares)[:, None] * np.array([0.5, 1.0, 1.0])
    for limit, factor in (("", 1.0), ("_lower", 0.9), ("_upper", 1.0)):
        variables[f"contact_share{limit}"] = ("record", "threshold"), factor * below
    folded = ("record", "phase"), np.full((count, PHASES), np.nan)
    trace = ("record", "trace_sample"), np.full((count, 4), np.nan)
    variables |= dict.fromkeys(("folded_share", "folded_deviation"), folded)
    variables |= dict.fromkeys(("trace_time", "trace_resistance"), trace)
    coords = {
        "threshold": THRESHOLDS,
        "phase": (np.arange(PHASES) + 0.5) / PHASES,
        "origin": "simulated",
    }
    experiment = xr.Dataset(variables, coords, {"refused": "", "remarks": ""})
    pairs = len(set(experiment["pair"].values.tolist()))
    experiment = experiment.assign(comparison_threshold=100.0, drift=0.0, pairs=pairs)
    labels = [f"{name}_level" for name in conditions]
    return label(
        experiment.set_coords(
            [*conditions, *labels, "lubricant", "slide_to_roll_ratio", "pair", "duration"]
        ),
        "experiment",
    )


def experiment_at(levels, shares, **values):
    """Records at all points of a grid, the force changing fastest, with given shares."""
    names = ("temperature", "speed", "force")
    grid = np.meshgrid(*(np.asarray(levels[name]) for name in names), indexing="ij")
    conditions = {name: each.ravel() for name, each in zip(names, grid, strict=True)}
    return experiment_of(np.ravel(shares), **(conditions | values))


def model_of_records(experiment, film, contact, study):
    """The model at the conditions of each record, as the workflow makes it."""
    return model_at_records(experiment, film, contact, study)


def surface_probability(ratios):
    """Probability of made-up surfaces, which touch more often than the lines of the busy study."""
    return -np.expm1(-5.0 * np.exp(-(ratios**2)))


def made_up_surfaces(ratios, error=0.0):
    """A ``surface_records`` dataset at the lambda ratios of records by every film formula.

    It has a relative standard error.
    """
    ratios = ratios.transpose("film_formula", "record")
    records = ratios.sizes["record"]
    curves = np.repeat(surface_probability(CURVE_RATIOS)[:, None], records, axis=1)
    sides = np.array([1.0, 1.0 - 2.0 * error, 1.0 + 2.0 * error])
    values = {
        "record": [f"record {number}" for number in range(records)],
        "film_formula": ratios["film_formula"].values,
        "sample_size": np.full(ratios.shape, float(SURFACE_WINDOWS)),
        "scatter_ratio": np.ones(records),
        "curve_lambda_ratio": CURVE_RATIOS,
        "curve_sample_size": np.full(curves.shape, float(SURFACE_WINDOWS)),
        **values_with_limits("curve_probability", sides[:, None, None] * curves),
    }
    by_layer = LAYER_BREAKS[:, None] * surface_probability(CURVE_RATIOS[::3])
    values |= {
        "layer_strength": LAYER_STRENGTHS,
        "layer_lambda_ratio": CURVE_RATIOS[::3],
        "layer_curve_probability": np.repeat(by_layer[..., None], records, axis=2),
    }
    limits = sides[:, None, None] * surface_probability(ratios.values)
    values |= values_with_limits("breakthrough_probability", limits)
    return label(xr.Dataset(with_dims("surface_records", values)), "surface_records")
