"""Entry point: ``wedgesweep`` and ``python -m wedgesweep``."""

import atexit
import gc
import os
import signal
import sys

# One thread per process, whatever the machine's settings: the jobs share out the processors, and no
# number may depend on how a library splits its sums. numpy's libraries read this when they are
# loaded, and the jobs inherit it.
THREADS = ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS")

# New objects after which Python looks for garbage. Compilation makes millions that stay: by default it would
# look 150 times as often, a sixth of the time of a first run.
GARBAGE = 100_000


def main() -> None:
    """Run the command line."""
    os.environ.update(dict.fromkeys(THREADS, "1"))
    # This process is the command's own; what is left when it ends need not be looked through.
    gc.set_threshold(GARBAGE)
    atexit.register(gc.freeze)
    for stream in (sys.stdout, sys.stderr):
        # A terminal that cannot show a character, as in the locale C, gets its code.
        stream.reconfigure(errors="backslashreplace")  # type: ignore[union-attr]
    try:
        from wedgesweep.cli.failure import end_on_signals

        end_on_signals()
        from wedgesweep.cli import cli

        cli(prog_name="wedgesweep")
    except KeyboardInterrupt as interrupt:  # before or after the command itself
        raise SystemExit(128 + getattr(interrupt, "number", signal.SIGINT)) from None


if __name__ == "__main__":
    main()
