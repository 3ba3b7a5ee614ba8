"""Settings of a config that are right each, but cannot run together."""

from collections.abc import Iterable, Iterator, Mapping
from math import nan
from typing import Any


def contradictions(document: Mapping[str, Any]) -> Iterator[str]:
    """All of them, each as a line that names the key and says what would be right."""
    yield from _geometry(document)
    yield from _settling(document)


def _geometry(document: Mapping[str, Any]) -> Iterator[str]:
    suspension, sweep = document.get("suspension", {}), document.get("sweep", {})
    wedge, column = (suspension.get(f"{name}_angle_deg", nan) for name in ("wedge", "column"))
    if wedge + column <= 0.0:
        yield (
            f"suspension.column_angle_deg: {column} closes a wedge of {wedge} deg; "
            "the sum of both angles must be greater than 0"
        )
    cases: Iterable[Mapping[str, Any]] = filter(None, sweep.get("case", ()))
    laws = [*sweep.get("friction_law", ()), *(case.get("friction_law") for case in cases)]
    if "coulomb" in laws and column == 0.0 and document.get("friction", {}).get("dynamic", 0.0) > 0.0:
        yield (
            "suspension.column_angle_deg: 0 leaves the bolster face without slip, where coulomb "
            "does not determine the friction; use friction.dynamic = 0, another law, or a lean"
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
            "solver.continuation: hands steady states on, which only the event-driven solver finds; "
            'write method = "event-driven" and settle = "steady"'
        )
    if "case" in document.get("sweep", {}):
        yield (
            "solver.continuation: a list of cases has no neighbours in beta; "
            "write [sweep] with lists of frequencies and amplitudes"
        )
