"""What a rig found, measured or simulated, and how the simulation compares with it."""

from lube.schema import oil
from lube.schema.coordinates import (
    AT_POINTS,
    COMPARISON_DIMS,
    COORDINATES,
    EXPERIMENT_DIMS,
    POINT_DIMS,
)
from lube.schema.variables import (
    OVER_ALL,
    OVER_RECORD,
    FileKind,
    flag,
    limited,
    number,
    run_mean,
    text,
)

ORIGINS = ("measured", "simulated")
"""Where the rig's records may come from."""

_SHARE_DIMS = (*EXPERIMENT_DIMS, "threshold")
_EXPERIMENT = {
    "origin": COORDINATES["origin"],
    **limited(
        "contact_share",
        _SHARE_DIMS,
        "1",
        "share of time with resistance below the threshold",
        content="record",
        attributes=OVER_RECORD,
    ),
    "true_contact_share": number(
        EXPERIMENT_DIMS,
        "1",
        "share of time with metal contact in the simulated rig",
        attributes=OVER_RECORD,
    ),
    "comparison_threshold": number([], "ohm", "threshold that is compared with the simulation"),
    **limited(
        "revolution_share",
        [*EXPERIMENT_DIMS, "revolution"],
        "1",
        "share of time below the compared threshold, one revolution alone",
        content="record",
        attributes={"cell_methods": "revolution: mean"},
    ),
    "record": text(EXPERIMENT_DIMS, "record of the rig"),
    "duration": COORDINATES["duration"],
    "sampling_interval": number(EXPERIMENT_DIMS, "s", "time between samples"),
}

_RIG = {
    "origin": COORDINATES["origin"],
    "revolutions": COORDINATES["revolutions"],
    **{name: AT_POINTS[name] for name in EXPERIMENT_DIMS},
    "voltage": number(["operating_point", "rig_time"], "V", "voltage that the rig logs"),
    "resistance": number(["operating_point", "rig_time"], "ohm", "resistance between the rollers"),
    "contact_share": run_mean(
        ["operating_point", "bandwidth", "threshold"],
        "1",
        "share of time with resistance below the threshold",
    ),
    "true_contact_share": run_mean(["operating_point"], "1", "share of time with metal contact"),
    "rig_bandwidth": number([], "Hz", "bandwidth of the study's rig"),
    "rig_sampling_rate": number([], "s-1", "sampling rate"),
    "rig_bias_voltage": number([], "V", "bias voltage"),
}


def _over_points(level, method):
    """Cell methods of a figure for all operating points at one level."""
    return {"cell_methods": f"{level}: {method} (over all points at one {level})"}


_AGREEMENT_DIMS = ("film_formula", "threshold")
_COMPARISON = {
    "origin": COORDINATES["origin"],
    "revolutions": COORDINATES["revolutions"],
    "duration": COORDINATES["duration"],
    "comparison_threshold": _EXPERIMENT["comparison_threshold"],
    **limited(
        "simulated_probability",
        COMPARISON_DIMS,
        "1",
        "simulated breakthrough probability",
        attributes=OVER_ALL,
    ),
    **limited(
        "measured_share",
        EXPERIMENT_DIMS,
        "1",
        "share of time below the threshold",
        content="record",
        attributes=OVER_RECORD,
    ),
    "intervals_overlap": flag(
        COMPARISON_DIMS,
        "whether the intervals of simulation and record overlap",
        ("apart", "overlapping"),
    ),
    "bias": number(
        _AGREEMENT_DIMS,
        "1",
        "mean of simulated probability less measured share",
        attributes=_over_points("film_formula", "mean"),
    ),
    "rms_difference": number(
        _AGREEMENT_DIMS,
        "1",
        "rms difference of the probabilities",
        attributes=_over_points("film_formula", "root_mean_square"),
    ),
    "logit_rms_difference": number(
        _AGREEMENT_DIMS,
        "1",
        "rms difference of the logits",
        attributes=_over_points("film_formula", "root_mean_square"),
    ),
    "rank_correlation": number(_AGREEMENT_DIMS, "1", "Spearman's rank correlation"),
    "overlap_share": number(
        _AGREEMENT_DIMS, "1", "share of the points with two intervals whose intervals overlap"
    ),
    "compared_points": number(_AGREEMENT_DIMS, "1", "number of points compared", kind="i"),
    "logit_points": number(
        _AGREEMENT_DIMS, "1", "number of points with both probabilities within 0 and 1", kind="i"
    ),
    **{
        f"{name}_by_{level}": number(
            [*dims, level],
            "1",
            f"{long_name} at this {level}",
            attributes=_over_points(level, "mean"),
        )
        for level in ("force", "speed", "temperature")
        for name, dims, long_name in (
            ("simulated_mean", ["film_formula"], "mean simulated probability"),
            ("measured_mean", [], "mean measured share"),
        )
    },
}

_FIT_DIMS = ("lubricant", "film_formula")
_GAUGE = {
    "origin": COORDINATES["origin"],
    "comparison_threshold": _EXPERIMENT["comparison_threshold"],
    **limited("gauged_film_thickness", POINT_DIMS, "m", "film thickness that explains the record"),
    **limited("gauged_lambda_ratio", POINT_DIMS, "1", "lambda ratio that explains the record"),
    **{name: oil.KINDS["film"].variables[name] for name in ("film_thickness", "lambda_ratio")},
    **limited(
        "alpha_factor",
        _FIT_DIMS,
        "1",
        "factor of the pressure-viscosity coefficient that explains the records",
    ),
    **limited(
        "fitted_layer_strength",
        _FIT_DIMS,
        "Pa m-1",
        "strength tau0 / h_c of the boundary layer that explains the records",
    ),
    "study_layer_strength": number([], "Pa m-1", "strength tau0 / h_c of the study's layer"),
    "interval_coverage": number(
        POINT_DIMS,
        "1",
        "share of revolutions, each gauged as a record of its own, whose interval holds the film",
    ),
    "fitted_points": number(
        ["lubricant"], "1", "number of points with a record in pure rolling", kind="i"
    ),
}

KINDS = {
    "experiment": FileKind(
        _EXPERIMENT,
        "Share of time that the rig's resistance is below a threshold, for several "
        "thresholds, with intervals; its coordinate `origin` says whether the rig was measured "
        "or simulated.",
        ("refused",),
    ),
    "rig": FileKind(
        _RIG,
        "What a simulated rig logs at those points, and what narrower bands would find.",
    ),
    "comparison": FileKind(
        _COMPARISON,
        "Simulation against experiment, point by point, and figures of their agreement.",
        ("missing",),
    ),
    "gauge": FileKind(
        _GAUGE,
        "The other way round: the film, the pressure-viscosity coefficient and the boundary "
        "layer that would explain the records.",
        ("missing",),
    ),
}
