"""The lubricant and film tables."""

from lube.schema.coordinates import OPERATING_DIMS
from lube.schema.variables import FileKind, flag, number, text

REGIMES = (
    "isoviscous_rigid",
    "piezoviscous_rigid",
    "isoviscous_elastic",
    "piezoviscous_elastic",
)
"""Regimes of lubrication, in the order of their flags."""

_LUBRICANT = {
    "lubricant_title": text(["lubricant"], "lubricant"),
    "kinematic_viscosity": number(["lubricant", "temperature"], "m2 s-1", "kinematic viscosity"),
    "density": number(["lubricant", "temperature"], "kg m-3", "density"),
    "dynamic_viscosity": number(["lubricant", "temperature"], "Pa s", "dynamic viscosity"),
    "pressure_viscosity_coefficient": number(
        ["lubricant", "temperature"], "Pa-1", "pressure-viscosity coefficient"
    ),
    "pressure_viscosity_definition": text(
        ["lubricant"], "definition of the pressure-viscosity coefficient"
    ),
    "viscosity_law_used": text(["lubricant"], "law that gives the kinematic viscosity"),
    "viscosity_index": number(["lubricant"], "1", "viscosity index (ASTM D2270)"),
    "thermal_conductivity": number(
        ["lubricant", "temperature"], "W m-1 K-1", "thermal conductivity"
    ),
    "temperature_viscosity_coefficient": number(
        ["lubricant", "temperature"], "K-1", "relative fall of dynamic viscosity with temperature"
    ),
    "law_source": text(["viscosity_law"], "equation and source of the viscosity law"),
    "parameter": text(["parameter"], "parameter of the viscosity-temperature laws"),
    "parameter_units": text(["parameter"], "unit of the parameter"),
    "fit_parameter": number(
        ["lubricant", "viscosity_law", "parameter"],
        "1",
        "parameter of the viscosity-temperature law",
        attributes={
            "comment": "viscosity in mm2/s and temperature in K within the law; "
            "the unit of each parameter is in parameter_units"
        },
    ),
    "fitted_kinematic_viscosity": number(
        ["lubricant", "viscosity_law", "fit_temperature"], "m2 s-1", "fitted kinematic viscosity"
    ),
    "data_temperature": number(
        ["lubricant", "data_point"],
        "degC",
        "temperature of the datum",
        content="referenceInformation",
    ),
    "data_kinematic_viscosity": number(
        ["lubricant", "data_point"],
        "m2 s-1",
        "kinematic viscosity of the datum",
        content="referenceInformation",
    ),
    "fit_residual": number(
        ["lubricant", "viscosity_law", "data_point"],
        "1",
        "relative residual, fit over datum less one",
        content="qualityInformation",
    ),
}

_FILM = {
    "reduced_radius": number([], "m", "reduced radius R*"),
    "reduced_modulus": number([], "Pa", "reduced modulus E*"),
    "composite_rms_roughness": number([], "m", "composite rms roughness"),
    "film_thickness": number(OPERATING_DIMS, "m", "film thickness"),
    "lambda_ratio": number(OPERATING_DIMS, "1", "lambda ratio"),
    "contact_half_width": number(["force"], "m", "contact half-width"),
    "hertz_pressure": number(["force"], "Pa", "maximum Hertzian pressure"),
    "entrainment_speed": number(["speed"], "m s-1", "entrainment speed"),
    "moes_load": number(["lubricant", "temperature", "speed", "force"], "1", "Moes load number M"),
    "moes_material": number(["lubricant", "temperature", "speed"], "1", "Moes material number L"),
    "regime": flag(
        ["lubricant", "temperature", "speed", "force"], "regime of lubrication", REGIMES, kind="i"
    ),
    "in_validity_range": flag(
        OPERATING_DIMS,
        "whether the film formula is within its range of validity",
        ("outside", "inside"),
    ),
    "inlet_shear_heating_factor": number(
        ["lubricant", "temperature", "speed"],
        "1",
        "film reduction by inlet shear heating, not applied",
    ),
    "formula_place": text(["film_formula"], "where in the contact the formula gives the film"),
    "formula_source": text(["film_formula"], "source of the film thickness formula"),
}

KINDS = {
    "lubricant": FileKind(
        _LUBRICANT,
        "Viscosity, density and pressure-viscosity coefficient of each lubricant at each "
        "temperature; the fitted viscosity laws and their residuals.",
    ),
    "film": FileKind(
        _FILM,
        "Film thickness, lambda ratio, Hertz contact, Moes numbers, regime and validity, for "
        "every film formula.",
    ),
}
