"""The measured topography of a roller, in place of an rms height and a Hurst exponent.

Its file is read when the study is checked; form and holes are removed, and heights are filtered.
The roller gets its lines in one of three ways: new lines are drawn from the spectrum, or the
profile is the line, as one turn around the roller or repeated around it.

The modules that read and compute are imported on first use: most studies have no topography.
"""

import hashlib
from pathlib import Path
from typing import Any, Literal

from pydantic import PrivateAttr, ValidationInfo, model_validator
from pydantic_core import to_jsonable_python

from lube.errors import DataError, located
from lube.study.field_types import Length, StrictModel, Text


class RollerTopography(StrictModel):
    """What was measured of a roller's surface, and how it is used."""

    file: Text
    """profile or map: a file of an instrument, CSV (`position [mm],height [um]`) or NetCDF"""
    texture: Literal["isotropic", "lay", "along rolling"]
    """alike in all directions; or a map of ridges, such as those of a ground surface, whose length
    and direction are found from it; or only profiles along rolling are used
    """
    use: Literal["spectrum", "closed line", "repeated line"] = "spectrum"
    """lines are drawn from its spectrum; or the profile is the line, as one turn or repeated"""
    form: Literal["none", "tilt", "curvature"] = "tilt"
    """what is removed by least squares: the mean alone, a straight line or plane, a parabola"""
    long_cutoff: Length | None = None
    """cutoff of the Gaussian filter against long waves (ISO 16610); by default none"""
    short_cutoff: Length | None = None
    """cutoff of the Gaussian filter against short waves; by default none"""
    holes: Literal["refuse", "interpolate"] = "refuse"
    """what is done where nothing was measured, up to 5 % of the points"""
    rolling: Literal["x", "y"] = "x"
    """direction of rolling on a map"""

    _measured: Any = PrivateAttr()

    @model_validator(mode="after")
    def _read(self, info: ValidationInfo):
        if self.is_line and self.texture != "along rolling":
            raise ValueError(
                f"texture: got {self.texture!r}, need 'along rolling' for a profile that is the "
                "line: the line that stands for a surface is not its profile"
            )
        from lube.study import topography_lines

        with located(kind=ValueError):
            self._measured = topography_lines.measured(self, (info.context or {}).get(self.key))
        return self

    @property
    def is_line(self) -> bool:
        """Whether the profile itself is the line."""
        return self.use != "spectrum"

    @property
    def key(self) -> str:
        """Text that tells this topography from others."""
        return self.model_dump_json()

    @property
    def reading(self) -> dict[str, Any]:
        """The measured spectrum as plain data, so that jobs need not read the file again."""
        return to_jsonable_python(self._measured, fallback=lambda array: array.tolist())

    @property
    def content(self) -> dict[str, Any]:
        """Settings, and the file by its SHA-256 sum instead of its path."""
        digest = hashlib.sha256(Path(self.file).read_bytes()).hexdigest()
        return self.model_dump(exclude={"file"}) | {"sha256": digest}

    def line(
        self, grid: tuple[int, float, tuple[float, float]], width: float, height_step: float
    ) -> dict[str, Any]:
        """Determine the roughness line of the roller.

        Parameters
        ----------
        grid : tuple
            Points N around the roller, their distance, m, and the longest and the shortest
            wavelength of the line, m.
        width : float
            Largest contact width of the study, m.
        height_step : float
            Height of one step of the whole-number heights, m.

        Returns
        -------
        dict
            ``rms_height``, and ``spectrum`` with the lay, or ``heights``, of
            `lube.study.line_spec.RoughLine`.

        Raises
        ------
        DataError
            If the topography does not hold such a line.
        """
        from lube.study import topography_lines

        points, spacing, band = grid
        if not self.is_line:
            rms, spectrum = topography_lines.table(self._measured, band)
            lay = {name: getattr(self._measured, name) for name in ("lay_ratio", "lay_angle")}
            return {"rms_height": rms, "spectrum": spectrum, **lay}
        length = self._measured.lengths[0]
        if length < width:
            needed = f"need one longer than the contact is wide, {1e3 * width:.3g} mm"
            raise DataError(f"{self.file}: got a profile of {1e3 * length:.3g} mm, {needed}")
        rms, heights = topography_lines.measured_line(
            self.use, self._measured, points, spacing, band[1], height_step
        )
        return {"rms_height": rms, "heights": heights}
