"""A spring in series with a damper and its friction: bushings, rods, oil that yields.

The damper has no mass. Behind the spring are friction at mu_d, set-valued for every law, and all damping. A
run begins with the spring at its free length. With friction only it is Prandtl's element (Prandtl, 1928),
with damping only Maxwell's.
Beside other tests than loops no candidate unless asked for: a stiff spring takes short steps in runs.
Neutral: the limit of infinite stiffness; off where the table is absent (0 in the record).
Default: stiffness must be given; damping added to the model's: 0.
"""

from math import copysign, exp, inf, log, nan

from wedgesweep.compiled import inlined, inner, term
from wedgesweep.effects import directional_friction, hooks
from wedgesweep.effects.base import NUMERICAL, OSCILLATOR, Effect
from wedgesweep.effects.states import LENGTH, set_state, state
from wedgesweep.equations.symbols import Meaning
from wedgesweep.quantity import Quantity

EQUATIONS = (
    "D = stiffness e",
    "D = mu_d N sign(w) + (c + coefficient) w",
    "e' = v - w",
)
SYMBOLS = {
    "D": Meaning("force of the damper: friction and damping", "N"),
    "e": Meaning("elongation of the spring in series with the damper", "m"),
    "w": Meaning("velocity of the damper behind the spring", "m/s"),
}
REMARK = "The damper rests, w = 0, for |D| up to mu_d N."

EFFECT = Effect(
    name="series_compliance",
    family="contact",
    branch=NUMERICAL,
    systems=(OSCILLATOR,),
    excludes=("stribeck", "presliding", "ageing", "damper_play"),
    of_loops=True,
    contains=("viscous_damping",),  # where the spring is stiff
    meaning="a spring in series with the damper and its friction",
    quantities=(
        Quantity(
            "stiffness_N_per_mm",
            nan,
            "stiffness of the spring in series",
            above=0.0,
            off=0.0,
            search=(2.0, 5000.0),
            logarithmic=True,
        ),
        Quantity(
            "coefficient_N_s_per_m",
            0.0,
            "damping behind the spring, added to the model's",
            minimum=0.0,
            search=(0.0, 100.0),
        ),
    ),
    extends=("stiffness",),
)


STATES = (LENGTH,)
# Speeds at which damping takes a force are found to this relative accuracy, in at most so many steps.
ACCURACY, MOST_STEPS = 1e-13, 40
# Powers of the speed between which those of all dampers lie; rounding errors would leave any slope.
LEAST_POWER, MOST_POWER = 0.2, 3.0


_elongation = state("series_compliance", 0)
_with_elongation = set_state("series_compliance", 0)


@term("series_compliance", off="False")
def acts(p):
    """Whether the damper is behind a spring."""
    return p.series_compliance.stiffness > 0.0


@term("series_compliance", off="0.0")
def force(y, p):
    """Force (N) of spring and damper, positive against positive velocity."""
    return p.series_compliance.stiffness * _elongation(y, p)


@inlined
def damping(velocity, y, p):
    """Force (N) of the damping that the effect adds, at the velocity (m/s) of the damper."""
    return -p.series_compliance.coefficient * velocity


@inlined
def _friction(direction, p):
    """Friction (N) of a damper that moves in a direction (-1, 1)."""
    factor = directional_friction.factor(direction, p)
    return factor * p.friction.mu_d * p.oscillator.normal_force + p.guide_friction.force


@inlined
def _damping(speed, direction, y, p):
    """Damping force (N) against a speed (m/s) in a direction (-1, 1)."""
    return p.oscillator.damping * speed - direction * hooks.damping(direction * speed, y, p)


@inner
def _speed(force, direction, y, p):
    """Speed (m/s) at which damping takes a force (N, positive), by secants; inf without damping.

    Damping is a sum of powers of the speed: on logarithmic scales it is convex, and nearly a line.
    """
    if not force > 0.0:
        return 0.0
    speed, slope, change, before = 1.0, 1.0, 0.0, 0.0
    for _ in range(MOST_STEPS):
        taken = _damping(speed, direction, y, p)
        if not taken > 0.0:
            return inf
        excess = log(taken) - log(force)
        if abs(excess) <= ACCURACY:
            break
        if change != 0.0:
            slope = min(max((excess - before) / change, LEAST_POWER), MOST_POWER)
        change, before = -excess / slope, excess
        speed *= exp(change)
    return speed


@inlined
def branch(y, p):
    """Direction (-1, 1) of the damper; 0: friction holds it."""
    pull = force(y, p)
    if pull > _friction(1, p):
        return 1
    return -1 if -pull > _friction(-1, p) else 0


@inlined
def write_events(y, direction, place, p, out):
    """Write the distances (N) of the force to the lower and the upper end of a branch."""
    pull = force(y, p)
    if direction == 0:
        out[place], out[place + 1] = _friction(-1, p) + pull, _friction(1, p) - pull
    elif direction > 0:
        out[place] = pull - _friction(1, p)
    else:
        out[place + 1] = -pull - _friction(-1, p)


@inlined
def _velocity(y, direction, p):
    """Velocity (m/s) of the damper on a branch."""
    if direction == 0:
        return 0.0
    return direction * _speed(direction * force(y, p) - _friction(direction, p), direction, y, p)


@inlined
def rates(column_slip, acceleration, mode, y, p):
    """Rate (m/s) of the spring's elongation."""
    return (column_slip - _velocity(y, mode.column, p) if acts(p) else 0.0,)


@inlined
def power(velocity, y, p):
    """Power (W) that the spring takes back from what friction and damping take."""
    return force(y, p) * (_velocity(y, branch(y, p), p) - velocity) if acts(p) else 0.0


# A motion that is imposed: exact where damping is viscous, in steps of any length and without damping, too.


@inlined
def _settled(velocity, direction, y, p):
    """Elongation (m) at which a damper that moves in a direction has the velocity (m/s) of its rod."""
    speed = direction * velocity
    resistance = copysign(_damping(abs(speed), direction, y, p), speed)
    return direction * (_friction(direction, p) + resistance) / p.series_compliance.stiffness


@term("series_compliance", off="y")
def settled(y, velocity, beyond, p):
    """The state vector as after a long motion at a velocity (m/s), or off by a share ``beyond`` of that."""
    if not acts(p):
        return y
    elongation = _settled(velocity, 1 if velocity >= 0.0 else -1, y, p)
    return _with_elongation(y, elongation + beyond * abs(elongation), p)


@term("series_compliance", off="following")
def moved(y, following, velocity, change, step, p):
    """The state vector ``following`` with the elongation after a step (s) of the rod.

    ``velocity``: its mean (m/s), ``change``: by how much it grows evenly over the step.
    """
    if not acts(p):
        return following
    end = 1 if velocity >= 0.0 else -1
    if abs(change) > 2.0 * abs(velocity):
        change = 0.0
    slipping = branch(y, p)
    if slipping == -end:
        y, step = _relaxed(y, (velocity, change), slipping, step, p)
        change = 0.0
    limit = _limit(end, p)
    if step > 0.0 and end * (limit - _elongation(y, p)) > 0.0:
        left = step - (limit - _elongation(y, p)) / velocity
        y = _with_elongation(y, limit if left > 0.0 else _elongation(y, p) + velocity * step, p)
        step, change = left, 0.0
    if step > 0.0:
        y, _ = _relaxed(y, (velocity, change), end, step, p)
    return _with_elongation(following, _elongation(y, p), p)


@inlined
def _limit(direction, p):
    """Elongation (m) up to which friction holds the damper against a direction."""
    return direction * _friction(direction, p) / p.series_compliance.stiffness


@inner
def _relaxed(y, motion, direction, step, p):
    """The state vector after a step (s) of a damper that moves in a direction, and the time that is left.

    ``motion``: mean velocity of the rod and its change. The elongation follows the settled one, which moves
    evenly, at the rate that it has in the middle of the step. The damper stops where friction holds it.
    """
    velocity, change = motion
    start, limit = _elongation(y, p), _limit(direction, p)
    aim = _settled(velocity, direction, y, p)
    first = _settled(velocity - 0.5 * change, direction, y, p)
    drift = _settled(velocity + 0.5 * change, direction, y, p) - first
    middle, rate = start, 0.0
    for _ in range(2):
        if middle == aim:
            break
        here = _velocity(_with_elongation(y, middle, p), direction, p)
        rate = max((velocity - here) / (aim - middle), 0.0)
        middle = first + 0.5 * drift + _behind(start - first, drift, 0.5, rate * step)
    end = first + drift + _behind(start - first, drift, 1.0, rate * step)
    if direction * (end - limit) >= 0.0 or direction * (aim - limit) >= 0.0:
        return _with_elongation(y, end, p), 0.0
    return _with_elongation(y, limit, p), step - log((start - aim) / (limit - aim)) / rate


@inlined
def _behind(start, drift, share, times):
    """How far (m) an elongation is from the settled one after a share of a step.

    ``start``: how far at first; ``drift``: how far the settled one moves; ``times``: rate times step.
    """
    left = exp(-share * times)
    return start * left - (drift * (1.0 - left) / times if times > 0.0 else drift * share)
