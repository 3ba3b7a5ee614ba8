"""Declaration of the table [input], whose keys depend on its kind, and of [sweep] beside it."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from wedgesweep.config.keys import Choice, Flag, Key, Number, Text, Unit, Whole
from wedgesweep.config.series import Numbers, Series
from wedgesweep.config.tables import Table, table
from wedgesweep.hints import hint, show
from wedgesweep.inputs.units import RECORDED, UNITS

KIND = "kind"


def _positive(key: str, meaning: str, **more: Any) -> Number:
    return Number.new(key, meaning, above=0.0, **more)


def _size(key: str, meaning: str, example: float) -> tuple[Key, ...]:
    """A number whose unit tells the quantity: motion of the base, or a force on the mass."""
    return tuple(
        _positive(f"{key}_{unit}", f"{meaning}: {own.quantity}", example=example)
        for unit, own in UNITS.items()
    )


DURATION = _positive("duration_s", "length of the input", example=30.0)
SAMPLING = _positive(
    "sampling_hz",
    "sampling rate of the stored waveforms; default: as high as input and model need",
    optional=True,
    example=500.0,
)
FADE = Number.new("fade_s", "time in which it rises at its start and falls at its end", 0.0, minimum=0.0)


def _kind(name: str, meaning: str, *keys: Key | tuple[Key, ...]) -> Table:
    kind = Choice(KIND, meaning, choices=(name,), example=name)
    return table("input", meaning, kind, *keys, optional=True)


SINE_SWEEP = _kind(
    "sine-sweep",
    "a sine whose frequency moves through a band",
    _size("amplitude", "amplitude", 1.0),
    _positive("start_hz", "frequency at the start", example=2.0),
    _positive("stop_hz", "frequency at the end", example=30.0),
    Choice(
        "rate",
        "how the frequency moves: equal ratios, or equal steps, in equal times",
        choices=("logarithmic", "linear"),
        default="logarithmic",
    ),
    DURATION,
    FADE,
    SAMPLING,
)
RANDOM = _kind(
    "random",
    "random motion with a given power spectral density",
    _size("rms", "rms of the whole input", 1.0),
    _positive("start_hz", "lowest frequency of a band of constant density", optional=True, example=2.0),
    _positive("stop_hz", "highest frequency of the band", optional=True, example=30.0),
    Series(
        "frequency_hz",
        "instead of a band: frequencies at which the density is given",
        item=_positive("frequency_hz", "frequency"),
        optional=True,
        example=[1.0, 10.0, 30.0],
    ),
    Numbers(
        "level",
        "the density at each of them, in any unit",
        item=_positive("level", "level"),
        optional=True,
        example=[1.0, 1.0, 0.1],
    ),
    Whole.new("seed", "seed of the random numbers", 0, minimum=0, maximum=2**31 - 1),
    Flag("periodic", "whether it is one period of a periodic signal, whose spectrum is exact", default=True),
    DURATION,
    FADE,
    SAMPLING,
)
RELEASE = _kind(
    "release",
    "no input: the mass is released and rings down",
    Number.new("displacement_mm", "displacement at the start, as the dataset counts it", 0.0),
    Number.new("velocity_mm_per_s", "velocity at the start", 0.0),
    DURATION,
    SAMPLING,
)
RAMP = _kind(
    "ramp",
    "a base that moves at a constant velocity",
    Number.new("velocity_mm_per_s", "velocity of the base", example=10.0),
    DURATION,
    SAMPLING,
)


RECORD = _kind(
    "record",
    "a recorded input",
    Text("file", "CSV file, relative to this config", example="bump.csv"),
    Text("sha256", "digest of the file; filled in when the config is read", optional=True),
    Text("column", "header of the input's column", example="base"),
    Choice("quantity", "what it is", choices=tuple(RECORDED), default="displacement"),
    Unit(
        "unit",
        "its unit",
        choices=tuple(dict.fromkeys(unit for units in RECORDED.values() for unit in units)),
        example="mm",
    ),
    (
        Text("time", "header of the time's column (s)", example="time"),
        _positive("sampling_hz", "sampling rate, where there is no such column", example=500.0),
    ),
    Flag("detrend", "whether to subtract its mean", default=False),
)
KINDS = {
    "sine-sweep": SINE_SWEEP,
    "random": RANDOM,
    "record": RECORD,
    "ramp": RAMP,
    "release": RELEASE,
}


@dataclass(frozen=True, kw_only=True)
class ByKind(Key):
    """A table whose keys depend on its key ``kind``."""

    kinds: Mapping[str, Table]

    def read(self, value: Any, path: str, problems: list[str]) -> dict[str, Any]:
        if not isinstance(value, dict):
            problems.append(f"{path}: {show(value)} is not a table; write [{path}], its keys below")
            return {}
        if value.get(KIND) not in list(self.kinds):
            fault = f"unknown name {show(value[KIND])}" if KIND in value else "missing"
            problems.append(f"{path}.{KIND}: {fault}; {hint(str(value.get(KIND, '')), self.kinds)}")
            return {}
        return self.kinds[value[KIND]].read(value, path, problems)

    def shape(self) -> dict[str, Any]:
        return {"oneOf": [each.shape() for each in self.kinds.values()]}


INPUT = ByKind(
    "input",
    "an input that does not repeat, instead of frequencies and amplitudes in [sweep]",
    kinds=KINDS,
    optional=True,
)
SCALE = Series(
    "scale",
    "factor of the input, or of the displacement and velocity of a release",
    item=_positive("scale", "scale"),
    default=[1.0],
)
