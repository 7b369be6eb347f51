"""All kinds of file, by their names."""

from lube.schema import benchmarks, lines, oil, rig

_KINDS = {**oil.KINDS, **lines.KINDS, **rig.KINDS, **benchmarks.KINDS}

FILES = {kind: file.variables for kind, file in _KINDS.items()}
"""Variables of each kind of file, by the kind's name."""

SUMMARIES = {kind: file.summary for kind, file in _KINDS.items() if file.summary}
"""What each kind of file that is kept contains, in a sentence or two."""

ATTRIBUTES = {kind: file.attributes for kind, file in _KINDS.items() if file.attributes}
"""Global attributes that the stages read from a file, by kind."""
