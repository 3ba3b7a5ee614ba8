"""case: one case in numbers, a file and a picture."""

from pathlib import Path
from typing import TYPE_CHECKING

import click

from wedgesweep.cli.failure import SOME_FAILED, Failure
from wedgesweep.cli.options import CONFIG, OutputPath, command_line
from wedgesweep.cli.run import tell_of_compiling

if TYPE_CHECKING:
    import xarray as xr

    from wedgesweep.config import Config

# SI unit of a variable -> factor and unit for a reader.
SHOWN = {
    "m": (1e3, "mm"),
    "m s-1": (1e3, "mm/s"),
    "J": (1e3, "mJ"),
    "rad": (57.29577951308232, "deg"),
    "1": (1.0, ""),
}
PICTURE = "phase-portrait"


@click.command()
@CONFIG
@click.option("--law", help="Friction law; default: the config's first.")
@click.option("--beta", type=float, help="Input frequency over omega_n.")
@click.option("--frequency", type=float, metavar="HZ", help="Input frequency, instead of --beta.")
@click.option("--amplitude", type=float, metavar="MM", required=True, help="Input amplitude.")
@click.option(
    "-o",
    "--output",
    type=OutputPath(),
    metavar="STEM",
    help="Writes STEM.nc and STEM.png; default: named after the case, here.",
)
@click.pass_context
def case(
    ctx: click.Context,
    config_path: Path,
    law: str | None,
    beta: float | None,
    frequency: float | None,
    amplitude: float,
    output: Path | None,
) -> None:
    """Run one case, of any values: its numbers, trajectory (netCDF) and phase portrait."""
    if (beta is None) == (frequency is None):
        message = "give either --beta or --frequency"
        raise click.UsageError(message)
    from wedgesweep import config

    where = ("beta", beta) if frequency is None else ("frequency_hz", frequency)
    settings = _one_case(config.load(config_path), law, where, amplitude)
    stem = output or Path(_name(config_path, settings))
    _require_no_sweep(_with_suffix(stem, ".nc"))
    tell_of_compiling(settings.solver.method)
    from wedgesweep.sweep.run import Sweep

    ds = Sweep(settings, stem).run_here(command=command_line())
    _print_numbers(ds)
    if ds["status"].item():
        click.echo(f"failed: {ds['message'].item()}", err=True)
        ctx.exit(SOME_FAILED)
    _write(ds, stem)


def _one_case(
    settings: "Config", law: str | None, where: tuple[str, float | None], amplitude: float
) -> "Config":
    """The config with a grid of a single case and its waveforms, so that every figure can draw it."""
    from wedgesweep.config import parse, toml

    grid = {
        "friction_law": [law or settings.case_list()[0].law],
        where[0]: where[1],
        "amplitude_mm": amplitude,
        "omega_n_rad_per_s": settings.sweep.omega_n,
    }
    solver = settings.document["solver"] | {"keep_waveforms": True, "continuation": False}
    return parse(toml.dumps(settings.document | {"sweep": grid, "solver": solver}), "case")


def _name(config_path: Path, settings: "Config") -> str:
    law, beta, amplitude = settings.case_list()[0]
    return f"{config_path.stem}-{law}-{beta:.6g}-{amplitude * 1e3:.6g}mm"


def _with_suffix(stem: Path, suffix: str) -> Path:
    return stem.with_name(stem.name + suffix)  # with_suffix would cut "0.4" off


def _require_no_sweep(path: Path) -> None:
    """Do not let one case take the place of a whole sweep."""
    from wedgesweep.sweep import dataset

    if not path.exists():
        return
    found = dataset.read(path)
    if "status" not in found or found["status"].size > 1:
        message = f"{path}: holds a sweep, or something else; choose another -o"
        raise Failure(message)


def _print_numbers(ds: "xr.Dataset") -> None:
    from wedgesweep.sweep.cases import describe
    from wedgesweep.sweep.dataset import VARIABLES

    where = (ds[name].item() for name in ("friction_law", "beta", "amplitude"))
    click.echo(f"{describe(*where)}, {ds['frequency'].item():.6g} Hz")
    for variable in VARIABLES:
        if variable.dims or variable.name in ("status", "message"):
            continue
        factor, unit = SHOWN.get(variable.units, (1.0, variable.units))
        number = f"{ds[variable.name].item() * factor:.6g}"
        name = variable.name.replace("_", " ")
        click.echo(f"  {name:<21}{number:>12} {unit:<5} {variable.long_name}")


def _write(ds: "xr.Dataset", stem: Path) -> None:
    from wedgesweep import figures
    from wedgesweep.sweep import dataset

    file, picture = _with_suffix(stem, ".nc"), _with_suffix(stem, ".png")
    dataset.write(ds, file)
    figures.save(figures.FIGURES[PICTURE].draw(ds), picture)
    click.echo(f"trajectory: {file}\npicture: {picture}")
