"""Counts of a record's samples below limits, block by block.

All blocks of a record have the same number of samples, a power of two: sample n is in block
n >> doublings.
"""

import numpy as np

from lube.kernels.compiler import kernel
from lube.types import Array


@kernel
def count_below(values: Array, seen: int, doublings: int, limits: Array, counts: Array) -> None:
    """Count the samples of a piece of a record below each limit.

    Parameters
    ----------
    values : numpy.ndarray
        Shape (N,), the piece.
    seen : int
        Number of samples of the record before this piece.
    doublings : int
        Binary logarithm of the number of samples in a block.
    limits : numpy.ndarray
        Shape (K,), in the unit of `values`.
    counts : numpy.ndarray
        Shape (K, B), int64: samples below each limit in each block, increased in place.

    Examples
    --------
    Blocks of two samples:

    >>> counts = np.zeros((1, 3), np.int64)
    >>> count_below(np.array([0.0, 0.0, 9.0, 0.0, 9.0]), 0, 1, np.array([1.0]), counts)
    >>> counts
    array([[2, 1, 0]])
    """
    for block in range(seen >> doublings, ((seen + values.size - 1) >> doublings) + 1):
        begin = (block << doublings) - seen
        part = values[max(begin, 0) : begin + (1 << doublings)]
        for k in range(limits.size):
            limit, count = limits[k], 0
            for i in range(part.size):
                count += part[i] < limit
            counts[k, block] += count


@kernel
def follow_contact(
    values: Array,
    seen: int,
    doublings: int,
    limits: Array,
    releases: Array,
    hold: int,
    states: Array,
    counts: Array,
) -> None:
    """Count the samples of a piece of a record in contact, with hysteresis and hold time.

    A trigger closes where a value is below the limit, and opens where a value is not below the
    release. A change of the trigger becomes a change of contact if it lasts `hold` samples, and
    then from the first of them on. Before the record there is no contact.

    Parameters
    ----------
    values, seen, doublings
        As in `count_below`.
    limits, releases : numpy.ndarray
        Shape (K,) each, in the unit of `values`.
    hold : int
        Number of samples that a change must last; 0 and 1 have the same effect.
    states : numpy.ndarray
        Shape (K, 3), int64, zeros before the record, updated in place: whether the trigger is
        closed, whether there is contact, and for how many samples the two have differed.
    counts : numpy.ndarray
        Shape (K, B), int64: samples in contact in each block, increased in place.

    Examples
    --------
    One contact, from the value below 1 to the value that reaches 2:

    >>> counts, states = np.zeros((1, 3), np.int64), np.zeros((1, 3), np.int64)
    >>> values, limits = np.array([9.0, 0.5, 1.5, 2.0, 1.5]), np.array([1.0])
    >>> follow_contact(values, 0, 1, limits, 2.0 * limits, 0, states, counts)
    >>> counts
    array([[1, 1, 0]])
    """
    for k in range(limits.size):
        closed, contact, lasting = states[k]
        for i in range(values.size):
            sample = seen + i
            closed = np.int64(values[i] < (releases[k] if closed else limits[k]))
            counts[k, sample >> doublings] += contact
            lasting = lasting + 1 if closed != contact else 0
            if lasting > 0 and lasting >= hold:
                for past in range(sample - lasting + 1, sample + 1):
                    counts[k, past >> doublings] += closed - contact
                contact, lasting = closed, 0
        states[k] = closed, contact, lasting
