"""What a rig found, measured or simulated, and how the simulation compares with it."""

from lube.schema.coordinates import (
    AT_POINTS,
    AT_RECORDS,
    COORDINATES,
    EXPERIMENT_DIMS,
)
from lube.schema.variables import (
    OVER_RECORD,
    OVER_RECORDS,
    FileKind,
    flag,
    limited,
    number,
    run_mean,
)

ORIGINS = ("measured", "simulated")
"""Where the rig's records may come from."""

_EXPERIMENT = {
    "origin": COORDINATES["origin"],
    **AT_RECORDS,
    **limited(
        "contact_share",
        ["record", "threshold"],
        "1",
        "share of time with resistance below the threshold",
        content="record",
        attributes=OVER_RECORD,
    ),
    "true_contact_share": number(
        ["record"],
        "1",
        "share of time with metal contact in the simulated rig",
        attributes=OVER_RECORD,
    ),
    "comparison_threshold": number([], "ohm", "threshold that is compared with the simulation"),
    "sampling_interval": number(["record"], "s", "time between samples"),
    "turns": number(["record"], "1", "revolutions of the roller with the faster surface"),
    "revolution_period": number(
        ["record"],
        "s",
        "time of a revolution of the first roller that turns, from the record's repetition where "
        "it is clear",
        content="record",
    ),
    "repeatability": number(
        ["record"], "1", "correlation between two revolutions", content="record"
    ),
    "speed_ratio": number(
        ["record"],
        "1",
        "speed that a clear repetition of the record tells, over the one stated",
        content="record",
    ),
    "share_error": number(
        ["record"],
        "1",
        "standard error of the share by what differs between revolutions",
        content="qualityInformation",
    ),
    "folded_share": number(
        ["record", "phase"],
        "1",
        "share of time in contact at a phase of the revolution",
        content="record",
        attributes=OVER_RECORD,
    ),
    "folded_deviation": number(
        ["record", "phase"],
        "1",
        "standard deviation between revolutions at a phase",
        content="record",
    ),
    "trace_time": number(["record", "trace_sample"], "s", "time"),
    "trace_resistance": number(
        ["record", "trace_sample"],
        "ohm",
        "resistance between the rollers over the first revolution",
        content="record",
    ),
    "drift": number([], "1", "share of the roughness's variance that each revolution renews"),
    "pairs": number([], "1", "number of pairs of rollers behind the records", kind="i"),
}

_RIG = {
    "origin": COORDINATES["origin"],
    "revolutions": number([], "1", COORDINATES["revolutions"].long_name),
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


def _over_records(level, method):
    """Cell methods of a figure for all records at one level."""
    return {"cell_methods": f"{level}: {method} (over all records at one {level})"}


_BY_FORMULA = ("film_formula", "record")
_AT_RECORDS = {
    "film_thickness": number(_BY_FORMULA, "m", "film thickness by the formula"),
    "lambda_ratio": number(_BY_FORMULA, "1", "lambda ratio by the formula"),
    "contact_half_width": number(["record"], "m", "contact half-width"),
}

_AGREEMENT_DIMS = ("film_formula", "threshold")


def _agreement(name, long_name, method):
    """Describe a figure of agreement, and the range in which a perfect model's would lie."""
    figure = number(
        _AGREEMENT_DIMS, "1", long_name, attributes=_over_records("film_formula", method)
    )
    return {name: figure} | {
        f"{name}_expected_{side}": number(
            ["film_formula"],
            "1",
            f"{long_name}, {side} limit of what a perfect model shows in 95 % of pairs",
            content="qualityInformation",
        )
        for side in ("lower", "upper")
    }


_COMPARISON = {
    "origin": COORDINATES["origin"],
    **AT_RECORDS,
    **_AT_RECORDS,
    "comparison_threshold": _EXPERIMENT["comparison_threshold"],
    "pairs": _EXPERIMENT["pairs"],
    "drift": _EXPERIMENT["drift"],
    "reduced_radius": number([], "m", "reduced radius R*"),
    "composite_rms_roughness": number([], "m", "composite rms roughness"),
    "moes_load": number(["record"], "1", "Moes load number M"),
    "moes_material": number(["record"], "1", "Moes material number L"),
    "breakthrough_probability": number(
        ["realisation", *_BY_FORMULA],
        "1",
        "probability of boundary layer breakthrough of each realisation, in rolling",
        attributes=OVER_RECORD,
    ),
    **limited(
        "simulated_probability",
        _BY_FORMULA,
        "1",
        "simulated breakthrough probability, mean over realisations",
        attributes=OVER_RECORDS,
    ),
    "scatter_ratio": number(
        _BY_FORMULA,
        "1",
        "variance of the record's share between pairs over that of one revolution in rolling",
    ),
    "record_deviation": number(
        ["realisation", *_BY_FORMULA],
        "1",
        "deviation of each realisation in such a record, for the correlation between records",
    ),
    **{
        f"predicted_share_{side}": number(
            _BY_FORMULA,
            "1",
            f"{side} limit of the 95 % prediction interval of the share of one pair's record",
            content="qualityInformation",
        )
        for side in ("lower", "upper")
    },
    **limited(
        "measured_share",
        ["record"],
        "1",
        "share of time below the threshold",
        content="record",
        attributes=OVER_RECORD,
    ),
    "share_error": _EXPERIMENT["share_error"],
    "within_prediction": flag(
        _BY_FORMULA,
        "whether the record's share lies within the prediction interval",
        ("outside", "inside"),
    ),
    **_agreement("bias", "mean of simulated probability less measured share", "mean"),
    **_agreement("rms_difference", "rms difference of the probabilities", "root_mean_square"),
    **_agreement("logit_rms_difference", "rms difference of the logits", "root_mean_square"),
    **_agreement(
        "overlap_share", "share of the records that lie within their prediction interval", "mean"
    ),
    "rank_correlation": number(_AGREEMENT_DIMS, "1", "Spearman's rank correlation"),
    "compared_records": number(_AGREEMENT_DIMS, "1", "number of records compared", kind="i"),
    "logit_records": number(
        _AGREEMENT_DIMS, "1", "number of records with both probabilities within 0 and 1", kind="i"
    ),
    **{
        f"{name}_by_{level}": number(
            [*dims, f"{level}_group"],
            "1",
            f"{long_name} of the records near this {level}",
            attributes=_over_records(f"{level}_group", "mean"),
        )
        for level in ("force", "speed", "temperature")
        for name, dims, long_name in (
            ("simulated_mean", ["film_formula"], "mean simulated probability"),
            ("measured_mean", [], "mean measured share"),
        )
    },
}

_FIT_DIMS = ("fitted_lubricant", "film_formula")
_GAUGE = {
    "origin": COORDINATES["origin"],
    **AT_RECORDS,
    **_AT_RECORDS,
    "comparison_threshold": _EXPERIMENT["comparison_threshold"],
    "pairs": _EXPERIMENT["pairs"],
    "drift": _EXPERIMENT["drift"],
    **limited("gauged_film_thickness", ["record"], "m", "film thickness that explains the record"),
    **limited("gauged_lambda_ratio", ["record"], "1", "lambda ratio that explains the record"),
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
    **{
        f"{kind}_coverage": number(
            ["record"],
            "1",
            "share of realisations, each left out and gauged as the record of one pair, whose "
            f"{words} holds the film",
            content="qualityInformation",
        )
        for kind, words in (
            ("interval", "interval"),
            ("closed", "two-sided interval"),
            ("one_sided", "one-sided interval"),
        )
    },
    "closed_share": number(
        ["record"], "1", "share of realisations whose gauged film has both limits"
    ),
    **{
        f"{fit}_coverage": number(
            _FIT_DIMS,
            "1",
            f"share of realisations, each left out and taken as the records, whose {words} "
            "interval holds the truth",
            content="qualityInformation",
        )
        for fit, words in (("alpha_factor", "factor's"), ("fitted_layer_strength", "strength's"))
    },
    "fitted_records": number(
        ["fitted_lubricant"], "1", "number of records that were fitted", kind="i"
    ),
}

KINDS = {
    "experiment": FileKind(
        _EXPERIMENT,
        "Of each record its conditions, the share of time that its resistance is below a "
        "threshold, the record folded by the revolution, and its first revolution; the "
        "coordinate `origin` says whether the rig was measured or simulated.",
        ("refused", "remarks"),
    ),
    "rig": FileKind(
        _RIG,
        "What a simulated rig logs at those points, and what narrower bands would find.",
    ),
    "comparison": FileKind(
        _COMPARISON,
        "Simulation against experiment at the conditions of each record: how often single pairs of "
        "rollers should lie where it lies, and figures of agreement.",
        ("missing", "remarks", "travel", "longest_wavelength"),
    ),
    "gauge": FileKind(
        _GAUGE,
        "The other way round: the film, the pressure-viscosity coefficient and the boundary "
        "layer that would explain the records.",
    ),
}
