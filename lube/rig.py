"""From metallic contact to the voltage that a twin-disc rig logs.

A bias voltage drives a current through a series resistor, the leads and the contact. The film
around the contact is a capacitor, and some current leaks past it. An amplifier of finite range
looks at the voltage over leads and contact; what it gives is low-pass filtered, sampled, and
rounded to the steps of the converter.

    bias --[ series ]--+--[ leads ]--+-- contact --+
                       |             +-- leak -----+-- ground
                   amplifier         +-- film -----+
"""

import numpy as np

from lube.kernels.circuit import sampled_voltage
from lube.resistance import contact_resistance


def logged_voltage(contact, time_step, spot_resistance, capacitance, rig, generator):
    """Record that the rig logs of a contact that is known at every time step.

    Parameters
    ----------
    contact : numpy.ndarray
        Shape (T,), points in metallic contact at each time step.
    time_step : float
        Time between two steps, s.
    spot_resistance : float
        Contact resistance of one point, rho / dx, ohm (paper, Eq. 1).
    capacitance : float
        Of the film, F.
    rig : Rig
        Circuit, amplifier and sampling.
    generator : numpy.random.Generator
        Source of the noise.

    Returns
    -------
    numpy.ndarray
        Shape (samples,), float64, V, whole steps of the converter.
    """
    points = np.arange(contact.max() + 1)
    feed = rig.series_resistance + rig.lead_resistance
    conductance = 1.0 / contact_resistance(points, spot_resistance) + 1.0 / rig.leak_resistance
    targets = rig.bias_voltage / (1.0 + feed * conductance)
    memories = np.exp(-time_step * (conductance + 1.0 / feed) / capacitance)
    gain = rig.series_resistance / feed
    voltage = sampled_voltage(
        contact,
        targets,
        memories,
        gain,
        rig.bias_voltage * (1.0 - gain),
        rig.amplifier_range,
        np.exp(-2.0 * np.pi * rig.bandwidth * time_step),
        1.0 / (rig.sampling_rate * time_step),
        int(contact.size * time_step * rig.sampling_rate) or 1,
    )
    voltage += rig.noise * generator.standard_normal(voltage.size, np.float32)
    steps = np.rint(voltage / rig.resolved_voltage)
    most = 2 ** (rig.resolution - 1)
    return np.clip(steps, -most, most - 1) * rig.resolved_voltage
