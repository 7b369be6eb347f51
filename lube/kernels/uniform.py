"""Looking through the samples of a record for the first that breaks uniform sampling."""

import numpy as np

from lube.kernels.compiler import kernel
from lube.kernels.threshold import CHUNK


@kernel
def first_uneven(times, before, interval):
    """Find the first step of time that is no sampling interval, by more than its half.

    Parameters
    ----------
    times : numpy.ndarray
        Shape (N,) and N > 0, s.
    before : float
        Time of the sample before them, s.
    interval : float
        Sampling interval, s.

    Returns
    -------
    int
        Index of the sample after the step, -1 if there is none. NaN is no step.
    """
    least, most = 0.5 * interval, 1.5 * interval
    if not least < times[0] - before < most:
        return 0
    for begin in range(1, times.size, CHUNK):
        end = min(begin + CHUNK, times.size)
        even = 0
        for i in range(begin, end):  # without a way out, for the sake of speed
            step = times[i] - times[i - 1]
            even += (least < step) & (step < most)
        if even < end - begin:
            for i in range(begin, end):
                if not least < times[i] - times[i - 1] < most:
                    return i
    return -1


@kernel
def first_unsound(values, highest):
    """Find the first value that is NaN, minus infinity or above the highest.

    Parameters
    ----------
    values : numpy.ndarray
        Shape (N,).
    highest : float
        Value that is still allowed.

    Returns
    -------
    int
        Index of the value, -1 if there is none.
    """
    for begin in range(0, values.size, CHUNK):
        end = min(begin + CHUNK, values.size)
        sound = 0
        for i in range(begin, end):
            sound += (values[i] > -np.inf) & (values[i] <= highest)
        if sound < end - begin:
            for i in range(begin, end):
                if not -np.inf < values[i] <= highest:
                    return i
    return -1
