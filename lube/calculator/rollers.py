"""The rollers of an answer, from numbers with units."""

from __future__ import annotations

import inspect
import math
from collections.abc import Mapping

from lube import types
from lube.calculator.arguments import amount, checked, in_words
from lube.contact.rough_pair import RoughPair
from lube.errors import StudyError, shown
from lube.grid.gap import Gap
from lube.study import rollers
from lube.study.field_types import validate
from lube.study.roller_lines import band_in_words, check_points, line_spec
from lube.units import parse_quantity, with_unit

_SMOOTH = ("radius", "young_modulus", "poisson_ratio")
"""Arguments for the first roller, apart from the heights of its roughness."""
_WAVES = (*rollers.OwnRoughness.model_fields, "points")
"""Arguments for the roughness of both rollers, apart from its heights."""
_LENGTHS = ("longest_wavelength", "shortest_wavelength")
_LAYER = ("critical_thickness", "shear_strength")
_PARTS = {
    "roughness": (rollers.Roughness, _WAVES),
    "boundary_layer": (rollers.BoundaryLayer, _LAYER),
}
"""Parts of a study, each with its class and the arguments that it sets."""


class Rollers:
    """Two rollers in line contact: geometry, material, roughness and boundary layer.

    Quantities are given as text, such as ``"50 mm"``, as ``(50, "mm")`` or by pint.

    Parameters
    ----------
    radius : str
        Radius of the first roller, such as ``"50 mm"``.
    rms_roughness : str, optional
        Rms roughness of the first roller by itself, such as ``"0.2 um"``. Without it,
        `ra_roughness`, `composite_rms_roughness` or a `topography` is needed.
    length : str, optional
        Length of the line contact.
    young_modulus, poisson_ratio : str, float, optional
        Elastic constants of the first roller; the default is steel.
    second : dict, optional
        Values of the second roller that differ from the first's, such as ``{"radius": "30 mm"}``
        or ``{"roughness": {"hurst_exponent": 0.8}}``. Without it the rollers are equal.
    longest_wavelength, shortest_wavelength : str, optional
        Ends of the roughness band. The defaults are `lube.study.rollers.LONGEST_WAVELENGTH`, the
        cutoff with which an Ra from 0.1 to 2 um is customarily measured, and the paper's shortest
        wavelength. The answers depend on them.
    long_cutoff, short_cutoff : str, optional
        Cutoffs lambda_c and lambda_s that the roughness was measured with: its height is that of
        the waves between them, and other waves add to it. By default the longest and the shortest
        wavelength.
    hurst_exponent : float, optional
        Hurst exponent of the roughness, from 0 to 1.
    ra_roughness : str, optional
        Mean absolute height Ra of the first roller; the rms is taken as Ra (pi / 2)^0.5.
    composite_rms_roughness : str, optional
        Rms roughness of both rollers together; each roller then has this value / 2^0.5.
    topography : dict, optional
        Measured surface of the first roller, from whose spectrum its lines are drawn, such as
        ``{"file": "scan.x3p", "texture": "isotropic"}``; the keys are those of a study. The
        longest and the shortest wavelength must lie within the measured ones.
    roll_off_wavelength : str, optional
        Wavelength beyond which the spectral density of the surface is constant; by default there is
        none.
    skewness, kurtosis : float, optional
        Skewness and kurtosis of the heights, by default Gaussian.
    lay_ratio : float, optional
        How many times longer than wide the ridges of the surfaces are, by default 1: no lay.
    lay_angle : str, optional
        Angle between ridges and rolling, such as ``"0 deg"`` for ground rollers.
    points : int, optional
        Grid points around the first roller; by default about ten in the shortest wavelength.
    critical_thickness, shear_strength : str, optional
        Properties of the boundary layer, by default the paper's.
    roughness : Roughness, optional
        Roughness of a study, such as ``study.roughness``, in place of all arguments on the
        roughness except its heights.
    boundary_layer : BoundaryLayer, optional
        Boundary layer of a study, in place of the two arguments on it.
    resistivity : str, optional
        Resistivity of the rollers' material, by default hardened bearing steel. ``"insulator"`` if
        either roller does not conduct: contact then has no resistance.

    Attributes
    ----------
    pair : RollerPair
        Geometry, material and roughness: the rms heights are those of the lines.
    lines : LineSpec
        What determines the roughness lines.
    roughness, given_pair : Roughness, RollerPair
        Roughness and rollers as given, from which the lines follow.
    band : str
        Longest and shortest wave of the roughness, in words.
    layer : BoundaryLayer
        The boundary layer.
    resistivity : float
        Resistivity, ohm m; NaN if either roller does not conduct.

    Raises
    ------
    StudyError
        Which argument, what came, what is needed.

    Examples
    --------
    >>> rollers = Rollers(radius="50 mm", rms_roughness="0.2 um")
    >>> f"{1e6 * rollers.pair.composite_rms_roughness:.3f} um"
    '0.283 um'
    """

    @checked
    def __init__(
        self,
        radius: types.OneAmount,
        rms_roughness: types.OneAmount | None = None,
        length: types.OneAmount = "10 mm",
        *,
        young_modulus: types.OneAmount = "210 GPa",
        poisson_ratio: float = 0.3,
        second: Mapping[str, object] | None = None,
        longest_wavelength: types.OneAmount = rollers.LONGEST_WAVELENGTH,
        shortest_wavelength: types.OneAmount = rollers.SHORTEST_WAVELENGTH,
        long_cutoff: types.OneAmount | None = None,
        short_cutoff: types.OneAmount | None = None,
        hurst_exponent: float = 0.7,
        ra_roughness: types.OneAmount | None = None,
        composite_rms_roughness: types.OneAmount | None = None,
        topography: Mapping[str, object] | None = None,
        roll_off_wavelength: types.OneAmount | None = None,
        skewness: float = 0.0,
        kurtosis: float = 3.0,
        lay_ratio: float | None = None,
        lay_angle: types.OneAmount | None = None,
        points: int | None = None,
        critical_thickness: types.OneAmount = "5 nm",
        shear_strength: types.OneAmount = "1 MPa",
        roughness: rollers.Roughness | None = None,
        boundary_layer: rollers.BoundaryLayer | None = None,
        resistivity: types.OneAmount = "0.2 uohm*m",
    ) -> None:
        given = {name: in_words(value) for name, value in locals().items()}
        _check_parts(given)
        self.given_pair = _pair(given)
        layer = {name: given[name] for name in _LAYER}
        self.layer = boundary_layer or validate(rollers.BoundaryLayer, layer, "Rollers", StudyError)
        self.resistivity = math.nan
        if given["resistivity"] != rollers.INSULATOR:
            self.resistivity = amount("resistivity", resistivity, "ohm*m", above=0.0).item()
        self.roughness = roughness or _roughness(given, self.given_pair.first.radius)
        if self.roughness.longest_wavelength == rollers.AUTOMATIC_WAVELENGTH:
            came = f"got {rollers.AUTOMATIC_WAVELENGTH!r}, need a length"
            raise StudyError(f"Rollers: roughness.longest_wavelength: {came}")
        self.lines = line_spec(self.given_pair, self.roughness, largest_force=math.nan)
        self.band = band_in_words(self.given_pair, self.roughness, self.lines)
        self.pair = self.given_pair.with_rms_heights(self.lines.rms_height)
        if not self.lines.is_drawn:
            raise StudyError(
                "Rollers: topography.use: got a measured line, need 'spectrum': an answer is a "
                "mean over drawn lines; only a study can use a measured line"
            )

    def rough_pair(self, seed: int, gap: Gap) -> RoughPair:
        """Pair of rollers for the contact model; ``seed`` and ``gap`` as in `RoughPair`."""
        return RoughPair(self.lines, self.pair.length, self.layer, seed, gap)

    def __repr__(self) -> str:
        pair = self.pair
        radii = " and ".join(f"{1e3 * one.radius:.4g}" for one in (pair.first, pair.second))
        rms = " and ".join(f"{1e6 * height:.4g}" for height in pair.rms_heights)
        length = f"{1e3 * pair.length:.4g} mm long"
        return f"<Rollers: radii {radii} mm, rms roughness {rms} um, {length}, {self.band}>"


def _check_parts(given):
    """Refuse parts of a study of another class, and single arguments together with such a part."""
    for name, (kind, _) in _PARTS.items():
        if not isinstance(given[name], kind | None):
            needed = f"need a lube.stages.{kind.__name__}"
            needed += "; did you mean rms_roughness or ra_roughness?" * (name == "roughness")
            raise StudyError(f"Rollers: {name}: got {shown(given[name])}, {needed}")
    usual = inspect.signature(Rollers).parameters
    for name, (_, arguments) in _PARTS.items():
        for argument in arguments if given[name] is not None else ():
            if given[argument] != usual[argument].default:
                came = f"{argument}: got {shown(given[argument])} together with `{name}`"
                raise StudyError(f"Rollers: {came}, which sets it, need only one of the two")


def _pair(given):
    """Geometry, material and heights of both rollers as given."""
    first = {name: given[name] for name in _SMOOTH}
    heights = {name: given[name] for name in rollers.ROUGHNESS_KEYS}
    second = given["second"]
    if not isinstance(second, Mapping | None):
        needed = "need a dict of the values that differ, such as {'radius': '30 mm'}"
        raise StudyError(f"Rollers: second: got {shown(second)}, {needed}")
    own = dict(second or {})
    other = first | ({} if heights.keys() & own.keys() else heights) | own
    pair = {
        "length": _metres("length", given["length"]),
        "first": validate(rollers.Roller, first | heights, "Rollers", StudyError),
        "second": validate(rollers.Roller, other, "Rollers: second", StudyError),
        "composite_rms_roughness": given["composite_rms_roughness"],
    }
    return validate(rollers.RollerPair, pair, "Rollers", StudyError)


def _roughness(given, radius):
    """Roughness of rollers by single arguments; `radius` is that of the first roller."""
    waves = {name: given[name] for name in _WAVES}
    # Lengths only: a study's other choices depend on its grid.
    waves |= {name: _metres(name, given[name]) for name in _LENGTHS}
    if waves["lay_ratio"] is None:  # not stated
        del waves["lay_ratio"]
    if waves["points"] is None:
        shortest = parse_quantity(waves["shortest_wavelength"], "m")
        waves["points"] = points = rollers.grid_points(radius, shortest)
        lengths = (with_unit(length, "m", 3) for length in (radius, shortest))
        check_points(points, "Rollers: radius: got {} with waves down to {}".format(*lengths))
    waves["height_step"] = "1 pm"
    return validate(rollers.Roughness, waves, "Rollers", StudyError)


def _metres(name, length):
    """Check a length and write it as the models of a study read it."""
    if str(length).endswith("points"):  # which would be those of a printer
        needed = "need a length: only a study counts in points of its grid"
        raise StudyError(f"{name}: got {shown(length)}, {needed}")
    return f"{amount(name, length, 'm', above=0.0).item()!r} m"
