"""The lubricant and film tables."""

from lube.schema.coordinates import OPERATING_DIMS, POINT_DIMS
from lube.schema.variables import FileKind, flag, number, quality, text

REGIMES = (
    "isoviscous_rigid",
    "piezoviscous_rigid",
    "isoviscous_elastic",
    "piezoviscous_elastic",
)
"""Regimes of lubrication, in the order of their flags."""

_OIL = ("lubricant",)
_OIL_TEMPERATURE = ("lubricant", "temperature")
_DATA = ("lubricant", "data_point")
_FITS = ("lubricant", "viscosity_law")
_PROPERTIES = {
    "kinematic_viscosity": ("m2 s-1", "kinematic viscosity"),
    "density": ("kg m-3", "density"),
    "dynamic_viscosity": ("Pa s", "dynamic viscosity"),
    "pressure_viscosity_coefficient": ("Pa-1", "pressure-viscosity coefficient"),
    "thermal_conductivity": ("W m-1 K-1", "thermal conductivity"),
    "temperature_viscosity_coefficient": (
        "K-1",
        "relative decrease of dynamic viscosity with temperature",
    ),
}
_REFERENCE = "referenceInformation"

_LUBRICANT = {
    "lubricant_title": text(_OIL, "lubricant"),
    **{name: number(_OIL_TEMPERATURE, *units_words) for name, units_words in _PROPERTIES.items()},
    "pressure_viscosity_definition": text(_OIL, "definition of the pressure-viscosity coefficient"),
    "viscosity_law_used": text(_OIL, "law used for the kinematic viscosity"),
    "viscosity_index": number(_OIL, "1", "viscosity index (ASTM D2270)"),
    "law_source": text(["viscosity_law"], "equation and source of the viscosity law"),
    "parameter": text(["parameter"], "parameter of the viscosity-temperature laws"),
    "parameter_units": text(["parameter"], "unit of the parameter"),
    "fit_parameter": number(
        (*_FITS, "parameter"),
        "1",
        "parameter of the viscosity-temperature law",
        comment="the laws take viscosity in mm2/s and temperature in K; "
        "the unit of each parameter is in parameter_units",
    ),
    "fitted_kinematic_viscosity": number(
        (*_FITS, "fit_temperature"), "m2 s-1", "fitted kinematic viscosity"
    ),
    "data_temperature": number(_DATA, "degC", "temperature of the datum", content=_REFERENCE),
    "data_kinematic_viscosity": number(
        _DATA, "m2 s-1", "kinematic viscosity of the datum", content=_REFERENCE
    ),
    "fit_residual": quality(
        (*_FITS, "data_point"), "1", "relative residual, fitted value over datum minus one"
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
    "moes_load": number(POINT_DIMS, "1", "Moes load number M"),
    "moes_material": number(POINT_DIMS[:-1], "1", "Moes material number L"),
    "regime": flag(POINT_DIMS, "regime of lubrication", REGIMES, kind="i"),
    "in_validity_range": flag(
        OPERATING_DIMS,
        "whether the film formula is within its range of validity",
        ("outside", "inside"),
    ),
    "inlet_shear_heating_factor": number(
        POINT_DIMS[:-1], "1", "film reduction by inlet shear heating, not applied"
    ),
    "formula_place": text(["film_formula"], "location in the contact that the formula refers to"),
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
