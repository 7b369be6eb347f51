"""What the oil adds to a rough line in the contact window, wave by wave."""

import numpy as np
from scipy.interpolate import CubicSpline

from lube.ehl.response import at_wavelengths


class PlainAnswer:
    """Answer to one line at some points of the window, counted from its centre.

    A film response at an operating point and roller gives the change T - 1 of every single wave at
    every point; nothing is expanded, and no coarser grid is used.
    """

    def __init__(self, line, spacing, film, points):
        half_width = film["contact_half_width"].item()
        solved = film["wavelength"].values / half_width
        count = int(line.size * spacing / (solved[-1] * half_width))
        self.numbers, self.size = np.arange(1, count + 1), line.size
        self.waves = 2.0 * np.fft.rfft(line.astype(float))[1 : count + 1] / line.size
        wavelength = line.size * spacing / self.numbers / half_width
        response = film["response_real"].values + 1j * film["response_imaginary"].values
        known = film["response_position"].values
        change = at_wavelengths(wavelength, solved, response, known) - 1.0
        # Points of a line are passed against the direction in which positions are counted.
        position = np.clip(-points * spacing / half_width, *known[[0, -1]])
        self.change = CubicSpline(known, change, axis=1)(position).T.conj()
        self.phase = np.exp(2j * np.pi * np.outer(points, self.numbers) / line.size)

    def lift(self, place):
        """Heights that the oil adds when this point of the line is at the window's centre."""
        phase = np.exp(2j * np.pi * self.numbers * place / self.size)
        return ((self.change * self.phase) @ (self.waves * phase)).real

    def lifts(self, places):
        """The same for each of the first points of the line, one row each."""
        rows = np.empty((places, len(self.change)))
        for row, change, phase in zip(rows.T, self.change, self.phase, strict=True):
            spectrum = np.zeros(self.size // 2 + 1, complex)
            spectrum[self.numbers] = 0.5 * self.size * change * phase * self.waves
            row[:] = np.fft.irfft(spectrum, self.size)[:places]
        return rows
