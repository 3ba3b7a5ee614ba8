"""Processes that must not outlive the one that started them."""

import os
import signal
import threading
import time

KILL = getattr(signal, "SIGKILL", signal.SIGTERM)  # Windows has the latter only
# Time (s) between two looks at the parent.
INTERVAL = 1.0


def end_with(parent: int) -> None:
    """Let this process end soon after its parent, a process id, however that has ended."""
    threading.Thread(target=_watch, args=(parent,), daemon=True).start()


def _watch(parent: int) -> None:
    while os.getppid() == parent:
        time.sleep(INTERVAL)
    os.kill(os.getpid(), KILL)
