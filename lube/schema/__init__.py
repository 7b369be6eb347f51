"""The contents of every file of a study: names, dimensions, units and meaning.

They are listed in two tables, ``variables.csv`` and ``files.csv``; `lube.schema.tables` explains
the columns.

Arithmetic on labelled arrays keeps the attributes of one operand, which may be wrong for the
result. So each stage writes the attributes last, with `label`. `check` refuses a dataset that does
not fit its kind, before it is saved and when it is read.
"""

from lube.schema.labels import check, label
from lube.schema.stages import CONDITIONS, DATASETS, ON_REQUEST, STAGES, TARGETS, forerunners
from lube.schema.tables import (
    AT_RECORDS,
    ATTRIBUTES,
    CONTACT_DIMS,
    COORDINATES,
    EXPERIMENT_DIMS,
    FILES,
    LIMITS,
    MEAN_LIMITS,
    OPERATING_DIMS,
    POINT_DIMS,
    REGIMES,
    SUMMARIES,
    model_dependent,
    values_with_limits,
    with_dims,
)
