"""The roughness lines, and what comes of pressing them together: runs, map and traces."""

from lube.schema.coordinates import (
    AT_POINTS,
    CONTACT_DIMS,
    COORDINATES,
    LAYER_DIMS,
    LINE_DIMS,
    MASTER_DIMS,
)
from lube.schema.variables import OVER_ALL, FileKind, limited, number, run_mean

_ROUGHNESS = {
    "height": number([*LINE_DIMS, "position"], "m", "height of the line towards the other roller"),
    "seed": number(["realisation"], "1", "study seed the realisation was drawn with", kind="i"),
    "rms_height": number(LINE_DIMS, "m", "realised rms height"),
    "rms_slope": number(LINE_DIMS, "1", "realised rms slope"),
    "rms_curvature": number(LINE_DIMS, "m-1", "realised rms curvature"),
    "skewness": number(LINE_DIMS, "1", "realised skewness of heights"),
    "kurtosis": number(LINE_DIMS, "1", "realised kurtosis of heights"),
    "spectrum_rms_height": number(["roller"], "m", "rms height of the spectrum"),
    "spectrum_rms_slope": number(["roller"], "1", "rms slope of the spectrum"),
    "spectrum_rms_curvature": number(["roller"], "m-1", "rms curvature of the spectrum"),
}

_ROUGHNESS_BATCH = {
    "height": number([*LINE_DIMS, "position"], "m", "height of the line", kind="i"),
}


_RUN_DIMS = ("realisation", *CONTACT_DIMS)
_PROBABILITIES = {
    "breakthrough_probability": "probability of boundary layer breakthrough",
    "geometric_contact_probability": "probability of geometric contact",
}

_LAYER = {
    "critical_thickness": number([], "m", "critical thickness of the boundary layer"),
    "shear_strength": number([], "Pa", "limiting shear stress of the boundary layer"),
}

_CONTACT_RUN = {
    "revolutions": COORDINATES["revolutions"],
    **_LAYER,
    **{name: run_mean(_RUN_DIMS, "1", long_name) for name, long_name in _PROBABILITIES.items()},
    "mean_contact_length": run_mean(_RUN_DIMS, "m", "mean contact length"),
    "mean_contact_force": run_mean(
        _RUN_DIMS,
        "N",
        "mean contact force of one line's springs",
        comment="E* dx sum(overlap), Eq. 5. One line stands for a patch of about 2a x 2a, "
        "not for the length of the rollers",
    ),
    "contact_load_share": run_mean(
        _RUN_DIMS,
        "1",
        "mean contact force over the nominal load of a patch 2a x 2a",
        comment="mean_contact_force / (F_N 2a / L'): the patch carries the mean Hertzian "
        "pressure, F_N / (2a L'), over its area, (2a)^2",
    ),
}


def _intervals(dims):
    """Describe the mean of each probability over the realisations, and its limits."""
    intervals = {}
    for name, long_name in _PROBABILITIES.items():
        value, meaning = "_mean", ", mean over realisations"
        intervals |= limited(name, dims, "1", long_name, value, meaning, attributes=OVER_ALL)
    return intervals


_MASTER_RUN = {
    "revolutions": COORDINATES["revolutions"],
    **{
        name: run_mean(("realisation", *MASTER_DIMS), "1", long_name)
        for name, long_name in _PROBABILITIES.items()
    },
    "layer_breakthrough_probability": run_mean(
        ("realisation", *LAYER_DIMS), "1", "probability of breakthrough of weak and strong layers"
    ),
}

_TRACE = {
    **_LAYER,
    "reduced_modulus": number([], "Pa", "reduced modulus E*"),
    "resistivity": number([], "ohm m", "resistivity of the rollers' material"),
    "contact_length": number(["operating_point", "time"], "m", "contact length"),
    "contact_resistance": number(["operating_point", "time"], "ohm", "contact resistance"),
    **AT_POINTS,
    "film_thickness": number(["operating_point"], "m", "film thickness"),
    "contact_half_width": number(["operating_point"], "m", "contact half-width"),
    "entrainment_speed": number(["operating_point"], "m s-1", "entrainment speed"),
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
        {**_CONTACT_RUN, **_intervals(CONTACT_DIMS)},
        "The answer: probabilities, contact length, contact force and its share of the load, of "
        "every realisation, and means with intervals.",
        _RUN_ATTRIBUTES,
    ),
    "master_batch": FileKind(_MASTER_RUN, attributes=_RUN_ATTRIBUTES),
    "master": FileKind(
        {**_MASTER_RUN, **_intervals(MASTER_DIMS)},
        "The same probabilities over lambda ratio and contact width, whatever is behind "
        "them: the master curve; and, coarser, for weaker and stronger layers.",
        _RUN_ATTRIBUTES,
    ),
    "trace": FileKind(
        _TRACE,
        "Contact length and resistance at every time step of one revolution, at the points "
        "the study names.",
    ),
}
