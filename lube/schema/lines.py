"""The roughness lines and the results of the contact model: runs, master map and traces."""

from lube.schema.coordinates import (
    AT_POINTS,
    CONTACT_DIMS,
    COORDINATES,
    LAYER_DIMS,
    LINE_DIMS,
    MASTER_DIMS,
)
from lube.schema.variables import (
    MEAN_OF_RUN,
    THEN_REALISATIONS,
    FileKind,
    count,
    number,
    run_mean,
    sides,
)

_HEIGHT_DIMS = (*LINE_DIMS, "position")
_ROUGHNESS = {
    "height": number(_HEIGHT_DIMS, "m", "height of the line, positive towards the other roller"),
    "seed": count(["realisation"], "1", "seed of the study that the line was drawn with"),
    "rms_height": number(LINE_DIMS, "m", "realised rms height"),
    "rms_slope": number(LINE_DIMS, "1", "realised rms slope"),
    "rms_curvature": number(LINE_DIMS, "m-1", "realised rms curvature"),
    "skewness": number(LINE_DIMS, "1", "realised skewness of heights"),
    "kurtosis": number(LINE_DIMS, "1", "realised kurtosis of heights"),
    "spectrum_rms_height": number(["roller"], "m", "rms height of the spectrum"),
    "spectrum_rms_slope": number(["roller"], "1", "rms slope of the spectrum"),
    "spectrum_rms_curvature": number(["roller"], "m-1", "rms curvature of the spectrum"),
}
_ROUGHNESS_BATCH = {"height": count(_HEIGHT_DIMS, "m", "height of the line")}

_PROBABILITIES = {
    "breakthrough_probability": "probability of boundary layer breakthrough",
    "geometric_contact_probability": "probability of geometric contact",
}


def _of_realisations(dims):
    """Describe the probabilities of each realisation."""
    return {
        name: run_mean(("realisation", *dims), "1", words) for name, words in _PROBABILITIES.items()
    }


def _over_realisations(dims):
    """Describe the mean of each probability over the realisations, and its limits."""
    described = {}
    for name, words in _PROBABILITIES.items():
        mean = f"{words}, mean over realisations"
        methods = f"{MEAN_OF_RUN} {THEN_REALISATIONS}"
        described[f"{name}_mean"] = number(dims, "1", mean, cell_methods=methods)
        described |= sides(dims, "1", words, name)
    return described


_LAYER = {
    "critical_thickness": number([], "m", "critical thickness of the boundary layer"),
    "shear_strength": number([], "Pa", "limiting shear stress of the boundary layer"),
}

_RUN_DIMS = ("realisation", *CONTACT_DIMS)
_CONTACT_RUN = {
    "revolutions": COORDINATES["revolutions"],
    **_LAYER,
    **_of_realisations(CONTACT_DIMS),
    "mean_contact_length": run_mean(_RUN_DIMS, "m", "mean contact length"),
    "mean_contact_force": run_mean(
        _RUN_DIMS,
        "N",
        "mean contact force of one line",
        comment="E* dx sum(overlap), Eq. 5. One line represents a patch of about 2a x 2a, "
        "not the full length of the rollers",
    ),
    "contact_load_share": run_mean(
        _RUN_DIMS,
        "1",
        "mean contact force over the nominal load of a patch 2a x 2a",
        comment="mean_contact_force / (F_N 2a / L'): the patch carries the mean Hertzian "
        "pressure, F_N / (2a L'), over its area, (2a)^2",
    ),
}

_MASTER_RUN = {
    "revolutions": COORDINATES["revolutions"],
    **_of_realisations(MASTER_DIMS),
    "layer_breakthrough_probability": run_mean(
        ("realisation", *LAYER_DIMS),
        "1",
        "probability of boundary layer breakthrough, by strength of the layer",
    ),
}

_OF_TRACES = ("operating_point", "time")
_OF_POINTS = ("operating_point",)
_TRACE = {
    **_LAYER,
    "reduced_modulus": number([], "Pa", "reduced modulus E*"),
    "resistivity": number([], "ohm m", "resistivity of the rollers' material"),
    "contact_length": number(_OF_TRACES, "m", "contact length"),
    "contact_resistance": number(_OF_TRACES, "ohm", "contact resistance"),
    **AT_POINTS,
    "film_thickness": number(_OF_POINTS, "m", "film thickness"),
    "contact_half_width": number(_OF_POINTS, "m", "contact half-width"),
    "entrainment_speed": number(_OF_POINTS, "m s-1", "entrainment speed"),
}

_LINE_ATTRIBUTES = ("q_min", "q_max", "spacing", "points", "height_step")
_RUN_ATTRIBUTES = ("travel", "longest_wavelength")

KINDS = {
    "roughness": FileKind(
        _ROUGHNESS,
        "The kept roughness lines, with their moments beside those of the spectrum.",
        _LINE_ATTRIBUTES,
    ),
    "roughness_batch": FileKind(_ROUGHNESS_BATCH, attributes=_LINE_ATTRIBUTES),
    "contact_batch": FileKind(_CONTACT_RUN, attributes=_RUN_ATTRIBUTES),
    "contact": FileKind(
        {**_CONTACT_RUN, **_over_realisations(CONTACT_DIMS)},
        "The main result: probabilities, contact length, contact force and its share of the "
        "load for every realisation, and mean probabilities with 95 % intervals.",
        _RUN_ATTRIBUTES,
    ),
    "master_batch": FileKind(_MASTER_RUN, attributes=_RUN_ATTRIBUTES),
    "master": FileKind(
        {**_MASTER_RUN, **_over_realisations(MASTER_DIMS)},
        "The master map: the same probabilities as functions of lambda ratio and contact "
        "width only; and, on a coarser grid, for weaker and stronger boundary layers.",
        _RUN_ATTRIBUTES,
    ),
    "trace": FileKind(
        _TRACE,
        "Contact length and resistance at every time step of one revolution, at the operating "
        "points named in the study.",
    ),
}
