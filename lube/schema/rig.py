"""The records of the rig, measured or simulated, and their comparison with the model."""

from dataclasses import replace

from lube.schema.coordinates import AT_POINTS, AT_RECORDS, COORDINATES, EXPERIMENT_DIMS
from lube.schema.variables import (
    MEAN_OF_RECORD,
    THEN_REALISATIONS,
    FileKind,
    count,
    flag,
    number,
    quality,
    recorded,
    run_mean,
    sides,
    with_limits,
)

ORIGINS = ("measured", "simulated")
"""Possible origins of the records."""

_RECORD = ("record",)
_PHASE = ("record", "phase")
_TRACE = ("record", "trace_sample")
_BELOW = "share of time with resistance below the threshold"

# Variables that the comparison and the gauge take over from the experiment.
_SHARED = {
    "origin": COORDINATES["origin"],
    **AT_RECORDS,
    "comparison_threshold": number(
        [], "ohm", "threshold at which records are compared with the simulation"
    ),
    "drift": number([], "1", "share of the roughness variance renewed in each revolution"),
    "pairs": count([], "1", "number of pairs of rollers among the records"),
}
_SHARE_ERROR = quality(
    _RECORD, "1", "standard error of the contact share, from the scatter between revolutions"
)

_EXPERIMENT = {
    **_SHARED,
    **with_limits(
        "contact_share",
        ("record", "threshold"),
        "1",
        _BELOW,
        content="record",
        cell_methods=MEAN_OF_RECORD,
    ),
    "true_contact_share": number(
        _RECORD,
        "1",
        "share of time with metal contact in the simulated rig",
        cell_methods=MEAN_OF_RECORD,
    ),
    "share_error": _SHARE_ERROR,
    "sampling_interval": number(_RECORD, "s", "time between samples"),
    "turns": number(_RECORD, "1", COORDINATES["revolutions"].long_name),
    "revolution_period": recorded(
        _RECORD,
        "s",
        "period of revolution of the first rotating roller, from the periodicity of the record "
        "where it is clear",
    ),
    "repeatability": recorded(_RECORD, "1", "correlation between two revolutions"),
    "speed_ratio": recorded(
        _RECORD, "1", "speed from the periodicity of the record over the stated speed"
    ),
    "folded_share": recorded(
        _PHASE,
        "1",
        "share of time in contact at a phase of the revolution",
        cell_methods=MEAN_OF_RECORD,
    ),
    "folded_deviation": recorded(_PHASE, "1", "standard deviation between revolutions at a phase"),
    "trace_time": number(_TRACE, "s", "time"),
    "trace_resistance": recorded(
        _TRACE, "ohm", "resistance between the rollers during the first revolution"
    ),
}

_POINT_TIME = ("operating_point", "rig_time")
_RIG = {
    "origin": COORDINATES["origin"],
    "revolutions": replace(COORDINATES["revolutions"], kind="f"),
    **{name: AT_POINTS[name] for name in EXPERIMENT_DIMS},
    "voltage": number(_POINT_TIME, "V", "recorded voltage"),
    "resistance": number(_POINT_TIME, "ohm", "resistance between the rollers"),
    "contact_share": run_mean(("operating_point", "bandwidth", "threshold"), "1", _BELOW),
    "true_contact_share": run_mean(["operating_point"], "1", "share of time with metal contact"),
    "rig_bandwidth": number([], "Hz", "bandwidth of the amplifier in the study"),
    "rig_sampling_rate": number([], "s-1", "sampling rate"),
    "rig_bias_voltage": number([], "V", "bias voltage"),
}

_BY_FORMULA = ("film_formula", "record")
_BY_REALISATION = ("realisation", *_BY_FORMULA)
_BY_THRESHOLD = ("film_formula", "threshold")
_BY_OIL = ("fitted_lubricant", "film_formula")

_FILM = {
    "film_thickness": number(_BY_FORMULA, "m", "film thickness by the formula"),
    "lambda_ratio": number(_BY_FORMULA, "1", "lambda ratio by the formula"),
    "contact_half_width": number(_RECORD, "m", "contact half-width"),
}


def _agreement(name, long_name, method):
    """Describe a figure of agreement, and its range if the model is correct."""
    methods = f"film_formula: {method} (over all records at one film_formula)"
    return {
        name: number(_BY_THRESHOLD, "1", long_name, cell_methods=methods),
        **sides(
            ["film_formula"], "1", long_name, f"{name}_expected", "95 % range for a correct model"
        ),
    }


def _level_means(level):
    """Describe the means of both sides over the records at each level."""
    group = f"{level}_group"
    methods = f"{group}: mean (over all records at one {group})"
    both = {
        "simulated_mean": (("film_formula", group), "mean simulated probability"),
        "measured_mean": ((group,), "mean measured share"),
    }
    return {
        f"{name}_by_{level}": number(
            dims, "1", f"{words} of the records at this {level}", cell_methods=methods
        )
        for name, (dims, words) in both.items()
    }


_COMPARISON = {
    **_SHARED,
    **_FILM,
    "reduced_radius": number([], "m", "reduced radius R*"),
    "composite_rms_roughness": number([], "m", "composite rms roughness"),
    "moes_load": number(_RECORD, "1", "Moes load number M"),
    "moes_material": number(_RECORD, "1", "Moes material number L"),
    "breakthrough_probability": number(
        _BY_REALISATION,
        "1",
        "probability of boundary layer breakthrough of each realisation, in pure rolling",
        cell_methods=MEAN_OF_RECORD,
    ),
    **with_limits(
        "simulated_probability",
        _BY_FORMULA,
        "1",
        "simulated breakthrough probability, mean over realisations",
        cell_methods=f"{MEAN_OF_RECORD} {THEN_REALISATIONS}",
    ),
    "scatter_ratio": number(
        _BY_FORMULA,
        "1",
        "variance between pairs of the record's share over that of one revolution in pure rolling",
    ),
    "record_deviation": number(
        _BY_REALISATION,
        "1",
        "deviation of each realisation in such a record, for the correlation between records",
    ),
    **sides(
        _BY_FORMULA,
        "1",
        "contact share of one pair's record",
        "predicted_share",
        "95 % prediction interval",
    ),
    **with_limits(
        "measured_share",
        _RECORD,
        "1",
        "share of time below the threshold",
        content="record",
        cell_methods=MEAN_OF_RECORD,
    ),
    "share_error": _SHARE_ERROR,
    "within_prediction": flag(
        _BY_FORMULA,
        "whether the contact share of the record lies within the prediction interval",
        ("outside", "inside"),
    ),
    **_agreement("bias", "mean of simulated probability minus measured share", "mean"),
    **_agreement("rms_difference", "rms difference of the probabilities", "root_mean_square"),
    **_agreement("logit_rms_difference", "rms difference of the logits", "root_mean_square"),
    **_agreement("overlap_share", "share of records within their prediction interval", "mean"),
    "rank_correlation": number(_BY_THRESHOLD, "1", "Spearman's rank correlation"),
    "compared_records": count(_BY_THRESHOLD, "1", "number of records compared"),
    "logit_records": count(
        _BY_THRESHOLD, "1", "number of records with both probabilities between 0 and 1"
    ),
    **_level_means("force"),
    **_level_means("speed"),
    **_level_means("temperature"),
}

_LEFT_OUT = "share of realisations, each left out and treated as the records, whose"
_GAUGE = {
    **_SHARED,
    **_FILM,
    **with_limits("gauged_film_thickness", _RECORD, "m", "film thickness inferred from the record"),
    **with_limits("gauged_lambda_ratio", _RECORD, "1", "lambda ratio inferred from the record"),
    **with_limits(
        "alpha_factor", _BY_OIL, "1", "factor of the pressure-viscosity coefficient that fits best"
    ),
    **with_limits(
        "fitted_layer_strength",
        _BY_OIL,
        "Pa m-1",
        "strength tau0 / h_c of the boundary layer that fits best",
    ),
    "study_layer_strength": number(
        [], "Pa m-1", "strength tau0 / h_c of the boundary layer in the study"
    ),
    **{
        f"{name}_coverage": quality(_RECORD, "1", f"{_LEFT_OUT} {words} contains the film")
        for name, words in (
            ("interval", "interval"),
            ("closed", "two-sided interval"),
            ("one_sided", "one-sided interval"),
        )
    },
    "closed_share": number(
        _RECORD, "1", "share of realisations whose inferred film has both limits"
    ),
    **{
        f"{fit}_coverage": quality(
            _BY_OIL, "1", f"{_LEFT_OUT} interval of the {words} contains the true value"
        )
        for fit, words in (("alpha_factor", "factor"), ("fitted_layer_strength", "strength"))
    },
    "fitted_records": count(["fitted_lubricant"], "1", "number of records fitted"),
}

KINDS = {
    "experiment": FileKind(
        _EXPERIMENT,
        "For each record its operating conditions, the share of time with resistance below each "
        "threshold, the record folded by the revolution, and its first revolution; the "
        "coordinate `origin` says whether the records were measured or simulated.",
        ("refused", "remarks"),
    ),
    "rig": FileKind(
        _RIG,
        "What a simulated rig records at the operating points of the traces, and the contact "
        "shares that amplifiers of smaller bandwidth would give.",
    ),
    "comparison": FileKind(
        _COMPARISON,
        "Simulation against experiment at the conditions of each record: the prediction interval "
        "of the contact share of a single pair of rollers, and figures of agreement.",
        ("missing", "remarks", "travel", "longest_wavelength"),
    ),
    "gauge": FileKind(
        _GAUGE,
        "The inverse problem: the film thickness, the pressure-viscosity coefficient and the "
        "strength of the boundary layer that explain the records.",
    ),
}
