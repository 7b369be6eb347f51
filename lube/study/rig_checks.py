"""Refuse a rig, or an evaluation of records, that could not show whether the rollers touch."""

from typing import TYPE_CHECKING

import numpy as np

from lube.errors import StudyError, shown
from lube.grid.levels import rolling
from lube.physics.electrical import divider_voltage
from lube.study.rollers import INSULATOR

if TYPE_CHECKING:
    from lube.study.study import Study


def check_rig(study: "Study") -> None:
    """Refuse a rig that could not show whether the rollers touch.

    Parameters
    ----------
    study : Study
        The study, its parts checked.

    Raises
    ------
    StudyError
        Which key, what came, what is needed.
    """
    experiment, rig = study.experiment, study.rig
    if experiment.threshold not in experiment.thresholds:
        raise StudyError(
            f"experiment.threshold: got {experiment.threshold:g} ohm, need one of "
            f"experiment.thresholds: {shown(experiment.thresholds)} ohm"
        )
    if rig.has_surfaces:
        _check_surfaces(study)
    is_simulated = experiment.manifest is None
    if not (study.conducts or is_simulated):
        raise StudyError(
            f"resistivity: got {INSULATOR} together with experiment.manifest, need a "
            "resistivity: records show contact by its resistance"
        )
    if is_simulated and rig.drift > 0.0 and not study.line_spec.is_gaussian:
        raise StudyError(
            f"rig.drift: got {rig.drift:g}, need 0 for a simulated rig with roughness "
            "that is measured or not Gaussian: mixing lines changes the distribution of heights"
        )
    largest = max(experiment.thresholds) * experiment.release_ratio
    voltage = divider_voltage(largest, rig)
    if voltage >= rig.amplifier_range:
        raise StudyError(
            f"rig.amplifier_range: got {rig.amplifier_range:g} V, need more than the "
            f"{voltage:.3g} V across {largest:g} ohm in this circuit"
        )
    if is_simulated and study.conducts:
        _check_simulated_circuit(rig, experiment.threshold, largest)


def _check_surfaces(study):
    """Refuse surfaces on the rig where other points of them meet in every turn."""
    slips = rolling(study.slips), study.trace_points[0]["slide_to_roll_ratio"]
    needed = {
        "contact_model: surface or [line, surface]": study.has_surfaces,
        "rollers of one radius: else other points of the surfaces meet in every turn": (
            study.line_spec.points[0] == study.line_spec.points[1]
        ),
        "a slide-to-roll ratio of 0 in operating_grid and traces: with slip other points of "
        "the surfaces meet at every step": not any(slips),
        "rig.drift: 0": study.rig.drift == 0.0,
    }
    for what, is_so in needed.items():
        if not is_so:
            line = "line" if study.line_spec.follows_rolling else "line, without records then"
            raise StudyError(f"rig.contact_model: got surface, need {line}, or {what}")


def _check_simulated_circuit(rig, threshold, largest):
    """Refuse a leak or a noise that shows contact where there is none, or hides it."""
    if rig.leak_resistance <= largest:
        raise StudyError(
            f"rig.leak_resistance: got {rig.leak_resistance:g} ohm, need more than "
            f"{largest:g} ohm, below which a record shows contact"
        )
    levels = divider_voltage(np.array([0.0, threshold, rig.leak_resistance]), rig)
    most = np.diff(np.minimum(levels, rig.amplifier_range)).min() / 3.0
    if rig.noise > most:
        raise StudyError(
            f"rig.noise: got {rig.noise:.3g} V, need at most {most:.3g} V, a third of the "
            f"voltage between {threshold:g} ohm and a contact that is closed or open"
        )
