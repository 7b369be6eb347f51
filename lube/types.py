"""Names of types that many signatures share."""

from collections.abc import Iterable
from pathlib import Path

File = str | Path
"""Path of a file or folder."""
Files = Iterable[File]
