"""The paper's claims, checked on runs of its own cases, and hypotheses on the experiment it leaves open."""

import os

from wedgesweep.__main__ import THREADS

# Before numpy is loaded: no number may depend on how its libraries split their sums.
os.environ.update(dict.fromkeys(THREADS, "1"))
