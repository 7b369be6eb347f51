"""Whether a measured record can be used in a study: its conditions and its samples."""

from collections.abc import Iterator

import numpy as np

from lube.errors import DataError, located
from lube.recordings.manifest import OF_FILES, Entry
from lube.recordings.reader import Recording, open_recording
from lube.study.study import Study

SATURATED = 0.001
"""Largest part of the samples that may lie at the amplifier's limits."""

REVERSED = 0.001
"""Largest part of the samples that may lie further below zero than half the bias voltage."""


def lubricant_of(entry: Entry, study: Study) -> str:
    """Find the lubricant of a record, whose conditions must be within the study's model.

    Parameters
    ----------
    entry : Entry
        Its row of the manifest.
    study : Study
        The study.

    Returns
    -------
    str
        Name of a lubricant of the study, by default its first.

    Raises
    ------
    DataError
        If the study has no such lubricant, the lubricant's data do not cover the temperature, the
        contact at the force is too narrow or too wide, or the study's model does not hold at the
        slip.
    """
    lubricants = {record.name: record for record in study.lubricants}
    name = entry.lubricant or study.lubricants[0].name
    if name not in lubricants:
        needed = f"need one of the study's: {', '.join(lubricants)}"
        raise DataError(f"{entry.where}: lubricant: got {name}, {needed}")
    with located(entry.where, DataError):
        lubricants[name].check_temperatures([entry.temperature])
        study.check_window(entry.force)
        study.gap.check_slip(entry.slide_to_roll_ratio or 0.0)
    return name


def open_entry(entry: Entry) -> Recording:
    """Open the recording of a row of the manifest; errors are those of `open_recording`."""
    return open_recording(entry.file, **{name: getattr(entry, name) for name in OF_FILES})


def unsaturated_pieces(recording: Recording, study: Study) -> Iterator[np.ndarray]:
    """Read a recording, which must be within the range of the rig's amplifier, and not reversed.

    Parameters
    ----------
    recording : Recording
        From `open_entry`.
    study : Study
        Its rig has the range.

    Yields
    ------
    numpy.ndarray
        As `Recording.pieces`.

    Raises
    ------
    DataError
        After the last piece, if too many samples are saturated, or of the wrong sign, which would
        count as contact; and as from `Recording.pieces`.
    """
    # An infinite resistance is an open circuit; none is at or beyond NaN.
    is_voltage = recording.quantity == "voltage"
    limit = study.rig.amplifier_range if is_voltage else np.nan
    lowest = -0.5 * study.rig.bias_voltage if is_voltage else np.nan
    samples = saturated = reversed_ = 0
    for piece in recording.pieces():
        samples += piece.size
        saturated += np.count_nonzero(np.abs(piece) >= limit)
        reversed_ += np.count_nonzero(piece < lowest)
        yield piece
    if saturated > SATURATED * samples:
        raise DataError(
            f"{recording.path}: saturated, {saturated / samples:.1%} of its samples are at or "
            f"beyond {limit:g} V, need at most {SATURATED:.1%} beyond rig.amplifier_range"
        )
    if reversed_ > REVERSED * samples:
        raise DataError(
            f"{recording.path}: reversed, {reversed_ / samples:.1%} of its samples are below "
            f"{lowest:g} V, need at most {REVERSED:.1%}; a gain below 0 turns the sign"
        )
