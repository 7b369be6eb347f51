"""What every file of a study contains: names, dimensions, units and meaning.

Stages return unlabelled arithmetic wrapped in xarray; `label` writes the attributes last,
because arithmetic on labelled arrays keeps the wrong ones, and `check` refuses a dataset
that is not what its name promises, before it is saved and after it is read.
"""

from lube.schema.coordinates import (
    AT_RECORDS,
    CONTACT_DIMS,
    COORDINATES,
    EXPERIMENT_DIMS,
    LAYER_DIMS,
    LINE_DIMS,
    MASTER_DIMS,
    OPERATING_DIMS,
    POINT_DIMS,
)
from lube.schema.kinds import ATTRIBUTES, FILES, SUMMARIES
from lube.schema.labels import check, label
from lube.schema.oil import REGIMES
from lube.schema.rig import ORIGINS
from lube.schema.stages import DATASETS, MEASURED, STAGES, Stage, forerunners
from lube.schema.variables import LIMITS, Variable

__all__ = [
    "ATTRIBUTES",
    "AT_RECORDS",
    "CONTACT_DIMS",
    "COORDINATES",
    "DATASETS",
    "EXPERIMENT_DIMS",
    "FILES",
    "LAYER_DIMS",
    "LIMITS",
    "LINE_DIMS",
    "MASTER_DIMS",
    "MEASURED",
    "OPERATING_DIMS",
    "ORIGINS",
    "POINT_DIMS",
    "REGIMES",
    "STAGES",
    "SUMMARIES",
    "Stage",
    "Variable",
    "check",
    "forerunners",
    "label",
]
