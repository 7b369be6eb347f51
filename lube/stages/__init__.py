"""Stages of a study: each makes one kind of file from the files of earlier stages.

A stage is a row of `lube.schema.stages` and a module of its name with a function
``make(study, inputs, threads)``. It takes the study, the datasets of the kinds that its row lists,
and the number of threads that it may use, which does not change the result; it returns the dataset.
Stages that run in batches find these datasets in ``inputs["batches"]``; their modules also have
``make_batch(study, film, lines)``, for the lines of some realisations, or ``make_batch(study,
inputs, number)``, for some samples of what is uncertain.

Functions that stages call, and the types of their arguments, are names of this package, listed in
``__init__.pyi``. They use SI units except for the operating variables: force in N, speed in r/min,
temperature in degC.
"""

import importlib
from collections.abc import Callable

import xarray as xr

from lube.lazy import attach

__getattr__, __dir__ = attach("lube.stages")


def maker(stage: str, name: str = "make") -> Callable[..., xr.Dataset]:
    """Return the function that makes a stage's dataset.

    Parameters
    ----------
    stage : str
        Name of the stage in `lube.schema.STAGES`.
    name : str, optional
        ``make``, or ``make_batch`` for a batch.

    Returns
    -------
    callable
        ``make(study, inputs, threads)``, or `make_batch` with the arguments of its module.
    """
    return getattr(importlib.import_module(f"lube.stages.{stage}"), name)
