"""Entry point: ``wedgesweep`` and ``python -m wedgesweep``."""

import os

# One thread per process, whatever the machine's settings: the jobs share out the processors, and no
# number may depend on how a library splits its sums. numpy's libraries read this when they are
# loaded, and the jobs inherit it.
THREADS = ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS")


def main() -> None:
    """Run the command line."""
    os.environ.update(dict.fromkeys(THREADS, "1"))
    from wedgesweep.cli import cli

    cli(prog_name="wedgesweep")


if __name__ == "__main__":
    main()
