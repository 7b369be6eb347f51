"""The film_plane stage: the computed film over Moes' numbers, and how far off each formula is."""

import numpy as np
import xarray as xr

from lube.digits import six_digits
from lube.ehl.film_formulas import FORMULAS
from lube.ehl.line_contact import profiles_of
from lube.physics.dimensionless import dimensionless_material
from lube.schema import label, with_dims
from lube.study.study import Study
from lube.types import Datasets

MOES_LOADS = np.geomspace(0.1, 100.0, 25)
MOES_MATERIALS = np.arange(2.0, 16.0)
PLACES = ("central", "minimum", "mean")


def make(study: Study, inputs: Datasets, threads: int = 1) -> xr.Dataset:
    r"""Make ``film_plane.nc``: the film over the Moes numbers M and L, and the formulas' errors.

    Parameters
    ----------
    study, inputs, threads
        As in `lube.stages`. The film is computed with each oil at the middle temperature, as
        Roelands' law needs the viscosity and the pressure-viscosity coefficient besides M and L.

    Returns
    -------
    xarray.Dataset
        The ``film_plane`` file of `lube.schema`. A film that did not converge is NaN and named in
        the log; the attribute ``not_converged`` is the number of these films.

    Notes
    -----
    With the oil and the rollers' steel, M and L set the speed and the load:

    .. math:: U = \frac{1}{2} \left( \frac{L}{G} \right)^4, \qquad W = M \sqrt{2U}

    Each formula is compared with the computed film that it stands for: at the line of centres, the
    minimum, or the mean over the Hertzian zone.
    """
    lubricant = inputs["lubricant"]
    levels = np.sort(lubricant["temperature"].values)
    oils = lubricant.sel(temperature=levels[levels.size // 2])
    properties = ["dynamic_viscosity", "pressure_viscosity_coefficient"]
    film_modulus = 2.0 * study.rollers.reduced_modulus
    columns = (oils[name].values.tolist() for name in properties)
    planes = [_plane(*oil, film_modulus) for oil in zip(*columns, strict=True)]
    films, groups = (np.array(each) for each in zip(*planes, strict=True))
    found = {name: films[..., at] for at, name in enumerate(PLACES)}
    load, speed, material = np.moveaxis(groups, -1, 0)
    rows = [row for row in FORMULAS.values() if not row.depends_on_oil]
    errors = [row.evaluate(load, speed, material) / found[row.thickness] - 1.0 for row in rows]
    values = {
        **{f"{name}_film_parameter": film / np.sqrt(2.0 * speed) for name, film in found.items()},
        "film_error": np.stack(errors, axis=1),
        "hertz_pressure": film_modulus * np.sqrt(load / (2.0 * np.pi)),
        "formula_place": [row.thickness for row in rows],
        "formula_source": [row.source for row in rows],
        "film_formula": [row.name for row in rows],
        "moes_material": MOES_MATERIALS,
        "moes_load": MOES_LOADS,
    }
    table = oils[properties].assign(with_dims("film_plane", values)).drop_attrs()
    not_converged = int(np.isnan(films[..., 0]).sum())
    return label(table.assign_attrs(not_converged=not_converged), "film_plane")


def _plane(viscosity, alpha, film_modulus):
    """Central, minimum and mean film over R*, and W, U and G, shape (materials, loads, 3) each."""
    material = dimensionless_material(alpha, film_modulus)
    groups = []
    for moes_material in MOES_MATERIALS:
        speed = 0.5 * (moes_material / material) ** 4
        groups += [(load, speed, material) for load in MOES_LOADS * np.sqrt(2.0 * speed)]
    solved = profiles_of(*np.transpose(groups), viscosity, film_modulus)
    films = [[getattr(one, f"{name}_film", np.nan) for name in PLACES] for one in solved]
    shape = (MOES_MATERIALS.size, MOES_LOADS.size, 3)
    return six_digits(np.reshape(films, shape)), np.reshape(groups, shape)
