"""The errors a user of the study can cause, each told in one line.

Every message says which input is meant, what came and what is needed.
"""


class LubeError(Exception):
    """Base of all errors that a user can mend."""


class StudyError(LubeError):
    """A study's configuration cannot be carried out as written."""


class RecordError(LubeError):
    """A lubricant record, or the data file it names, cannot be used."""


class DataError(LubeError):
    """A dataset is missing, damaged, foreign, or does not fit its stage."""


class RangeError(LubeError):
    """A value lies outside the range in which a model or property is known."""
