"""Hostile input and violent ends: what ``fuzz.py`` and ``kill_campaign.py`` do, in parts that tests use."""

import sys
from pathlib import Path

# The specimens are written by fixtures of the tests.
sys.path.insert(0, str(Path(__file__).parents[2]))
