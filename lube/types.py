"""Short names of types that signatures share."""

from pathlib import Path

File = str | Path
