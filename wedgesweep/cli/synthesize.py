"""synthesize: measured data of a known system."""

from pathlib import Path
from typing import Any

import click

from wedgesweep import formatting
from wedgesweep.cli.compiling import announce_compiling
from wedgesweep.cli.messages import log
from wedgesweep.cli.options import CONFIG, N_JOBS, PLUGIN, FiniteRange, GivenPath, WholeRange
from wedgesweep.synthesize.options import NOISES, QUANTITIES

SHARE = FiniteRange(min=0.0, max=1.0, max_open=True)


@click.command()
@CONFIG
@PLUGIN
@click.option(
    "--tests",
    "plan_path",
    type=GivenPath(),
    required=True,
    metavar="TESTS",
    help="TOML file with a [[test]] table per test (frequency_hz, amplitude_mm or amplitude_N, optionally "
    "amplitude_std, and known = false to withhold the amplitude) and an optional [uncertain] table as in "
    "measured.toml. Keys of transients and loops (kind, motion, duration_s, ...): docs/diagnosis.md.",
)
@click.option(
    "--noise", type=click.Choice(NOISES), default=NOISES[0], show_default=True, help="Kind of noise."
)
@click.option(
    "--level",
    type=SHARE,
    default=0.04,
    show_default=True,
    help="Std of the noise relative to the channel's rms.",
)
@click.option("--seed", type=WholeRange(min=0), default=0, show_default=True, help="Random seed.")
@click.option("-o", "--output", type=GivenPath(), help="Directory to write; default: CONFIG-measured.")
@click.option(
    "--periods",
    type=FiniteRange(min=4.0),
    default=8.4,
    show_default=True,
    help="Length of each record in periods.",
)
@click.option(
    "--sampling-hz",
    type=FiniteRange(min=0.0, min_open=True),
    help="Sampling rate; default: about 150 times the natural frequency (2000 for the paper's bench), "
    "different in each test, so that none divides the period.",
)
@click.option(
    "--settle-periods",
    type=WholeRange(min=1),
    default=60,
    show_default=True,
    help="Number of periods after which the motion counts as steady, if it has not repeated before.",
)
@click.option(
    "--amplitude-error",
    type=SHARE,
    default=1e-3,
    show_default=True,
    help="Relative std of the true amplitudes about the nominal ones; a test's amplitude_std overrides it.",
)
@click.option(
    "--record-input",
    type=click.Choice(QUANTITIES),
    help="Record this quantity of the input, in its SI unit, instead of stating its amplitude.",
)
@click.option(
    "--input-level",
    type=SHARE,
    default=0.01,
    show_default=True,
    help="Std of the recorded input's noise relative to its rms.",
)
@click.option(
    "--normal-force",
    type=FiniteRange(min=0.0),
    metavar="ZERO_STD",
    help="Record the normal force of one wedge on its column in steady tests; std of its zero, in N.",
)
@N_JOBS
def synthesize(
    config_path: Path, plan_path: Path, output: Path | None, n_jobs: int | None, **options: Any
) -> None:
    """Make synthetic measured data of a known system.

    The system is that of CONFIG, with its effects and its one friction law. Writes measured.toml, a CSV file
    per test, model.toml (CONFIG without its effects) and truth.json. The same seed gives the same data.
    """
    from wedgesweep import config
    from wedgesweep.sweep.backend import count_jobs
    from wedgesweep.synthesize import plan
    from wedgesweep.synthesize.campaign import synthesize as make
    from wedgesweep.synthesize.options import Options

    settings = config.load(config_path)
    tests = plan.load(plan_path, settings.turns)
    directory = output or Path(f"{config_path.stem}-measured")
    announce_compiling()
    for remark in make(settings, str(config_path), tests, Options(**options), directory, count_jobs(n_jobs)):
        log.info(remark)
    click.echo(f"wrote {directory / 'measured.toml'}: {formatting.counted(len(tests.tests), 'test')}")
