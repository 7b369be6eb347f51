"""Stages of a study: each makes one kind of file from those before it.

A stage is a row of `lube.schema.stages` and a module of its name with a function
``make(study, inputs, threads)``. It takes the study, the datasets of the kinds that its row lists,
and the number of threads that it may use, which does not change the result; it returns the dataset.
Stages that run in batches of realisations find these datasets in ``inputs["batches"]``; their
modules have ``make_batch(study, film, lines)`` besides, for some realisations of the lines.

The functions behind them, and what they take, are names of this package, in ``__init__.pyi``. They
are in SI units but for the operating variables: force in N, speed in r/min, temperature in degC.
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
        Its name in `lube.schema.STAGES`.
    name : str, optional
        ``make``, or ``make_batch`` for that of a batch.

    Returns
    -------
    callable
        ``make(study, inputs, threads)``, or ``make_batch(study, film, lines)``.
    """
    return getattr(importlib.import_module(f"lube.stages.{stage}"), name)
