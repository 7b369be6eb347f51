"""The public names of `lube`: answers with units, and the results of studies."""

from lube import stages as stages
from lube import types as types
from lube.archive.explain import explain as explain
from lube.calculator.answers import Answer as Answer
from lube.calculator.choices import COMPLETE as COMPLETE
from lube.calculator.contact import contact_probability as contact_probability
from lube.calculator.duty_cycle import duty as duty
from lube.calculator.film import film as film
from lube.calculator.indicators import indicators as indicators
from lube.calculator.oil import Oil as Oil
from lube.calculator.one_point import profile as profile
from lube.calculator.one_point import trace as trace
from lube.calculator.planning import plan as plan
from lube.calculator.required import required_film as required_film
from lube.calculator.required import required_speed as required_speed
from lube.calculator.required import required_temperature as required_temperature
from lube.calculator.required import required_viscosity as required_viscosity
from lube.calculator.required_roughness import required_roughness as required_roughness
from lube.calculator.rollers import Rollers as Rollers
from lube.ehl.film_formulas import FORMULAS as FORMULAS
from lube.errors import DataError as DataError
from lube.errors import LubeError as LubeError
from lube.errors import RangeError as RangeError
from lube.errors import RecordError as RecordError
from lube.errors import StudyError as StudyError
from lube.inference.study_shares import over_grid as over_grid
from lube.pipeline.results import results_folder as results_folder
from lube.storage.netcdf import load as load

__version__: str
