"""The measuring circuit: film capacitance, amplifier, low-pass filter and sampling."""

import numpy as np

from lube.kernels.compiler import kernel
from lube.types import Array


@kernel
def sampled_voltage(
    contact: Array,
    targets: Array,
    decays: Array,
    gain: float,
    offset: float,
    limit: float,
    filter_decay: float,
    steps_per_sample: float,
    samples: int,
) -> Array:
    r"""Compute the sampled voltage of a contact that is known at every time step.

    In a time step the contact resistance is constant, so the voltage over the gap, which charges
    the film's capacitance, approaches a steady value exponentially. The amplifier limits it, and
    its value at the end of the step is the input of the low-pass filter:

    .. math::

        u_i &= u_\infty(w_i) + (u_{i-1} - u_\infty(w_i)) \, m(w_i) \\
        v_i &= a_i + (v_{i-1} - a_i) \, k, \qquad a_i = [g u_i + o]_{-l}^{l}

    An open gap within a billionth of its steady voltage is taken as steady. Then only the filter
    changes, in one calculation per sample.

    Parameters
    ----------
    contact : numpy.ndarray
        Shape (T,), number w of points in metal contact at each time step.
    targets : numpy.ndarray
        Shape (W + 1,), steady voltage over the gap for each number of points, V.
    decays : numpy.ndarray
        Shape (W + 1,), factor m by which the distance to the steady voltage shrinks in one time
        step.
    gain, offset : float
        Gain g and offset o (V): the amplifier's input is ``gain * gap voltage + offset``.
    limit : float
        Voltage l of either sign at which the amplifier saturates, V.
    filter_decay : float
        Factor k by which the filter's distance to its input shrinks in one time step.
    steps_per_sample : float
        Time steps per sample.
    samples : int
        Number of samples, the first at the first time step.

    Returns
    -------
    numpy.ndarray
        Shape (samples,), float64, V.

    Examples
    --------
    Open for two steps, then in contact; a capacitance that halves the distance in each step:

    >>> contact = np.array([0, 0, 1, 1], np.int32)
    >>> targets, decays = np.array([1.0, 0.0]), np.array([0.5, 0.5])
    >>> sampled_voltage(contact, targets, decays, 1.0, 0.0, 9.0, 0.0, 1.0, 4)
    array([1.  , 1.  , 0.5 , 0.25])
    """
    record = np.empty(samples)
    gap = targets[contact[0]]
    open_input = min(max(gain * targets[0] + offset, -limit), limit)
    voltage = min(max(gain * gap + offset, -limit), limit)
    settled = 1e-9 * abs(targets[0])
    step = 0
    for sample in range(samples):
        last = min(int(sample * steps_per_sample), contact.size - 1)
        touched = 0
        # Without a branch, so the compiler vectorises it.
        for i in range(np.uint64(step), np.uint64(last + 1)):
            touched |= contact[i]
        if touched == 0 and abs(gap - targets[0]) < settled:
            gap = targets[0]
            voltage = open_input + (voltage - open_input) * filter_decay ** (last + 1 - step)
        else:
            for i in range(step, last + 1):
                target = targets[contact[i]]
                gap = target + (gap - target) * decays[contact[i]]
                seen = min(max(gain * gap + offset, -limit), limit)
                voltage = seen + (voltage - seen) * filter_decay
        record[sample] = voltage
        step = last + 1
    return record
