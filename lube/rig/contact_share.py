"""From a record to the share of time in contact, and how far that share can be trusted.

A record of the rig may hold more samples than fit into memory, so it is counted in pieces as
they come. What stays of it are counts in many equal blocks: their sum is the share of time
below a limit, their scatter tells its interval, and they can be folded by the revolution.
"""

import numpy as np

from lube.errors import RangeError
from lube.kernels.threshold import count_below, follow_contact
from lube.physics.electrical import divider_voltage
from lube.statistics.confidence import probability_limits

BLOCKS = 2**18
"""So many blocks at most; whenever they are full, each two become one."""

MOST_STRETCHES = 4096
"""Shorter stretches than in so many equal parts see the same contact as their neighbours."""

STRETCHES = 64
"""Stretches of the circumference that a folded record is cut into, at most."""

LEAST_BLOCKS = 8
"""Fewer blocks than this tell too little of their scatter."""


class ContactShare:
    """Count the share of time below limits, of a record that comes in pieces.

    Contact begins where a value is below the limit, and ends where one reaches the release.
    The counts depend on the samples only, never on how the record is cut into pieces.

    Parameters
    ----------
    limits : numpy.ndarray
        Shape (K,), rising, in the record's own unit (V or ohm).
    releases : numpy.ndarray, optional
        Shape (K,), no less than the limits; by default the limits, which is no hysteresis.
    hold : int, optional
        A change of state counts only once it has lasted so many samples, and then from its
        first sample on; 0 is off.

    Raises
    ------
    RangeError
        If the limits do not rise, a release is below its limit, or `hold` is negative.
    """

    def __init__(self, limits, releases=None, hold=0):
        self._limits = np.array(limits, float)
        self._releases = self._limits if releases is None else np.array(releases, float)
        self._hold = hold
        self._check()
        self._remembers = releases is not None or hold > 0
        self._states = np.zeros((self._limits.size, 3), np.int64)
        self._counts = np.zeros((self._limits.size, BLOCKS), np.int64)
        self._doublings = self._samples = 0

    def _check(self):
        limits, releases = self._limits.tolist(), self._releases.tolist()
        if not limits or not np.all(np.diff(limits) > 0.0) or not np.all(np.isfinite(limits)):
            raise RangeError(f"limits: got {limits}, need one or more, finite and rising")
        if len(releases) != len(limits) or not np.all(self._releases >= self._limits):
            raise RangeError(
                f"releases: got {releases}, need one for each limit, no less than it: {limits}"
            )
        if self._hold < 0:
            raise RangeError(f"hold: got {self._hold}, need a number of samples, or 0")

    def add(self, values):
        """Count the next piece of the record.

        Parameters
        ----------
        values : numpy.ndarray
            Shape (N,), in the unit of the limits, float64 or float32.
        """
        values = np.ascontiguousarray(values)
        while values.size:
            room = (BLOCKS << self._doublings) - self._samples
            self._count(values[:room])
            self._samples += min(room, values.size)
            values = values[room:]
            if self._samples == BLOCKS << self._doublings:
                self._merge()

    def _count(self, values):
        place = values, self._samples, self._doublings
        if self._remembers:
            limits = self._limits, self._releases, self._hold
            follow_contact(*place, *limits, self._states, self._counts)
        else:
            count_below(*place, self._limits, self._counts)

    def _merge(self):
        self._counts[:, : BLOCKS // 2] = _pairs(self._counts)
        self._counts[:, BLOCKS // 2 :] = 0
        self._doublings += 1

    @property
    def samples(self):
        """Samples counted so far."""
        return self._samples

    @property
    def below(self):
        """Samples in contact, shape (K, B), int64: at each limit, in each block."""
        return self._counts[:, : self.sizes.size].copy()

    @property
    def sizes(self):
        """Samples in each block, shape (B,), int64; the last may be shorter."""
        firsts = np.arange(0, self._samples, 1 << self._doublings)
        return np.diff(firsts, append=self._samples)


def record_counter(experiment, rig, quantity, sampling_interval):
    """Begin to count the time that a record of the rig lies below a study's thresholds.

    Parameters
    ----------
    experiment : Experiment
        Thresholds (ohm), release ratio and debounce (s).
    rig : Rig
        The circuit, which tells a resistance's voltage.
    quantity : str
        What the record holds, ``voltage`` (V) or ``resistance`` (ohm).
    sampling_interval : float
        Time between its samples, s.

    Returns
    -------
    ContactShare
        With limits in the record's own unit, in the order of the thresholds.
    """
    limits = np.array(experiment.thresholds)
    releases = limits * experiment.release_ratio
    if quantity == "voltage":
        limits, releases = divider_voltage(limits, rig), divider_voltage(releases, rig)
    hold = round(experiment.debounce / sampling_interval)
    return ContactShare(limits, None if experiment.release_ratio == 1.0 else releases, hold)


def _pairs(counts):
    """Add neighbours along the last axis; a last one without a partner stays alone."""
    if counts.shape[-1] % 2:
        counts = np.append(counts, np.zeros_like(counts[..., :1]), axis=-1)
    return counts[..., ::2] + counts[..., 1::2]


def folded_counts(below, sizes, interval, period):
    """Count a record by the phase of a revolution, all its revolutions together.

    Parameters
    ----------
    below : numpy.ndarray
        Shape (K, B), samples in contact at each limit in each block of the record.
    sizes : numpy.ndarray
        Shape (B,), samples in each block; all but the last are equal.
    interval : float
        Duration of a block, s.
    period : float
        Of a revolution, s.

    Returns
    -------
    below, sizes : numpy.ndarray
        The same over at most `STRETCHES` phases, those that were seen, shapes (K, F) and (F,).
    """
    phases = min(STRETCHES, max(int(period / interval), 1))
    turns = (np.arange(sizes.size) + 0.5) * interval / period
    phase = np.minimum((turns % 1.0 * phases).astype(np.int64), phases - 1)
    counts = np.array([np.bincount(phase, row, phases) for row in (*below, sizes)])
    counts = counts[:, counts[-1] > 0]
    return counts[:-1], counts[-1]


def share_interval(below, sizes, windows, folded=()):
    """Share of one record and its 95 % interval, from the scatter between stretches of it.

    It is the interval of the mean over pairs of rollers, as far as the record of one pair
    tells it. Neighbouring samples see the same roughness and are no independent looks; long
    stretches are nearly so. The variance of the mean grows with the length of the stretches
    that it is taken from, until they are longer than what a record remembers. It is taken from
    blocks, from pairs of them, pairs of pairs and so on, and the largest of these is believed.
    Where rollers repeat themselves, stretches a revolution apart are no independent looks
    either: then stretches of the circumference take the place of stretches of time.

    Parameters
    ----------
    below : numpy.ndarray
        Shape (K, B), samples in contact at each limit in each block of the record.
    sizes : numpy.ndarray
        Shape (B,), samples in each block.
    windows : float
        Independent windows in the record, at least one; they stand in where the record has
        no scatter to tell (`lube.statistics.confidence.probability_limits`).
    folded : sequence of tuple, optional
        The same counts over phases of a revolution, from `folded_counts`, once for each roller.

    Returns
    -------
    share, lower, upper : numpy.ndarray
        Shape (K,) each.

    Raises
    ------
    RangeError
        If the record is empty, or `windows` less than one.

    References
    ----------
    H. Flyvbjerg, H. G. Petersen, Error estimates on averages of correlated data,
    J. Chem. Phys. 91 (1989) 461-466.
    """
    below, sizes = np.asarray(below), np.asarray(sizes)
    if not sizes.sum() > 0:
        raise RangeError("got a record without samples, need one or more")
    if not windows >= 1.0:
        raise RangeError(f"windows: got {windows:g}, need at least 1")
    share = below.sum(axis=-1) / sizes.sum()
    variance, degrees = _levelled_variance(below, sizes)
    for counts in folded:
        around, freedom = _levelled_variance(*counts)
        degrees = np.where(around > variance, freedom, degrees)
        variance = np.maximum(around, variance)
    with np.errstate(divide="ignore", invalid="ignore"):
        looks = np.where(variance > 0.0, share * (1.0 - share) / variance, np.nan)
    return share, *probability_limits(share, looks, degrees, windows)


def _levelled_variance(below, sizes):
    """Largest variance of the share over all lengths of stretches, and its degrees of freedom."""
    variance, degrees = np.zeros(below.shape[0]), np.ones(below.shape[0])
    while sizes.size > MOST_STRETCHES:
        below, sizes = _pairs(below), _pairs(sizes)
    while sizes.size >= LEAST_BLOCKS:
        here = _variance(below, sizes)
        degrees = np.where(here > variance, sizes.size - 1, degrees)
        variance = np.maximum(here, variance)
        below, sizes = _pairs(below), _pairs(sizes)
    return variance, degrees


def _variance(below, sizes):
    """Variance of the share in all blocks, which need not be equally long."""
    shares, weights = below / sizes, sizes / sizes.sum()
    excess = weights * (shares - (weights * shares).sum(axis=-1, keepdims=True))
    variance = sizes.size / (sizes.size - 1) * (excess**2).sum(axis=-1)
    # Asked of the shares themselves: the variance of equal ones need not round to zero.
    return np.where(np.ptp(shares, axis=-1) > 0.0, variance, 0.0)
