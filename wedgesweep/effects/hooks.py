"""Where effects act: a hook combines the functions of its name in the files of all effects of a record.

An effect takes part by a compiled function with the name and arguments of the hook in its own file; after all
others if it says ``LAST = True`` there. Code for
records without the effect does not contain it. Units are SI.
"""

from collections.abc import Callable, Mapping
from inspect import signature
from typing import Any

from wedgesweep.compiled import by_record, expression_of


def _functions(name: str, fields: Mapping[str, Any]) -> list[Callable]:
    from wedgesweep.effects import REGISTERED

    modules = [module for owner, module in REGISTERED.items() if owner in fields]
    modules.sort(key=lambda module: getattr(module, "LAST", False))
    return [getattr(module, name) for module in modules if hasattr(module, name)]


def _built(arguments: list[str], expression: str, functions: list[Callable]) -> Callable:
    return expression_of(arguments, expression, **{f"f{i}": each for i, each in enumerate(functions)})


def _sum(nothing: str) -> Callable[[Callable], Callable]:
    """A hook that adds what the effects return; ``nothing``: the sum without effects."""

    def decorate(hook: Callable) -> Callable:
        arguments = list(signature(hook).parameters)

        def choose(fields: Mapping[str, Any]) -> Callable:
            functions = _functions(hook.__name__, fields)
            calls = [f"f{i}({', '.join(arguments)})" for i in range(len(functions))]
            return _built(arguments, " + ".join(calls) or nothing, functions)

        return by_record(hook, choose)

    return decorate


def _chain(hook: Callable) -> Callable:
    """A hook whose first argument each effect changes in turn."""
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
def damping(velocity, y, p):
    """Further damping: force on the mass (N) that takes the power -force velocity."""


@_sum(nothing="0.0")
def power(velocity, y, p):
    """Power (W) that dampers take which do not act on the mass."""


@_sum(nothing="()")
def rates(column_slip, acceleration, mode, y, p):
    """Rates of the effects' own states, a tuple; ``acceleration``: what Newton's equations give."""


@_chain
def base_displacement(u, t, p):
    """Displacement of the input (m)."""


@_chain
def base_velocity(u1, t, p):
    """Velocity of the input (m/s)."""


@_chain
def input_force(force, t, p):
    """Force of the input on the mass (N)."""


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
