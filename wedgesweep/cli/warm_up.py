"""``wedgesweep warm-up``: compile ahead what a first sweep and a first diagnosis would compile."""

import click

from wedgesweep.cli.compiling import announce_compiling, seconds_compiling
from wedgesweep.formatting import duration


@click.command(name="warm-up")
def warm_up() -> None:
    """Compile ahead what a first sweep and a first diagnosis of steady tests need.

    The code stays in the cache folder (WEDGESWEEP_CACHE_DIR) until wedgesweep or numba changes.
    """
    announce_compiling()
    from wedgesweep.kernels import folder
    from wedgesweep.simulate import Settings
    from wedgesweep.sweep.cases import compile_once

    for settings in (Settings("radau"), Settings("event-driven"), Settings("event-driven", steady=True)):
        compile_once(settings)
    _compile_diagnosis()
    click.echo(f"compiled for {duration(seconds_compiling())}; kept in {folder() or 'no folder'}")


def _compile_diagnosis() -> None:
    """Steady responses of the base model, of one with effects, and of joints that open."""
    from wedgesweep.solvers import periodic
    from wedgesweep.systems import example
    from wedgesweep.systems.suspension.parameters import ALL, BASE, JOINTS_OPEN

    for kit in (BASE, ALL, JOINTS_OPEN):
        case = example("suspension", 2 * kit)
        accuracy = periodic.Accuracy(1e-3, 2, rtol=1e-3)
        periodic.respond(case, periodic.at_rest(1), accuracy, 32, 2)
        periodic.sampled(case, periodic.at_rest(1).state, 1, 1, 32, 1e-3)
