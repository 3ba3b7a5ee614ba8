"""Runs a command without a stage of the diagnosis: ``python -m validation.without STAGE diagnose ...``."""

import runpy
import sys

from wedgesweep.ablation import without

if __name__ == "__main__":
    with without(sys.argv.pop(1)):
        runpy.run_module("wedgesweep", run_name="__main__", alter_sys=True)
