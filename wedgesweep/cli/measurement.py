"""The table of measured tests that check prints."""

from collections.abc import Sequence
from itertools import groupby
from typing import TYPE_CHECKING

import click

from wedgesweep import rotation
from wedgesweep.cli.messages import log

if TYPE_CHECKING:
    from wedgesweep.diagnose.steady.column_load import ColumnLoad
    from wedgesweep.diagnose.steady.spectra import Spectrum
    from wedgesweep.diagnose.transient.window import RecordWindow
    from wedgesweep.measured import Measurement, TestRecord

HEADINGS = ("file", "frequency", "amplitude", "periods", "samples", "noise", "harmonics seen")
LOOP_HEADINGS = ("file", "duration", "samples", "low-pass", "noise", "of velocity", "blocks")
LOOP_UNITS = ("", "s", "", "Hz", "of force", "", "of cycles")
TRANSIENT_HEADINGS = (
    *("file", "duration", "samples", "periods", "windows"),
    *("largest", "noise", "its correlation", "taken from"),
)
TRANSIENT_UNITS = ("", "s", "", "natural", "", "mm", "of first response", "to the next sample", "")


# Tests of a kind whose noise a diagnosis prints.
NOISE_LINES = 12
# Noise over the rms of a channel that is worth a warning.
NOISY = 0.2


def print_measurement(measurement: "Measurement") -> None:
    """Print what was read, and a table of the tests."""
    click.echo(f"{measurement.path}: valid\ntitle: {measurement.title}")
    click.echo(f"model: {measurement.model.title}, {measurement.law}")
    for name, std in measurement.uncertain.items():
        click.echo(f"uncertain: {name}, {100.0 * std:.3g} %")
    for test in measurement.tests:
        if test.remarks:
            click.echo(f"{test.file}: {'; '.join(test.remarks)}")
    derived = " (velocity derived from displacement)" if measurement.derived_velocity else ""
    click.echo(f"tests: {len(measurement.tests)}{derived}\n")
    for kind in measurement.kinds:
        _print_table(measurement.of_kind(kind))
    print_warnings(measurement)


def _table(measurement: "Measurement") -> list[tuple[str, ...]]:
    """Headings, units and a row for each of the tests of one kind, in the units of the model."""
    rows = _rows(measurement)
    if not measurement.model.turns:
        return rows
    headings, units, *tests = rows
    return [tuple(map(rotation.in_units, row)) for row in (headings, map(rotation.prose, units), *tests)]


def _rows(measurement: "Measurement") -> list[tuple[str, ...]]:
    """The same in the units of a translation."""
    if measurement.kind == "loop":
        return [LOOP_HEADINGS, LOOP_UNITS, *_loop_rows(measurement)]
    if measurement.kind == "transient":
        return [TRANSIENT_HEADINGS, TRANSIENT_UNITS, *_transient_rows(measurement)]
    unit = measurement.model.amplitude_unit
    units = ("", "Hz", unit.unit, "", "per period", "of responses", "")
    return [HEADINGS, units, *_steady_rows(measurement, unit.factor)]


def print_noise(measurement: "Measurement") -> None:
    """Print the noise of each test, as it is in the table."""
    for kind in measurement.kinds:
        headings, units, *rows = _table(measurement.of_kind(kind))
        place = headings.index("noise")
        for row in rows[:NOISE_LINES]:
            log.info(f"{row[0]}: noise {row[place]} {units[place]}")


def _print_table(measurement: "Measurement") -> None:
    """Print the tests of one kind."""
    rows = _table(measurement)
    widths = [max(map(len, column)) for column in zip(*rows, strict=True)]
    for row in rows:
        cells = (cell.ljust(width) for cell, width in zip(row, widths, strict=True))
        click.echo("  ".join(cells).rstrip())


def print_warnings(measurement: "Measurement") -> None:
    """Print what is odd in records that are usable all the same."""
    from wedgesweep.measured import consistency, quality

    for test in measurement.tests:
        for warning in quality.warnings(test):
            log.warning(f"warning: {test.file}: {warning}")
    for warning in consistency.warnings(measurement):
        log.warning(f"warning: {warning}")


def _transient_rows(measurement: "Measurement") -> list[tuple[str, ...]]:
    """What is compared of each free motion."""
    from wedgesweep.diagnose.transient.from_measurement import recorded_windows

    windows = recorded_windows(measurement).windows
    rows: list[tuple[str, ...]] = []
    for number, test in enumerate(measurement.tests):
        own = [each for each in windows if each.number == number]
        noise = own[0].spectra[0]
        rows.append(
            (
                test.file,
                f"{test.duration:.4g}",
                f"{test.time.size}",
                f"{sum(each.natural for each in own):.4g}",
                f"{len(own)}",
                f"{1e3 * max(each.length for each in own):.4g}",
                _transient_noise(own),
                f"{noise.correlation:.2f}",
                noise.source,
            )
        )
    return rows


def _transient_noise(windows: "Sequence[RecordWindow]") -> str:
    """Noise of the first response of a test, in its unit and as a share of that response at its largest."""
    from wedgesweep.measured.declarations import MOTIONS
    from wedgesweep.measured.kinds import DISPLAY_UNITS

    order, signals = windows[0].orders[0], [each.channels[0] for each in windows]
    # The zero of an accelerometer is unknown.
    swing = max(0.5 * float(each.max() - each.min()) for each in signals)
    largest = max(each.length for each in windows) if order == 0 else swing
    std, (size, unit) = windows[0].spectra[0].std, DISPLAY_UNITS[MOTIONS[order]]
    return f"{std / size:.3g} {unit} ({100.0 * std / largest:.2g} %)"


def _loop_rows(measurement: "Measurement") -> list[tuple[str, ...]]:
    """What is compared of each loop."""
    from wedgesweep.diagnose.loop.loop_data import loop_data

    recordings = loop_data(measurement).recordings
    for test, own in zip(measurement.tests, recordings, strict=True):
        _warn_of_noise(test, "force", own.noise_share, "lower lowpass_hz")
    return [
        (
            test.file,
            f"{test.duration:.4g}",
            f"{test.time.size}",
            f"{own.low_pass.cutoff:.4g}",
            f"{own.noise:.3g} N ({100.0 * own.noise_share:.2g} %)",
            f"{1e3 * own.motion.noise[1]:.3g} mm/s",
            f"{len(own.blocks)}",
        )
        for test, own in zip(measurement.tests, recordings, strict=True)
    ]


def _warn_of_noise(test: "TestRecord", name: str, share: float, mend: str) -> None:
    """Warn of noise that is more than NOISY of the rms of a channel."""
    if share > NOISY:
        what = f"noise is {100.0 * share:.0f} % of the {name}"
        log.warning(f"warning: {test.file}: {what}; average it down, or {mend}")


def _steady_rows(measurement: "Measurement", size: float) -> list[tuple[str, ...]]:
    """What is compared of each steady test; input amplitudes are in a unit of some size."""
    from wedgesweep.diagnose.steady.from_measurement import column_load_of, recorded_spectra

    names, spectra = measurement.compared(measurement.tests[0]), recorded_spectra(measurement)
    for test, own in zip(measurement.tests, spectra, strict=True):
        for name, share in zip(names, own.sample_noise / own.rms, strict=False):
            _warn_of_noise(test, name, float(share), "excite more")
    return [
        (
            test.file,
            f"{own.frequency:.6g}{_origin(test.frequency, own.frequency)}",
            _amplitude(test, size),
            f"{test.duration * own.frequency:.2f}",
            f"{test.sampling_rate / own.frequency:.4g}",
            ", ".join(filter(None, (_noise(names, own), _load_noise(column_load_of(test))))),
            _runs(own.seen),
        )
        for test, own in zip(measurement.tests, spectra, strict=True)
    ]


def _origin(stated: float | None, used: float) -> str:
    """Say where a frequency (Hz) comes from if it is not the stated one."""
    if stated is None:
        return " (estimated)"
    return "" if used == stated else f" (stated: {stated:.6g})"


def _amplitude(test: "TestRecord", size: float) -> str:
    """The input amplitude in a unit of some size."""
    if test.input is not None:
        return "recorded"
    if test.amplitude is None:
        return "unknown"
    std = f" +- {100.0 * test.amplitude_std:.3g} %" if test.amplitude_std else ""
    return f"{test.amplitude / size:.6g}{std}"


def _noise(names: "Sequence[str]", spectrum: "Spectrum") -> str:
    """Noise per response, in its unit and as a share of the rms of the response."""
    from wedgesweep.measured.kinds import DISPLAY_UNITS

    # A response that is the same signal as the one before it is not compared.
    both = zip(names, spectrum.sample_noise, spectrum.rms, strict=False)
    levels = [(std, std / rms, *DISPLAY_UNITS[name]) for name, std, rms in both]
    return ", ".join(f"{std / size:.3g} {unit} ({100.0 * share:.2g} %)" for std, share, size, unit in levels)


def _load_noise(load: "ColumnLoad | None") -> str:
    """Noise of the load of a column, and as a share of its mean."""
    return f"{load.noise:.3g} N ({100.0 * load.noise / load.mean[-1].real:.2g} %)" if load else ""


def _runs(orders: tuple[int, ...]) -> str:
    """Format 1, 2, 3, 5 as 1-3, 5."""
    numbered = enumerate(orders)
    runs = [[order for _, order in run] for _, run in groupby(numbered, lambda each: each[1] - each[0])]
    return ", ".join(f"{run[0]}" if len(run) == 1 else f"{run[0]}-{run[-1]}" for run in runs) or "none"
