"""One dataset of every kind, for tests of files."""

import numpy as np
import xarray as xr
from made import made, on_few_surfaces
from studies import CONFIG

from lube.schema import COORDINATES, FILES, STAGES, label
from lube.stages.surface import measured_surfaces
from lube.study.roller_topography import RollerTopography


def example_surface():
    """The map that comes with the package; to read it takes a second."""
    file = str(CONFIG / "surfaces/example.x3p")
    return RollerTopography(file=file, texture="isotropic", holes="interpolate")


def measured_values(kind):
    """Values as the file of a stage that is not run here has them, all different."""
    rng = np.random.default_rng(1)
    variables = {
        name: (row.dims, rng.uniform(1.0, 1e6, (2,) * len(row.dims)).astype(row.kind + "8"))
        for name, row in FILES[kind].items()
    }
    dims = {dim for row in FILES[kind].values() for dim in row.dims}
    dims &= COORDINATES.keys()
    coords = {dim: np.arange(2).astype(COORDINATES[dim].kind + "8") for dim in sorted(dims)}
    return label(xr.Dataset(variables, coords, {"not_converged": 0}), kind)


def datasets_of_every_kind(study):
    """One dataset of every kind, by the stages themselves, on a coarse grid."""
    # Rollers of two sizes, so that the shorter line is padded.
    second = study.rollers.second.model_copy(update={"radius": 0.04})
    own = {
        "rollers": study.rollers.model_copy(update={"second": second}),
        "roughness": study.roughness.model_copy(update={"points": 12_000}),
        "realisations": 2,
    }
    own = study.model_copy(update=own)
    # Measured times, what a package makes that need not be installed, what takes long, and what
    # needs measured records.
    others = [kind for kind, stage in STAGES.items() if stage.target == "benchmark"]
    others += ["patch", "passage", "film_plane", "heating_plane"]
    others += ["surface_response", "variants", "surface_records"]
    others += [
        "sensitivity_responses",
        "sensitivity_runs",
        "sensitivity",
        "record_bands",
        "plan",
        "verification",
    ]
    batches = ["sensitivity_runs_batch"]
    with on_few_surfaces():
        quick = made(own, [kind for kind in STAGES if kind not in others])
    return {
        **quick,
        "surface": measured_surfaces({"first": example_surface()}, own.line_spec, 0.7),
        **{kind: measured_values(kind) for kind in [*others, *batches]},
    }
