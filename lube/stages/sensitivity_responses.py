"""The sensitivity_responses stage: responses of films for the runs of the sensitivity study."""

import numpy as np
import xarray as xr

from lube.schema import FILES, label
from lube.sensitivity.conditions import Deviating
from lube.sensitivity.responses import NAMES, solve_responses
from lube.sensitivity.runs import design, models
from lube.study.study import Study
from lube.types import Datasets


def make(study: Study, inputs: Datasets, threads: int = 1) -> xr.Dataset:
    """Make ``sensitivity_responses.nc``; see `lube.stages`."""
    deviating = Deviating.of(study)
    answered = [model for model in models(deviating) if model.gap.is_answered]
    units, points = zip(*(design(deviating, model) for model in answered), strict=True)
    contact_models = dict.fromkeys(model.contact_model for model in answered)
    table = solve_responses(
        deviating, contact_models, np.concatenate(units), xr.concat(points, "run"), threads
    )
    names = [f"{NAMES[one]}_{part}" for one in contact_models for part in ("real", "imaginary")]
    dims = FILES["sensitivity_responses"]["surface_response_real"].dims
    table = table[[*names, "contact_half_width"]].transpose(*dims, missing_dims="ignore")
    return label(table, "sensitivity_responses")
