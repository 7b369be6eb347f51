"""The measuring circuit: film capacitance, amplifier, low-pass filter and sampling."""

import numpy as np

from lube.kernels.compiler import kernel
from lube.types import Array, Pair

Triple = tuple[float, float, float]


@kernel
def sampled_voltage(
    contact: Array, gap_states: Pair, amplifier: Triple, passed: float, ratio: float, samples: int
) -> Array:
    r"""Compute the sampled voltage of a contact that is known at every time step.

    In a time step the contact resistance is constant, so that the voltage over the gap, which
    charges the film's capacitance, approaches its target exponentially. The amplifier limits it,
    and the low-pass filter takes its value at the end of the step as the input:

    .. math::

        u_i &= u_\infty(w_i) + (u_{i-1} - u_\infty(w_i)) \, m(w_i) \\
        v_i &= a_i + (v_{i-1} - a_i) \, k, \qquad a_i = [g u_i + o]_{-l}^{l}

    Parameters
    ----------
    contact : numpy.ndarray
        Shape (T,), number w of points in metallic contact at each time step.
    gap_states : tuple of numpy.ndarray
        For each number of points, shape (W + 1,): the steady voltage over the gap, V, and the
        factor m of the distance to it in one time step.
    amplifier : tuple of float
        Gain g and offset o (V): its input is ``gain * gap voltage + offset``. Last the voltage l
        of either sign at which it saturates, V.
    passed : float
        Factor k of the filter's distance to its input in one time step.
    ratio : float
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
    >>> gap_states = np.array([1.0, 0.0]), np.array([0.5, 0.5])
    >>> sampled_voltage(contact, gap_states, (1.0, 0.0, 9.0), 0.0, 1.0, 4)
    array([1.  , 1.  , 0.5 , 0.25])
    """
    (targets, memories), (gain, offset, limit) = gap_states, amplifier
    record = np.empty(samples)
    gap = targets[contact[0]]
    open_input = min(max(gain * targets[0] + offset, -limit), limit)
    voltage = min(max(gain * gap + offset, -limit), limit)
    settled = 1e-9 * abs(targets[0])
    step = 0
    for sample in range(samples):
        last = min(int(sample * ratio), contact.size - 1)
        touched = 0
        for i in range(step, last + 1):  # without a branch, so that the compiler vectorises it
            touched |= contact[i]
        if touched == 0 and abs(gap - targets[0]) < settled:
            gap = targets[0]
            voltage = open_input + (voltage - open_input) * passed ** (last + 1 - step)
        else:
            for i in range(step, last + 1):
                target = targets[contact[i]]
                gap = target + (gap - target) * memories[contact[i]]
                seen = min(max(gain * gap + offset, -limit), limit)
                voltage = seen + (voltage - seen) * passed
        record[sample] = voltage
        step = last + 1
    return record
