"""The dimensions of the datasets, and the coordinates that several kinds of file share."""

from lube.schema.variables import Variable, number, text

OPERATING_DIMS = ("lubricant", "film_formula", "temperature", "speed", "force")
CONTACT_DIMS = ("slide_to_roll_ratio", *OPERATING_DIMS)
LINE_DIMS = ("realisation", "roller")
MASTER_DIMS = ("lambda_ratio", "contact_width")
LAYER_DIMS = ("layer_strength", "layer_lambda_ratio", "layer_contact_width")
EXPERIMENT_DIMS = ("slide_to_roll_ratio", "lubricant", "temperature", "speed", "force")
POINT_DIMS = ("lubricant", "temperature", "speed", "force")

COORDINATES = {
    "lubricant": text(["lubricant"], "lubricant record"),
    "fitted_lubricant": text(["fitted_lubricant"], "lubricant record"),
    "film_formula": text(["film_formula"], "film thickness formula"),
    "viscosity_law": text(["viscosity_law"], "viscosity-temperature law"),
    "temperature": number(["temperature"], "degC", "temperature of rollers and oil"),
    "speed": number(["speed"], "rpm", "rotation speed"),
    "force": number(["force"], "N", "normal force"),
    "slide_to_roll_ratio": number(["slide_to_roll_ratio"], "1", "slide-to-roll ratio"),
    "realisation": number(["realisation"], "1", "realisation of the roughness", kind="i"),
    "roller": number(["roller"], "1", "roller", kind="i"),
    "position": number(["position"], "m", "position along the circumference"),
    "time": number(["time"], "s", "time"),
    "lambda_ratio": number(["lambda_ratio"], "1", "lambda ratio"),
    "contact_width": number(["contact_width"], "m", "contact width"),
    "layer_strength": number(
        ["layer_strength"], "Pa m-1", "strength of the boundary layer, tau0 / h_c"
    ),
    "layer_lambda_ratio": number(["layer_lambda_ratio"], "1", "lambda ratio"),
    "layer_contact_width": number(["layer_contact_width"], "m", "contact width"),
    "fit_temperature": number(["fit_temperature"], "degC", "temperature"),
    "rig_time": number(["rig_time"], "s", "time"),
    "bandwidth": number(["bandwidth"], "Hz", "bandwidth of the amplifier"),
    "threshold": number(["threshold"], "ohm", "threshold of the resistance"),
    "revolutions": number([], "1", "revolutions of the roller with the faster surface", kind="i"),
    "record": text(["record"], "record of the rig"),
    "duration": number(["record"], "s", "duration of the record"),
    "force_group": number(["force_group"], "N", "normal force"),
    "speed_group": number(["speed_group"], "rpm", "rotation speed"),
    "temperature_group": number(["temperature_group"], "degC", "temperature of rollers and oil"),
    "phase": number(["phase"], "1", "phase of the revolution"),
    "origin": text([], "whether the rig's records were measured or simulated"),
    "record_reader": text(["record_reader"], "way to read and evaluate a binary record"),
    "table_reader": text(["table_reader"], "way to read a CSV record"),
    "least_lambda": number(["least_lambda"], "1", "least lambda ratio of the operating points"),
    "line_points": number(["line_points"], "1", "points around the first roller", kind="i"),
    "operating_points": number(["operating_points"], "1", "number of operating points", kind="i"),
    "scenario": text(["scenario"], "rollers, their motion, and where their records come from"),
    "record_turns": number(["record_turns"], "1", "turns in the record"),
    "point": number(["point"], "1", "operating point, by rising lambda ratio", kind="i"),
    "ensemble": number(["ensemble"], "1", "ensemble", kind="i"),
    "realisations": number(["realisations"], "1", "number of realisations", kind="i"),
}
"""Coordinates, by name: the same in every file that has them."""

AT_POINTS = {
    name: Variable(
        ("operating_point",),
        COORDINATES[name].units,
        COORDINATES[name].long_name,
        kind=COORDINATES[name].kind,
    )
    for name in CONTACT_DIMS
}
"""Operating variables of a list of points."""

_CONDITIONS = ("force", "speed", "temperature", "slide_to_roll_ratio", "lubricant")
AT_RECORDS = {
    **{
        name: Variable(
            ("record",),
            COORDINATES[name].units,
            COORDINATES[name].long_name,
            kind=COORDINATES[name].kind,
        )
        for name in _CONDITIONS
    },
    **{
        f"{name}_level": number(
            ["record"], COORDINATES[name].units, f"{COORDINATES[name].long_name} that it is near"
        )
        for name in _CONDITIONS[:3]
    },
    "pair": text(["record"], "pair of rollers"),
    "duration": COORDINATES["duration"],
}
"""Operating conditions of each record, and the levels of the study that they mean."""
