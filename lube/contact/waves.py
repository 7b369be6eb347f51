"""Waves of rough lines in the gap: a formula flattens them, or the computed film answers them."""

from dataclasses import dataclass
from typing import ClassVar, Self

import numpy as np
import scipy
import xarray as xr

from lube.digits import six_digits
from lube.ehl.line_contact import one_blas_thread
from lube.ehl.response import at_wavelengths
from lube.grid.discretise import LineGrid
from lube.kernels.motion import surface_position
from lube.kernels.runs import BLOCK_SHIFT
from lube.kernels.shaped import Surface, answer_at
from lube.physics.flattening import amplitude_ratio
from lube.physics.hertz import hertz_gap
from lube.types import Array, Pair, Ratios

PRECISION = 0.01
"""Largest error of the answers to rough lines, over the rms height of the lines."""
FINER = 4
"""Number of wavelengths at which answers are expanded, for each of the stored wavelengths."""
STEEPNESS = 0.7
"""Waves are weighted by this power of their length, since long waves of rough surfaces are high."""
NODES = 20
"""Least number of nodes in a half-width of the contact."""


@dataclass(frozen=True, eq=False)
class Answer:
    r"""What the oil adds to the waves of a surface at an operating point.

    The response of the film is expanded in functions of the position X and of the wavenumber k,

    .. math:: T_k(X) - 1 = \sum_m u_m(X)\, f_m(k)

    with real :math:`u_m`, as many as `PRECISION` needs where lines may touch.

    Attributes
    ----------
    half_width : float
        Half-width of the contact, m.
    position : numpy.ndarray, shape (n,)
        Positions over the half-width, rising.
    shapes : numpy.ndarray, shape (n, M)
        :math:`u_m` at these positions.
    wavenumber : numpy.ndarray, shape (K,)
        Wavenumbers, rad/m, rising. The oil does not change shorter waves.
    filters : numpy.ndarray of complex, shape (K, M)
        :math:`f_m` at these wavenumbers.
    response, waves
        Variable of the response without its ending, and dimensions of the waves, in ``film.nc``.
    coarsest : int
        Largest `shift`.
    """

    half_width: float
    position: Array
    shapes: Array
    wavenumber: Array
    filters: Array
    response: ClassVar[str] = "response"
    waves: ClassVar[tuple[str, ...]] = ("wavelength",)
    coarsest: ClassVar[int] = BLOCK_SHIFT

    @classmethod
    def of(cls, response: Array, levels: list[Array], half_width: float, importance: Array) -> Self:
        """Expand a response of the film.

        Parameters
        ----------
        response : numpy.ndarray of complex, shape (w, n)
            The response.
        levels : list of numpy.ndarray
            Wavelengths in m, falling, shape (w,), and positions over the half-width, rising,
            shape (n,).
        half_width : float
            Half-width of the contact, m.
        importance : numpy.ndarray, shape (n,)
            Weight of an error at each position, 1 at most.

        Returns
        -------
        Answer
            The expansion.
        """
        wavelength, position = levels
        changed = np.flatnonzero(np.abs(response - 1.0).max(axis=1))
        last = changed[-1] if changed.size else 1
        finer = np.geomspace(wavelength[0], wavelength[last], FINER * last + 1)
        answer = at_wavelengths(finer / half_width, wavelength / half_width, response, position)
        shapes, filters = expanded(answer - 1.0, finer**STEEPNESS, importance)
        return cls(half_width, position, shapes, 2.0 * np.pi / finer, filters)

    def shift(self, spacing: float) -> int:
        """Binary logarithm of the number of points, at this spacing in m, from node to node."""
        points = self.half_width / (NODES * spacing)
        return int(np.log2(np.clip(points, 1, 2**self.coarsest)))

    def at(self, position: Array) -> Array:
        """Functions :math:`u_m` at positions over the half-width, shape (positions, M)."""
        known = np.clip(position, *self.position[[0, -1]])
        return scipy.interpolate.CubicSpline(self.position, self.shapes)(known)

    def at_points(self, points: Array, spacing: float) -> Array:
        """Functions :math:`u_m` at points counted from the centre with the motion, (points, M)."""
        return self.at(points * (spacing / self.half_width))


def expanded(change: Array, weight: Array, importance: Array) -> Pair:
    """Expand the change of waves by the oil in functions of the position and of the wave.

    Parameters
    ----------
    change : numpy.ndarray of complex, shape (K, n)
        Response less 1, for K waves at n positions.
    weight : numpy.ndarray, shape (K,)
        Height of the waves.
    importance : numpy.ndarray, shape (n,)
        Weight of an error at each position, 1 at most.

    Returns
    -------
    shapes : numpy.ndarray, shape (n, M)
        Functions of the position, to six digits.
    filters : numpy.ndarray of complex, shape (K, M)
        Functions of the wave, to six digits: as many as `PRECISION` needs.
    """
    weighted = np.concatenate([change.real, change.imag]) * np.tile(weight[:, None], (2, 1))
    left, values, right = np.linalg.svd(weighted * importance, full_matrices=False)
    # Largest square error of all positions if the first 0, 1, ... functions are kept.
    parts = (values[:, None] * right) ** 2
    errors = np.cumsum(parts[::-1], axis=0)[::-1].max(axis=1)
    count = np.count_nonzero(errors > PRECISION**2 * np.sum(weight[:, None] ** 2))
    shapes = np.einsum("km,kx->xm", left[:, :count], weighted)
    filters = np.einsum("kx,mx->km", change * importance, right[:count]) / values[:count]
    return six_digits(shapes), six_digits(filters.real) + 1j * six_digits(filters.imag)


def longest_answers(film: xr.Dataset) -> list[xr.DataArray]:
    """Return the response to both rollers' longest wave at the line of centres.

    It distinguishes operating points that differ only in slip.

    Parameters
    ----------
    film : xarray.Dataset
        As in `answers_at`.

    Returns
    -------
    list of xarray.DataArray
        Complex responses for the first and the second roller, over the other dimensions.
    """
    response = film["response_real"] + 1j * film["response_imaginary"]
    longest = response.isel(wavelength=0).sel(response_position=0.0, drop=True)
    return [longest.isel(roller=roller, drop=True) for roller in (0, 1)]


def answers_at(film: xr.Dataset, has_shape: bool, kind: type[Answer] = Answer) -> xr.DataArray:
    """Answers of the oil to the roughness of both rollers.

    Parameters
    ----------
    film : xarray.Dataset
        A ``film`` dataset, or rows of one, with the film's response.
    has_shape : bool
        Whether the rollers may touch outside the contact too.
    kind : type, optional
        `Answer` to lines, or `lube.contact.surface_answers.SurfaceAnswer`.

    Returns
    -------
    xarray.DataArray
        Over roller and the dimensions of the response: an answer, or None where the response is not
        known. Both rollers have the same object where the film responds to both alike.
    """
    response = film[f"{kind.response}_real"] + 1j * film[f"{kind.response}_imaginary"]
    names = [*kind.waves, "response_position"]
    *_, position = levels = [response[name].values for name in names]

    def of_both(response, half_width, radius, roughness):
        gap = hertz_gap(position) * (half_width**2 / radius)
        importance = np.exp(-gap / roughness) if has_shape else np.abs(position) <= 1.0
        answers = np.full(2, None)
        for roller, one in enumerate(response):
            if roller and np.array_equal(one, response[0]):
                answers[1] = answers[0]
            elif np.isfinite(one).all():
                with one_blas_thread():
                    answers[roller] = kind.of(one, levels, half_width, importance)
        return answers

    contact = "contact_half_width", "reduced_radius", "composite_rms_roughness"
    core = {"input_core_dims": [["roller", *names], [], [], []], "output_core_dims": [["roller"]]}
    options = {"vectorize": True, "output_dtypes": [object]}
    return xr.apply_ufunc(of_both, response, *(film[name] for name in contact), **core, **options)


def lifted(
    lines: Pair, grid: LineGrid, answers: Pair, ratios: Ratios, step: int, window: Array
) -> Array:
    """Compute what the oil adds to two lines in the contact window of a trace.

    Parameters
    ----------
    lines : tuple of numpy.ndarray
        Heights of both lines, int32 height steps.
    grid : LineGrid
        Their grid.
    answers : tuple of Answer
        Answers to both surfaces.
    ratios : tuple of float
        Surface speeds over that of the faster surface.
    step : int
        Time step.
    window : numpy.ndarray of int, shape (W,)
        Points of the window, counted from its centre.

    Returns
    -------
    numpy.ndarray of int64, shape (2, W)
        What is added to each line, height steps; the sum is that of
        `lube.kernels.shaped.shaped_trace`.
    """
    shift = answers[0].shift(grid.spacing)
    nodes = np.arange(window[0] >> shift, (window[-1] >> shift) + 2) << shift
    begin = step >> shift << shift
    at_nodes = np.zeros((2, 2, nodes.size))
    for roller, (line, answer) in enumerate(zip(lines, answers, strict=True)):
        shapes = answer.at_points(-nodes, grid.spacing)
        surface = Surface(line, line, Waves(line, grid).filtered(answer), shapes)
        for time in (0, 1):
            moved = surface_position(begin + (time << shift), ratios[roller])
            at_nodes[time, roller] = [
                answer_at(surface, moved + nodes[0], 1 << shift, node) for node in range(nodes.size)
            ]
    at_nodes[:, 1] += at_nodes[:, 0]
    now, then = np.rint(at_nodes).astype(np.int64)
    whole = now + ((then - now) * (step - begin) >> shift)
    number, part = (window - nodes[0]) >> shift, window & ((1 << shift) - 1)
    first, both = whole[:, number] + (np.diff(whole)[:, number] * part >> shift)
    return np.array([first, both - first])


class Waves:
    """Waves of a line, to be flattened by a formula or filtered by an answer of the oil.

    Parameters
    ----------
    line : numpy.ndarray
        Heights, shape (N,), height steps.
    grid : LineGrid
        Grid of the line. Waves shorter than its band come from the rounding to whole height steps,
        and are left out.
    """

    def __init__(self, line: Array, grid: LineGrid) -> None:
        self._unit = 2.0 * np.pi / (line.size * grid.spacing)
        last = int(grid.q_max / self._unit * (1.0 + 1e-9))
        self._size, self._spacing = line.size, grid.spacing
        self._waves = scipy.fft.rfft(line.astype(float))[1 : last + 1]

    def flattened(self, half_width: float, moes_load: float, moes_material: float) -> Array:
        """Heights of the line flattened by `lube.physics.flattening.amplitude_ratio`.

        Parameters
        ----------
        half_width : float
            Half-width of the contact, m.
        moes_load, moes_material : float
            M and L.

        Returns
        -------
        numpy.ndarray
            Shape (N,), int32 height steps.
        """
        wavelength = 2.0 * np.pi / (self._unit * np.arange(1, self._waves.size + 1))
        kept = amplitude_ratio(wavelength / half_width, moes_load, moes_material)
        return np.rint(self._line(self._waves * kept, self._size)).astype(np.int32)

    def filtered(self, answer: Answer | None) -> Array:
        """Filter the line by each function of an answer, on a coarser grid.

        The line is passed against the direction in which positions are counted, so its waves are
        conjugate.

        Parameters
        ----------
        answer : Answer or None
            The answer of the oil; None if it does not answer.

        Returns
        -------
        numpy.ndarray
            As in `lube.kernels.shaped.Surface`.
        """
        if answer is None:
            return np.zeros((2, 0), np.float32)
        count = min(self._waves.size, int(answer.wavenumber[-1] / self._unit))
        wavenumber = np.log(self._unit * np.arange(1, count + 1))
        size = max(-(-self._size >> answer.shift(self._spacing)), 2 * count + 2)
        size = scipy.fft.next_fast_len(size, real=True)
        lines = np.empty((size + 1, answer.filters.shape[1]), np.float32)
        for m, own in enumerate(answer.filters.T):
            kept = np.interp(wavenumber, np.log(answer.wavenumber), own)
            lines[:-1, m] = self._line(self._waves[:count] * kept.conj(), size)
        lines[-1] = lines[0]
        return lines

    def _line(self, waves, size):
        """Sum of waves on a grid of some points."""
        spectrum = np.zeros(size // 2 + 1, complex)
        spectrum[1 : waves.size + 1] = waves * (size / self._size)
        return scipy.fft.irfft(spectrum, size, overwrite_x=True)
