"""Measured clock times, by `snakemake benchmark`; they are no part of the results."""

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

KINDS = {
    "speed": FileKind(
        _SPEED,
        "Measured times of the study's kernels, each beside a plain version of the same work.",
    ),
    "reading": FileKind(
        _READING,
        "Measured times of reading long records, beside other readers of the same files.",
    ),
}
