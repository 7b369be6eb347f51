r"""The example of a measured map that the study ships, in an instrument's format.

It is not measured: an isotropic self-affine surface of 256 x 256 points, 1.5625 um apart, with
:math:`H = 0.8`, a roll-off at 50 um and an rms height of 0.2 um, tilted by 3 um along x and 1 um
along y, with a few holes. X3P is the open format of ISO 25178-72. It is made again by

    python tests/example_surface.py workflow/config/surfaces/example.x3p
"""

import datetime
import io
import sys
import zipfile

import numpy as np
import scipy.fft

from lube.types import Array, File

POINTS = 256
LENGTH = 400e-6
HURST_EXPONENT = 0.8
ROLL_OFF = 50e-6
RMS_HEIGHT = 0.2e-6
_SEED = 25178


def rolled_off_surface(
    points: int,
    length: float,
    hurst_exponent: float,
    wavelength: float,
    rms_height: float,
    generator: np.random.Generator,
) -> Array:
    """Draw a periodic Gaussian surface, of constant density below the roll-off.

    Parameters
    ----------
    points : int
        Points n along either side.
    length : float
        Length of either side, m.
    hurst_exponent : float
        Hurst exponent H.
    wavelength : float
        Wavelength of the roll-off, m.
    rms_height : float
        Rms height, m, exactly that of the surface drawn.
    generator : numpy.random.Generator
        Source of randomness.

    Returns
    -------
    numpy.ndarray
        Shape (n, n), m.

    Examples
    --------
    >>> surface = rolled_off_surface(64, 1.0, 0.8, 0.2, 0.01, np.random.default_rng(1))
    >>> surface.shape, f"{np.std(surface):.4f}"
    ((64, 64), '0.0100')
    """
    along = scipy.fft.fftfreq(points, length / points)
    across = scipy.fft.rfftfreq(points, length / points)
    waves = np.maximum(np.hypot(along[:, None], across) * wavelength, 1.0)
    amplitudes = waves ** (-hurst_exponent - 1.0)
    amplitudes[0, 0] = 0.0
    noise = scipy.fft.rfft2(generator.standard_normal((points, points)))
    surface = scipy.fft.irfft2(amplitudes * noise, (points, points))
    return rms_height / np.std(surface) * surface


def example_heights() -> Array:
    """Heights of the example, shape (256, 256), m, NaN in holes."""
    generator = np.random.default_rng(_SEED)
    heights = rolled_off_surface(POINTS, LENGTH, HURST_EXPONENT, ROLL_OFF, RMS_HEIGHT, generator)
    place = np.arange(POINTS) / POINTS
    heights += 3e-6 * place[:, None] + 1e-6 * place
    for row, column in generator.integers(5, POINTS - 5, (8, 2)):
        heights[row : row + 3, column : column + 2] = np.nan
    return heights


def write_example(path: File) -> None:
    """Write the example, the same bytes each time.

    Parameters
    ----------
    path : str or Path
        The X3P file.
    """
    from SurfaceTopography import Topography

    surface = Topography(
        np.ma.masked_invalid(example_heights()),
        (LENGTH, LENGTH),
        unit="m",
        info={"acquisition_time": datetime.datetime(2026, 1, 1)},
    )
    written = io.BytesIO()
    surface.to_x3p(written, dtype="I", manufacturer="lube", model="synthetic", version="1")
    with zipfile.ZipFile(written) as parts, zipfile.ZipFile(path, "w") as file:
        for name in parts.namelist():  # the library's members have the time of writing
            member = zipfile.ZipInfo(name, (2026, 1, 1, 0, 0, 0))
            file.writestr(member, parts.read(name), zipfile.ZIP_DEFLATED)


if __name__ == "__main__":
    write_example(sys.argv[1])
