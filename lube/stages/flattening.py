"""The flattening stage: contact of lines whose long waves the oil has flattened."""

from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor

import numpy as np
import scipy.fft
import xarray as xr

from lube.grid.discretise import layer_factor_of, whole_numbers
from lube.grid.operating_points import at_slip
from lube.kernels.strips import strip_statistics
from lube.physics.flattening import amplitude_ratio
from lube.rig.map_curves import windows_in
from lube.schema import POINT_DIMS, label, values_with_limits
from lube.statistics.confidence import probability_interval, ratio_interval
from lube.study.line_spec import LineSpec
from lube.study.rollers import BoundaryLayer
from lube.surfaces.spectra import line_attributes
from lube.surfaces.synthetic import draw_realisation

ROUGHNESS_MODELS = ("undeformed", "flattened")


def flattened_contact(
    spec: LineSpec,
    film: xr.Dataset,
    boundary_layer: BoundaryLayer,
    seed: int,
    realisations: Sequence[int],
    threads: int = 1,
) -> xr.Dataset:
    """Compute contact with the lines as drawn, and as the oil flattens them.

    Parameters
    ----------
    spec : LineSpec
        Parameters of the lines; `Study.line_spec` of a study.
    film : xarray.Dataset
        A ``film`` dataset; its first film formula is used.
    boundary_layer : BoundaryLayer
        The boundary layer.
    seed : int
        Seed of the study.
    realisations : sequence of int
        Realisations of the lines.
    threads : int, optional
        Threads that share the work; they do not change the results.

    Returns
    -------
    xarray.Dataset
        The ``flattening`` file of `lube.schema`, in pure rolling.
    """
    film = at_slip(film).isel(film_formula=0).transpose(*POINT_DIMS, ...)
    points = _Points(spec, film, boundary_layer)

    def run(number):
        return points.run(draw_realisation(spec, seed, number))

    with ThreadPoolExecutor(threads) as pool:
        probabilities, ratios = zip(*pool.map(run, realisations), strict=True)
    dims = ("realisation", "roughness_model", *POINT_DIMS)
    probability = np.stack(probabilities).reshape(-1, len(ROUGHNESS_MODELS), *points.shape)
    # From the same lines; NaN where no contact was seen.
    ratio = ratio_interval(probability[:, 1], probability[:, 0])
    table = xr.Dataset(
        {
            "breakthrough_probability": (dims, probability),
            **_limited(probability, dims[1:], points.windows),
            **values_with_limits(
                "probability_ratio",
                [(POINT_DIMS, each) for each in ratio],
            ),
            "roughness_ratio": (POINT_DIMS, np.mean(ratios, axis=0).reshape(points.shape)),
            "lambda_ratio": film["lambda_ratio"].drop_attrs(),
        },
        {name: film[name] for name in POINT_DIMS}
        | {"realisation": np.asarray(realisations), "roughness_model": list(ROUGHNESS_MODELS)}
        | {"revolutions": 1},
    )
    formula = film["film_formula"].item()
    table = table.drop_vars("film_formula", errors="ignore").assign(film_formula=formula)
    return label(table, "flattening")


class _Points:
    """All operating points, flat lists in the order of `POINT_DIMS`."""

    def __init__(self, spec, film, boundary_layer):
        thickness, half_width = xr.broadcast(film["film_thickness"], film["contact_half_width"])
        half_width = half_width.transpose(*POINT_DIMS)
        lines = xr.Dataset(attrs=line_attributes(spec))
        self.shape = thickness.shape
        self.films, self.half_windows = whole_numbers(
            thickness.values.ravel(), half_width.values.ravel(), lines
        )
        self.factor = layer_factor_of(lines, film["reduced_modulus"].item(), boundary_layer)
        load = film["moes_load"].transpose(*POINT_DIMS)
        material = film["moes_material"].broadcast_like(load).transpose(*POINT_DIMS)
        numbers = (each.values.ravel() for each in (half_width, load, material))
        self.contacts = list(zip(*numbers, strict=True))
        self.spacing, self.q_max = spec.spacing, spec.q_max
        travel = xr.Dataset(
            attrs={
                "travel": spec.spacing * min(spec.points),
                "longest_wavelength": 2.0 * np.pi / spec.q_min,
            }
        )
        self.windows = windows_in(travel, 2.0 * half_width.values)

    def run(self, pair):
        """Breakthrough probability of a pair of lines over (roughness model, point), and rms ratio.

        The rms ratio is that of both lines together, flattened over as drawn.
        """
        found, ratios = np.empty((2, self.films.size)), np.empty(self.films.size)
        found[0] = self._broken(pair, slice(None))
        if pair[0].size == pair[1].size:
            # Both lines are flattened alike, so their sum is.
            pair = [pair[0] + pair[1]]
        waves = [_Waves(line, self.spacing, self.q_max) for line in pair]
        for point, contact in enumerate(self.contacts):
            flattened, powers = zip(*(one.flattened(*contact) for one in waves), strict=True)
            found[1, point] = self._broken(flattened, slice(point, point + 1))[0]
            ratios[point] = np.sqrt(sum(powers) / sum(one.power.sum() for one in waves))
        return found, ratios

    def _broken(self, lines, points):
        pair = tuple(lines) if len(lines) == 2 else (lines[0], np.zeros_like(lines[0]))
        steps = pair[0].size
        own = self.films[points], self.half_windows[points], self.factor
        return strip_statistics(pair, (1.0, 1.0), steps, *own)[:, 1] / steps


class _Waves:
    """Waves of a line, each of which can be flattened."""

    def __init__(self, line, spacing, q_max):
        step = 2.0 * np.pi / (line.size * spacing)
        self.size, last = line.size, int(q_max / step * (1.0 + 1e-9))
        self.waves = scipy.fft.rfft(line.astype(float))[1 : last + 1]
        self.power = np.abs(self.waves) ** 2
        self.wavelength = 2.0 * np.pi / (step * np.arange(1, last + 1))

    def flattened(self, half_width, moes_load, moes_material):
        """Heights of the flattened line, height steps, and their power."""
        kept = amplitude_ratio(self.wavelength / half_width, moes_load, moes_material)
        spectrum = np.zeros(self.size // 2 + 1, complex)
        spectrum[1 : kept.size + 1] = self.waves * kept
        line = np.rint(scipy.fft.irfft(spectrum, self.size, overwrite_x=True)).astype(np.int32)
        return line, np.sum(kept**2 * self.power)


def _limited(probability, dims, windows):
    limits = probability_interval(probability, windows)
    names = ("mean", "lower", "upper")
    return {
        f"breakthrough_probability_{name}": (dims, values)
        for name, values in zip(names, limits, strict=True)
    }
