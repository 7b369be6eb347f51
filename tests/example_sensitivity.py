"""A sensitivity dataset of three factors at three operating points."""

import numpy as np
import xarray as xr

FIRST = [[0.19, 0.36, 0.51], [0.7, 0.5, 0.4], [0.0, 0.0, 0.0]]


def dataset(**changes):
    """The dataset, with some variables changed."""
    forces = [100.0, 200.0, 400.0]
    probability = np.array([1e-5, 1e-3, 0.1])
    shape = {"lubricant": ["oil"], "temperature": [40.0], "speed": [600 / 7], "force": forces}
    dims = tuple(shape)
    effects = np.log([[2.0, 3.0, 4.0], [20.0, 30.0, 40.0], [1.01, 1.01, 1.01]])
    table = {
        "elementary_effect": (("factor", *dims), effects.reshape(3, 1, 1, 1, 3)),
        "first_order": (("factor", *dims), np.reshape(FIRST, (3, 1, 1, 1, 3))),
        "group_of_factor": ("factor", ["conditions", "contact model", "seed"]),
        "range_of_factor": ("factor", ["-1 K to 1 K", "line, surface", "any"]),
        "source_of_factor": ("factor", ["assumed", "the model", "the study's seed"]),
    }
    for name in ("elementary_effect", "first_order"):
        dims_, values = table[name]
        table |= {f"{name}_lower": (dims_, values - 0.01), f"{name}_upper": (dims_, values + 0.01)}
    for end, times in (("median", 1.0), ("lower", 0.1), ("upper", 2.0)):
        values = (probability * times).reshape(1, 1, 1, 3)
        table[f"breakthrough_probability_{end}"] = dims, values
    coordinates = shape | {"factor": ["temperature", "contact_model", "seed"]}
    return xr.Dataset(table, coordinates).assign(changes)
