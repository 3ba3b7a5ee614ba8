"""Settings of a config that are valid alone, but contradict each other."""

from collections.abc import Iterable, Iterator, Mapping
from math import nan
from typing import Any


def contradictions(document: Mapping[str, Any]) -> Iterator[str]:
    """Yield all contradictions, each as a line that names the key and a valid setting."""
    yield from _geometry(document)
    yield from _settling(document)


def _geometry(document: Mapping[str, Any]) -> Iterator[str]:
    suspension, sweep = document.get("suspension", {}), document.get("sweep", {})
    wedge, column = (suspension.get(f"{name}_angle_deg", nan) for name in ("wedge", "column"))
    if wedge + column <= 0.0:
        yield (
            f"suspension.column_angle_deg: {column} closes a wedge of {wedge} deg; "
            "the sum of both angles must be positive"
        )
    cases: Iterable[Mapping[str, Any]] = filter(None, sweep.get("case", ()))
    laws = [*sweep.get("friction_law", ()), *(case.get("friction_law") for case in cases)]
    if "coulomb" in laws and column == 0.0 and document.get("friction", {}).get("dynamic", 0.0) > 0.0:
        yield (
            "suspension.column_angle_deg: at 0 the bolster face does not slip, and coulomb "
            "does not determine its friction; use friction.dynamic = 0, another law, or another angle"
        )


def _settling(document: Mapping[str, Any]) -> Iterator[str]:
    solver = document.get("solver", {})
    event_driven, steady = solver.get("method") == "event-driven", "settle" in solver
    if steady and not event_driven:
        yield 'solver.settle: "steady" needs solver.method = "event-driven"; or give settle_periods'
    if not solver.get("continuation"):
        return
    if not (event_driven and steady):
        yield (
            "solver.continuation: needs steady states, which only the event-driven solver finds; "
            'write method = "event-driven" and settle = "steady"'
        )
    if "case" in document.get("sweep", {}):
        yield (
            "solver.continuation: needs a grid, not a list of cases; "
            "write [sweep] with lists of frequencies and amplitudes"
        )
