"""The oscillator as a hybrid system: what solvers ask of it, see hybrid/interface.py."""

from math import inf, nan

from wedgesweep import excitation, friction
from wedgesweep.compiled import inlined, inner
from wedgesweep.effects import (
    ageing,
    damper_play,
    directional_friction,
    hooks,
    maxwell_presliding,
    series_compliance,
    states,
    travel,
)
from wedgesweep.hybrid import interface
from wedgesweep.hybrid.interface import implement
from wedgesweep.hybrid.vectors import replaced
from wedgesweep.systems.oscillator.forces import (
    elongation,
    friction_force,
    load,
    powers,
    resistance,
)
from wedgesweep.systems.oscillator.modes import HELD, VELOCITY, Mode, X, creeps, crosses, slip, stuck
from wedgesweep.systems.oscillator.parameters import PLAIN
from wedgesweep.systems.shared import LOOK_AHEAD, ROUNDING, implement_shared, soon

OSCILLATOR = "oscillator"
# Pairs of event functions: ends of a slip branch or of a rod's play (the only pair without effects), segment
# of travel, sign of the slip, time at rest.
SLIP, TRAVEL, DIRECTION, CLOCK = 0, 2, 4, 6
PLAIN_EVENTS, EVENTS = 2, 8
# A jump of friction below this share of it is none.
SMOOTH = 1e-8

implement_shared(OSCILLATOR)
implement(interface.holds, OSCILLATOR)(stuck)
implement(interface.powers, OSCILLATOR)(powers)


@implement(interface.event_count, PLAIN)
@inlined
def plain_event_count(p):
    """Number of event functions without effects."""
    return PLAIN_EVENTS


@implement(interface.event_count, OSCILLATOR)
@inlined
def event_count(p):
    """Number of event functions."""
    return EVENTS


@implement(interface.fastest, OSCILLATOR)
@inlined
def fastest(p):
    """Highest angular frequency (rad/s) of the input and of the free oscillator, which a belt drives, too."""
    return max(excitation.fastest(p), (p.oscillator.spring / p.oscillator.mass) ** 0.5)


@implement(interface.linear, OSCILLATOR)
@inlined
def linear(mode, p):
    """Whether the mass sticks, or slips under friction that does not depend on velocity."""
    if not (p.oscillator.linear and excitation.is_sine(p)):
        return False
    return stuck(mode, p) or (abs(mode.column) == 1 and friction.is_constant(p))


@implement(interface.free, OSCILLATOR)
@inlined
def free(y, p):
    """A mass that friction holds keeps its velocity, and a rod that presses its place."""
    pinned = p.friction.set_valued != 0 and slip(y, p) == 0.0
    found = replaced(states.active(p), VELOCITY, not pinned)
    return damper_play.freed(found, y, p)


@implement(interface.observed, OSCILLATOR)
@inlined
def observed(y, p):
    """Deflection and its rate: minus the displacement, which is what results are reported as."""
    return -y[X], -y[VELOCITY]


@implement(interface.sticks, OSCILLATOR)
@inlined
def sticks(y, mode, p):
    """Whether the mass sticks, or slips below the threshold velocity."""
    if creeps(p):
        return abs(slip(y, p)) <= p.friction.v_t
    return abs(mode.column) != 1 and not crosses(mode)


@implement(interface.driving_force, OSCILLATOR)
@inlined
def driving_force(t, acceleration, y, mode, p):
    """Inertia, springs, dampers and friction; not determined while friction holds the mass."""
    if stuck(mode, p):
        return nan
    return p.oscillator.mass * acceleration - load(t, y, mode, p) + friction_force(y, mode, p)


@implement(interface.already_moving, OSCILLATOR)
@inlined
def already_moving(y, deflected, p):
    """The rod of a damper presses to the side to which the mass moves, or pulls its spring."""
    y = series_compliance.settled(y, slip(y, p), deflected, p)
    return damper_play.pressing(y, 1 if y[VELOCITY] >= 0.0 else -1, p)


@implement(interface.share_before_jump, OSCILLATOR)
@inlined
def share_before_jump(y, step, p):
    """The rod of a damper reaches an end of its play."""
    return damper_play.share_before_end(y, slip(y, p) * step, p)


@implement(interface.moved_freely, OSCILLATOR)
@inlined
def moved_freely(y, following, change, step, p):
    """The rod of a damper moves between the ends of its play, or pulls its spring."""
    following = series_compliance.moved(y, following, slip(y, p), change, step, p)
    following = maxwell_presliding.moved(y, following, step, p)
    return damper_play.with_rod(following, damper_play.rod_after(y, slip(y, p) * step, p), p)


@implement(interface.rate, PLAIN)
@inlined
def plain_rate(t, y, mode, p):
    """dy/dt, and the load."""
    now = load(t, y, mode, p)
    gain = (now - resistance(now, y, mode, p)) / p.oscillator.mass
    return (y[VELOCITY], gain) + hooks.rates(slip(y, p), now, mode, y, p), now  # noqa: RUF005


@implement(interface.rate, OSCILLATOR)
@inner
def rate(t, y, mode, p):
    """As ``plain_rate``, in one copy for all stages of a step: effects make it long."""
    return plain_rate(t, y, mode, p)


# Events


@inlined
def _breakaway(now, y, direction, p):
    """Net force (N) under the load ``now`` if a mass that sticks slipped in a direction."""
    return now - friction_force(y, _slipping(direction, y, 0, 1, p), p)


@inlined
def _slip_events(now, y, mode, p, out):
    """Write the distances of slip to both ends of its branch, or of the load to where friction lets go."""
    value, branch = slip(y, p), mode.column
    if series_compliance.acts(p):
        series_compliance.write_events(y, branch, SLIP, p, out)
    elif crosses(mode):
        damper_play.write_events(y, SLIP, p, out)
    elif stuck(mode, p):
        out[SLIP] = _breakaway(now, y, -1, p)
        out[SLIP + 1] = -_breakaway(now, y, 1, p)
    elif abs(branch) == HELD:
        out[SLIP] = now - friction_force(y, _beside(y, mode, 0, p), p)
        out[SLIP + 1] = friction_force(y, _beside(y, mode, 1, p), p) - now
    elif p.friction.set_valued or creeps(p):
        out[SLIP if branch > 0 else SLIP + 1] = branch * value
    else:
        friction.write_branch_ends(value, p.friction.v_t, branch, SLIP, out)
        end = damper_play.side(y, p)
        if end != 0 and branch == 0:  # a rod that presses cannot pull
            out[SLIP if end > 0 else SLIP + 1] = end * value


@inlined
def _effect_events(t, y, mode, p, out):
    """Write the events of effects."""
    if travel.acts(p):
        travel.write_events(elongation(t, y, p), mode.segment, p, TRAVEL, out)
    ramp = mode.column == 0 and not p.friction.set_valued
    if mode.direction != 0 and ramp and not damper_play.acts(p):
        out[DIRECTION if mode.direction > 0 else DIRECTION + 1] = mode.direction * slip(y, p)
    if ageing.acts(p) and creeps(p):
        inside = p.friction.v_t - abs(slip(y, p))
        out[CLOCK] = inside if mode.clock else -inside


@implement(interface.events, OSCILLATOR)
@inlined
def events(now, t, y, mode, p, out):
    """Write the event functions (m/s, m, N) under the load ``now``."""
    for i in range(interface.event_count(p)):
        out[i] = inf
    _slip_events(now, y, mode, p, out)
    _effect_events(t, y, mode, p, out)


# Modes


@inlined
def _directed(p):
    """Whether the equations change where the slip reverses, on a ramp, too."""
    return directional_friction.acts(p) or maxwell_presliding.acts(p)


@inlined
def _slipping(direction, y, segment, clock, p):
    """Mode of slip in a direction; ``clock`` = 1: about to slip, still at rest.

    A rod that presses to one side crosses its play in the other direction.
    """
    if direction * damper_play.side(y, p) < 0:
        return _crossing(segment)
    return Mode(direction, direction if _directed(p) else 0, segment, clock)


@inlined
def _crossing(segment):
    """Mode in which a rod crosses its play, and the damper rests."""
    return Mode(damper_play.CROSSING, 0, segment, 1)


@inlined
def _behind_spring(branch, segment):
    """Mode on a branch of a damper behind a spring."""
    return Mode(branch, 0, segment, 1 if branch == 0 else 0)


@inlined
def _beside(y, mode, higher, p):
    """Mode on the lower (0) or higher (1) side of the jump that holds the slip velocity."""
    if creeps(p):
        return _slipping(2 * higher - 1, y, mode.segment, mode.clock, p)
    column = (0 if mode.column > 0 else -1) + higher
    return Mode(column, mode.direction, mode.segment, 0 if abs(column) == 1 else 1)


@inner
def _mode_at_rest(t, y, segment, p):
    """Mode that follows zero slip under a set-valued law."""
    held = Mode(0, 0, segment, 1)
    now = load(t, y, held, p)
    forward, backward = _breakaway(now, y, 1, p), _breakaway(now, y, -1, p)
    nothing = ROUNDING * (abs(now) + p.oscillator.mass * p.input.omega**2 * states.input_length(p))
    if forward > nothing:
        return _slipping(1, y, segment, 0, p)
    if backward < -nothing:
        return _slipping(-1, y, segment, 0, p)
    if backward - forward > nothing:
        return held
    return _without_friction(t, y, segment, p)


@inner
def _without_friction(t, y, segment, p):
    """Mode that follows zero slip where nothing holds the mass: the direction in which it soon moves."""
    mode = _slipping(1, y, segment, 0, p)
    y = soon(t, y, LOOK_AHEAD / fastest(p), mode, p)
    return mode if slip(y, p) >= 0.0 else _slipping(-1, y, segment, 0, p)


@implement(interface.initial_mode, OSCILLATOR)
@inner
def initial_mode(t, y, p):
    """Mode in which a run begins."""
    return _mode_at(t, y, travel.segment_at(elongation(t, y, p), p), p), True


@inner
def _mode_at(t, y, segment, p):
    """Mode that a state is in, at a segment of the travel."""
    if series_compliance.acts(p):
        return _behind_spring(series_compliance.branch(y, p), segment)
    rubbing = slip(y, p)
    sign = 1 if rubbing >= 0.0 else -1
    direction = sign if _directed(p) else 0
    if damper_play.acts(p) and (damper_play.side(y, p) == 0 or damper_play.side(y, p) * rubbing < 0.0):
        return _crossing(segment)
    if p.friction.set_valued:
        if rubbing == 0.0:
            return _mode_at_rest(t, y, segment, p)
        return _slipping(sign, y, segment, 0, p)
    branch = friction.branch_at(rubbing, p)
    clock = 1 if branch == 0 else 0
    return Mode(sign if creeps(p) else branch, direction, segment, clock)


@inner
def _cross(t, y, mode, upward, p):
    """Mode on the next branch of a regularised law, or held where the next branch points back."""
    if abs(mode.column) == HELD:
        return _beside(y, mode, upward, p)
    if creeps(p):
        across = _slipping(-mode.column, y, mode.segment, mode.clock, p)
        # Friction that depends on the direction jumps while bristles are bent.
        pulled = across.column * (load(t, y, across, p) - friction_force(y, across, p))
        if pulled >= 0.0 or not directional_friction.acts(p):
            return across
        return Mode(HELD, 0, mode.segment, mode.clock)
    column = mode.column + 2 * upward - 1
    across = Mode(column, mode.direction, mode.segment, 0 if abs(column) == 1 else 1)
    onward = (2 * upward - 1) * (load(t, y, across, p) - friction_force(y, across, p))
    before = friction_force(y, mode, p)
    jump = abs(friction_force(y, across, p) - before)
    if onward >= 0.0 or jump <= SMOOTH * abs(before):
        return across
    return Mode(HELD if mode.column + upward > 0 else -HELD, mode.direction, mode.segment, 1)


@inner
def _transition(t, y, mode, place, p):
    upward = place % 2
    if series_compliance.acts(p) and place < TRAVEL:
        return y, _behind_spring(mode.column + 2 * upward - 1, mode.segment)
    if crosses(mode) and place < TRAVEL:
        y = damper_play.pressing(y, 2 * upward - 1, p)
        return y, _mode_at(t, y, mode.segment, p)
    if place >= CLOCK:
        return y, Mode(mode.column, mode.direction, mode.segment, 1 - mode.clock)
    if place >= DIRECTION:
        return y, Mode(mode.column, -mode.direction, mode.segment, mode.clock)
    if place >= TRAVEL:
        segment = travel.next_segment(mode.segment, upward, p)
        return y, Mode(mode.column, mode.direction, segment, mode.clock)
    at_rest = replaced(y, VELOCITY, p.oscillator.belt_velocity)
    if not p.friction.set_valued:
        if mode.column == 0 and (2 * upward - 1) * damper_play.side(y, p) < 0:
            return at_rest, _crossing(mode.segment)
        return y, _cross(t, y, mode, upward, p)
    y = at_rest
    if stuck(mode, p):
        return y, _slipping(2 * upward - 1, y, mode.segment, 0, p)
    y = ageing.rejuvenated(y, p)
    return y, _mode_at_rest(t, y, mode.segment, p)


@implement(interface.transition, OSCILLATOR)
@inner
def transition(t, y, mode, place, p):
    """State and mode after an event: set-valued friction stops the slip, and slip ends the time at rest."""
    y, found = _transition(t, maxwell_presliding.slipped(y, p), mode, place, p)
    return y if found.clock else ageing.rejuvenated(y, p), found, True
