"""What a study must have for contact of the surfaces that its lines stand for."""

from lube.errors import DataError, StudyError
from lube.grid.gap import Gap
from lube.surfaces.rare_contact import check_stands_for_surface
from lube.surfaces.rough_surface import surface_grid
from lube.surfaces.synthetic import LineSpecLike


def check_surfaces(spec: LineSpecLike, length: float, width: float, gap: Gap) -> None:
    """Refuse rollers whose surfaces the model cannot bring into contact.

    Parameters
    ----------
    spec : LineSpecLike
        Parameters of the lines that stand for the surfaces.
    length : float
        Length of the rollers, m.
    width : float
        Largest contact width, m.
    gap : Gap
        How film and roughness make up the gap.

    Raises
    ------
    StudyError
        If the heights of a line are not Gaussian, a line was measured along rolling, or a formula
        flattens the roughness.
    DataError
        If the rollers are shorter than the contact is wide, or the band of wavelengths is too wide
        for a surface.
    """
    check_stands_for_surface(spec)
    if gap.is_flattened:
        raise StudyError(
            f"roughness_deformation: got {gap.roughness_deformation}, need none or computed for "
            "contact of the surface: the formula is for waves that run along rolling"
        )
    if length < width:
        needed = f"need the contact width of {width:g} m or more"
        raise DataError(f"rollers.length: got {length:g} m, {needed}")
    surface_grid(spec, width)
