"""Tests run as the command does: threads of numpy's libraries stand in each other's way on a busy machine."""

import os

from wedgesweep.__main__ import THREADS

os.environ.update(dict.fromkeys(THREADS, "1"))
