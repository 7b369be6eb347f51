"""The contents of every file of a study: names, dimensions, units and meaning.

Arithmetic on labelled arrays keeps the attributes of one operand, which are wrong for the result.
So each stage writes the attributes last, with `label`; `check` refuses a dataset that does not
fit its kind, before it is saved and after it is read.
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
