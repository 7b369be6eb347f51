"""Counting the samples of a record that lie below limits, block by block.

The blocks of a record are equally long, a power of two of samples, and follow one another
from its first sample on: sample n lies in block n >> doublings.
"""

import numpy as np

from lube.kernels.compiler import kernel

CHUNK = 4096
"""Values held against all limits at a time; so many stay in the nearest cache."""


@kernel
def count_below(values, seen, doublings, limits, counts):
    """Add a piece of a record to the number of samples below each limit.

    Parameters
    ----------
    values : numpy.ndarray
        Shape (N,), the piece.
    seen : int
        Samples of the record before this piece.
    doublings : int
        Binary logarithm of the samples in a block.
    limits : numpy.ndarray
        Shape (K,), in the unit of `values`.
    counts : numpy.ndarray
        Shape (K, B), int64: samples below each limit in each block, added to in place.
    """
    begin = 0
    while begin < values.size:
        block = (seen + begin) >> doublings
        end = min(values.size, begin + CHUNK, ((block + 1) << doublings) - seen)
        chunk = values[begin:end]
        for k in range(limits.size):
            limit, count = limits[k], 0
            for i in range(chunk.size):
                count += chunk[i] < limit
            counts[k, block] += count
        begin = end


@kernel
def follow_contact(values, seen, doublings, limits, releases, hold, states, counts):
    """Add a piece of a record to the number of samples in contact, with hysteresis and hold.

    A trigger closes where a value is below the limit, and opens where one is not below the
    release. Contact follows the trigger once that has stayed changed for `hold` samples, and
    then from the first of them on. Before the record there is no contact.

    Parameters
    ----------
    values, seen, doublings
        As in `count_below`.
    limits, releases : numpy.ndarray
        Shape (K,), in the unit of `values`.
    hold : int
        Samples that a change must last; 0 and 1 mean the same.
    states : numpy.ndarray
        Shape (K, 3), int64, zeros before the record, updated in place: trigger closed, in
        contact, and samples since the two differ.
    counts : numpy.ndarray
        Shape (K, B), int64: samples in contact in each block, added to in place.
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
