"""The experiment stage: the share of time that the rig's resistance lies below a threshold.

Records are measured ones, or those of a simulated rig, never both: a file says which in its
coordinate ``origin``. The simulated rig has rollers of its own, of realisations that no
simulation uses, and each of its revolutions shows another roughness, as if the rollers had
been moved against one another in between.
"""

import logging
from itertools import product

import numpy as np
import xarray as xr

from lube.errors import DataError
from lube.evaluation import ContactShare, share_interval
from lube.kernels.strips import strip_trace
from lube.recordings import open_recording
from lube.resistance import divider_voltage, film_capacitance, resistance_from_voltage
from lube.rig import logged_voltage
from lube.schema import EXPERIMENT_DIMS, label
from lube.steps import layer_factor_of, line_pair, revolution, speed_ratios, whole_numbers

log = logging.getLogger(__name__)

TOGETHER = 16
"""Operating points whose contact at all time steps is held at once: a matter of memory."""

NEAR = 0.005
"""Relative distance within which a record's force, speed or temperature is a level's."""

SATURATED = 0.001
"""Share of a record's samples at the amplifier's limits from which on it is refused."""

REVOLUTIONS = ("revolution_share", "revolution_share_lower", "revolution_share_upper")
"""Share of time below the compared threshold in each revolution alone, and its limits."""

BANDWIDTHS = (1e3, 3e3, 1e4, 3e4, 1e5, 3e5)
"""Bandwidths in Hz that the rig's records are tried with, other things equal."""


class SimulatedRig:
    """The rollers of a simulated rig, and the circuit that watches them.

    Parameters
    ----------
    lines : xarray.Dataset
        A ``roughness_batch`` dataset of the rig's own realisations, one a revolution.
    study : Study
        Its rig, boundary layer, rollers and seed.
    """

    def __init__(self, lines, study):
        self._lines, self._study = lines, study

    def contacts(self, places, realisation, slip):
        """Points in metallic contact at all time steps of one revolution, place by place.

        Parameters
        ----------
        places : list of dict
            Each with ``film_thickness``, ``contact_half_width`` (m), ``entrainment_speed``
            (m/s) and ``reduced_modulus`` (Pa).
        realisation : int
            Which of the rig's realisations.
        slip : float
            Slide-to-roll ratio.

        Yields
        ------
        contact : numpy.ndarray
            Shape (T,), int32.
        """
        pair, ratios = line_pair(self._lines, realisation), speed_ratios(slip)
        steps = revolution(pair, ratios)
        factor = layer_factor_of(
            self._lines, places[0]["reduced_modulus"], self._study.boundary_layer
        )
        for first in range(0, len(places), TOGETHER):
            some = places[first : first + TOGETHER]
            films, half_windows = whole_numbers(
                [place["film_thickness"] for place in some],
                [place["contact_half_width"] for place in some],
                self._lines,
            )
            yield from strip_trace(*pair, ratios, steps, films, half_windows, factor)

    def voltage(self, contact, place, slip, noise_of, rig):
        """Log a contact with a rig's circuit.

        Parameters
        ----------
        contact : numpy.ndarray
            From `contacts`.
        place : dict
            The operating point, as there.
        slip : float
            Slide-to-roll ratio.
        noise_of : tuple of int
            What the noise hangs on, beside the study's seed.
        rig : Rig
            Circuit, amplifier and sampling.

        Returns
        -------
        numpy.ndarray
            Shape (samples,), V.
        """
        study = self._study
        spacing = self._lines.attrs["spacing"]
        faster = place["entrainment_speed"] * (1.0 + abs(slip) / 2.0)
        capacitance = film_capacitance(
            place["film_thickness"],
            place["contact_half_width"],
            study.rollers.length,
            rig.oil_permittivity,
        )
        return logged_voltage(
            contact,
            spacing / faster,
            study.resistivity / spacing,
            capacitance,
            rig,
            np.random.default_rng(np.random.SeedSequence((study.seed, *noise_of))),
        )


def simulated_experiment(lines, film, study):
    """Let a simulated rig record all operating points, and evaluate what it logs.

    The films are those of the film table's first formula.

    Parameters
    ----------
    lines : xarray.Dataset
        A ``roughness_batch`` dataset of the rig's own realisations, one a revolution.
    film : xarray.Dataset
        A ``film`` dataset.
    study : Study
        Its rig, evaluation of records, boundary layer, rollers and seed.

    Returns
    -------
    xarray.Dataset
        The ``experiment`` file of `lube.schema`, of the origin ``simulated``.
    """
    simulated, rig, slip = SimulatedRig(lines, study), study.rig, study.rig_slip
    q_min = lines.attrs["q_min"]
    places = _places(film.isel(film_formula=0), slip)
    interval = 1.0 / rig.sampling_rate
    counters = [_counter(study.experiment, rig, "voltage", interval) for _ in places]
    touched = np.zeros((len(places), 2))  # steps in contact, and all
    compared = study.experiment.model_copy(update={"thresholds": (study.experiment.threshold,)})
    alone = [[] for _ in places]  # each revolution as a record of its own
    for count, realisation in enumerate(lines["realisation"].values.tolist(), start=1):
        for number, contact in enumerate(simulated.contacts(places, realisation, slip)):
            noise_of = (realisation, number + 1)
            voltage = simulated.voltage(contact, places[number], slip, noise_of, rig)
            counters[number].add(voltage)
            turn = _counter(compared, rig, "voltage", interval)
            turn.add(voltage)
            alone[number].append(np.ravel(_shares(places[number], turn, interval, q_min)))
            touched[number] += np.count_nonzero(contact), contact.size
        log.info("simulated rig: revolution %d of %d", count, lines.sizes["realisation"])
    rows = [
        _row(place, counter, interval, "simulated", q_min)
        | {"true_contact_share": steps[0] / steps[1]}
        | dict(zip(REVOLUTIONS, np.transpose(shares), strict=True))
        for place, counter, steps, shares in zip(places, counters, touched, alone, strict=True)
    ]
    return _experiment(rows, film, study, "simulated", [])


def measured_experiment(manifest, film, study):
    """Evaluate measured records, as far as they can be used.

    Parameters
    ----------
    manifest : Manifest
        From `lube.recordings.read_manifest`.
    film : xarray.Dataset
        A ``film`` dataset, whose levels are the study's.
    study : Study
        Its rig, which tells a voltage's resistance, and its evaluation of records.

    Returns
    -------
    xarray.Dataset
        The ``experiment`` file of `lube.schema`; what could not be used stands, a line each, in
        its attribute ``refused``.

    Raises
    ------
    DataError
        If no record can be used.
    """
    table = film.isel(film_formula=0)  # of which only contact width and speed are used
    places = {_key(place): place for slip in study.slips for place in _places(table, slip)}
    rows, refused = {}, list(manifest.refused)
    for entry in manifest.entries:
        try:
            place = places[_level_key(entry, film, study)]
            if _key(place) in rows:
                raise DataError(f"{entry.where}: its operating point has a record already")
            rows[_key(place)] = _evaluated(entry, place, study)
        except DataError as error:
            refused.append(str(error))
    for line in refused:
        log.warning("Refused: %s", line)
    if not rows:
        raise DataError(f"no record can be used; the first: {refused[0] if refused else 'none'}")
    return _experiment(list(rows.values()), film, study, manifest.origin, refused)


def _places(table, slip):
    """Operating points of a film table, of one formula, as plain numbers, in order."""
    names = EXPERIMENT_DIMS[1:]
    return [
        {
            **dict(zip(names, levels, strict=True)),
            "slide_to_roll_ratio": slip,
            "film_thickness": table["film_thickness"].values[index],
            "contact_half_width": table["contact_half_width"].values[index[-1]],
            "entrainment_speed": table["entrainment_speed"].values[index[-2]],
            "reduced_modulus": table["reduced_modulus"].item(),
        }
        for index, levels in zip(
            np.ndindex(table["film_thickness"].transpose(*names).shape),
            product(*(table[name].values.tolist() for name in names)),
            strict=True,
        )
    ]


def _key(place):
    return tuple(place[name] for name in EXPERIMENT_DIMS)


def _level_key(entry, film, study):
    """Levels of the study that an entry of a manifest names."""
    given = {
        "lubricant": entry.lubricant or study.lubricants[0].name,
        "slide_to_roll_ratio": entry.slide_to_roll_ratio,
        **{name: getattr(entry, name) for name in ("temperature", "speed", "force")},
    }
    if given["slide_to_roll_ratio"] is None:
        given["slide_to_roll_ratio"] = study.rig_slip
    return tuple(_level(entry.where, name, given[name], film, study) for name in EXPERIMENT_DIMS)


def _level(where, name, value, film, study):
    levels = study.slips if name == "slide_to_roll_ratio" else film[name].values.tolist()
    for level in levels:
        if value == level or (name != "lubricant" and abs(value - level) <= NEAR * abs(level)):
            return level
    told = ", ".join(f"{level:g}" if name != "lubricant" else level for level in levels)
    raise DataError(f"{where}: {name}: got {value}, need one of the study's: {told}")


def _counter(experiment, rig, quantity, interval):
    """Begin to count the time below the thresholds, in a record of voltage or resistance."""
    limits = np.array(experiment.thresholds)
    releases = limits * experiment.release_ratio
    if quantity == "voltage":
        limits, releases = divider_voltage(limits, rig), divider_voltage(releases, rig)
    hold = round(experiment.debounce / interval)
    return ContactShare(limits, None if experiment.release_ratio == 1.0 else releases, hold)


def _evaluated(entry, place, study):
    """Row of one entry of a manifest."""
    if entry.file is None:
        # Evaluated elsewhere, at the threshold that is compared: there alone it stands.
        at = np.array(study.experiment.thresholds) == study.experiment.threshold
        return {
            **place,
            "contact_share": np.where(at, entry.probability, np.nan),
            "contact_share_lower": np.where(at, _or_nan(entry.lower), np.nan),
            "contact_share_upper": np.where(at, _or_nan(entry.upper), np.nan),
            "record": entry.where,
        }
    recording = open_recording(entry.file, entry.sampling_interval)
    interval = recording.sampling_interval
    counter = _counter(study.experiment, study.rig, recording.quantity, interval)
    limit = study.rig.amplifier_range if recording.quantity == "voltage" else np.inf
    saturated = samples = 0
    for piece in recording.pieces():
        counter.add(piece)
        saturated += np.count_nonzero(np.abs(piece) >= limit)
        samples += piece.size
    if saturated > SATURATED * samples:
        raise DataError(
            f"{entry.file}: {saturated / samples:.1%} of its samples are at or beyond "
            f"{limit:g} V, rig.amplifier_range: the record is saturated"
        )
    return _row(place, counter, interval, entry.file.name, study.line_spec.q_min)


def _or_nan(value):
    return np.nan if value is None else value


def _shares(place, counter, interval, q_min):
    """Share below each threshold, and the limits of its interval, each of shape (K,)."""
    duration = counter.sizes.sum() * interval
    slower = place["entrainment_speed"] * (1.0 - abs(place["slide_to_roll_ratio"]) / 2.0)
    # Windows a longest wavelength apart share no roughness.
    reach = 2.0 * place["contact_half_width"] + 2.0 * np.pi / q_min
    windows = max(duration * slower / reach, 1.0)
    return share_interval(counter.below, counter.sizes, windows)


def _row(place, counter, interval, record, q_min):
    """Share, interval and origin of one record."""
    share, lower, upper = _shares(place, counter, interval, q_min)
    return {
        **place,
        "contact_share": share,
        "contact_share_lower": lower,
        "contact_share_upper": upper,
        "record": record,
        "duration": counter.sizes.sum() * interval,
        "sampling_interval": interval,
    }


def _experiment(rows, film, study, origin, refused):
    """Put rows where they belong on the study's coordinates."""
    coords = {"slide_to_roll_ratio": np.array(study.slips)}
    coords |= {name: film[name].values for name in EXPERIMENT_DIMS[1:]}
    shape = tuple(values.size for values in coords.values())
    thresholds = np.array(study.experiment.thresholds)
    numbers = ("true_contact_share", "duration", "sampling_interval")
    shares = ("contact_share", "contact_share_lower", "contact_share_upper")
    values = {name: np.full(shape, np.nan) for name in numbers}
    values |= {name: np.full((*shape, thresholds.size), np.nan) for name in shares}
    revolutions = max(np.size(row.get(REVOLUTIONS[0], np.nan)) for row in rows)
    values |= {name: np.full((*shape, revolutions), np.nan) for name in REVOLUTIONS}
    records = np.full(shape, "", object)
    for row in rows:
        index = tuple(levels.tolist().index(row[name]) for name, levels in coords.items())
        records[index] = row["record"]
        for name in values:
            values[name][index] = row.get(name, np.nan)
    dataset = xr.Dataset(
        {name: (EXPERIMENT_DIMS, values[name]) for name in numbers}
        | {name: ((*EXPERIMENT_DIMS, "threshold"), values[name]) for name in shares}
        | {name: ((*EXPERIMENT_DIMS, "revolution"), values[name]) for name in REVOLUTIONS}
        | {"record": (EXPERIMENT_DIMS, records.astype(str))},
        coords=coords | {"threshold": thresholds, "origin": origin},
        attrs={"refused": "\n".join(refused)},
    )
    dataset["comparison_threshold"] = study.experiment.threshold
    return label(dataset, "experiment")


def rig_records(lines, film, study):
    """Record the study's trace points with the simulated rig, and with others.

    Parameters
    ----------
    lines, film, study
        As in `simulated_experiment`; of the lines, the first realisation is recorded.

    Returns
    -------
    xarray.Dataset
        The ``rig`` file of `lube.schema`: voltage (V) and resistance (ohm) over
        (operating_point, rig_time) for one revolution, and the shares of time below the
        thresholds that rigs of several bandwidths would find, over all revolutions.
    """
    simulated, places = SimulatedRig(lines, study), []
    for point in study.trace_points:
        slip = point["slide_to_roll_ratio"]  # the same for all
        table = _places(film.sel(film_formula=point["film_formula"]), slip)
        places += [place for place in table if _key(place) == _key(point)]
    interval = 1.0 / study.rig.sampling_rate
    rigs = [study.rig.model_copy(update={"bandwidth": bandwidth}) for bandwidth in BANDWIDTHS]
    counters = [
        [_counter(study.experiment, rig, "voltage", interval) for rig in rigs] for _ in places
    ]
    touched, voltages = np.zeros((len(places), 2)), []
    for realisation in lines["realisation"].values.tolist():
        for number, contact in enumerate(simulated.contacts(places, realisation, slip)):
            touched[number] += np.count_nonzero(contact), contact.size
            noise_of = (realisation, number + 1)
            for rig, counter in zip(rigs, counters[number], strict=True):
                counter.add(simulated.voltage(contact, places[number], slip, noise_of, rig))
            if len(voltages) < len(places):
                voltages.append(
                    simulated.voltage(contact, places[number], slip, noise_of, study.rig)
                )
    voltage = np.array(voltages)
    shares = [
        [counter.below.sum(axis=1) / counter.sizes.sum() for counter in of] for of in counters
    ]
    dataset = xr.Dataset(
        {
            "voltage": (("operating_point", "rig_time"), voltage),
            "resistance": (
                ("operating_point", "rig_time"),
                resistance_from_voltage(voltage, study.rig),
            ),
            "contact_share": (("operating_point", "bandwidth", "threshold"), np.array(shares)),
            "true_contact_share": ("operating_point", touched[:, 0] / touched[:, 1]),
            **{
                name: ("operating_point", np.array([place[name] for place in places]))
                for name in EXPERIMENT_DIMS
            },
        },
        coords={
            "rig_time": interval * np.arange(voltage.shape[1]),
            "bandwidth": np.array(BANDWIDTHS),
            "threshold": np.array(study.experiment.thresholds),
            "origin": "simulated",
        },
    )
    for name in ("bandwidth", "sampling_rate", "bias_voltage"):
        dataset[f"rig_{name}"] = getattr(study.rig, name)
    return label(dataset.set_coords(list(EXPERIMENT_DIMS)), "rig")
