"""The band of the assumptions, as of a study whose sensitivity study was made."""

import numpy as np
import pytest
import xarray as xr

from lube.schema import POINT_DIMS


@pytest.fixture(scope="session")
def with_assumptions():
    """A function that adds the dataset ``sensitivity`` to those of the explorer."""

    def added(datasets):
        film = datasets["film"]
        levels = {name: film[name] for name in POINT_DIMS}
        sizes = [film.sizes[name] for name in POINT_DIMS]
        upper = np.linspace(0.1, 0.9, np.prod(sizes)).reshape(sizes)
        table = {"lower": upper / 100.0, "upper": upper}
        found = {f"breakthrough_probability_{end}": (POINT_DIMS, one) for end, one in table.items()}
        attributes = {"units": "1"}
        dataset = xr.Dataset(found, levels, film.attrs).map(
            lambda one: one.assign_attrs(attributes)
        )
        dataset = dataset.assign_coords(factor=["viscosity"])
        return datasets | {"sensitivity": dataset.assign_attrs(film.attrs)}

    return added
