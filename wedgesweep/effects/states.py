"""States of effects, which follow the displacement and velocity of the mass in a state vector.

An effect lists the kinds of its states as ``STATES``. Their places depend on the effects that a record has;
the accessors made here find them when they are compiled.
"""

from collections.abc import Callable, Mapping
from math import inf, pi
from typing import Any

from wedgesweep.compiled import by_record, expression_of, function_of
from wedgesweep.hybrid.vectors import replaced

# Kinds, and their natural sizes.
LENGTH, VELOCITY, SHARE, TIME = "length", "velocity", "share", "time"
# A share that an imposed motion changes in closed form (``moved_freely``).
SLIDER = "slider"
SIZES = {
    LENGTH: "input_length(p)",
    VELOCITY: "input_length(p) * p.input.omega",
    SHARE: "1.0",
    SLIDER: "1.0",
    TIME: "2.0 * pi / p.input.omega",
}
# Displacement from rest and velocity of the mass.
MASS = (LENGTH, VELOCITY)


# States that systems have beyond those of the mass and of effects, by the field that marks their records.
_OF_SYSTEMS: dict[str, tuple[str, ...]] = {}


def add_last(owner: str, kinds: tuple[str, ...]) -> None:
    """Let records that have a field ``owner`` have states of these kinds after all others."""
    _OF_SYSTEMS[owner] = kinds


# How systems measure a motion whose input is no displacement, by the field that marks their records.
_LENGTHS: dict[str, Callable] = {}


def measured_by(owner: str) -> Callable[[Callable], Callable]:
    """Let a compiled function (p) be the ``input_length`` of records that have a field ``owner``."""

    def decorate(written: Callable) -> Callable:
        _LENGTHS[owner] = written
        return input_length

    return decorate


def input_length(p):
    """What motions are compared with (m): the input amplitude, or what a system names."""


def _choose_length(fields: Mapping[str, Any]) -> Callable:
    for owner, written in _LENGTHS.items():
        if owner in fields:
            return written
    return function_of(["p"], "p.input.amplitude")


by_record(input_length, _choose_length)


def kinds(fields: Mapping[str, Any]) -> list[tuple[str, str]]:
    """Owner and kind of every state of the records with these fields."""
    from wedgesweep.effects import REGISTERED

    found = [("", kind) for kind in MASS]
    for name, module in REGISTERED.items():
        if name in fields:
            found += [(name, kind) for kind in getattr(module, "STATES", ())]
    return found + [("", kind) for owner, more in _OF_SYSTEMS.items() if owner in fields for kind in more]


def _place(owner: str, number: int, fields: Mapping[str, Any]) -> int:
    return [each for each, _ in kinds(fields)].index(owner) + number


def state(owner: str, number: int) -> Callable:
    """Accessor (y, p) of one of an effect's states; 0 where a record does not have the effect."""

    def get(y, p): ...

    def choose(fields: Mapping[str, Any]) -> Callable:
        return expression_of(["y", "p"], f"y[{_place(owner, number, fields)}]" if owner in fields else "0.0")

    return by_record(get, choose)


def set_state(owner: str, number: int) -> Callable:
    """A function (y, value, p) for the state vector with another value of one of an effect's states."""

    def put(y, value, p): ...

    def choose(fields: Mapping[str, Any]) -> Callable:
        body = f"replaced(y, {_place(owner, number, fields)}, value)" if owner in fields else "y"
        return expression_of(["y", "value", "p"], body, replaced=replaced)

    return by_record(put, choose)


def place_of(owner: str, number: int) -> Callable:
    """A function (p) for the place of one of an effect's states in the state vector."""

    def place(p): ...

    return by_record(place, lambda fields: function_of(["p"], str(_place(owner, number, fields))))


def _of_all(expressions: Mapping[str, str]) -> Callable[[Callable], Callable]:
    """A function (p) that is a vector: for each state of a record the expression of its kind."""

    def choose(fields: Mapping[str, Any]) -> Callable:
        parts = ", ".join(expressions[kind] for _, kind in kinds(fields))
        return function_of(["p"], f"({parts},)", pi=pi, inf=inf, input_length=input_length)

    return lambda function: by_record(function, choose)


@_of_all(SIZES)
def scales(p):
    """Natural size of each state."""


@_of_all(SIZES | {TIME: "inf"})
def error_scales(p):
    """What an integration error of each state is compared with; inf where there is none."""


@_of_all(dict.fromkeys(SIZES, "False") | {TIME: "True"})
def clocks(p):
    """Whether each state only counts time."""


@_of_all(dict.fromkeys(SIZES, "False") | {VELOCITY: "True"})
def velocities(p):
    """Whether each state is a velocity."""


@_of_all(dict.fromkeys(SIZES, "False") | {SHARE: "True", SLIDER: "True"})
def bristles(p):
    """Whether each state is a share of the largest deflection of bristles."""


@_of_all(dict.fromkeys(SIZES, "False") | {SLIDER: "True"})
def sliders(p):
    """Whether each state has a closed form under an imposed motion."""


def active(p):
    """Whether each state moves at all, a vector of booleans."""


def _choose_active(fields: Mapping[str, Any]) -> Callable:
    from wedgesweep.effects import REGISTERED

    owners = list(dict.fromkeys(owner for owner, _ in kinds(fields) if owner))
    scope = {f"acts_{owner}": REGISTERED[owner].acts for owner in owners}
    parts = [f"acts_{owner}(p)" if owner else "True" for owner, _ in kinds(fields)]
    return function_of(["p"], f"({', '.join(parts)},)", **scope)


by_record(active, _choose_active)
