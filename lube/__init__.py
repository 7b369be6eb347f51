"""Mixed lubrication of rough rollers: film, contact and their probabilities.

Functions such as `film` take and return quantities with units. `load` and `results_folder` open
the results of a study. The steps of a study, in SI units, are in `lube.stages`. `__init__.pyi`
lists the names.
"""

from lube.lazy import attach

__version__ = "0.2.0"
__getattr__, __dir__ = attach("lube", "stages", "types")
