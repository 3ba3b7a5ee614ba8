"""Batch sweeps of a friction wedge suspension, and a diagnosis of what its model misses."""

import logging
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from wedgesweep.api import (
        diagnose_measurement,
        engineering,
        load_config,
        plot,
        read_measurement,
        run_sweep,
        simulate_case,
    )

__version__ = "0.1.0"
__all__ = [
    "diagnose_measurement",
    "engineering",
    "load_config",
    "plot",
    "read_measurement",
    "run_sweep",
    "simulate_case",
]

# Messages are shown to those who ask for them: logging.getLogger("wedgesweep").
logging.getLogger(__name__).addHandler(logging.NullHandler())


def __getattr__(name: str) -> Any:
    """The functions of ``wedgesweep.api``; numba and xarray load when the first of them is used."""
    if name not in __all__:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    from wedgesweep import api

    return getattr(api, name)


def __dir__() -> list[str]:
    return sorted([*globals(), *__all__])
