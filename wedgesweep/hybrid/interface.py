"""What a solver knows of a mechanical system: a hybrid system of smooth modes and events between them.

State y: a vector (hybrid.vectors) of as many numbers as the system's record ``p`` has room for. Mode:
which smooth piece of the equations holds, a tuple of integers whose meaning is the system's own. While a
mode holds, all its event functions are positive; where one reaches zero the system names the mode that
follows (``transition``).

Each function below is declared here and written in ``systems/``: ``implement`` ties it to the records of a
system, which are known by the name of one of their fields; of several the first in the record counts. Times
in s, all else in the units of ``scales``.
"""

from collections.abc import Callable, Mapping
from typing import Any, TypeVar

from wedgesweep.compiled import by_record

Function = TypeVar("Function", bound=Callable)

# Functions of the systems by what they implement, then by the field that marks a system's records.
_IMPLEMENTED: dict[Callable, dict[str, Callable]] = {}


def declared(function: Function) -> Function:
    """Declare a function that every system writes for its own records."""
    _IMPLEMENTED[function] = {}

    def choose(fields: Mapping[str, Any]) -> Callable:
        for field in fields:
            if field in _IMPLEMENTED[function]:
                return _IMPLEMENTED[function][field]
        message = f"no system with these records has {function.__name__}: {', '.join(fields)}"
        raise NotImplementedError(message)

    return by_record(function, choose)


def implement(what: Callable, owner: str) -> Callable[[Function], Function]:
    """Write one of the functions below, compiled, for the records that have a field ``owner``."""

    def decorate(written: Function) -> Function:
        _IMPLEMENTED[what][owner] = written
        return written

    return decorate


def provided(what: Callable, fields: Mapping[str, Any]) -> bool:
    """Whether the system with these records writes one of the functions that it may leave out."""
    return any(owner in fields for owner in _IMPLEMENTED[what])


# What every system writes.


@declared
def scales(p):
    """Natural sizes of the states, a vector: what an error or a distance of each is measured by."""


@declared
def error_scales(p):
    """What an integration error of each state is compared with; inf where there is none."""


@declared
def active(p):
    """Which states move at all, a vector of booleans."""


@declared
def event_count(p):
    """Number of event functions: a constant of the record's type."""


@declared
def fastest(p):
    """Highest angular frequency of the input (rad/s)."""


@declared
def cycle(p):
    """Period of the input (s)."""


@declared
def repeats(p):
    """Whether the whole input repeats after its period."""


@declared
def initial_mode(t, y, p):
    """Mode in which a run begins, and whether the state is well-posed."""


@declared
def rate(t, y, mode, p):
    """dy/dt, a vector, and the forces, in the form in which the system's ``events`` takes them."""


@declared
def events(forces, t, y, mode, p, out):
    """Write the event functions (positive while the mode holds; inf: not of this mode) under known forces."""


@declared
def event(place, t, y, mode, p, out):
    """One event function, with ``out`` as working space."""


@declared
def transition(t, y, mode, place, p):
    """State and mode after the event at a place of the event functions, and whether they are well-posed."""


@declared
def well_posed(t, y, mode, p):
    """Whether exactly one set of contact forces fits the state: else the system locks."""


@declared
def never_locks(p):
    """Whether it is proved that every state of the case is well-posed."""


@declared
def clocks(p):
    """Which states only count time between events, a vector of booleans: they may grow for ever."""


@declared
def free(y, p):
    """Which states may take other values near y, a vector of booleans: not those that a contact holds."""


@declared
def holds(mode, p):
    """Whether the mode keeps the mass at rest, so that nothing limits a step but the input."""


@declared
def sticks(y, mode, p):
    """Whether the observed contact sticks."""


@declared
def observed(y, p):
    """Displacement from rest and velocity that are recorded, of the state."""


@declared
def contact_forces(t, y, mode, p):
    """Normal forces of both contacts (N); NaN while they are not determined."""


@declared
def powers(t, y, mode, p):
    """Power that friction and damping take, power of the input (W), and the normal forces (N, or NaN)."""


# What a system may leave out.


@declared
def expected_event(forces, t, y, mode, p):
    """Time (s) in which a velocity would reach the end of its branch at its present rate; inf: in none."""


@declared
def driving_force(t, acceleration, y, mode, p):
    """Force on the mass (N) that gives it an acceleration (m/s^2); NaN where it is not determined."""


@declared
def stiff(mode, p):
    """Whether an explicit step could not follow the mode."""


@declared
def outruns(h, y, p):
    """Whether the state is so stiff that it limits an explicit step h (s)."""


@declared
def settling_step(p):
    """A step (s) that resolves the beginning of a stiff mode."""


@declared
def perturbation(place, y, p):
    """Step of a state for the derivative of the rate by differences, and whether these are central."""


@declared
def growth(by_state, p):
    """Growth rate (1/s) of velocities, from the derivative of the rate by the states, shape (n, n)."""


@declared
def stiff_error(error, mode, p):
    """Largest error of a velocity on which the mode is stiff, over the width of the stiff range."""


@declared
def opened(mode, p):
    """Whether the first contact and the second one are open."""


@declared
def impact(y, mode, place, p):
    """Whether an event is an impact, its largest impulse (N s), and the energy (J) that it takes."""


@declared
def closed_form(state, stop, p, keeping, recorder, counts):
    """Follow a mode that has a closed form to its event or ``stop``, or several modes, one after the other.

    Returns whether it has one, the state reached, and the event, NO_EVENT or HANDED_OVER; ``counts[2]``
    counts the events passed.
    """


# Two systems may take turns in following a motion: one that holds while contacts are closed, and one for all
# motions.


@declared
def leaves(y, mode, p):
    """Whether a mode is for the other system to follow."""


@declared
def taken_over(t, y, mode, p):
    """Mode with which a system goes on, and whether it is unique; ``mode``: an array, the other system's."""
