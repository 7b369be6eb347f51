"""Mixed lubrication of rough rollers: film, roughness, contact, and their probabilities.

The names below are the public interface. They are loaded on first use, so that importing the
package, as the workflow does at every start, costs nothing.
"""

import importlib

_HOMES = {
    "lube.comparison": ("compare",),
    "lube.contact": ("contact_map", "contact_statistics"),
    "lube.ensemble": ("gather", "gather_map", "with_intervals"),
    "lube.errors": ("DataError", "LubeError", "RangeError", "RecordError", "StudyError"),
    "lube.evaluation": ("ContactShare", "share_interval"),
    "lube.explanation": ("explain",),
    "lube.film": ("film_table",),
    "lube.fits": ("fit_alpha", "fit_layer_strength"),
    "lube.formulas": ("FORMULAS",),
    "lube.gauge": ("gauge_film", "gauge_records"),
    "lube.io": ("load", "save"),
    "lube.lubricant": ("lubricant_table",),
    "lube.manifest": ("read_manifest",),
    "lube.recordings": ("Recording", "open_recording"),
    "lube.records": ("load_record", "shipped_records"),
    "lube.resistance": ("contact_resistance",),
    "lube.roughness": ("power_spectrum", "roughness_lines"),
    "lube.shares": ("over_grid",),
    "lube.study": ("Study", "load_study"),
    "lube.surfaces": (
        "BoundaryLayer",
        "LineSpec",
        "Roller",
        "RollerPair",
        "Roughness",
        "line_spec",
    ),
    "lube.trace": ("contact_trace", "contact_window"),
}
_HOME_OF = {name: home for home, names in _HOMES.items() for name in names}

__all__ = sorted(_HOME_OF)


def __getattr__(name):
    if name not in _HOME_OF:
        raise AttributeError(f"module 'lube' has no attribute {name!r}")
    return getattr(importlib.import_module(_HOME_OF[name]), name)


def __dir__():
    return __all__
