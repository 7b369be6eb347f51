"""A record folded by the revolution, to see what repeats in each turn.

A roller shows the same roughness again after each turn. If both rollers repeat together (equal
circumferences, no slip), so does the whole record, except for electrical noise. The repeatability
checks this assumption, and the period of the repetition measures the speed.
"""

from dataclasses import dataclass

import numpy as np
import scipy.fft

PHASES = 512
"""Largest number of phases of a revolution into which a record is folded."""
SPAN = 0.05
"""Relative distance from the nominal period within which the period is searched."""
LEAST_BLOCKS = 8
"""Fewest blocks per revolution with which a repetition can be seen."""
ALIKE = 0.98
"""Peaks of the autocorrelation above this fraction of the highest count as equally high; of these
the one nearest to the nominal period is taken."""
CLEAR = 0.5
"""Lowest repeatability at which the period found in the record replaces the nominal period."""


@dataclass(frozen=True)
class Fold:
    """A record folded by the revolution, with the names of the ``experiment`` file.

    Attributes
    ----------
    revolution_period : float
        Period of a revolution, s: found in the record if it repeats clearly, else the nominal one.
    repeatability : float
        Mean correlation between two revolutions: 1 if they are the same, 0 if they are
        independent; NaN if the record holds at most one revolution, does not vary, or has too few
        blocks in a revolution.
    folded_share : numpy.ndarray
        Shape (PHASES,), contact share at each phase of a revolution.
    folded_deviation : numpy.ndarray
        Shape (PHASES,), standard deviation between revolutions; NaN where a phase occurs only
        once.
    share_error : float
        Standard error of the record's contact share from the scatter between its whole
        revolutions; 0 if there are fewer than two.
    """

    revolution_period: float
    repeatability: float
    folded_share: np.ndarray
    folded_deviation: np.ndarray
    share_error: float


def fold(shares: np.ndarray, interval: float, nominal_period: float) -> Fold:
    """Fold a record by the revolution.

    Parameters
    ----------
    shares : numpy.ndarray
        Shape (B,), contact share in successive equal blocks of the record.
    interval : float
        Duration of a block, s.
    nominal_period : float
        Period of a revolution by the speed of the rig, s.

    Returns
    -------
    Fold
        The folded record.

    Examples
    --------
    A record of ten equal revolutions, each of 64 blocks:

    >>> turn = np.random.default_rng(1).random(64)
    >>> folded = fold(np.tile(turn, 10), interval=0.01, nominal_period=0.64)
    >>> f"{folded.revolution_period:.3f} s", f"{folded.repeatability:.3f}"
    ('0.640 s', '1.000')
    """
    period = refined_period(shares, interval, nominal_period)
    repeatability = _repeatability(shares, interval, period)
    if not repeatability >= CLEAR:
        period = nominal_period
        repeatability = _repeatability(shares, interval, period)
    profile = _profile(shares, interval, period)
    return Fold(period, repeatability, *profile, _share_error(shares, interval, period))


def refined_period(shares: np.ndarray, interval: float, nominal_period: float) -> float:
    """Find the period at which a record repeats, near a nominal one.

    The autocorrelation has a peak at each multiple of the period. The first peak is searched
    within `SPAN` of the nominal period; then the multiple is doubled again and again, and each
    peak is searched near the position that follows from the one before.

    Parameters
    ----------
    shares, interval, nominal_period
        As in `fold`.

    Returns
    -------
    float
        The period, s; the nominal one if the record is too short, does not vary, or has too few
        blocks in a revolution.

    Examples
    --------
    >>> record = np.tile(np.random.default_rng(1).random(64), 10)
    >>> f"{refined_period(record, interval=0.01, nominal_period=0.65):.3f}"
    '0.640'
    """
    reach = SPAN * nominal_period / interval
    lag = nominal_period / interval
    if shares.size < lag + reach + 2 or lag < LEAST_BLOCKS or np.ptp(shares) == 0.0:
        return nominal_period
    correlation = _autocorrelation(shares)
    multiple = 1
    while multiple * (lag + reach) + 2 < shares.size:
        lag = _peak(correlation, multiple * lag, max(multiple * reach, 2.0)) / multiple
        reach = 1.5 / multiple  # the position is accurate to about one block
        multiple *= 2
    return lag * interval


def _autocorrelation(shares):
    """Mean product of deviations at each lag."""
    length = scipy.fft.next_fast_len(2 * shares.size, real=True)
    power = np.abs(scipy.fft.rfft(shares - shares.mean(), length)) ** 2
    return scipy.fft.irfft(power, length)[: shares.size] / np.arange(shares.size, 0, -1)


def _peak(correlation, middle, reach):
    """Lag of the peak near a given lag, by a parabola through its neighbours.

    A signal that repeats several times in a turn, such as mains hum, has many equal peaks.
    """
    first = max(int(np.floor(middle - reach)), 1)
    last = min(int(np.ceil(middle + reach)), correlation.size - 2)
    lags = np.arange(first, last + 1)
    high = correlation[lags].max()
    ridges = np.split(lags, 1 + np.flatnonzero(np.diff(correlation[lags] > 0.5 * high)))
    tops = [ridge[np.argmax(correlation[ridge])] for ridge in ridges]
    tops = [top for top in tops if correlation[top] >= min(ALIKE * high, high)]
    top = min(tops, key=lambda lag: abs(lag - middle))
    before, here, after = correlation[top - 1 : top + 2]
    if max(before, after) > here:  # the largest value searched lies on a slope, not on a peak
        return float(top)
    bend = before - 2.0 * here + after
    return top + (0.5 * (before - after) / bend if bend < 0.0 else 0.0)


def phases_of_blocks(
    count: int, interval: float, period: float, most: int = PHASES
) -> tuple[np.ndarray, np.ndarray, int]:
    """Divide the blocks of a record by revolution and phase.

    Parameters
    ----------
    count : int
        Number of blocks.
    interval, period : float
        Duration of a block and of a revolution, s.
    most : int, optional
        Largest number of phases.

    Returns
    -------
    phase, turn : numpy.ndarray
        Shape (count,), int64, phase and revolution in which the middle of each block is.
    phases : int
        Number of phases.

    Examples
    --------
    >>> phases_of_blocks(5, 1.0, 2.0)
    (array([0, 1, 0, 1, 0]), array([0, 0, 1, 1, 2]), 2)
    """
    turns = (np.arange(count) + 0.5) * interval / period
    phases = min(most, max(int(period / interval), 1))
    return (turns % 1.0 * phases).astype(np.int64), turns.astype(np.int64), phases


def _cells(shares, interval, period):
    """Mean share in each phase of each revolution, that phase, and how often each phase occurs."""
    phase, turn, phases = phases_of_blocks(shares.size, interval, period)
    cell = turn * phases + phase
    counts = np.bincount(cell)
    means = np.bincount(cell, shares) / np.maximum(counts, 1)
    phase = np.flatnonzero(counts) % phases
    return means[counts > 0], phase, np.bincount(phase, minlength=phases)


def _repeatability(shares, interval, period):
    """Mean correlation between two revolutions."""
    # The shares themselves decide: deviations of equal shares need not round to zero.
    if np.ptp(shares) == 0.0:
        return np.nan
    values, phase, times = _cells(shares - shares.mean(), interval, period)
    again = times > 1
    sums, squares = (np.bincount(phase, each, times.size)[again] for each in (values, values**2))
    known = times[again]
    alike = np.sum((sums**2 - squares) / (known * (known - 1)))
    total = np.sum(squares / known)
    return alike / total if total > 0.0 and times.size >= LEAST_BLOCKS else np.nan


def _profile(shares, interval, period):
    """Mean over the revolutions at each of `PHASES` phases, and standard deviation."""
    values, phase, times = _cells(shares, interval, period)
    with np.errstate(divide="ignore", invalid="ignore"):
        mean = np.bincount(phase, values, times.size) / times
        excess = np.bincount(phase, (values - mean[phase]) ** 2, times.size) / (times - 1)
    deviation = np.where(times > 1, np.sqrt(excess), np.nan)
    wanted = np.arange(PHASES) * times.size // PHASES
    return mean[wanted], deviation[wanted]


def _share_error(shares, interval, period):
    """Calculate the standard error of the share from the scatter between whole revolutions."""
    _, turn, _ = phases_of_blocks(shares.size, interval, period)
    inside = turn < int(shares.size * interval / period)
    blocks = np.bincount(turn[inside])
    seen = blocks > 0  # samples may be further apart than a turn
    if np.count_nonzero(seen) < 2:
        return 0.0
    each = np.bincount(turn[inside], shares[inside])[seen] / blocks[seen]
    return np.std(each, ddof=1) / np.sqrt(each.size)
