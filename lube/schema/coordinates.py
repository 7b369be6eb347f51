"""The dimensions of the datasets, and the coordinates that several kinds of file share."""

from dataclasses import replace

from lube.schema.variables import count, number, text

OPERATING_DIMS = ("lubricant", "film_formula", "temperature", "speed", "force")
CONTACT_DIMS = ("slide_to_roll_ratio", *OPERATING_DIMS)
LINE_DIMS = ("realisation", "roller")
MASTER_DIMS = ("lambda_ratio", "contact_width")
LAYER_DIMS = ("layer_strength", "layer_lambda_ratio", "layer_contact_width")
EXPERIMENT_DIMS = ("slide_to_roll_ratio", "lubricant", "temperature", "speed", "force")
POINT_DIMS = ("lubricant", "temperature", "speed", "force")

_TEMPERATURE = "temperature of rollers and oil"
_NUMBERS = {
    "temperature": ("degC", _TEMPERATURE),
    "speed": ("rpm", "rotation speed"),
    "force": ("N", "normal force"),
    "slide_to_roll_ratio": ("1", "slide-to-roll ratio"),
    "position": ("m", "position along the circumference"),
    "time": ("s", "time"),
    "lambda_ratio": ("1", "lambda ratio"),
    "contact_width": ("m", "contact width"),
    "layer_strength": ("Pa m-1", "strength of the boundary layer, tau0 / h_c"),
    "layer_lambda_ratio": ("1", "lambda ratio"),
    "layer_contact_width": ("m", "contact width"),
    "fit_temperature": ("degC", "temperature"),
    "rig_time": ("s", "time"),
    "bandwidth": ("Hz", "bandwidth of the amplifier"),
    "threshold": ("ohm", "threshold of the resistance"),
    "force_group": ("N", "normal force"),
    "speed_group": ("rpm", "rotation speed"),
    "temperature_group": ("degC", _TEMPERATURE),
    "phase": ("1", "phase of the revolution"),
    "least_lambda": ("1", "lowest lambda ratio of the operating points"),
    "record_turns": ("1", "revolutions in the record"),
}
_COUNTS = {
    "realisation": "realisation of the roughness",
    "roller": "roller",
    "line_points": "points around the first roller",
    "operating_points": "number of operating points",
    "point": "operating point, by increasing lambda ratio",
    "ensemble": "ensemble",
    "realisations": "number of realisations",
}
_TEXTS = {
    "lubricant": "name of the lubricant record",
    "fitted_lubricant": "name of the lubricant record",
    "film_formula": "film thickness formula",
    "viscosity_law": "viscosity-temperature law",
    "record": "record",
    "record_reader": "method of reading and evaluating a binary file",
    "table_reader": "method of reading a CSV file",
    "scenario": "rollers, slip and source of the records",
}

COORDINATES = {
    **{name: number([name], units, words) for name, (units, words) in _NUMBERS.items()},
    **{name: count([name], "1", words) for name, words in _COUNTS.items()},
    **{name: text([name], words) for name, words in _TEXTS.items()},
    "revolutions": count([], "1", "revolutions of the roller with the faster surface"),
    "duration": number(["record"], "s", "duration of the record"),
    "origin": text([], "whether the records were measured or simulated"),
}
"""Coordinates, by name: the same in every file that has them."""


AT_POINTS = {name: replace(COORDINATES[name], dims=("operating_point",)) for name in CONTACT_DIMS}
"""Operating variables of a list of points."""

_LEVELS = ("force", "speed", "temperature")
AT_RECORDS = {
    **{
        name: replace(COORDINATES[name], dims=("record",))
        for name in (*_LEVELS, "slide_to_roll_ratio", "lubricant")
    },
    **{
        f"{name}_level": replace(
            COORDINATES[name],
            dims=("record",),
            long_name=f"{COORDINATES[name].long_name}, nearest level of the study",
        )
        for name in _LEVELS
    },
    "pair": text(["record"], "pair of rollers"),
    "duration": COORDINATES["duration"],
}
"""Measured conditions of each record, and the study's levels assigned to it."""
