"""The rig that measures contact by electrical resistance, and the evaluation of its records.

Every default except the threshold of 100 ohm is assumed: the paper says nothing about the circuit.
Voltages far below a volt are usual, so that the film does not break down electrically.
"""

import math
from pathlib import Path
from typing import Annotated, Literal, NamedTuple

from pydantic import Field, StrictInt, model_validator

from lube.schema.tables import read_table
from lube.study.field_types import StrictModel, levels, quantity

RIG_REALISATIONS = 1_000_000
"""First realisation of the simulated rig's rollers; a study's realisations are below it."""

OWN_RIG = "study"
"""Name of a study's own rig among the known ones."""

_TABLE = Path(__file__).with_name("known_rigs.csv")
"""The known rigs: settings as in a study, what the meter reads, and where they come from."""

_Resistance = Annotated[float, quantity("ohm", above=0.0)]


class Preset(NamedTuple):
    """Settings of a known rig.

    Attributes
    ----------
    settings : dict
        Keys of `Rig` with their values; all others are as in the study.
    source : str
        Where they come from.
    reading : str
        What its meter reads, one of `lube.rig.readings.READINGS`.
    """

    settings: dict[str, str]
    source: str
    reading: str


KnownRig = Literal[
    "mtm-ecr",
    "mtm-ecr-10-ohm",
    "mtm-ecr-1-kohm",
    "mtm-ecr-10-kohm",
    "threshold-counter",
    "impedance-bridge",
]


def _preset(reading, source, **settings):
    return Preset({key: value for key, value in settings.items() if value}, source, reading)


PRESETS = {row.pop("name"): _preset(**row) for row in read_table(_TABLE)}
"""Known rigs, by the name that a study gives."""


class Rig(StrictModel, validate_default=True):
    """Circuit, amplifier and sampling of a simulated twin-disc rig."""

    preset: KnownRig | None = None
    """a known rig, whose values hold where the study gives none of its own"""
    bias_voltage: Annotated[float, quantity("V", above=0.0)] = "50 mV"
    """voltage across rollers and series resistor"""
    series_resistance: _Resistance = "100 ohm"
    """resistor in series with the rollers"""
    lead_resistance: Annotated[float, quantity("ohm", least=0.0)] = "0.2 ohm"
    """resistance of leads and slip rings, known and subtracted"""
    leak_resistance: _Resistance = "1 Mohm"
    """resistance of the insulation, in parallel with the contact"""
    oil_permittivity: Annotated[float, quantity(None, least=1.0)] = 2.2
    """relative permittivity, for the film's capacitance; typical of PAO"""
    amplifier_range: Annotated[float, quantity("V", above=0.0)] = "100 mV"
    """largest voltage of either sign before saturation"""
    bandwidth: Annotated[float, quantity("Hz", above=0.0)] = "50 kHz"
    """-3 dB frequency of the first-order low-pass"""
    sampling_rate: Annotated[float, quantity("Hz", above=0.0)] = "100 kHz"
    """samples per second"""
    resolution: Annotated[StrictInt, Field(ge=2, le=32)] = 16
    """bits of the converter, over the range of both signs"""
    noise: Annotated[float, quantity("V", least=0.0)] = "20 uV"
    """rms noise at the amplifier's input"""
    revolutions: Annotated[float, quantity(None, least=0.01, most=1000.0)] = 12
    """revolutions of the roller with the faster surface in each simulated record"""
    contact_model: Literal["line", "surface"] = "line"
    """what touches on the simulated rig: two roughness lines, or the rough surfaces over the whole
    length of the rollers, in pure rolling of rollers of one radius
    """
    pairs: Annotated[StrictInt, Field(ge=1, le=1000)] = 1
    """pairs of rollers that the simulated rig runs, one after the other; each makes a record at
    every operating point
    """
    drift: Annotated[float, quantity(None, least=0.0, most=1.0)] = 0
    """fraction of the roughness variance that each revolution renews, on the simulated rollers and,
    by assumption, on measured ones; at 0 the roughness stays the same
    """

    frequency: Annotated[float, quantity("Hz", above=0.0)] = "100 kHz"
    """frequency at which an impedance bridge measures the contact"""
    dielectric_strength: Annotated[float, quantity("V/m", above=0.0)] = "20 MV/m"
    """field at which the oil breaks down; as of insulating oils over 2.5 mm (IEC 60156), thin films
    bear more
    """

    @model_validator(mode="before")
    @classmethod
    def _take_preset(cls, given):
        match given:
            case {"preset": str(name)} if name in PRESETS:
                return {**PRESETS[name].settings, **given}
        return given

    def like(self, preset: KnownRig) -> "Rig":
        """Return this rig with the settings of a known one."""
        known = Rig(preset=preset).model_dump(include={"preset", *PRESETS[preset].settings})
        return self.model_copy(update=known)

    @property
    def has_surfaces(self) -> bool:
        """Whether rough surfaces touch on the simulated rig, and not lines."""
        return self.contact_model == "surface"

    @property
    def turns(self) -> int:
        """Number of revolutions, of which the last may be run in part."""
        return math.ceil(self.revolutions)

    @property
    def reading(self) -> str:
        """What its meter reads; a rig without a preset has a threshold."""
        return PRESETS[self.preset].reading if self.preset else "threshold"

    @property
    def resolved_voltage(self) -> float:
        """Voltage of one step of the converter, V."""
        return 2.0 * self.amplifier_range / 2**self.resolution


class Experiment(StrictModel, validate_default=True):
    """Source of the rig's records, and the criterion for contact."""

    manifest: str | None = None
    """CSV or YAML list of measured records; without it the rig is simulated"""
    thresholds: Annotated[tuple[float, ...], levels("ohm", above=0.0)] = Field(
        {"values": [10, 30, 100, 300, 1000], "units": "ohm"}
    )
    """resistances below which a record shows contact"""
    threshold: _Resistance = "100 ohm"
    """threshold, one of `thresholds`, at which records are compared with the simulation"""
    force_tolerance: Annotated[float, quantity(None, above=0.0, most=1.0)] = 0.01
    """largest relative deviation of a record's force from a level of the grid"""
    speed_tolerance: Annotated[float, quantity(None, above=0.0, most=1.0)] = 0.01
    """the same for its rotation speed; also the largest relative deviation of that speed from the
    one at which the record repeats itself
    """
    temperature_tolerance: Annotated[float, quantity("K", above=0.0)] = "1 K"
    """largest deviation of a record's temperature from a level of the grid"""
    release_ratio: Annotated[float, quantity(None, least=1.0)] = 1
    """contact ends at this multiple of the threshold; 1 is no hysteresis"""
    debounce: Annotated[float, quantity("s", least=0.0)] = "0 s"
    """shortest time that a change must last to count"""
