"""Where effects act: each hook is all the functions of its name in the effects of a record, as one.

An effect takes part by a compiled function of the hook's name and arguments in its own file; records
without the effect are compiled without it. Units are SI.
"""

from collections.abc import Callable, Mapping
from inspect import signature
from typing import Any

from wedgesweep.compiled import by_record


def _functions(name: str, fields: Mapping[str, Any]) -> list[Callable]:
    from wedgesweep.effects import REGISTERED

    modules = [module for owner, module in REGISTERED.items() if owner in fields]
    return [getattr(module, name) for module in modules if hasattr(module, name)]


def _built(arguments: list[str], expression: str, functions: list[Callable]) -> Callable:
    scope: dict[str, Any] = {f"f{i}": each for i, each in enumerate(functions)}
    exec(f"def function({', '.join(arguments)}):\n    return {expression}", scope)
    return scope["function"]


def _sum(nothing: str) -> Callable[[Callable], Callable]:
    """A hook that adds what the effects return; ``nothing`` is what none of them give."""

    def decorate(hook: Callable) -> Callable:
        arguments = list(signature(hook).parameters)

        def choose(fields: Mapping[str, Any]) -> Callable:
            functions = _functions(hook.__name__, fields)
            calls = [f"f{i}({', '.join(arguments)})" for i in range(len(functions))]
            return _built(arguments, " + ".join(calls) or nothing, functions)

        return by_record(hook, choose)

    return decorate


def _chain(hook: Callable) -> Callable:
    """A hook whose first argument goes from one effect to the next."""
    arguments = list(signature(hook).parameters)

    def choose(fields: Mapping[str, Any]) -> Callable:
        functions = _functions(hook.__name__, fields)
        expression = arguments[0]
        for i in range(len(functions)):
            expression = f"f{i}({', '.join([expression, *arguments[1:]])})"
        return _built(arguments, expression, functions)

    return by_record(hook, choose)


@_sum(nothing="0.0")
def force_on_mass(z, velocity, y, p):
    """Further force on the mass (N)."""


@_sum(nothing="0.0")
def power(velocity, y, p):
    """Power (W) that the dampers of effects take."""


@_sum(nothing="()")
def rates(column_slip, acceleration, mode, y, p):
    """Rates of the effects' own states, a tuple; ``acceleration``: what Newton's equations give."""


@_chain
def base_acceleration(u2, t, p):
    """Acceleration of the input (m/s^2)."""


@_chain
def fastest(omega, p):
    """Highest angular frequency of the input (rad/s)."""


@_chain
def static(mu, clock, y, p):
    """Static coefficient of friction; ``clock``: whether the time at rest runs."""


@_chain
def sliding(mu, speed, p):
    """Coefficient of friction above the threshold velocity, at a speed (m/s)."""
