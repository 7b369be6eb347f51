"""What `snakemake benchmark` measures of the study's code; not among the results of a study."""

from lube.schema.variables import FileKind, count, number

_SLIP_RUN = ("least_lambda", "slide_to_roll_ratio")
_SPEED = {
    "points_above": count(["least_lambda"], "1", "number of operating points"),
    "strip_time": number(_SLIP_RUN, "s", "time of one revolution, strip method"),
    "scan_time": number(_SLIP_RUN, "s", "time of one revolution, literal scan"),
    "speedup": number(_SLIP_RUN, "1", "time of the literal scan over that of the strip method"),
    "transform_time": number([], "s", "time of an inverse FFT of the length of a line"),
    "reading_time": number([], "s", "time to read a line from memory"),
    "line_time": number([], "s", "time to draw a line"),
    "grid_time": number(["line_points"], "s", "time of a realisation"),
    "operating_points_time": number(["operating_points"], "s", "time of the contact runs"),
    "ensemble_time": number(["realisations"], "s", "time of an ensemble"),
    "processes": count([], "1", "number of parallel processes"),
    "peak_memory": number([], "byte", "peak memory of a process"),
}

_READING = {
    "record_samples": count([], "1", "samples of the binary file"),
    "record_time": number(["record_reader"], "s", "time to read and evaluate the file"),
    "record_memory": number(["record_reader"], "byte", "peak memory of the process"),
    "table_rows": count([], "1", "rows of the CSV file"),
    "table_time": number(["table_reader"], "s", "time to read the file"),
    "table_memory": number(["table_reader"], "byte", "peak memory of the process"),
    "bare_memory": number([], "byte", "peak memory of a process that reads nothing"),
    "thresholds": count([], "1", "number of thresholds"),
}

_OVER_SPREAD = "over the central 95 % range between pairs"
_BY_LENGTH = ("scenario", "record_turns")
_BY_POINT = (*_BY_LENGTH, "point")
_OF_POINT = ("scenario", "point")
_SHARES = {
    "film_coverage": "share of records whose film interval contains the true value",
    "agreement": "share of records within their prediction interval",
    "alpha_coverage": "share of pairs whose interval of the alpha factor contains the true value",
    "layer_coverage": "share of pairs whose interval of layer strength contains the true value",
    "closed_coverage": "share of two-sided film intervals that contain the true value",
    "one_sided_coverage": "share of one-sided film intervals that contain the true value",
    "closed_share": "share of film intervals that have two limits",
}
_WIDTHS = {
    "film": "median width of the film interval",
    "prediction": "width of the prediction interval",
    "alpha": "median width of the interval of the alpha factor",
    "layer": "median width of the interval of layer strength",
}
_COVERAGE = {
    "pairs": count(["scenario"], "1", "number of held-out pairs of rollers"),
    "ensemble_realisations": count([], "1", "realisations of each ensemble"),
    "least_probability": number([], "1", "lowest mean probability of the points counted"),
    **{name: number(_BY_LENGTH, "1", words) for name, words in _SHARES.items()},
    **{
        f"{name}_width_ratio": number(_BY_LENGTH, "1", f"{words} {_OVER_SPREAD}")
        for name, words in _WIDTHS.items()
    },
    "point_lambda_ratio": number(_OF_POINT, "1", "lambda ratio"),
    "point_probability": number(_OF_POINT, "1", "probability, mean over realisations"),
    "point_film_coverage": number(_BY_POINT, "1", _SHARES["film_coverage"]),
    "point_agreement": number(_BY_POINT, "1", _SHARES["agreement"]),
    **{
        f"ensemble_{name}": number(["ensemble"], "1", f"{_SHARES[name]}, by ensemble")
        for name in ("film_coverage", "agreement", "alpha_coverage", "layer_coverage")
    },
    "ensemble_turns": number([], "1", "revolutions in the records judged by every ensemble"),
    "ensemble_pairs": count([], "1", "number of pairs judged by every ensemble"),
}

KINDS = {
    "coverage": FileKind(
        _COVERAGE,
        "How often the study's intervals contain the true value, for pairs of rollers that are "
        "in no ensemble, and the width of the intervals relative to the spread between pairs.",
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
