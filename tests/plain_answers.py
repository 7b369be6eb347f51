"""What the oil adds to a rough line in the contact window, wave by wave."""

import numpy as np
from scipy.interpolate import CubicSpline

from lube.ehl.response import at_wavelengths


class PlainAnswer:
    """Answer to lines of one size at some points of the window, counted from its centre.

    A film response at an operating point and roller gives the change T - 1 of every single wave at
    every point; nothing is expanded, and no coarser grid is used.
    """

    def __init__(self, size, spacing, film, points):
        half_width = film["contact_half_width"].item()
        solved = film["wavelength"].values / half_width
        count = int(size * spacing / (solved[-1] * half_width))
        self.numbers, self.size = np.arange(1, count + 1), size
        wavelength = size * spacing / self.numbers / half_width
        response = film["response_real"].values + 1j * film["response_imaginary"].values
        known = film["response_position"].values
        change = at_wavelengths(wavelength, solved, response, known) - 1.0
        # Points of a line are passed against the direction in which positions are counted.
        position = np.clip(-points * spacing / half_width, *known[[0, -1]])
        self.change = CubicSpline(known, change, axis=1)(position).T.conj()
        self.phase = np.exp(2j * np.pi * np.outer(points, self.numbers) / size)

    def _waves(self, line):
        return 2.0 * np.fft.rfft(line.astype(float))[self.numbers] / self.size

    def lift(self, line, place):
        """Heights that the oil adds when this point of a line is at the window's centre."""
        phase = np.exp(2j * np.pi * self.numbers * place / self.size)
        return ((self.change * self.phase) @ (self._waves(line) * phase)).real

    def lifts(self, line, places):
        """The same for each of the first points of the line, one row each."""
        rows, waves = np.empty((places, len(self.change))), self._waves(line)
        for row, change, phase in zip(rows.T, self.change, self.phase, strict=True):
            spectrum = np.zeros(self.size // 2 + 1, complex)
            spectrum[self.numbers] = 0.5 * self.size * change * phase * waves
            row[:] = np.fft.irfft(spectrum, self.size)[:places]
        return rows
