"""Contact share of a record, and its confidence interval.

A record may hold more samples than fit into memory, so it is counted in pieces as they arrive. The
result is counts in many equal blocks: their sum gives the share of time below a threshold, their
scatter gives its interval, and they can be folded by the revolution.
"""

from collections.abc import Sequence
from functools import partial

import numpy as np
import numpy.typing as npt

from lube.kernels.threshold import count_below, follow_contact
from lube.physics.electrical import divider_voltage
from lube.statistics.confidence import probability_limits
from lube.statistics.folding import phases_of_blocks
from lube.study.rig_settings import Experiment, Rig

BLOCKS = 2**18
"""Largest number of blocks; when all are full, neighbours are added in pairs."""

MOST_STRETCHES = 4096
"""Largest number of stretches; shorter stretches see the same contact as their neighbours."""

STRETCHES = 64
"""Largest number of stretches of the circumference that a folded record is divided into."""

LEAST_BLOCKS = 8
"""Smallest number of blocks whose scatter is used."""

Counts = tuple[np.ndarray, np.ndarray]
"""Samples in contact, shape (K, B), and all samples, shape (B,), in each block."""


class ContactShare:
    """Count the samples of a record that lie below limits, piece by piece.

    Contact begins where a value is below the limit, and ends where one reaches the release.
    The counts do not depend on how the record is divided into pieces.

    Parameters
    ----------
    limits : array_like
        Shape (K,), rising, in the unit of the record (V or ohm).
    releases : array_like, optional
        Shape (K,), not below the limits; by default the limits, which is no hysteresis.
    hold : int, optional
        Number of samples that a change of state must last to count; it then counts from the first
        of them on. With 0 every change counts.

    Attributes
    ----------
    samples : int
        Samples counted so far.

    Examples
    --------
    >>> share = ContactShare([1.0, 3.0])
    >>> share.add(np.array([0.5, 2.0]))
    >>> share.add(np.array([2.0, 4.0]))
    >>> share.below.sum(axis=1) / share.samples
    array([0.25, 0.75])
    """

    def __init__(
        self, limits: npt.ArrayLike, releases: npt.ArrayLike | None = None, hold: int = 0
    ) -> None:
        limits = np.array(limits, float)
        self._counts = np.zeros((limits.size, BLOCKS), np.int64)
        options = {"limits": limits, "counts": self._counts}
        self._count = partial(count_below, **options)
        if releases is not None or hold > 0:
            options["releases"] = limits if releases is None else np.array(releases, float)
            options |= {"hold": hold, "states": np.zeros((limits.size, 3), np.int64)}
            self._count = partial(follow_contact, **options)
        self._doublings = self.samples = 0

    def add(self, values: np.ndarray) -> None:
        """Count the next piece of the record.

        Parameters
        ----------
        values : numpy.ndarray
            Shape (N,), in the unit of the limits, float64 or float32.
        """
        values = np.ascontiguousarray(values)
        while values.size:
            room = (BLOCKS << self._doublings) - self.samples
            self._count(values[:room], self.samples, self._doublings)
            self.samples += min(room, values.size)
            values = values[room:]
            if self.samples == BLOCKS << self._doublings:
                self._counts[:, : BLOCKS // 2] = _pairs(self._counts)
                self._counts[:, BLOCKS // 2 :] = 0
                self._doublings += 1

    @property
    def below(self) -> np.ndarray:
        """Samples in contact, shape (K, B), int64: at each limit, in each block."""
        return self._counts[:, : self.sizes.size].copy()

    @property
    def sizes(self) -> np.ndarray:
        """Samples in each block, shape (B,), int64; the last may be shorter."""
        firsts = np.arange(0, self.samples, 1 << self._doublings)
        return np.diff(firsts, append=self.samples)


def record_counter(
    experiment: Experiment, rig: Rig, quantity: str, sampling_interval: float
) -> ContactShare:
    """Prepare to count the time that a record lies below a study's thresholds.

    Parameters
    ----------
    experiment : Experiment
        Thresholds (ohm), release ratio and debounce time (s).
    rig : Rig
        The circuit, which relates resistance and voltage.
    quantity : str
        Quantity of the record, ``voltage`` (V) or ``resistance`` (ohm).
    sampling_interval : float
        Time between its samples, s.

    Returns
    -------
    ContactShare
        Counter with limits in the unit of the record, in the order of the thresholds.
    """
    limits = np.array(experiment.thresholds)
    releases = limits * experiment.release_ratio
    if quantity == "voltage":
        limits, releases = divider_voltage(limits, rig), divider_voltage(releases, rig)
    hold = round(experiment.debounce / sampling_interval)
    return ContactShare(limits, None if experiment.release_ratio == 1.0 else releases, hold)


def _pairs(counts):
    """Add neighbours along the last axis; a last one without a neighbour stays alone."""
    if counts.shape[-1] % 2:
        counts = np.append(counts, np.zeros_like(counts[..., :1]), axis=-1)
    return counts[..., ::2] + counts[..., 1::2]


def folded_counts(below: np.ndarray, sizes: np.ndarray, interval: float, period: float) -> Counts:
    """Sum the counts of a record over its revolutions, by phase.

    Parameters
    ----------
    below : numpy.ndarray
        Shape (K, B), samples in contact at each limit in each block of the record.
    sizes : numpy.ndarray
        Shape (B,), samples in each block; all but the last are equal.
    interval : float
        Duration of a block, s.
    period : float
        Period of a revolution, s.

    Returns
    -------
    below, sizes : numpy.ndarray
        The counts in at most `STRETCHES` phases that the record has, shapes (K, F) and (F,).

    Examples
    --------
    Two revolutions of three blocks:

    >>> folded_counts(np.array([[1, 0, 2, 3, 0, 0]]), np.full(6, 10), 1.0, 3.0)
    (array([[4., 0., 2.]]), array([20., 20., 20.]))
    """
    phase, _, phases = phases_of_blocks(sizes.size, interval, period, STRETCHES)
    counts = np.array([np.bincount(phase, row, phases) for row in (*below, sizes)])
    counts = counts[:, counts[-1] > 0]
    return counts[:-1], counts[-1]


def share_interval(
    below: npt.ArrayLike, sizes: npt.ArrayLike, windows: float, folded: Sequence[Counts] = ()
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    r"""Contact share of one record and its 95 % interval, from the scatter within the record.

    The interval is that of the mean over pairs of rollers, as far as one pair's record shows it.
    Neighbouring samples see the same roughness and are correlated; long stretches hardly are.
    The variance of the mean estimated from stretches grows with their length, until they are
    longer than the correlation of the record. It is estimated from blocks, from pairs of blocks,
    pairs of pairs and so on, and the largest estimate is used [1]_. Where rollers repeat
    themselves, stretches one revolution apart are correlated too; then the counts are folded by
    the revolution, and stretches of the circumference are used instead of stretches of time. The
    effective sample size follows from the variance :math:`s^2` of the share :math:`p`,

    .. math:: n = \frac{p (1 - p)}{s^2}

    Parameters
    ----------
    below : array_like
        Shape (K, B), samples in contact at each limit in each block of the record.
    sizes : array_like
        Shape (B,), samples in each block.
    windows : float
        Independent windows in the record, at least one; the sample size where the record does not
        scatter (`lube.statistics.confidence.probability_limits`).
    folded : sequence of tuple, optional
        The same counts by phase of a revolution, from `folded_counts`, for each roller.

    Returns
    -------
    share, lower, upper : numpy.ndarray
        Shape (K,) each.

    References
    ----------
    .. [1] H. Flyvbjerg, H. G. Petersen, Error estimates on averages of correlated data,
       J. Chem. Phys. 91 (1989) 461-466.

    Examples
    --------
    >>> share, lower, upper = share_interval([[2, 3, 1, 2] * 4], [10] * 16, windows=50.0)
    >>> share
    array([0.2])
    """
    below, sizes = np.asarray(below), np.asarray(sizes)
    share = below.sum(axis=-1) / sizes.sum()
    found = [(np.zeros(share.size), 1)]
    for counts in ((below, sizes), *folded):
        found += _variances(*counts)
    variances, degrees = (np.array(each) for each in zip(*found, strict=True))
    variance, degrees = variances.max(axis=0), degrees[variances.argmax(axis=0)]
    with np.errstate(divide="ignore", invalid="ignore"):
        samples = np.where(variance > 0.0, share * (1.0 - share) / variance, np.nan)
    return share, *probability_limits(share, samples, degrees, windows)


def _variances(below, sizes):
    """Yield the variance of the share by stretches of each length, and its degrees of freedom."""
    while sizes.size > MOST_STRETCHES:
        below, sizes = _pairs(below), _pairs(sizes)
    while sizes.size >= LEAST_BLOCKS:
        yield _variance(below, sizes), sizes.size - 1
        below, sizes = _pairs(below), _pairs(sizes)


def _variance(below, sizes):
    """Variance of the share over all blocks, which need not be equally long."""
    shares, weights = below / sizes, sizes / sizes.sum()
    excess = weights * (shares - (weights * shares).sum(axis=-1, keepdims=True))
    variance = sizes.size / (sizes.size - 1) * (excess**2).sum(axis=-1)
    # The shares themselves decide: the variance of equal shares need not round to zero.
    return np.where(np.ptp(shares, axis=-1) > 0.0, variance, 0.0)
