"""The command line; nothing outside this package prints or exits.

Heavy modules are imported inside the commands that need them, so that ``--help`` answers at once.
"""

import click

from wedgesweep import __version__
from wedgesweep.cli.case import case
from wedgesweep.cli.configs import check, init, schema
from wedgesweep.cli.diagnose import diagnose, write_report
from wedgesweep.cli.export import export
from wedgesweep.cli.failure import Commands
from wedgesweep.cli.messages import with_verbosity
from wedgesweep.cli.plot import plot
from wedgesweep.cli.run import run
from wedgesweep.cli.status import status
from wedgesweep.cli.synthesize import synthesize
from wedgesweep.cli.warm_up import warm_up

EPILOG = """\
Exit codes: 0 success; 1 some cases failed, or Radau disagrees (run --verify);
2 bad input; 3 ended by --time-limit; 130 interrupted (129 by SIGHUP, 143 by
SIGTERM).

Shell completion: add eval "$(_WEDGESWEEP_COMPLETE=bash_source wedgesweep)" to ~/.bashrc (zsh_source and
fish_source for the other shells).
"""


@click.group(
    cls=Commands,
    commands=[
        with_verbosity(command)
        for command in (
            *(init, schema, check, run, status, case, plot, export, synthesize),
            *(diagnose, write_report, warm_up),
        )
    ],
    context_settings={"help_option_names": ["-h", "--help"]},
    epilog=EPILOG,
)
@click.version_option(__version__, prog_name="wedgesweep")
def cli() -> None:
    """Simulate sweeps of a friction wedge suspension, and diagnose measured vibration."""
