"""What every file of a study contains: names, dimensions, units and meaning.

Stages return unlabelled arithmetic wrapped in xarray; `label` writes the attributes last,
because arithmetic on labelled arrays keeps the wrong ones, and `check` refuses a dataset
that is not what its name promises, before it is saved and after it is read.
"""

from dataclasses import dataclass, field

import numpy as np

from lube.errors import DataError

OPERATING_DIMS = ("lubricant", "film_formula", "temperature", "speed", "force")
CONTACT_DIMS = ("slide_to_roll_ratio", *OPERATING_DIMS)
LINE_DIMS = ("realisation", "roller")
MASTER_DIMS = ("lambda_ratio", "contact_width")
LAYER_DIMS = ("layer_strength", "layer_lambda_ratio", "layer_contact_width")
EXPERIMENT_DIMS = ("slide_to_roll_ratio", "lubricant", "temperature", "speed", "force")
POINT_DIMS = ("lubricant", "temperature", "speed", "force")
COMPARISON_DIMS = ("film_formula", *EXPERIMENT_DIMS)
ORIGINS = ("measured", "simulated")

REGIMES = (
    "isoviscous_rigid",
    "piezoviscous_rigid",
    "isoviscous_elastic",
    "piezoviscous_elastic",
)


@dataclass(frozen=True)
class Variable:
    """One variable or coordinate of a file.

    Attributes
    ----------
    dims : tuple of str
        Its dimensions, in order.
    units : str or None
        Unit in UDUNITS notation, ``"1"`` for a pure number or a flag, None for text.
    long_name : str
        What it is, in words fit for an axis.
    kind : str
        Allowed NumPy kinds: ``f`` float64, ``i`` integer, ``b`` true/false (stored as int8),
        ``U`` text.
    content : str
        What it is by ACDD's and ISO 19115-1's words for ``coverage_content_type``; ``record``
        stands for what the rig's records tell, measured or simulated.
    attributes : dict
        Further CF attributes.
    """

    dims: tuple
    units: str | None
    long_name: str
    kind: str = "f"
    content: str = "modelResult"
    attributes: dict = field(default_factory=dict)


def _number(dims, units, long_name, **more):
    return Variable(tuple(dims), units, long_name, **more)


def _text(dims, long_name):
    return Variable(tuple(dims), None, long_name, kind="U", content="auxiliaryInformation")


def _flag(dims, long_name, meanings, kind="b"):
    """Describe a variable of few whole values, each with its meaning."""
    attributes = {
        "flag_values": np.arange(len(meanings), dtype="int8"),
        "flag_meanings": " ".join(meanings),
    }
    return Variable(tuple(dims), "1", long_name, kind, "qualityInformation", attributes)


def _limited(name, dims, units, long_name, value="", meaning="", **more):
    """Describe a value, whose name may end in `value`, and the limits of its 95 % interval."""
    return {
        name + value: _number(dims, units, long_name + meaning, **more),
        **{
            f"{name}_{side}": _number(
                dims,
                units,
                f"{long_name}, {side} limit of the 95 % interval",
                content="qualityInformation",
            )
            for side in ("lower", "upper")
        },
    }


# What is a mean says over what, by CF's cell methods, which name a coordinate of the variable.
_OVER_RUN = {"cell_methods": "revolutions: mean"}
_OVER_ALL = {"cell_methods": "revolutions: mean (then over the realisations)"}
_OVER_RECORD = {"cell_methods": "duration: mean"}


COORDINATES = {
    "lubricant": _text(["lubricant"], "lubricant record"),
    "film_formula": _text(["film_formula"], "film thickness formula"),
    "viscosity_law": _text(["viscosity_law"], "viscosity-temperature law"),
    "temperature": _number(["temperature"], "degC", "temperature of rollers and oil"),
    "speed": _number(["speed"], "rpm", "rotation speed"),
    "force": _number(["force"], "N", "normal force"),
    "slide_to_roll_ratio": _number(["slide_to_roll_ratio"], "1", "slide-to-roll ratio"),
    "realisation": _number(["realisation"], "1", "realisation of the roughness", kind="i"),
    "roller": _number(["roller"], "1", "roller", kind="i"),
    "position": _number(["position"], "m", "position along the circumference"),
    "time": _number(["time"], "s", "time"),
    "lambda_ratio": _number(["lambda_ratio"], "1", "lambda ratio"),
    "contact_width": _number(["contact_width"], "m", "contact width"),
    "layer_strength": _number(
        ["layer_strength"], "Pa m-1", "strength of the boundary layer, tau0 / h_c"
    ),
    "layer_lambda_ratio": _number(["layer_lambda_ratio"], "1", "lambda ratio"),
    "layer_contact_width": _number(["layer_contact_width"], "m", "contact width"),
    "fit_temperature": _number(["fit_temperature"], "degC", "temperature"),
    "rig_time": _number(["rig_time"], "s", "time"),
    "bandwidth": _number(["bandwidth"], "Hz", "bandwidth of the amplifier"),
    "threshold": _number(["threshold"], "ohm", "threshold of the resistance"),
    "revolutions": _number([], "1", "revolutions of the roller with the faster surface", kind="i"),
    "duration": _number(EXPERIMENT_DIMS, "s", "duration of the record"),
    "origin": _text([], "whether the rig's records were measured or simulated"),
    "record_reader": _text(["record_reader"], "way to read and evaluate a binary record"),
    "table_reader": _text(["table_reader"], "way to read a CSV record"),
    "least_lambda": _number(["least_lambda"], "1", "least lambda ratio of the operating points"),
    "line_points": _number(["line_points"], "1", "points around the first roller", kind="i"),
    "operating_points": _number(["operating_points"], "1", "number of operating points", kind="i"),
    "realisations": _number(["realisations"], "1", "number of realisations", kind="i"),
}

_LUBRICANT = {
    "lubricant_title": _text(["lubricant"], "lubricant"),
    "kinematic_viscosity": _number(["lubricant", "temperature"], "m2 s-1", "kinematic viscosity"),
    "density": _number(["lubricant", "temperature"], "kg m-3", "density"),
    "dynamic_viscosity": _number(["lubricant", "temperature"], "Pa s", "dynamic viscosity"),
    "pressure_viscosity_coefficient": _number(
        ["lubricant", "temperature"], "Pa-1", "pressure-viscosity coefficient"
    ),
    "pressure_viscosity_definition": _text(
        ["lubricant"], "definition of the pressure-viscosity coefficient"
    ),
    "viscosity_law_used": _text(["lubricant"], "law that gives the kinematic viscosity"),
    "viscosity_index": _number(["lubricant"], "1", "viscosity index (ASTM D2270)"),
    "thermal_conductivity": _number(
        ["lubricant", "temperature"], "W m-1 K-1", "thermal conductivity"
    ),
    "temperature_viscosity_coefficient": _number(
        ["lubricant", "temperature"], "K-1", "relative fall of dynamic viscosity with temperature"
    ),
    "law_source": _text(["viscosity_law"], "equation and source of the viscosity law"),
    "parameter": _text(["parameter"], "parameter of the viscosity-temperature laws"),
    "parameter_units": _text(["parameter"], "unit of the parameter"),
    "fit_parameter": _number(
        ["lubricant", "viscosity_law", "parameter"],
        "1",
        "parameter of the viscosity-temperature law",
        attributes={
            "comment": "viscosity in mm2/s and temperature in K within the law; "
            "the unit of each parameter is in parameter_units"
        },
    ),
    "fitted_kinematic_viscosity": _number(
        ["lubricant", "viscosity_law", "fit_temperature"], "m2 s-1", "fitted kinematic viscosity"
    ),
    "data_temperature": _number(
        ["lubricant", "data_point"],
        "degC",
        "temperature of the datum",
        content="referenceInformation",
    ),
    "data_kinematic_viscosity": _number(
        ["lubricant", "data_point"],
        "m2 s-1",
        "kinematic viscosity of the datum",
        content="referenceInformation",
    ),
    "fit_residual": _number(
        ["lubricant", "viscosity_law", "data_point"],
        "1",
        "relative residual, fit over datum less one",
        content="qualityInformation",
    ),
}

_FILM = {
    "reduced_radius": _number([], "m", "reduced radius R*"),
    "reduced_modulus": _number([], "Pa", "reduced modulus E*"),
    "composite_rms_roughness": _number([], "m", "composite rms roughness"),
    "film_thickness": _number(OPERATING_DIMS, "m", "film thickness"),
    "lambda_ratio": _number(OPERATING_DIMS, "1", "lambda ratio"),
    "contact_half_width": _number(["force"], "m", "contact half-width"),
    "hertz_pressure": _number(["force"], "Pa", "maximum Hertzian pressure"),
    "entrainment_speed": _number(["speed"], "m s-1", "entrainment speed"),
    "moes_load": _number(["lubricant", "temperature", "speed", "force"], "1", "Moes load number M"),
    "moes_material": _number(["lubricant", "temperature", "speed"], "1", "Moes material number L"),
    "regime": _flag(
        ["lubricant", "temperature", "speed", "force"], "regime of lubrication", REGIMES, kind="i"
    ),
    "in_validity_range": _flag(
        OPERATING_DIMS,
        "whether the film formula is within its range of validity",
        ("outside", "inside"),
    ),
    "inlet_shear_heating_factor": _number(
        ["lubricant", "temperature", "speed"],
        "1",
        "film reduction by inlet shear heating, not applied",
    ),
    "formula_place": _text(["film_formula"], "where in the contact the formula gives the film"),
    "formula_source": _text(["film_formula"], "source of the film thickness formula"),
}

_ROUGHNESS = {
    "height": _number([*LINE_DIMS, "position"], "m", "height of the line towards the other roller"),
    "seed": _number(["realisation"], "1", "study seed the realisation was drawn with", kind="i"),
    "rms_height": _number(LINE_DIMS, "m", "realised rms height"),
    "rms_slope": _number(LINE_DIMS, "1", "realised rms slope"),
    "rms_curvature": _number(LINE_DIMS, "m-1", "realised rms curvature"),
    "skewness": _number(LINE_DIMS, "1", "realised skewness of heights"),
    "kurtosis": _number(LINE_DIMS, "1", "realised kurtosis of heights"),
    "spectrum_rms_height": _number(["roller"], "m", "rms height of the spectrum"),
    "spectrum_rms_slope": _number(["roller"], "1", "rms slope of the spectrum"),
    "spectrum_rms_curvature": _number(["roller"], "m-1", "rms curvature of the spectrum"),
}

_ROUGHNESS_BATCH = {
    "height": _number([*LINE_DIMS, "position"], "m", "height of the line", kind="i"),
}


def _run_mean(dims, units, long_name):
    return _number(dims, units, long_name, attributes=_OVER_RUN)


_RUN_DIMS = ("realisation", *CONTACT_DIMS)
_PROBABILITIES = {
    "breakthrough_probability": "probability of boundary layer breakthrough",
    "geometric_contact_probability": "probability of geometric contact",
}

_LAYER = {
    "critical_thickness": _number([], "m", "critical thickness of the boundary layer"),
    "shear_strength": _number([], "Pa", "limiting shear stress of the boundary layer"),
}

_CONTACT_RUN = {
    "revolutions": COORDINATES["revolutions"],
    **_LAYER,
    **{name: _run_mean(_RUN_DIMS, "1", long_name) for name, long_name in _PROBABILITIES.items()},
    "mean_contact_length": _run_mean(_RUN_DIMS, "m", "mean contact length"),
    "mean_contact_force": _run_mean(_RUN_DIMS, "N", "mean contact force"),
}


def _intervals(dims):
    limited = (
        _limited(
            name,
            dims,
            "1",
            long_name,
            "_mean",
            ", mean over realisations",
            attributes=_OVER_ALL,
        )
        for name, long_name in _PROBABILITIES.items()
    )
    return {name: variable for each in limited for name, variable in each.items()}


_MASTER_RUN = {
    "revolutions": COORDINATES["revolutions"],
    **{
        name: _run_mean(("realisation", *MASTER_DIMS), "1", long_name)
        for name, long_name in _PROBABILITIES.items()
    },
    "layer_breakthrough_probability": _run_mean(
        ("realisation", *LAYER_DIMS), "1", "probability of breakthrough of weak and strong layers"
    ),
}

_AT_POINTS = {
    name: Variable(
        ("operating_point",),
        COORDINATES[name].units,
        COORDINATES[name].long_name,
        kind=COORDINATES[name].kind,
    )
    for name in CONTACT_DIMS
}

_TRACE = {
    **_LAYER,
    "reduced_modulus": _number([], "Pa", "reduced modulus E*"),
    "resistivity": _number([], "ohm m", "resistivity of the rollers' material"),
    "contact_length": _number(["operating_point", "time"], "m", "contact length"),
    "contact_resistance": _number(["operating_point", "time"], "ohm", "contact resistance"),
    **_AT_POINTS,
    "film_thickness": _number(["operating_point"], "m", "film thickness"),
    "contact_half_width": _number(["operating_point"], "m", "contact half-width"),
    "entrainment_speed": _number(["operating_point"], "m s-1", "entrainment speed"),
}

_SHARE_DIMS = (*EXPERIMENT_DIMS, "threshold")
_EXPERIMENT = {
    "origin": COORDINATES["origin"],
    **_limited(
        "contact_share",
        _SHARE_DIMS,
        "1",
        "share of time with resistance below the threshold",
        content="record",
        attributes=_OVER_RECORD,
    ),
    "true_contact_share": _number(
        EXPERIMENT_DIMS,
        "1",
        "share of time with metal contact in the simulated rig",
        attributes=_OVER_RECORD,
    ),
    "comparison_threshold": _number([], "ohm", "threshold that is compared with the simulation"),
    **_limited(
        "revolution_share",
        [*EXPERIMENT_DIMS, "revolution"],
        "1",
        "share of time below the compared threshold, one revolution alone",
        content="record",
        attributes={"cell_methods": "revolution: mean"},
    ),
    "record": _text(EXPERIMENT_DIMS, "record of the rig"),
    "duration": COORDINATES["duration"],
    "sampling_interval": _number(EXPERIMENT_DIMS, "s", "time between samples"),
}

_RIG = {
    "origin": COORDINATES["origin"],
    "revolutions": COORDINATES["revolutions"],
    **{name: _AT_POINTS[name] for name in EXPERIMENT_DIMS},
    "voltage": _number(["operating_point", "rig_time"], "V", "voltage that the rig logs"),
    "resistance": _number(["operating_point", "rig_time"], "ohm", "resistance between the rollers"),
    "contact_share": _run_mean(
        ["operating_point", "bandwidth", "threshold"],
        "1",
        "share of time with resistance below the threshold",
    ),
    "true_contact_share": _run_mean(["operating_point"], "1", "share of time with metal contact"),
    "rig_bandwidth": _number([], "Hz", "bandwidth of the study's rig"),
    "rig_sampling_rate": _number([], "s-1", "sampling rate"),
    "rig_bias_voltage": _number([], "V", "bias voltage"),
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
    **_limited(
        "simulated_probability",
        COMPARISON_DIMS,
        "1",
        "simulated breakthrough probability",
        attributes=_OVER_ALL,
    ),
    **_limited(
        "measured_share",
        EXPERIMENT_DIMS,
        "1",
        "share of time below the threshold",
        content="record",
        attributes=_OVER_RECORD,
    ),
    "intervals_overlap": _flag(
        COMPARISON_DIMS,
        "whether the intervals of simulation and record overlap",
        ("apart", "overlapping"),
    ),
    "bias": _number(
        _AGREEMENT_DIMS,
        "1",
        "mean of simulated probability less measured share",
        attributes=_over_points("film_formula", "mean"),
    ),
    "rms_difference": _number(
        _AGREEMENT_DIMS,
        "1",
        "rms difference of the probabilities",
        attributes=_over_points("film_formula", "root_mean_square"),
    ),
    "logit_rms_difference": _number(
        _AGREEMENT_DIMS,
        "1",
        "rms difference of the logits",
        attributes=_over_points("film_formula", "root_mean_square"),
    ),
    "rank_correlation": _number(_AGREEMENT_DIMS, "1", "Spearman's rank correlation"),
    "overlap_share": _number(
        _AGREEMENT_DIMS, "1", "share of the points with two intervals whose intervals overlap"
    ),
    "compared_points": _number(_AGREEMENT_DIMS, "1", "number of points compared", kind="i"),
    "logit_points": _number(
        _AGREEMENT_DIMS, "1", "number of points with both probabilities within 0 and 1", kind="i"
    ),
    **{
        f"{name}_by_{level}": _number(
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
    **_limited("gauged_film_thickness", POINT_DIMS, "m", "film thickness that explains the record"),
    **_limited("gauged_lambda_ratio", POINT_DIMS, "1", "lambda ratio that explains the record"),
    "film_thickness": _FILM["film_thickness"],
    "lambda_ratio": _FILM["lambda_ratio"],
    **_limited(
        "alpha_factor",
        _FIT_DIMS,
        "1",
        "factor of the pressure-viscosity coefficient that explains the records",
    ),
    **_limited(
        "fitted_layer_strength",
        _FIT_DIMS,
        "Pa m-1",
        "strength tau0 / h_c of the boundary layer that explains the records",
    ),
    "study_layer_strength": _number([], "Pa m-1", "strength tau0 / h_c of the study's layer"),
    "interval_coverage": _number(
        POINT_DIMS,
        "1",
        "share of revolutions, each gauged as a record of its own, whose interval holds the film",
    ),
    "fitted_points": _number(
        ["lubricant"], "1", "number of points with a record in pure rolling", kind="i"
    ),
}

_SLIP_RUN = ("least_lambda", "slide_to_roll_ratio")
_SPEED = {
    "points_above": _number(["least_lambda"], "1", "number of operating points", kind="i"),
    "strip_time": _number(_SLIP_RUN, "s", "time of one revolution, strip by strip"),
    "scan_time": _number(_SLIP_RUN, "s", "time of one revolution, literal scan"),
    "speedup": _number(_SLIP_RUN, "1", "time of the literal scan over that of the strips"),
    "transform_time": _number([], "s", "time of a bare inverse FFT as long as a line"),
    "reading_time": _number([], "s", "time to read a line from memory"),
    "line_time": _number([], "s", "time to draw a line"),
    "grid_time": _number(["line_points"], "s", "time of a realisation"),
    "operating_points_time": _number(["operating_points"], "s", "time of the contact runs"),
    "ensemble_time": _number(["realisations"], "s", "time of an ensemble"),
    "processes": _number([], "1", "processes side by side", kind="i"),
    "peak_memory": _number([], "byte", "peak memory of a process"),
}

_READING = {
    "record_samples": _number([], "1", "samples of the binary record", kind="i"),
    "record_time": _number(["record_reader"], "s", "time to read and evaluate the record"),
    "record_memory": _number(["record_reader"], "byte", "peak memory of the process"),
    "table_rows": _number([], "1", "rows of the CSV record", kind="i"),
    "table_time": _number(["table_reader"], "s", "time to read the record"),
    "table_memory": _number(["table_reader"], "byte", "peak memory of the process"),
    "bare_memory": _number([], "byte", "peak memory of a process that reads nothing"),
    "thresholds": _number([], "1", "number of thresholds", kind="i"),
}

FILES = {
    "lubricant": _LUBRICANT,
    "film": _FILM,
    "roughness": _ROUGHNESS,
    "roughness_batch": _ROUGHNESS_BATCH,
    "contact_batch": _CONTACT_RUN,
    "contact": {**_CONTACT_RUN, **_intervals(CONTACT_DIMS)},
    "master_batch": _MASTER_RUN,
    "master": {**_MASTER_RUN, **_intervals(MASTER_DIMS)},
    "trace": _TRACE,
    "experiment": _EXPERIMENT,
    "rig": _RIG,
    "comparison": _COMPARISON,
    "gauge": _GAUGE,
    "speed": _SPEED,
    "reading": _READING,
}
"""Variables of each kind of file, by the kind's name."""

SUMMARIES = {
    "lubricant": "Viscosity, density and pressure-viscosity coefficient of each lubricant at each "
    "temperature; the fitted viscosity laws and their residuals.",
    "film": "Film thickness, lambda ratio, Hertz contact, Moes numbers, regime and validity, for "
    "every film formula.",
    "roughness": "The kept roughness lines, with their moments beside those of the spectrum.",
    "contact": "The answer: probabilities, contact length and contact force of every realisation, "
    "and means with intervals.",
    "master": "The same probabilities over lambda ratio and contact width, whatever is behind "
    "them: the master curve; and, coarser, for weaker and stronger layers.",
    "trace": "Contact length and resistance at every time step of one revolution, at the points "
    "the study names.",
    "experiment": "Share of time that the rig's resistance is below a threshold, for several "
    "thresholds, with intervals; its coordinate `origin` says whether the rig was measured or "
    "simulated.",
    "rig": "What a simulated rig logs at those points, and what narrower bands would find.",
    "comparison": "Simulation against experiment, point by point, and figures of their agreement.",
    "gauge": "The other way round: the film, the pressure-viscosity coefficient and the boundary "
    "layer that would explain the records.",
    "speed": "Measured times of the study's kernels, each beside a plain version of the same work.",
    "reading": "Measured times of reading long records, beside other readers of the same files.",
}
"""What is in each kind of file, in a sentence."""

MEASURED = ("speed", "reading")
"""Files of measured clock times, by `snakemake benchmark`; they are no part of the results."""

_LINE_ATTRIBUTES = ("q_min", "q_max", "spacing", "points", "height_step")
_RUN_ATTRIBUTES = ("travel", "longest_wavelength")
ATTRIBUTES = {
    "roughness": _LINE_ATTRIBUTES,
    "roughness_batch": _LINE_ATTRIBUTES,
    "contact_batch": _RUN_ATTRIBUTES,
    "contact": _RUN_ATTRIBUTES,
    "master_batch": _RUN_ATTRIBUTES,
    "master": _RUN_ATTRIBUTES,
    "experiment": ("refused",),
    "comparison": ("missing",),
    "gauge": ("missing",),
}
"""Global attributes that the stages read from a file, by kind."""


def _expected(kind, name):
    return FILES[kind].get(name) or COORDINATES.get(name)


def label(dataset, kind):
    """Write units, long names and flags on a dataset, replacing what arithmetic left there.

    Parameters
    ----------
    dataset : xarray.Dataset
        Result of a stage.
    kind : str
        A key of `FILES`.

    Returns
    -------
    xarray.Dataset
        The same data with the attributes of the schema.

    Raises
    ------
    DataError
        If the dataset does not fit the schema.
    """
    labelled = dataset.copy()
    for name in labelled.variables:
        expected = _expected(kind, name)
        if expected is None:
            continue  # to be refused below, by name
        attributes = {"long_name": expected.long_name, **expected.attributes}
        if expected.units is not None:
            attributes["units"] = expected.units
        attributes["coverage_content_type"] = _content(name, expected, labelled)
        labelled[name].attrs = attributes
    return check(labelled, kind)


def _content(name, expected, dataset):
    """ACDD's word for what a variable holds."""
    if name in COORDINATES:
        return "coordinate"
    if expected.content == "record":
        measured = dataset["origin"].item() == "measured"
        return "physicalMeasurement" if measured else "modelResult"
    return expected.content


def check(dataset, kind, where="dataset"):
    """Refuse a dataset whose variables, dimensions, types or units are not the schema's.

    Parameters
    ----------
    dataset : xarray.Dataset
        Dataset to check.
    kind : str
        A key of `FILES`.
    where : str, optional
        What to call the dataset in an error, for instance its path.

    Returns
    -------
    xarray.Dataset
        `dataset` itself.

    Raises
    ------
    DataError
        At the first departure, naming the variable, what it is and what it should be.
    """
    for name in dataset.variables:
        if _expected(kind, name) is None:
            raise DataError(f"{where}: not a {kind} file: variable {name!r} does not belong there")
    for name, expected in FILES[kind].items():
        if name not in dataset.variables:
            raise DataError(f"{where}: not a {kind} file: variable {name!r} is missing")
        _check_variable(dataset[name], name, expected, where)
    for name in dataset.dims:
        if name in COORDINATES and (name in dataset.coords or name != "position"):
            _check_coordinate(dataset, name, where)
    for name in ATTRIBUTES.get(kind, ()):
        if name not in dataset.attrs:
            raise DataError(f"{where}: not a {kind} file: attribute {name!r} is missing")
    return dataset


def _check_coordinate(dataset, name, where):
    if name not in dataset.coords:
        raise DataError(f"{where}: coordinate {name!r} is missing")
    _check_variable(dataset[name], name, COORDINATES[name], where)
    if not dataset.indexes[name].is_unique:
        raise DataError(f"{where}: coordinate {name!r} repeats a value")


def _check_variable(array, name, expected, where):
    if array.dims != expected.dims:
        raise DataError(f"{where}: {name!r} has dimensions {array.dims}, need {expected.dims}")
    kind = {"O": "U", "T": "U", "u": "i"}.get(array.dtype.kind, array.dtype.kind)
    wanted = "i" if expected.kind == "b" and kind == "i" else expected.kind
    if kind != wanted:
        raise DataError(f"{where}: {name!r} holds {array.dtype}, need kind {expected.kind!r}")
    if array.attrs.get("units") != expected.units:
        raise DataError(
            f"{where}: {name!r} is in {array.attrs.get('units')!r}, need {expected.units!r}"
        )
