"""case: solve one case; print its numbers, store its waveforms, draw its phase portrait."""

from math import isfinite
from pathlib import Path
from typing import TYPE_CHECKING

import click

from wedgesweep import formatting
from wedgesweep.cli.compiling import announce_compiling
from wedgesweep.cli.failure import SOME_FAILED, Failure
from wedgesweep.cli.messages import log
from wedgesweep.cli.options import AT, CONFIG, PLUGIN, OutputPath, axis_values, command_line
from wedgesweep.cli.run import print_remark
from wedgesweep.outcome import lifted, unsettled

if TYPE_CHECKING:
    import xarray as xr

    from wedgesweep.config import Config

# SI unit of a variable -> factor and unit for a reader.
DISPLAY_UNITS = {
    "m": (1e3, "mm"),
    "m s-1": (1e3, "mm/s"),
    "J": (1e3, "mJ"),
    "rad": (57.29577951308232, "deg"),
    "1": (1.0, ""),
}
PICTURE = "phase-portrait"


@click.command()
@CONFIG
@PLUGIN
@click.option("--law", help="Friction law; default: the config's first.")
@click.option("--beta", type=float, help="Input frequency as a ratio to omega_n.")
@click.option("--frequency", type=float, metavar="HZ", help="Input frequency in Hz, instead of --beta.")
@click.option("--amplitude", type=float, metavar="MM", help="Input amplitude in mm, of a rotation in rad.")
@click.option(
    "--force", type=float, metavar="N", help="Amplitude of the force in N, if the config's input is a force."
)
@AT
@click.option(
    "-o",
    "--output",
    type=OutputPath(),
    metavar="STEM",
    help="Write STEM.nc and STEM.png; default: a name made from the case, in the current directory.",
)
def case(
    config_path: Path, law: str | None, at: tuple[str, ...], output: Path | None, **sine: float | None
) -> None:
    """Solve one case of any law, frequency and amplitude.

    Prints its numbers and writes its waveforms (netCDF) and its phase portrait (PNG).
    """
    beta, frequency, amplitude, force = (sine[key] for key in ("beta", "frequency", "amplitude", "force"))
    if (beta is None) == (frequency is None):
        raise click.UsageError("give either --beta or --frequency")
    if (amplitude is None) == (force is None):
        raise click.UsageError("give either --amplitude or --force")
    from wedgesweep.config import load
    from wedgesweep.config.variants import single_case

    given = load(config_path)
    if given.forced != (force is not None):
        wanted = "a force: give --force" if given.forced else "a motion: give --amplitude"
        raise Failure(f"{config_path}: its input is {wanted}")
    if given.turns and amplitude is not None:
        amplitude *= 1e3  # a rotation's rad is a length of 1 m
    settings = single_case(given, amplitude, beta, frequency, law, force, axis_values(at))
    print_remark(settings)
    stem = output or Path(_name(config_path, settings))
    _require_no_sweep(_with_suffix(stem, ".nc"))
    announce_compiling()
    from wedgesweep.sweep.run import Sweep

    ds = Sweep(settings, stem, command_line()).run_here()
    _print_numbers(ds)
    if ds["status"].item():
        click.echo(f"failed: {ds['message'].item()}", err=True)
        click.get_current_context().exit(SOME_FAILED)
    _print_remarks(ds)
    _write(ds, stem)


def _print_remarks(ds: "xr.Dataset") -> None:
    """Warn of what makes the numbers of a solved case doubtful."""
    from wedgesweep.friction import LAWS

    law = ds["friction_law"].item()
    if lifted(ds).item():
        share = f"{100.0 * ds['lift_off_fraction'].item():.2g} % of the slipping time"
        log.warning(f"outside of the model's validity: a joint pulls in {share}; a real one would lift off")
    creeps = ds["stick_fraction"].item() == 1.0 and ds["peak_to_peak"].item() > 0.0
    if creeps and not LAWS[law].SET_VALUED:
        travel = f"{ds['peak_to_peak'].item() * 1e3:.3g} mm"
        log.warning(f"a stick fraction of 1 is no rest: {law} creeps all the time, by {travel}")
    if unsettled(ds).item():
        log.warning("not settled: the response still changes from period to period")


def _name(config_path: Path, settings: "Config") -> str:
    law, beta, amplitude, _ = settings.sweep.case(0)
    length = f"{amplitude:.6g}rad" if settings.turns else f"{amplitude * 1e3:.6g}mm"
    size = f"{amplitude:.6g}N" if settings.forced else length
    return f"{config_path.stem}-{law}-{beta:.6g}-{size}"


def _with_suffix(stem: Path, suffix: str) -> Path:
    return stem.with_name(stem.name + suffix)  # with_suffix would cut "0.4" off


def _require_no_sweep(path: Path) -> None:
    """Refuse to overwrite the dataset of a sweep with a single case."""
    from wedgesweep.sweep import dataset

    if not path.exists():
        return
    found = dataset.read(path)
    if "status" not in found or found["status"].size > 1:
        raise Failure(f"{path}: holds a sweep or other data; choose another -o")


def _print_numbers(ds: "xr.Dataset") -> None:
    from wedgesweep.sweep.variables import OF_LIFT_OFF, VARIABLES

    law, beta, amplitude = (ds[name].item() for name in ("friction_law", "beta", "amplitude"))
    where = formatting.case(law, beta, amplitude, unit=ds["amplitude"].attrs["units"])
    click.echo(f"{where}, {ds['frequency'].item():.6g} Hz")
    for variable in VARIABLES + OF_LIFT_OFF:
        if variable.dims or variable.name in ("status", "message") or variable.name not in ds:
            continue
        si = ds[variable.name].attrs.get("units", variable.units)
        factor, unit = DISPLAY_UNITS.get(si, (1.0, si))
        value = ds[variable.name].item() * factor
        # Where nothing slips there is no phase and no normal force of slip.
        number = f"{value + 0.0:.6g}" if isfinite(value) else formatting.NONE
        name = variable.name.replace("_", " ")
        click.echo(f"  {name:<21}{number:>12} {unit:<5} {ds[variable.name].attrs['long_name']}")


def _write(ds: "xr.Dataset", stem: Path) -> None:
    from wedgesweep import figures
    from wedgesweep.sweep import dataset

    file, picture = _with_suffix(stem, ".nc"), _with_suffix(stem, ".png")
    dataset.write(ds, file)
    figures.save(figures.draw(ds, PICTURE), picture)
    click.echo(f"trajectory: {file}\npicture: {picture}")
