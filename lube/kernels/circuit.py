"""What an amplifier makes of a contact that comes and goes."""

import numpy as np

from lube.kernels.compiler import kernel


@kernel
def sampled_voltage(contact, targets, memories, gain, offset, limit, passed, ratio, samples):
    """Run the contact through film capacitance, amplifier and low-pass, and sample it.

    At every time step the voltage over the gap approaches its target, which the contact
    sets, exactly as over a resistance that stays for the step; the low-pass takes the
    amplified voltage at the end of the step for all of it.

    Parameters
    ----------
    contact : numpy.ndarray
        Shape (T,), points in metallic contact at each time step.
    targets : numpy.ndarray
        Shape (W + 1,): voltage that the gap approaches with so many points in contact, V.
    memories : numpy.ndarray
        Shape (W + 1,): share of the distance to the target that is left after a time step.
    gain, offset : float
        The amplifier sees ``gain * gap voltage + offset``, V.
    limit : float
        Voltage of either sign at which the amplifier saturates, V.
    passed : float
        Share of its distance to the input that the low-pass keeps for a time step.
    ratio : float
        Time steps per sample.
    samples : int
        How many samples, the first at the first time step.

    Returns
    -------
    numpy.ndarray
        Shape (samples,), float64, V.
    """
    record = np.empty(samples)
    gap = targets[contact[0]]
    open_input = min(max(gain * targets[0] + offset, -limit), limit)
    voltage = min(max(gain * gap + offset, -limit), limit)
    settled = 1e-9 * abs(targets[0])
    step = 0
    for sample in range(samples):
        last = min(int(sample * ratio), contact.size - 1)
        touched = 0
        for i in range(step, last + 1):  # without a branch, so the compiler vectorises it
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
