"""The steps of a study as functions, in SI units, and the types of their arguments."""

from collections.abc import Callable

import xarray as xr

from lube.contact.ensemble import gather as gather
from lube.contact.ensemble import gather_map as gather_map
from lube.contact.ensemble import with_intervals as with_intervals
from lube.inference.fits import fit_alpha as fit_alpha
from lube.inference.fits import fit_layer_strength as fit_layer_strength
from lube.inference.record_curves import RecordCurves as RecordCurves
from lube.inference.record_curves import map_curves as map_curves
from lube.inference.record_curves import own_curves as own_curves
from lube.physics.electrical import contact_resistance as contact_resistance
from lube.recordings.manifest import read_manifest as read_manifest
from lube.recordings.reader import Recording as Recording
from lube.recordings.reader import open_recording as open_recording
from lube.rig.contact_share import ContactShare as ContactShare
from lube.rig.contact_share import share_interval as share_interval
from lube.stages.comparison import compare as compare
from lube.stages.contact import contact_statistics as contact_statistics
from lube.stages.film import film_table as film_table
from lube.stages.film_response import film_responses as film_responses
from lube.stages.gauge import gauge_film as gauge_film
from lube.stages.gauge import gauge_records as gauge_records
from lube.stages.master import contact_map as contact_map
from lube.stages.roughness import roughness_lines as roughness_lines
from lube.stages.trace import contact_trace as contact_trace
from lube.stages.trace import contact_window as contact_window
from lube.storage.netcdf import save as save
from lube.study.line_spec import LineSpec as LineSpec
from lube.study.line_spec import RoughLine as RoughLine
from lube.study.lubricant_record import load_record as load_record
from lube.study.lubricant_record import shipped_records as shipped_records
from lube.study.oil_properties import lubricant_table as lubricant_table
from lube.study.roller_lines import line_spec as line_spec
from lube.study.rollers import BoundaryLayer as BoundaryLayer
from lube.study.rollers import Roller as Roller
from lube.study.rollers import RollerPair as RollerPair
from lube.study.rollers import Roughness as Roughness
from lube.study.study import Study as Study
from lube.study.study import load_study as load_study
from lube.surfaces.spectra import power_spectrum as power_spectrum

def maker(stage: str, name: str = "make") -> Callable[..., xr.Dataset]: ...
