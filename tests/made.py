"""All datasets of a study in memory, made as the workflow makes them."""

import contextlib

import numpy as np
import pytest

from lube.contact.rough_pair import roughness_batch
from lube.schema import STAGES
from lube.stages import maker, passage
from lube.study.uncertainty import SAMPLE_BATCHES


@contextlib.contextmanager
def with_few_passages():
    """Let rough lines pass at few operating points, and few single waves of few heights."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(passage, "LAMBDA_RATIOS", passage.LAMBDA_RATIOS[::2])
        patch.setitem(passage.WAVES, "relative_amplitude", (0.1, 1.0))
        yield


@contextlib.contextmanager
def on_few_surfaces(number=6):
    """Sample contact of surfaces on few strips of few of them, whose waves run at few angles to
    rolling, and follow it for few steps: where the size of an error is not judged."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("lube.contact.surface_strip.SURFACES", number)
        patch.setattr("lube.contact.strip_sampling.STRIPS", 150)
        patch.setattr("lube.inference.surface_records.FEWER", 1)
        patch.setattr("lube.inference.surface_records.LAYER_FEWER", 1)
        patch.setattr("lube.inference.planning.FEWER", 1)
        patch.setattr("lube.stages.areal.FEWER", 2)
        patch.setattr("lube.grid.film_responses.ANGLES", np.arange(0.0, 91.0, 45.0))
        patch.setattr("lube.contact.surface_trace.STEPS", 40)
        yield


def made(study, kinds=tuple(STAGES), threads=2):
    """Make the datasets of some kinds that the study has, and batches of all its realisations.

    Returns
    -------
    dict
        From each kind to its dataset, those that they are made from included.
    """
    datasets = {}
    for name, stage in STAGES.items():
        if stage.target == "benchmark" or not study.has(name) or name not in kinds:
            continue
        if stage.in_batches == "samples":
            batch = maker(name, "make_batch")
            datasets["batches"] = [batch(study, datasets, at) for at in range(SAMPLE_BATCHES)]
        elif stage.in_batches:
            lines = roughness_batch(study.line_spec, study.seed, range(study.realisations))
            batch = maker(name, "make_batch")(study, datasets["film"], lines)
            datasets[f"{name}_batch"] = batch
            datasets["batches"] = [batch]
        datasets[name] = maker(name)(study, datasets, threads)
    datasets.pop("batches", None)
    return datasets
