r"""The computed film: Reynolds' equation between elastic rollers, solved numerically.

Everything here is scaled by Hertz' dry contact: positions :math:`X = x / a` by its half-width,
pressures :math:`P = p / p_H` by its maximum pressure, films :math:`H = h R^* / a^2`. The oil enters
at negative positions. The entry point is `lube.ehl.line_contact.solve`.
"""
