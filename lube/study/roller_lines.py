"""Determine the roughness lines of a pair of rollers, and check them against the grid."""

import functools
import math

import numpy as np

from lube.errors import StudyError, located
from lube.study.line_spec import LineSpec, RoughLine
from lube.study.rollers import AUTOMATIC_WAVELENGTH, ROLLERS, RollerPair, Roughness
from lube.study.size_limits import LEAST_POINTS, MOST_POINTS
from lube.surfaces.lay import from_other_side
from lube.types import Values
from lube.units import with_unit


def line_spec(rollers: RollerPair, roughness: Roughness, largest_force: float) -> LineSpec:
    """Determine the roughness lines of a pair of rollers.

    Parameters
    ----------
    rollers : RollerPair
        The rollers.
    roughness : Roughness
        Statistics and grid of the lines; the values of a roller override these.
    largest_force : float
        Largest force of the study, N; its contact width may set the longest wavelength.

    Returns
    -------
    LineSpec
        Everything that determines the lines, except seed and realisation.

    Raises
    ------
    StudyError
        If the grid is too coarse for the shortest wavelength of a line, a perimeter too short for
        the longest, the height step unsuitable for the roughness, or the kurtosis too small for
        the skewness.
    """
    spacing = 2.0 * math.pi * rollers.first.radius / roughness.points
    width = 2.0 * float(rollers.contact_half_width(largest_force))
    each = zip(ROLLERS, rollers.rms_heights, strict=True)
    lines = tuple(_rough_line(rollers, roughness, *one, spacing, width) for one in each)
    return LineSpec(lines=lines, spacing=spacing, height_step=roughness.height_step)


def band_in_words(rollers: RollerPair, roughness: Roughness, spec: LineSpec) -> str:
    """State the band of wavelengths of the roughness.

    Parameters
    ----------
    rollers, roughness
        As in `line_spec`.
    spec : LineSpec
        Their lines.

    Returns
    -------
    str
        Such as ``waves 0.8 mm to 3.14 µm, heights stated for 0.8 mm to 2.5 µm``; for each roller,
        if they differ.
    """
    bands = []
    for name, line in zip(ROLLERS, spec.lines, strict=True):
        own = roughness.of(getattr(rollers, name).roughness)
        longest, shortest = line.longest_wavelength / line.lay_ratio, line.shortest_wavelength
        automatic = line.heights is None and own.longest_wavelength == AUTOMATIC_WAVELENGTH
        why = f" ({AUTOMATIC_WAVELENGTH})" if automatic else ""
        band = f"waves {with_unit(longest, 'm', 3)}{why} to {with_unit(shortest, 'm', 3)}"
        if line.heights is not None:
            band = f"waves of the measured profile, down to {with_unit(shortest, 'm', 3)}"
        if line.lay_ratio > 1.0:
            band += f" across ridges {line.lay_ratio:g} times longer, at {line.lay_angle:g} deg"
        if line.hurst_exponent is not None and (own.long_cutoff or own.short_cutoff):
            cutoffs = own.long_cutoff or longest, own.short_cutoff or shortest
            band += f", heights stated for {' to '.join(with_unit(one, 'm', 3) for one in cutoffs)}"
        bands.append(band)
    return bands[0] if bands[0] == bands[1] else f"first: {bands[0]}; second: {bands[1]}"


def _rough_line(rollers, roughness, name, rms, spacing, width):
    """Line of one roller, at a grid spacing and the largest contact width."""
    roller = getattr(rollers, name)
    own, key = roughness.of(roller.roughness), functools.partial(_key, name, roller.roughness)
    with located(key("shortest_wavelength")):
        longest, shortest = own.wavelengths(width, spacing)
    points = round(roughness.points * roller.radius / rollers.first.radius)
    check_points(points, f"rollers.{name}.radius: got {with_unit(roller.radius, 'm', 3)}")
    if roller.topography and roller.topography.is_line:
        longest = roller.topography.long_cutoff or points * spacing
    roll_off = (None if roller.topography else own.roll_off_wavelength) or longest
    _check_band(own, (longest, shortest, roll_off), roughness.points, spacing, key)
    _check_distribution(own, key)
    if roller.topography:
        grid = points, spacing, (longest, shortest)
        shape = _measured(roller.topography, name, grid, width, roughness.height_step)
    else:
        shape = _stated(own, key, name, rms, longest, shortest)
    _check_perimeter(points * spacing, longest * shape.get("lay_ratio", 1.0), shortest, name)
    _check_height_step(shape["rms_height"], roughness.height_step, name, roller)
    return RoughLine(
        points=points,
        q_min=2.0 * math.pi / longest,
        q_max=2.0 * math.pi / shortest,
        q_roll_off=2.0 * math.pi / roll_off,
        skewness=own.skewness,
        kurtosis=own.kurtosis,
        **shape,
    )


def _key(roller, own, name):
    """Name the key that set a value of the roughness: the roller's, else the study's."""
    is_own = getattr(own, name, None) is not None
    return f"rollers.{roller}.roughness.{name}" if is_own else f"roughness.{name}"


def _measured(topography, name, grid, width, height_step):
    """Height, spectrum and lay of a roller's line, from its measured topography."""
    with located(f"rollers.{name}.topography", StudyError):
        shape = topography.line(grid, width, height_step)
        shape["isotropic"] = topography.texture != "along rolling"
        if name == "second" and "lay_angle" in shape:
            # Either map is seen from outside its roller, both surfaces from the second roller.
            shape["lay_angle"] = from_other_side(shape["lay_angle"])
    return shape


def _stated(own, key, name, rms, longest, shortest):
    """Height, spectrum and lay of a roller's line, as the study states them."""
    if own.hurst_exponent is None:
        raise StudyError(f"{key('hurst_exponent')}: missing, need it for the {name} roller")
    cutoffs = own.long_cutoff, own.short_cutoff
    _check_cutoffs(cutoffs, longest, shortest, key)
    kept = beyond_cutoffs(own.hurst_exponent, longest, shortest, cutoffs, own.roll_off_wavelength)
    shape = {"rms_height": rms * kept, "hurst_exponent": own.hurst_exponent}
    return shape | {"long_cutoff": cutoffs[0], "short_cutoff": cutoffs[1]} | _lay(own, key)


def _lay(own, key):
    """Lay of a roller's surface, nothing if it has none."""
    if own.lay_ratio == 1.0:
        if own.lay_angle is not None and "lay_ratio" not in own.model_fields_set:
            raise StudyError(
                f"{key('lay_angle')}: got {own.lay_angle:g} deg without a lay_ratio, need how many "
                "times longer than wide the ridges are, or 1 for none"
            )
        return {}
    if own.lay_angle is None:
        raise StudyError(
            f"{key('lay_angle')}: missing, need it with a lay_ratio of {own.lay_ratio:g}: 0 deg "
            "for ridges along rolling, 90 deg for ridges across"
        )
    return {"lay_ratio": own.lay_ratio, "lay_angle": own.lay_angle}


def _check_cutoffs(cutoffs, longest, shortest, key):
    long_cutoff, short_cutoff = cutoffs[0] or longest, cutoffs[1] or shortest
    if long_cutoff <= short_cutoff:
        name = "long_cutoff" if cutoffs[0] else "short_cutoff"
        raise StudyError(
            f"{key(name)}: got a height stated for waves of {_length(long_cutoff)} to "
            f"{_length(short_cutoff)}, need a long cutoff above the short one; by default they are "
            "the ends of the band"
        )


def beyond_cutoffs(
    hurst_exponent: Values,
    longest: Values,
    shortest: Values,
    cutoffs: tuple[float | None, float | None],
    roll_off: float | None,
) -> Values:
    r"""Ratio of the rms height of all waves of a line to that of the waves within the cutoffs.

    Both follow from the integral of :math:`C \propto q^{-2H-1}`, below the roll-off
    :math:`C \propto q`.

    Parameters
    ----------
    hurst_exponent : float or array_like
        Hurst exponent H.
    longest, shortest : float or array_like
        Longest and shortest wavelength of the line, m.
    cutoffs : tuple of float or None
        Longest and shortest wavelength within the cutoffs, m; by default those of the line.
    roll_off : float or None
        Wavelength of the roll-off, m, if there is one.

    Returns
    -------
    float or array_like
        The ratio, exactly 1 without cutoffs.

    Examples
    --------
    >>> f"{beyond_cutoffs(0.7, 0.2e-3, 2.5e-6, (0.8e-3, None), None):.3f}"
    '0.379'
    """
    if cutoffs == (None, None):
        return 1.0
    stated = cutoffs[0] or longest, cutoffs[1] or shortest
    bend, exponent = roll_off or np.maximum(longest, stated[0]), 2.0 * hurst_exponent

    def power(wavelength):  # of all waves from the roll-off to this one
        ratio = wavelength / bend
        shorter = (1.0 - np.minimum(ratio, 1.0) ** exponent) / exponent
        return shorter + 0.5 * (np.maximum(ratio, 1.0) ** -2.0 - 1.0)

    whole, within = (power(short) - power(long) for long, short in ((longest, shortest), stated))
    return np.sqrt(whole / within)


def _length(value):
    return with_unit(value, "m", 3)


def _check_band(own, wavelengths, points, spacing, key):
    longest, shortest, roll_off = wavelengths
    if shortest < 2.0 * spacing * (1.0 - 1e-9):
        raise StudyError(
            f"roughness.points: got {points}, too coarse a grid: its spacing is "
            f"{_length(spacing)}, need at most half the shortest wavelength of {_length(shortest)}"
        )
    if shortest >= longest:
        needed = f"need less than the longest, {_length(longest)}"
        if isinstance(own.shortest_wavelength, str):  # in points
            least = math.ceil(points * shortest / longest) + 1
            needed += f"; if it is in points, need {least} roughness.points or more"
        raise StudyError(f"{key('shortest_wavelength')}: got {_length(shortest)}, {needed}")
    if not shortest * (1.0 - 1e-9) <= roll_off <= longest * (1.0 + 1e-9):
        raise StudyError(
            f"{key('roll_off_wavelength')}: got {_length(roll_off)}, need one from the shortest to "
            f"the longest wavelength, {_length(shortest)} to {_length(longest)}"
        )


def check_points(points: int, came: str) -> None:
    """Refuse too few or too many grid points around a roller.

    Parameters
    ----------
    points : int
        Number of points.
    came : str
        Beginning of the message.

    Raises
    ------
    StudyError
        With the number, and what is needed.
    """
    if not LEAST_POINTS <= points <= MOST_POINTS:
        raise StudyError(
            f"{came}, {points:.3g} grid points around the roller, need {LEAST_POINTS} to "
            f"{MOST_POINTS:.2g}"
        )


def _check_perimeter(perimeter, longest, shortest, roller):
    if perimeter < longest or math.ceil(perimeter / longest) > math.floor(perimeter / shortest):
        raise StudyError(
            f"rollers.{roller}.radius: got a perimeter of {_length(perimeter)}, need room for the "
            f"longest wave and for a whole number of waves of {_length(shortest)} to "
            f"{_length(longest)}"
        )


def _check_height_step(rms, step, name, roller):
    """Rms heights must be many height steps, and peaks must fit a 32-bit integer."""
    if 1e3 <= rms / step <= 1e7:
        return
    if 1e-9 <= rms <= 1e-5:
        needed = f"need {_length(rms / 1e7)} to {_length(rms / 1e3)} for a roughness of"
        raise StudyError(f"roughness.height_step: got {_length(step)}, {needed} {_length(rms)}")
    key = f"{name}.{roller.kinds[0]}" if roller.kinds else "composite_rms_roughness"
    raise StudyError(f"rollers.{key}: got {_length(rms)}, need an rms height of 1 nm to 10 µm")


def _check_distribution(own, key):
    """Close to the least kurtosis, heights take only two values, which no given spectrum allows."""
    square = own.skewness**2
    least = 1.5 + 1.25 * square
    if own.kurtosis < least:
        raise StudyError(
            f"{key('kurtosis')}: got {own.kurtosis:g} with a skewness of {own.skewness:g}, need at "
            f"least {least:g}: no kurtosis is below {square + 1.0:g}, the skewness squared plus "
            "one, and close to that the spectrum cannot be kept"
        )
