"""The public names of `lube`, for editors and type checkers."""

from lube.archive.explain import explain as explain
from lube.errors import DataError as DataError
from lube.errors import LubeError as LubeError
from lube.errors import RangeError as RangeError
from lube.errors import RecordError as RecordError
from lube.errors import StudyError as StudyError
from lube.physics.electrical import contact_resistance as contact_resistance
from lube.physics.film_formulas import FORMULAS as FORMULAS
from lube.recordings.manifest import read_manifest as read_manifest
from lube.recordings.reader import Recording as Recording
from lube.recordings.reader import open_recording as open_recording
from lube.rig.contact_share import ContactShare as ContactShare
from lube.rig.contact_share import share_interval as share_interval
from lube.rig.fits import fit_alpha as fit_alpha
from lube.rig.fits import fit_layer_strength as fit_layer_strength
from lube.rig.study_shares import over_grid as over_grid
from lube.stages.comparison import compare as compare
from lube.stages.contact import contact_map as contact_map
from lube.stages.contact import contact_statistics as contact_statistics
from lube.stages.ensemble import gather as gather
from lube.stages.ensemble import gather_map as gather_map
from lube.stages.ensemble import with_intervals as with_intervals
from lube.stages.film import film_table as film_table
from lube.stages.gauge import gauge_film as gauge_film
from lube.stages.gauge import gauge_records as gauge_records
from lube.stages.lubricant import lubricant_table as lubricant_table
from lube.stages.roughness import roughness_lines as roughness_lines
from lube.stages.trace import contact_trace as contact_trace
from lube.stages.trace import contact_window as contact_window
from lube.storage.netcdf import load as load
from lube.storage.netcdf import save as save
from lube.study.lubricant_record import load_record as load_record
from lube.study.lubricant_record import shipped_records as shipped_records
from lube.study.rollers import BoundaryLayer as BoundaryLayer
from lube.study.rollers import LineSpec as LineSpec
from lube.study.rollers import Roller as Roller
from lube.study.rollers import RollerPair as RollerPair
from lube.study.rollers import Roughness as Roughness
from lube.study.rollers import line_spec as line_spec
from lube.study.study import Study as Study
from lube.study.study import load_study as load_study
from lube.surfaces.synthetic import power_spectrum as power_spectrum
from lube.workflow.results import results_folder as results_folder

__version__: str
