"""The rig that measures contact by electrical resistance, and how its records are judged.

Every default is a value of one's own choosing: the paper tells of no circuit, only of the
threshold of 100 ohm. Voltages far below a volt are usual, so that the film does not break down
electrically.
"""

from typing import Annotated

from pydantic import Field, StrictInt, model_validator

from lube.fields import StrictModel, levels, pure_number, quantity

RIG_REALISATIONS = 1_000_000
"""First realisation of the rig's own rollers; a study's realisations end before it."""

_Resistance = quantity("ohm", above=0.0)


class Rig(StrictModel):
    """Circuit, amplifier and sampling of a simulated twin-disc rig."""

    bias_voltage: quantity("V", above=0.0) = Field(
        0.05, description="voltage over rollers and series resistor; assumed 50 mV"
    )
    series_resistance: _Resistance = Field(
        1e3, description="resistor in series with the rollers; assumed 1 kohm"
    )
    lead_resistance: quantity("ohm", least=0.0) = Field(
        0.2, description="leads and slip rings, known and subtracted; assumed 0.2 ohm"
    )
    leak_resistance: _Resistance = Field(
        1e6, description="insulation in parallel with the contact; assumed 1 Mohm"
    )
    oil_permittivity: pure_number(least=1.0) = Field(
        2.2, description="relative permittivity, for the film's capacitance; typical of PAO"
    )
    amplifier_range: quantity("V", above=0.0) = Field(
        0.1, description="largest voltage of either sign before saturation; assumed 100 mV"
    )
    bandwidth: quantity("Hz", above=0.0) = Field(
        5e4, description="-3 dB frequency of the first-order low-pass; assumed 50 kHz"
    )
    sampling_rate: quantity("Hz", above=0.0) = Field(
        2e5, description="samples per second; assumed 200 kHz"
    )
    resolution: Annotated[StrictInt, Field(ge=2, le=32)] = Field(
        16, description="bits of the converter, over the range of both signs; assumed 16"
    )
    noise: quantity("V", least=0.0) = Field(
        2e-5, description="rms noise at the amplifier's input; assumed 20 uV"
    )
    revolutions: Annotated[StrictInt, Field(ge=1, le=1000)] = Field(
        16, description="of each record, each with a roughness of its own"
    )

    @property
    def resolved_voltage(self):
        """Voltage of one step of the converter, V."""
        return 2.0 * self.amplifier_range / 2**self.resolution


class Experiment(StrictModel):
    """Where the rig's records come from, and when they are taken for contact."""

    manifest: str | None = Field(
        None, description="CSV or YAML list of measured records; without it the rig is simulated"
    )
    thresholds: levels("ohm", above=0.0) = Field(
        (10.0, 30.0, 100.0, 300.0, 1000.0),
        description="resistances below which a record shows contact",
    )
    threshold: _Resistance = Field(
        100.0, description="the one of them that is compared with the simulation (the paper's)"
    )
    release_ratio: pure_number(least=1.0) = Field(
        1.0, description="contact ends at so many times the threshold; 1 is no hysteresis"
    )
    debounce: quantity("s", least=0.0) = Field(
        0.0, description="shortest time that a change must last to count"
    )

    @model_validator(mode="after")
    def _check_threshold(self):
        if self.threshold not in self.thresholds:
            told = ", ".join(f"{value:g}" for value in self.thresholds)
            raise ValueError(f"threshold: got {self.threshold:g} ohm, need one of {told} ohm")
        return self
