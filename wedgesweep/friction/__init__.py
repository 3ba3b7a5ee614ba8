"""Friction laws: the signed coefficient of a face as a function of its slip velocity.

A law is a file of its own with two smooth functions and their ``bound``: ``static`` is the coefficient at the
end of the ramp around v = 0, or at which set-valued friction lets go, ``sliding`` the one beyond. Its
``exponent`` is that of ``sliding`` as a power of the speed: 0 if it is constant, NaN if it is no power. A law
has three branches: -1 and 1, sliding backward and forward, and 0, the ramp, or sticking under a set-valued
law. The contact mode says which branch holds, so that no integrator ever steps across a corner.
"""

from collections.abc import Callable, Mapping
from importlib import import_module
from inspect import signature
from types import ModuleType
from typing import Any

import numpy as np

from wedgesweep import kernels
from wedgesweep.compiled import by_record, function_of, inlined
from wedgesweep.effects import hooks, stribeck
from wedgesweep.friction.names import LAW_NAMES, OSCILLATOR_LAWS

# The laws by name; a law's place is its code in parameter records. ``register`` adds another.
LAWS: dict[str, ModuleType] = {
    name: import_module(f"{__name__}.{name.replace('-', '_')}") for name in (*LAW_NAMES, *OSCILLATOR_LAWS)
}

# The ramp overlaps the branches beside it by this share of v_t, so that a slip velocity that grazes its end
# cannot go back and forth between two branches at one instant.
OVERLAP = 1e-9


# The laws that compiled code of this process knows, once there is such code.
_compiled: list[str] = []


def register(name: str, module: ModuleType) -> None:
    """Add a law that is not part of this package; RuntimeError once a case has been run without it."""
    if _compiled and LAWS.get(name) is not module:
        raise RuntimeError(
            f"friction law {name!r}: register laws before the first case of this process is run"
        )
    LAWS[name] = module
    kernels.register(module)


def code(name: str) -> int:
    """Number that stands for a law in parameter records."""
    return list(LAWS).index(name)


def require_known(codes: np.ndarray) -> None:
    """Raise ValueError for the code of a law that this process does not have: another law would run."""
    _compiled[:] = LAWS
    if (unknown := codes[codes >= len(LAWS)]).size:
        raise ValueError(
            f"friction law number {unknown[0]} is not registered in this process, which has {[*LAWS]}"
        )


def _of_the_law(function: Callable) -> Callable:
    """A function (..., p) that calls the function of the same name of the law in the record p."""
    arguments = list(signature(function).parameters)

    def choose(fields: Mapping[str, Any]) -> Callable:
        _compiled[:] = LAWS
        calls = [f"f{i}({', '.join(arguments)})" for i in range(len(LAWS))]
        chosen = calls[-1]
        for i in reversed(range(len(LAWS) - 1)):
            chosen = f"{calls[i]} if p.friction.law == {i} else ({chosen})"
        functions = {f"f{i}": getattr(law, function.__name__) for i, law in enumerate(LAWS.values())}
        return function_of(arguments, chosen, **functions)

    return by_record(function, choose)


class _Law:
    """The functions that each law writes."""

    @staticmethod
    @_of_the_law
    def static(p): ...

    @staticmethod
    @_of_the_law
    def sliding(speed, p): ...

    @staticmethod
    @_of_the_law
    def exponent(p): ...


_static, _sliding, exponent = _Law.static, _Law.sliding, _Law.exponent


@inlined
def static(clock, y, p):
    """Static coefficient; ``clock``: whether the time at rest runs."""
    return hooks.static(_static(p), clock, y, p)


@inlined
def sliding(speed, p):
    """Coefficient above the threshold velocity, at a speed (m/s)."""
    return hooks.sliding(_sliding(speed, p), speed, p)


@inlined
def is_constant(p):
    """Whether the coefficient above the threshold velocity does not depend on velocity."""
    return exponent(p) == 0.0 and not stribeck.acts(p)


@inlined
def coefficient(velocity, branch, highest, p):
    """Signed coefficient at a slip velocity on a branch of the law; ``highest``: the static coefficient."""
    if branch == 0 and not p.friction.set_valued:
        return highest / p.friction.v_t * velocity
    return branch * sliding(branch * velocity, p)


@inlined
def branch_at(speed, p):
    """Branch of a regularised law at a measure of slip (m/s)."""
    if speed > p.friction.v_t:
        return 1
    return -1 if speed < -p.friction.v_t else 0


@inlined
def write_branch_ends(slip, threshold, branch, place, out):
    """Write the distances (m/s) of a slip velocity to the ends of its branch, the lower and the upper one."""
    if branch == 0:
        threshold *= 1.0 + OVERLAP
    if branch >= 0:
        out[place] = slip - threshold if branch else slip + threshold
    if branch <= 0:
        out[place + 1] = -threshold - slip if branch else threshold - slip
