"""What `snakemake benchmark` measures of the study's code; it is no part of the results."""

from lube.schema.variables import FileKind, number

_SLIP_RUN = ("least_lambda", "slide_to_roll_ratio")
_SPEED = {
    "points_above": number(["least_lambda"], "1", "number of operating points", kind="i"),
    "strip_time": number(_SLIP_RUN, "s", "time of one revolution, strip by strip"),
    "scan_time": number(_SLIP_RUN, "s", "time of one revolution, literal scan"),
    "speedup": number(_SLIP_RUN, "1", "time of the literal scan over that of the strips"),
    "transform_time": number([], "s", "time of a bare inverse FFT as long as a line"),
    "reading_time": number([], "s", "time to read a line from memory"),
    "line_time": number([], "s", "time to draw a line"),
    "grid_time": number(["line_points"], "s", "time of a realisation"),
    "operating_points_time": number(["operating_points"], "s", "time of the contact runs"),
    "ensemble_time": number(["realisations"], "s", "time of an ensemble"),
    "processes": number([], "1", "processes side by side", kind="i"),
    "peak_memory": number([], "byte", "peak memory of a process"),
}

_READING = {
    "record_samples": number([], "1", "samples of the binary record", kind="i"),
    "record_time": number(["record_reader"], "s", "time to read and evaluate the record"),
    "record_memory": number(["record_reader"], "byte", "peak memory of the process"),
    "table_rows": number([], "1", "rows of the CSV record", kind="i"),
    "table_time": number(["table_reader"], "s", "time to read the record"),
    "table_memory": number(["table_reader"], "byte", "peak memory of the process"),
    "bare_memory": number([], "byte", "peak memory of a process that reads nothing"),
    "thresholds": number([], "1", "number of thresholds", kind="i"),
}

_BY_LENGTH = ("scenario", "record_turns")
_BY_POINT = (*_BY_LENGTH, "point")
_OF_PAIRS = "over the central 95 % spread between pairs"


def _covered(dims, whose):
    """Describe how often an interval is right."""
    return number(dims, "1", f"share of {whose} interval holds the truth")


_COVERAGE = {
    "pairs": number(["scenario"], "1", "held-out pairs of rollers", kind="i"),
    "ensemble_realisations": number([], "1", "realisations of each ensemble", kind="i"),
    "least_probability": number([], "1", "probability above which records are counted"),
    "film_coverage": _covered(_BY_LENGTH, "records whose film's"),
    "closed_coverage": _covered(_BY_LENGTH, "all records with two limits whose film's"),
    "one_sided_coverage": _covered(_BY_LENGTH, "all records with one limit whose film's"),
    "closed_share": number(_BY_LENGTH, "1", "share of all records whose film has two limits"),
    "film_width_ratio": number(
        _BY_LENGTH, "1", f"median width of the film's interval {_OF_PAIRS}, median of the points"
    ),
    "agreement": number(_BY_LENGTH, "1", "share of records within their prediction interval"),
    "prediction_width_ratio": number(
        _BY_LENGTH, "1", f"width of the prediction interval {_OF_PAIRS}, median of the points"
    ),
    **{
        name: row
        for fit, words in (("alpha", "factor of alpha"), ("layer", "strength of the layer"))
        for name, row in (
            (f"{fit}_coverage", _covered(_BY_LENGTH, f"pairs whose {words}'s")),
            (
                f"{fit}_width_ratio",
                number(_BY_LENGTH, "1", f"median width of the {words}'s interval {_OF_PAIRS}"),
            ),
        )
    },
    "point_lambda_ratio": number(["scenario", "point"], "1", "lambda ratio"),
    "point_probability": number(["scenario", "point"], "1", "probability, mean over realisations"),
    "point_film_coverage": _covered(_BY_POINT, "pairs whose film's"),
    "point_agreement": number(_BY_POINT, "1", "share of pairs within the prediction interval"),
    **{
        f"ensemble_{name}": number(["ensemble"], "1", f"{words}, by each ensemble")
        for name, words in (
            ("film_coverage", "share of records whose film's interval holds the truth"),
            ("agreement", "share of records within their prediction interval"),
            ("alpha_coverage", "share of pairs whose factor of alpha's interval holds the truth"),
            ("layer_coverage", "share of pairs whose layer's interval holds the truth"),
        )
    },
    "ensemble_turns": number([], "1", "turns of the records that several ensembles judge"),
    "ensemble_pairs": number([], "1", "pairs that several ensembles judge", kind="i"),
}

KINDS = {
    "coverage": FileKind(
        _COVERAGE,
        "How often the study's intervals hold the truth, for pairs of rollers that no ensemble "
        "has seen, and how wide they are beside the spread between pairs.",
    ),
    "speed": FileKind(
        _SPEED,
        "Measured times of the study's kernels, each beside a plain version of the same work.",
    ),
    "reading": FileKind(
        _READING,
        "Measured times of reading long records, beside other readers of the same files.",
    ),
}
