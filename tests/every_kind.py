"""One dataset of every kind, for tests of files."""

import numpy as np
import xarray as xr
from experiments import model_of_records
from studies import CONFIG

from lube.schema import COORDINATES, FILES, label
from lube.stages.areal import strip_contacts
from lube.stages.areal_gauge import gauge_by_surface
from lube.stages.comparison import compare
from lube.stages.constant import constant_effect
from lube.stages.contact import contact_map, contact_statistics
from lube.stages.ensemble import gather, gather_map
from lube.stages.experiment import simulated_experiment
from lube.stages.film import film_profile_table, film_table
from lube.stages.film_plane import film_plane
from lube.stages.film_shape import film_shape_probabilities
from lube.stages.flattening import flattened_contact
from lube.stages.gauge import gauge_records
from lube.stages.height_distribution import height_distributions
from lube.stages.lubricant import lubricant_table
from lube.stages.rig import rig_records
from lube.stages.roughness import roughness_batch, roughness_lines
from lube.stages.surface import measured_surfaces
from lube.stages.tail import tail_probabilities
from lube.stages.trace import contact_trace
from lube.study.roller_topography import RollerTopography

EXAMPLE_SURFACE = RollerTopography(
    file=str(CONFIG / "surfaces/example.x3p"), texture="isotropic", holes="interpolate"
)


def measured_values(kind):
    """Values as the file of a stage that is not run here has them, all different."""
    rng = np.random.default_rng(1)
    variables = {
        name: (row.dims, rng.uniform(1.0, 1e6, (2,) * len(row.dims)).astype(row.kind + "8"))
        for name, row in FILES[kind].items()
    }
    dims = {dim for row in FILES[kind].values() for dim in row.dims}
    coords = {dim: np.arange(2).astype(COORDINATES[dim].kind + "8") for dim in sorted(dims)}
    return label(xr.Dataset(variables, coords), kind)


def datasets_of_every_kind(study):
    """One dataset of every kind, by the stages themselves, on a coarse grid."""
    grid, layer = study.operating_grid, study.boundary_layer
    # Rollers of two sizes, so that the shorter line is padded.
    second = study.rollers.second.model_copy(update={"radius": 0.04})
    own = study.model_copy(
        update={
            "rollers": study.rollers.model_copy(update={"second": second}),
            "roughness": study.roughness.model_copy(update={"points": 12_000}),
        }
    )
    spec = own.line_spec
    oil = lubricant_table(study.lubricants, grid.temperature)
    levels = grid.force, grid.speed, study.film_formulas
    film = film_table(oil, own.rollers, *levels, slide_to_roll_ratio=study.slips)
    profile = film_profile_table(oil, own.rollers, grid.force, grid.speed)
    lines = roughness_lines(spec, study.seed, [0, 1])
    batch = roughness_batch(spec, study.seed, [0, 1])
    run = contact_statistics(batch, film, layer, study.slips)
    rig_lines = roughness_batch(spec, study.seed, study.rig_realisations)
    mapped = contact_map(batch, film, layer, 5, 3)
    points = [point | {"slide_to_roll_ratio": 0.0} for point in study.trace_points]
    contact, master = gather([run], film), gather_map([mapped])
    experiment = simulated_experiment(rig_lines, film, own)
    comparison = compare(model_of_records(experiment, film, contact, own), experiment, contact)
    areal = strip_contacts(spec, film, layer, own.rollers.length, study.seed, study.slips)
    gauge = gauge_records(master, contact, comparison)
    return {
        "lubricant": oil,
        "film": film,
        "roughness": lines,
        "surface": measured_surfaces({"first": EXAMPLE_SURFACE}, spec, 0.7),
        "contact_batch": run,
        "contact": contact,
        "areal": areal,
        "areal_gauge": gauge_by_surface(film, areal, comparison, gauge),
        "tail": tail_probabilities(spec, film, layer, study.seed, study.slips),
        "height_distribution": height_distributions(spec, film, layer, study.seed),
        "master_batch": mapped,
        "master": master,
        "trace": contact_trace(lines, film, points, layer, study.resistivity),
        "experiment": experiment,
        "rig": rig_records(rig_lines, film, own),
        "comparison": comparison,
        "gauge": gauge,
        "film_profile": profile,
        "film_shape": film_shape_probabilities(spec, film, profile, layer, study.seed),
        "flattening": flattened_contact(spec, film, layer, study.seed, [0, 1]),
        "patch": measured_values("patch"),  # by a package that need not be installed
        "film_plane": film_plane(oil, own.rollers.reduced_modulus),
        "constant": constant_effect(oil, film, master),
        "speed": measured_values("speed"),
        "reading": measured_values("reading"),
        "coverage": measured_values("coverage"),
    }
