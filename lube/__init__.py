"""Mixed lubrication of rough rollers: film, roughness, contact, and their probabilities.

The names below are the public interface. Each is imported on first use, so that importing the
package itself takes no time. `__init__.pyi` repeats them for editors and type checkers.
"""

import importlib

__version__ = "0.2.0"

_HOMES = {
    "lube.archive.explain": ("explain",),
    "lube.calculator.answers": ("Answer",),
    "lube.calculator.duty_cycle": ("duty",),
    "lube.calculator.operating_points": ("contact_probability", "film", "profile", "trace"),
    "lube.calculator.parts": ("Oil", "Rollers"),
    "lube.calculator.required": (
        "required_film",
        "required_roughness",
        "required_speed",
        "required_temperature",
        "required_viscosity",
    ),
    "lube.contact.ensemble": ("gather", "gather_map", "with_intervals"),
    "lube.errors": ("DataError", "LubeError", "RangeError", "RecordError", "StudyError"),
    "lube.physics.electrical": ("contact_resistance",),
    "lube.ehl.film_formulas": ("FORMULAS",),
    "lube.recordings.manifest": ("read_manifest",),
    "lube.recordings.reader": ("Recording", "open_recording"),
    "lube.rig.contact_share": ("ContactShare", "share_interval"),
    "lube.inference.fits": ("fit_alpha", "fit_layer_strength"),
    "lube.inference.study_shares": ("over_grid",),
    "lube.stages.comparison": ("compare",),
    "lube.stages.contact": ("contact_statistics",),
    "lube.stages.film": ("film_table",),
    "lube.stages.gauge": ("gauge_film", "gauge_records"),
    "lube.study.oil_properties": ("lubricant_table",),
    "lube.stages.master": ("contact_map",),
    "lube.stages.roughness": ("roughness_lines",),
    "lube.stages.trace": ("contact_trace", "contact_window"),
    "lube.storage.netcdf": ("load", "save"),
    "lube.study.line_spec": ("LineSpec", "RoughLine", "line_spec"),
    "lube.study.lubricant_record": ("load_record", "shipped_records"),
    "lube.study.rollers": ("BoundaryLayer", "Roller", "RollerPair", "Roughness"),
    "lube.study.study": ("Study", "load_study"),
    "lube.surfaces.spectra": ("power_spectrum",),
    "lube.pipeline.results": ("results_folder",),
}
_HOME_OF = {name: home for home, names in _HOMES.items() for name in names}

__all__ = ["__version__", *sorted(_HOME_OF)]


def __getattr__(name):
    if name not in _HOME_OF:
        raise AttributeError(f"module 'lube' has no attribute {name!r}")
    return getattr(importlib.import_module(_HOME_OF[name]), name)


def __dir__():
    return __all__
