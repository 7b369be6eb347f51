"""Mixed lubrication of rough rollers: film, roughness, contact, and their probabilities.

The names below are the public interface. They are loaded on first use, so that importing the
package, as the workflow does at every start, costs nothing.
"""

import importlib

_HOMES = {
    "lube.stages.comparison": ("compare",),
    "lube.stages.contact": ("contact_map", "contact_statistics"),
    "lube.stages.ensemble": ("gather", "gather_map", "with_intervals"),
    "lube.errors": ("DataError", "LubeError", "RangeError", "RecordError", "StudyError"),
    "lube.rig.contact_share": ("ContactShare", "share_interval"),
    "lube.archive.explain": ("explain",),
    "lube.stages.film": ("film_table",),
    "lube.rig.fits": ("fit_alpha", "fit_layer_strength"),
    "lube.physics.film_formulas": ("FORMULAS",),
    "lube.stages.gauge": ("gauge_film", "gauge_records"),
    "lube.storage.netcdf": ("load", "save"),
    "lube.stages.lubricant": ("lubricant_table",),
    "lube.recordings.manifest": ("read_manifest",),
    "lube.recordings.reader": ("Recording", "open_recording"),
    "lube.study.lubricant_record": ("load_record", "shipped_records"),
    "lube.physics.electrical": ("contact_resistance",),
    "lube.stages.roughness": ("roughness_lines",),
    "lube.rig.study_shares": ("over_grid",),
    "lube.study.study": ("Study", "load_study"),
    "lube.study.rollers": (
        "BoundaryLayer",
        "LineSpec",
        "Roller",
        "RollerPair",
        "Roughness",
        "line_spec",
    ),
    "lube.surfaces.synthetic": ("power_spectrum",),
    "lube.stages.trace": ("contact_trace", "contact_window"),
}
_HOME_OF = {name: home for home, names in _HOMES.items() for name in names}

__all__ = sorted(_HOME_OF)


def __getattr__(name):
    if name not in _HOME_OF:
        raise AttributeError(f"module 'lube' has no attribute {name!r}")
    return getattr(importlib.import_module(_HOME_OF[name]), name)


def __dir__():
    return __all__
