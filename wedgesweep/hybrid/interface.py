"""What a solver knows of a mechanical system: a hybrid system of smooth modes and events between them.

State y: a vector (hybrid.vectors) of as many numbers as the system's record ``p`` has room for. Mode:
which smooth piece of the equations holds, a tuple of integers whose meaning is the system's own. While a
mode holds, all its event functions are positive; where one reaches zero the system names the mode that
follows (``transition``).

Each function below is declared here and written in ``systems/``: ``implement`` ties it to the records of a
system, which are known by the name of one of their fields; if several fields of a record name systems, the
first one decides. Times are in s, all else in the units of ``scales``.

A system may add states to those of another one, and have modes in which only the other's states move: solvers
follow these ``first_states`` alone there, and the functions of the other system are called.
"""

import inspect
import sys
from collections.abc import Callable, Mapping
from math import inf, nan
from typing import Any, TypeVar, cast

from wedgesweep import kernels
from wedgesweep.compiled import by_record, inlined
from wedgesweep.hybrid.state import NO_EVENT

Function = TypeVar("Function", bound=Callable)

# Functions of the systems by what they implement, then by the field that marks a system's records.
_IMPLEMENTED: dict[Callable, dict[str, Callable]] = {}


# Number of states of records of systems that add some, by the field that marks them.
_STATES: dict[str, Callable[[Mapping[str, Any]], int]] = {}


def adds_states(owner: str, count: Callable[[Mapping[str, Any]], int]) -> None:
    """Let records with a field ``owner`` have more states than the system that they extend has.

    ``count`` gets the fields of a record's type, and returns the number of all states.
    """
    _STATES[owner] = count


def _declared(function: Function, default: Callable | None) -> Function:
    _IMPLEMENTED[function] = {}
    of_state = "y" in inspect.signature(function).parameters

    def choose(fields: Mapping[str, Any], *length: int) -> Callable:
        for field in fields:
            if length and field in _STATES and length[0] < _STATES[field](fields):
                continue
            if field in _IMPLEMENTED[function]:
                return _IMPLEMENTED[function][field]
        if default:
            return default
        raise NotImplementedError(
            f"no system with these records has {function.__name__}: {', '.join(fields)}"
        )

    return by_record(function, choose, "y" if of_state else None)


def required(function: Function) -> Function:
    """Declare a function that a system writes for its own records; without it a call does not compile."""
    return _declared(function, None)


def optional(function: Function) -> Function:
    """Declare a function that a system may leave out; then it is as written here."""
    return _declared(function, inlined(function))


def implement(what: Callable, owner: str) -> Callable[[Function], Function]:
    """Write one of the functions below, compiled, for the records that have a field ``owner``."""

    def decorate(written: Function) -> Function:
        _IMPLEMENTED[what][owner] = written
        kernels.register(sys.modules[cast(Any, written).__module__])
        return written

    return decorate


def provided(what: Callable, fields: Mapping[str, Any]) -> bool:
    """Whether the system with these records writes one of the functions that it may leave out."""
    return any(owner in fields for owner in _IMPLEMENTED[what])


# What every system writes.


@required
def scales(p):
    """Natural sizes of the states, a vector: what an error or a distance of each is measured by."""


@required
def error_scales(p):
    """What an integration error of each state is compared with; inf where there is none."""


@required
def active(p):
    """Which states move at all, a vector of booleans."""


@required
def event_count(p):
    """Number of event functions: a constant of the record's type."""


@required
def fastest(p):
    """Highest angular frequency of the input (rad/s)."""


@required
def cycle(p):
    """Period of the input (s)."""


@required
def repeats(p):
    """Whether the whole input repeats after its period."""


@required
def initial_mode(t, y, p):
    """Mode in which a run begins, and whether the state is well-posed."""


@required
def rate(t, y, mode, p):
    """dy/dt, a vector, and the forces, in the form in which the system's ``events`` takes them."""


@required
def events(forces, t, y, mode, p, out):
    """Write the event functions (positive while the mode holds; inf: not of this mode) under known forces."""


@required
def transition(t, y, mode, place, p):
    """State and mode after the event at a place of the event functions, and whether they are well-posed."""


@required
def clocks(p):
    """Which states only count time between events, a vector of booleans: they may grow for ever."""


@required
def bristles(p):
    """Which states are deflections of bristles as shares of the largest one, a vector of booleans."""


@required
def sliders(p):
    """Which states ``moved_freely`` changes in closed form, a vector of booleans."""


@required
def free(y, p):
    """Which states may take other values near y, a vector of booleans: not those that a contact holds."""


@required
def holds(mode, p):
    """Whether the mode keeps the mass at rest, so that nothing limits a step but the input."""


@required
def sticks(y, mode, p):
    """Whether the observed contact sticks."""


@required
def observed(y, p):
    """Displacement from rest and velocity that are recorded, of the state."""


@required
def powers(t, y, mode, p):
    """Power that friction and damping take, power of the input (W), and the normal forces (N, or NaN)."""


# What a system may leave out.


@optional
def only_first_move(y, mode, p):
    """Whether a mode moves the ``first_states`` alone; only then it may be ``linear``, or have ``follow``."""
    return True


@optional
def first_states(y, p):
    """The states that the system which this one extends has as well, as a vector."""
    return y


@optional
def event(place, t, y, mode, p, out):
    """One event function, with ``out`` as working space."""
    events(rate(t, y, mode, p)[1], t, y, mode, p, out)
    return out[place]


@optional
def well_posed(t, y, mode, p):
    """Whether exactly one set of contact forces fits the state: else the system locks."""
    return True


@optional
def never_locks(p):
    """Whether it is proved that every state of the case is well-posed."""
    return True


@optional
def contact_forces(t, y, mode, p):
    """Normal forces of both contacts (N); NaN while they are not determined."""
    _, _, first, second = powers(t, y, mode, p)
    return first, second


@optional
def expected_event(forces, t, y, mode, p):
    """Time (s) in which a velocity would reach the end of its branch at its present rate; inf: in none."""
    return inf


@optional
def follow(state, stop, p, keeping, recorder, work):
    """Follow a mode by a method of the system's own to its event or ``stop``.

    Returns whether it has one, the state reached, and the event, NO_EVENT or FAILED. ``work``: tolerance and
    counts of the run (``integrate.Workspace``).
    """
    return False, state, NO_EVENT


@optional
def linear(mode, p):
    """Whether a mode is linear (hybrid/linear_modes.py): rates and events in displacement and velocity.

    All other states rest, and the input is a sine or none.
    """
    return False


# Imposed motions (solvers/imposed_motion.py), whose states of effects follow the motion.


@required
def driving_force(t, acceleration, y, mode, p):
    """Force on the mass (N) that gives it an acceleration (m/s^2); NaN where it is not determined."""


@optional
def already_moving(y, deflected, p):
    """A state at rest as a motion that has been going on would have left it.

    ``deflected``: how far from there what is elastic may be, as a share of how far it yields.
    """
    return y


@optional
def share_before_jump(y, step, p):
    """Share of a step (s) at a constant velocity after which the force jumps; NaN: it does not."""
    return nan


@optional
def moved_freely(y, following, change, step, p):
    """The state after a step (s), with states that move freely between two ends, or slowly behind the mass.

    ``following``: the other states after that step, by their rates; ``change``: by how much the velocity
    (m/s), whose mean the state holds, grows over the step.
    """
    return following


# Contacts that open and hit.


@optional
def opened(mode, p):
    """Whether the first contact and the second one are open."""
    return False, False


@optional
def impact(y, mode, place, p):
    """Whether an event is an impact, its largest impulse (N s), and the energy (J) that it takes."""
    return False, 0.0, 0.0


# Stiff modes. A system that writes ``stiff`` writes all of these.


@optional
def stiff(mode, p):
    """Whether an explicit step could not follow the mode."""
    return False


@optional
def outruns(h, y, p):
    """Whether the state is so stiff that it limits an explicit step h (s)."""
    return False


@optional
def settling_step(p):
    """A step (s) that resolves the beginning of a stiff mode."""
    return inf


@required
def perturbation(place, y, p):
    """Step of a state for the derivative of the rate by differences, and whether these are central."""


@required
def growth(by_state, p):
    """Growth rate (1/s) of velocities, from the derivative of the rate by the states, shape (n, n)."""


@required
def stiff_error(error, mode, p):
    """Largest error of a velocity on which the mode is stiff, over the width of the stiff range."""
