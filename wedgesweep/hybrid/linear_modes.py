"""Follows a mode of linear equations in closed form to its first event, whatever the system, and records it.

    x'' = c + a x + b x' + input        e = e_0 + e_x x + e_v x' + input    (each event function)

The input has one frequency. Rate and event functions at five places give all coefficients. What is left after
centre and forced motion, w = x - centre - forced, is free:

    w(s) = w_0 C(s) + w'_0 S(s) + c P(s)        S'' = a S + b S',  S(0) = 0,  S'(0) = 1
    C = S' - b S                                P' = S,  P(0) = 0

Without a spring (a = 0) there is no centre; with one it takes the constant c. Intervals of a part of a period
are scanned for events; Newton's method then finds the event itself to rounding error.
"""

from math import factorial, inf, pi, sqrt
from typing import Any, NamedTuple

import numpy as np

from wedgesweep.compiled import inlined, inner
from wedgesweep.hybrid.interface import cycle, event_count, events, fastest, rate
from wedgesweep.hybrid.recorder import first_sample, record_node, record_sample
from wedgesweep.hybrid.search import (
    Bracket,
    Sample,
    crossing,
    first_zero,
    may_graze,
    minimum,
    sample,
    searched,
    zero_near,
)
from wedgesweep.hybrid.state import FAILED, NO_EVENT, State
from wedgesweep.hybrid.step import step_limit
from wedgesweep.hybrid.vectors import with_motion
from wedgesweep.traced import traced
from wedgesweep.trigonometry import cosine, sine

# Displacement and velocity: the first two states of every system.
X, VELOCITY = 0, 1
# Scanned intervals per period of the input or of the free motion, whichever is shorter.
SCAN = 12
# Coefficients of cosh(sqrt(z)), sinh(sqrt(z)) / sqrt(z), cos(sqrt(z)), sin(sqrt(z)) / sqrt(z), exp(x), and
# (exp(x) - 1 - x) / x^2: over an interval, where z and x are small, the rest is less than rounding errors.
EVEN, ODD = (tuple(1.0 / factorial(2 * k + odd) for k in range(8)) for odd in (0, 1))
COSINE, SINE = (tuple((-1) ** k * c for k, c in enumerate(each)) for each in (EVEN, ODD))
EXPONENTIAL, EXPONENTIAL_BEYOND = (tuple(1.0 / factorial(k + n) for k in range(14)) for n in (0, 2))
# Relative distance of both squared frequencies below which the forced and the free part nearly cancel.
RESONANT = 1e-4
# A spring that is softer than this share of the highest squared frequency has no centre within reach.
SOFT = 1e-6
# Share of what its parts add up to below which a quantity is zero but for rounding errors.
NEARLY_ZERO = 1e-12
# Phase (rad) from which a series of order 3 leads to an event within rounding error.
CONVERGED = 2e-4
# Gauss' rule of eight points on [0, 1], and the end of a piece, which has no weight. On the longest piece
# that is recorded, over an interval, it leaves 4e-11 of an energy.
_GAUSS = np.polynomial.legendre.leggauss(8)
PLACES = (*(float(0.5 + 0.5 * node) for node in _GAUSS[0]), 1.0)
PLACE_WEIGHTS = (*(float(0.5 * weight) for weight in _GAUSS[1]), 0.0)
LONGEST_PIECE = 5.25
# Error of the place of an extreme as a share of an interval: the extreme itself has the square of it.
PLACE_OF_EXTREME = 1e-5
# Room for the equations of modes, of a slip up and of one down, and for numbers of a mode and quantities.
SLOTS, MOST_NUMBERS, MOST_QUANTITIES = 2, 16, 34
# A number that no mode has: a slot is empty. The end of a list of quantities.
EMPTY, NONE = -128, -1
# Where the event functions begin among the quantities; where the rate and the amplitude stand in their rows.
EVENTS, RATE, AMPLITUDE = 2, 5, 10
# Places at which rate and event functions give the equations.
PROBES = 5


class Equations(NamedTuple):
    """Room for the linear equations of the modes that a run has met last.

    ``modes`` (SLOTS, MOST_NUMBERS); ``motions`` (SLOTS, 13): a ``Motion`` and the ``Move`` over its step;
    ``quantities`` (SLOTS, MOST_QUANTITIES, 11): displacement, velocity and the event functions, each a
    ``Quantity``, its rate and the amplitude of its forced part; ``present`` (SLOTS, MOST_QUANTITIES): the
    event functions that a mode has, up to a NONE; ``extreme`` (SLOTS, MOST_QUANTITIES): those quantities
    whose extremes are recorded, up to a NONE; ``watched`` (MOST_QUANTITIES,): the event functions that may
    vanish, up to a NONE; ``values`` (PROBES, MOST_QUANTITIES): working space.
    """

    modes: Any
    motions: Any
    quantities: Any
    present: Any
    extreme: Any
    watched: Any
    values: Any


def room() -> Equations:
    """Room for equations, of no mode yet."""
    return Equations(
        np.full((SLOTS, MOST_NUMBERS), EMPTY),
        np.zeros((SLOTS, 13)),
        np.zeros((SLOTS, MOST_QUANTITIES, 11)),
        np.full((SLOTS, MOST_QUANTITIES), NONE),
        np.full((SLOTS, MOST_QUANTITIES), NONE),
        np.full(MOST_QUANTITIES, NONE),
        np.full((PROBES, MOST_QUANTITIES), inf),
    )


@inlined
def forget(equations):
    """Empty all slots: another case has other equations."""
    for slot in range(SLOTS):
        equations.modes[slot, 0] = EMPTY


class Motion(NamedTuple):
    """Equation of w; frequency of the input (rad/s); length of an interval (s), 0 without a closed form."""

    constant: float
    by_x: float
    by_velocity: float
    omega: float
    step: float


class Quantity(NamedTuple):
    """A linear function of a ``Phase``: a constant, and factors of w, w', cosine and sine."""

    constant: float
    by_w: float
    by_rate: float
    by_cosine: float
    by_sine: float


class Phase(NamedTuple):
    """Point of a motion: cosine and sine of the input's phase, w (m) and its rate (m/s)."""

    cosine: float
    sine: float
    w: float
    rate: float


class Linear(NamedTuple):
    """A mode with its equations; ``y``: its state, of which x and x' move.

    ``values``, ``slopes``: working space, of a mode for the event functions that are watched and their rates,
    of a record for the rates of what has extremes, and the rates of these.
    """

    motion: Motion
    quantities: Any
    extreme: Any
    values: Any
    slopes: Any
    y: Any
    mode: Any
    p: Any


class Move(NamedTuple):
    """How a phase changes in a time: cosine and sine of the input's turn, C, S, c P, S' and C'."""

    cosine: float
    sine: float
    c: float
    s: float
    constant: float
    s_rate: float
    c_rate: float
    constant_rate: float


# Motion


def _polynomial(c, x):
    """A polynomial by Estrin's scheme: short chains of operations that wait for each other."""
    while len(c) > 1:
        pairs = [c[i] + c[i + 1] * x for i in range(0, len(c) - 1, 2)]
        c, x = [*pairs, *c[2 * len(pairs) :]], x * x
    return c[0]


def _turn(angle: Any) -> tuple[Any, Any]:
    """Cosine and sine of a small angle (rad)."""
    square = angle * angle
    return _polynomial(COSINE, square), angle * _polynomial(SINE, square)


@traced
def _undamped(time, motion):
    """The move of a spring over a time (s), at most an interval."""
    angle, z = motion.omega * time, motion.by_x * time * time
    even, s = _polynomial(EVEN, z), time * _polynomial(ODD, z)
    return Move(*_turn(angle), even, s, 0.0 * s, even, motion.by_x * s, 0.0 * s)


@traced
def _damped(time, motion):
    """The move of a spring, a damper and a constant force over a time (s), at most an interval."""
    angle, half, ramp = motion.omega * time, 0.5 * motion.by_velocity, motion.by_velocity * time
    z, grown = (motion.by_x + half * half) * time * time, _polynomial(EXPONENTIAL, half * time)
    even, s = grown * _polynomial(EVEN, z), grown * time * _polynomial(ODD, z)
    constant = motion.constant * time * time * _polynomial(EXPONENTIAL_BEYOND, ramp)
    return Move(
        *_turn(angle), even - half * s, s, constant, even + half * s, motion.by_x * s, motion.constant * s
    )


@inlined
def _move(time, motion):
    """The move over a time (s), at most an interval."""
    if motion.by_velocity == 0.0 and motion.constant == 0.0:
        return _undamped(time, motion)
    return _damped(time, motion)


@traced
def _moved(phase, move):
    """The phase after a move."""
    return Phase(
        phase.cosine * move.cosine - phase.sine * move.sine,
        phase.sine * move.cosine + phase.cosine * move.sine,
        phase.w * move.c + phase.rate * move.s + move.constant,
        phase.w * move.c_rate + phase.rate * move.s_rate + move.constant_rate,
    )


@inlined
def _advanced(phase, time, motion):
    """The phase some time (s) later, at most an interval."""
    return _moved(phase, _move(time, motion))


@traced
def _derivative(quantity, motion):
    """The rate of a quantity, which is one as well."""
    return Quantity(
        quantity.by_rate * motion.constant,
        quantity.by_rate * motion.by_x,
        quantity.by_w + quantity.by_rate * motion.by_velocity,
        motion.omega * quantity.by_sine,
        -1.0 * motion.omega * quantity.by_cosine,
    )


@traced
def _value(quantity, phase):
    """Value at a phase."""
    free = quantity.constant + quantity.by_w * phase.w + quantity.by_rate * phase.rate
    return free + (quantity.by_cosine * phase.cosine + quantity.by_sine * phase.sine)


@traced
def _size(quantity, phase, forced):
    """What the parts of a quantity add up to at most; ``forced``: amplitude of its forced part."""
    return abs(quantity.constant) + abs(quantity.by_w * phase.w) + abs(quantity.by_rate * phase.rate) + forced


@inlined
def _phase_at(t, y, rows, omega):
    """Phase of a state at a time."""
    c, s = cosine(omega * t), sine(omega * t)
    w = y[X] - rows[X, 0] - (rows[X, 3] * c + rows[X, 4] * s)
    return Phase(c, s, w, y[VELOCITY] - (rows[VELOCITY, 3] * c + rows[VELOCITY, 4] * s))


@inlined
def _state(phase, y, rows):
    """State of a phase; ``y``: the other states."""
    x = rows[X, 0] + phase.w + (rows[X, 3] * phase.cosine + rows[X, 4] * phase.sine)
    velocity = phase.rate + (rows[VELOCITY, 3] * phase.cosine + rows[VELOCITY, 4] * phase.sine)
    return with_motion(y, x, velocity)


# Equations


@inner
def _probe(t, x, velocity, y, mode, p, out):
    """Acceleration (m/s^2) at a time and state; writes the event functions there."""
    there = with_motion(y, x, velocity)
    rates, forces = rate(t, there, mode, p)
    events(forces, t, there, mode, p, out)
    return rates[VELOCITY]


@inlined
def _forced(gain_cosine, gain_sine, by_x, by_velocity, omega):
    """Cosine and sine part of the forced motion (m), and whether it is far enough from resonance.

    ``gain_cosine``, ``gain_sine``: those of the acceleration (m/s^2).
    """
    if gain_cosine == 0.0 and gain_sine == 0.0:
        return 0.0, 0.0, True
    near, damped = -omega * omega - by_x, by_velocity * omega
    square = near * near + damped * damped
    in_cosine = (near * gain_cosine + damped * gain_sine) / square
    in_sine = (near * gain_sine - damped * gain_cosine) / square
    return in_cosine, in_sine, square > (RESONANT * omega * omega) ** 2


@inlined
def _store(quantity, motion, row):
    """Write a quantity and its rate."""
    slope = _derivative(quantity, motion)
    for i in range(5):
        row[i], row[i + RATE] = quantity[i], slope[i]
    row[AMPLITUDE] = sqrt(quantity.by_cosine**2 + quantity.by_sine**2)


@inlined
def _equation(y, mode, p, values):
    """The motion of a mode, and its displacement as a quantity; writes the event functions at five places."""
    omega, turn = 2.0 * pi / cycle(p), 0.25 * cycle(p)
    first = _probe(0.0, 0.0, 0.0, y, mode, p, values[0])
    quarter = _probe(turn, 0.0, 0.0, y, mode, p, values[1])
    half = _probe(2.0 * turn, 0.0, 0.0, y, mode, p, values[2])
    by_x = _probe(0.0, 1.0, 0.0, y, mode, p, values[3]) - first
    by_velocity = _probe(0.0, 0.0, 1.0, y, mode, p, values[4]) - first
    constant = 0.5 * (first + half)
    in_cosine, in_sine, usable = _forced(0.5 * (first - half), quarter - constant, by_x, by_velocity, omega)
    highest = max(fastest(p), sqrt(abs(by_x)), abs(by_velocity))
    centre = 0.0
    if by_x != 0.0:
        usable = usable and abs(by_x) > SOFT * highest * highest
        centre, constant = -constant / by_x, 0.0
    step = 2.0 * pi / SCAN / highest if usable else 0.0
    motion = Motion(constant, by_x, by_velocity, omega, step)
    return motion, Quantity(centre, 1.0, 0.0, in_cosine, in_sine)


@inner
def _write(slot, y, mode, p, equations):
    """Write the equations of a mode into a slot."""
    values, quantities = equations.values, equations.quantities[slot]
    motion, displacement = _equation(y, mode, p, values)
    velocity, move = _derivative(displacement, motion), _move(motion.step, motion)
    for i in range(5):
        equations.motions[slot, i] = motion[i]
    for i in range(8):
        equations.motions[slot, i + 5] = move[i]
    _store(displacement, motion, quantities[X])
    _store(velocity, motion, quantities[VELOCITY])
    present, extreme, count, more = equations.present[slot], equations.extreme[slot], 0, EVENTS
    extreme[X], extreme[VELOCITY] = X, VELOCITY
    for number in range(event_count(p)):
        first, half = values[0, number], values[2, number]
        if first == inf:
            continue
        mean, by_x, by_velocity = 0.5 * (first + half), values[3, number] - first, values[4, number] - first
        driven = 0.5 * (first - half), values[1, number] - mean
        quantity = Quantity(
            mean + by_x * displacement.constant,
            by_x,
            by_velocity,
            driven[0] + by_x * displacement.by_cosine + by_velocity * velocity.by_cosine,
            driven[1] + by_x * displacement.by_sine + by_velocity * velocity.by_sine,
        )
        _store(quantity, motion, quantities[number + EVENTS])
        present[count] = number + EVENTS
        count += 1
        # Else its extremes are those of the displacement or of the velocity.
        if driven[0] != 0.0 or driven[1] != 0.0 or by_x * by_velocity != 0.0:
            extreme[more] = number + EVENTS
            more += 1
    present[count], extreme[more] = NONE, NONE
    for i in range(len(mode)):
        equations.modes[slot, i] = mode[i]


@inlined
def _slot(y, mode, p, work):
    """The slot with the equations of a mode."""
    equations, slot = work.equations, 1 if mode[0] > 0 else 0
    known = True
    for i in range(len(mode)):
        known = known and equations.modes[slot, i] == mode[i]
    if not known:
        _write(slot, y, mode, p, equations)
        work.counts[0] += PROBES
    return slot


@inlined
def _stored_motion(n):
    return Motion(n[0], n[1], n[2], n[3], n[4])


@inlined
def _stored_move(n):
    return Move(n[5], n[6], n[7], n[8], n[9], n[10], n[11], n[12])


@inlined
def _quantity(rows, i):
    return Quantity(rows[i, 0], rows[i, 1], rows[i, 2], rows[i, 3], rows[i, 4])


@inlined
def _rate(rows, i):
    """The rate of a quantity."""
    return _quantity(rows[:, RATE:], i)


@inlined
def _sample(i, phase, rows):
    """Value and rate of a quantity at a phase."""
    return Sample(_value(_quantity(rows, i), phase), _value(_rate(rows, i), phase))


# Events


class _Function(NamedTuple):
    """A quantity from a phase on."""

    quantity: Quantity
    phase: Phase
    motion: Motion


@searched(_Function)
@inlined
def _at(time, function):
    phase = _advanced(function.phase, time, function.motion)
    slope = _derivative(function.quantity, function.motion)
    return _value(function.quantity, phase), _value(slope, phase)


@inlined
def _watch(phase, linear, present, watched):
    """Note which event functions may vanish while the mode lasts, and their samples at its start.

    A free motion that nothing drives and no damper feeds stays within its first amplitude.
    """
    motion, rows = linear.motion, linear.quantities
    bounded = motion.by_x < 0.0 and motion.by_velocity <= 0.0
    amplitude = speed = inf
    if bounded:
        speed = sqrt(phase.rate**2 - motion.by_x * phase.w**2)
        amplitude = speed / sqrt(-motion.by_x)
    count, place = 0, 0
    while present[place] != NONE:
        i = present[place]
        place += 1
        each = _quantity(rows, i)
        least = each.constant - rows[i, AMPLITUDE]
        if bounded:
            least -= abs(each.by_w) * amplitude + abs(each.by_rate) * speed
        if not bounded or least <= 0.0:
            watched[count] = i
            linear.values[count], linear.slopes[count] = _sample(i, phase, rows)
            count += 1
    watched[count] = NONE


@inner
def _first_zero(function, before, after, span, from_zero):
    """As ``search.first_zero``.

    Newton's method with two more terms of the series for time as a function of the quantity comes first.
    """
    motion, quantity = function.motion, function.quantity
    highest = 2.0 * pi / SCAN / motion.step
    if after.value <= 0.0 < before.value and not from_zero:
        near = crossing(before, after, span)
        phase = _advanced(function.phase, near, motion)
        slope = _derivative(quantity, motion)
        bend = _derivative(slope, motion)
        value, rising = _value(quantity, phase), _value(slope, phase)
        newton = -value / rising
        second = -0.5 * _value(bend, phase) / rising
        third = 2.0 * second**2 - _value(_derivative(bend, motion), phase) / (6.0 * rising)
        if abs(newton) * highest < CONVERGED and rising < 0.0:
            return near + newton * (1.0 + newton * (second + newton * third))
    return first_zero(function, 0.0, span, before, after, from_zero, 1.0 / highest)


@inlined
def _first_event(phase, later, span, linear, watched):
    """Time from a phase on and number of the first event in an interval that ends at the phase ``later``."""
    rows, time, first, place = linear.quantities, inf, NO_EVENT, 0
    while watched[place] != NONE:
        i, before = watched[place], Sample(linear.values[place], linear.slopes[place])
        after = _sample(i, later, rows)
        linear.values[place], linear.slopes[place] = after
        place += 1
        if after.value <= 0.0 or may_graze(before, after, span):
            quantity = _quantity(rows, i)
            from_zero = abs(before.value) <= NEARLY_ZERO * _size(quantity, phase, rows[i, AMPLITUDE])
            function = _Function(quantity, phase, linear.motion)
            found = _first_zero(function, before, after, span, from_zero)
            if found < time:
                time, first = found, i - EVENTS
    return time, first


@inner
def follow_linear(state, stop, p, keeping, recorder, work):
    """As ``interface.follow``, for a mode that is ``linear``."""
    t, y, mode, last_event, h = state
    equations = work.equations
    slot = _slot(y, mode, p, work)
    rows, numbers = equations.quantities[slot], equations.motions[slot]
    motion, move = _stored_motion(numbers), _stored_move(numbers)
    if motion.step == 0.0:
        return False, state, NO_EVENT
    values, slopes = equations.values[0], equations.values[1]
    linear = Linear(motion, rows, equations.extreme[slot], values, slopes, y, mode, p)
    first = _phase_at(t, y, rows, motion.omega)
    _watch(first, linear, equations.present[slot], equations.watched)
    phase, number = first, NO_EVENT
    most_steps = step_limit(work.counts[1], (stop - t) * fastest(p) / (2.0 * pi))
    while t < stop and number == NO_EVENT:
        work.counts[1] += 1
        if work.counts[1] > most_steps:
            return True, State(t, _state(phase, y, rows), mode, last_event, h), FAILED
        span = min(motion.step, stop - t)
        later = _moved(phase, move) if span == motion.step else _advanced(phase, span, motion)
        time, number = _first_event(phase, later, span, linear, equations.watched)
        if number >= 0:
            span, later = time, _advanced(phase, time, motion)
        t, phase = t + span, later
    t = stop if number == NO_EVENT else t
    if keeping:
        _record(state.t, t, first, linear, recorder)
    return True, State(t, _state(phase, y, rows), mode, last_event, h), number


# Records


@inlined
def _record_point(t, weight, phase, linear, recorder):
    """Add a phase to the sums, with its weight (s) in the quadrature."""
    y = _state(phase, linear.y, linear.quantities)
    record_node(t, y, weight, linear.mode, recorder, linear.p)


@inner
def _record(t, end, phase, linear, recorder):
    """Record a mode from a phase at time t to ``end`` (s)."""
    _record_samples(t, end, phase, linear, recorder)
    if not recorder.summed:
        return
    pieces = int((end - t) / (LONGEST_PIECE * linear.motion.step)) + 1
    span = (end - t) / pieces
    _record_point(t, 0.0, phase, linear, recorder)
    for _ in range(pieces):
        t, phase = _add_piece(t, span, phase, linear, recorder)
    _record_point(t, 0.0, phase, linear, recorder)


@inlined
def _steps(time, motion):
    """Number of equal moves for a time (s), each at most an interval, and the move."""
    count = int(time / motion.step) + 1
    return count, _move(time / count, motion)


@inlined
def _repeated(phase, steps):
    """The phase after some equal moves."""
    count, move = steps
    for _ in range(count):
        phase = _moved(phase, move)
    return phase


@inlined
def _record_samples(t, end, phase, linear, recorder):
    """Store the samples of a mode from a phase at time t to ``end`` (s)."""
    first, motion = first_sample(t, recorder), linear.motion
    phase = _repeated(phase, _steps(max(recorder.start + first * recorder.step - t, 0.0), motion))
    between = _steps(recorder.step, motion)
    for i in range(first, first_sample(end, recorder)):
        record_sample(i, _state(phase, linear.y, linear.quantities), linear.mode, recorder, linear.p)
        phase = _repeated(phase, between)


@inlined
def _add_piece(t, span, phase, linear, recorder):
    """Add a piece (s) from a phase on to the sums: integrals by quadrature, extremes between its nodes.

    Returns time and phase at its end.
    """
    place = 0.0
    _write_slopes(phase, linear)
    for i in range(len(PLACES)):
        width = (PLACES[i] - place) * span
        later = _advanced(phase, width, linear.motion)
        _record_extremes(t, width, phase, later, linear, recorder)
        if PLACE_WEIGHTS[i] > 0.0:
            _record_point(t + width, PLACE_WEIGHTS[i] * span, later, linear, recorder)
        t, phase, place = t + width, later, PLACES[i]
    return t, phase


@inlined
def _slope_at(place, phase, linear):
    """Rate of a quantity, as one, and its sample at a phase."""
    slope = _rate(linear.quantities, linear.extreme[place])
    return slope, Sample(_value(slope, phase), _value(_derivative(slope, linear.motion), phase))


@inlined
def _write_slopes(phase, linear):
    """Write the rates of all quantities at a phase."""
    place = 0
    while linear.extreme[place] != NONE:
        _, now = _slope_at(place, phase, linear)
        linear.values[place], linear.slopes[place] = now
        place += 1


@inlined
def _record_extremes(t, span, phase, later, linear, recorder):
    """Record the extremes of displacement, velocity and what decides on events between two phases."""
    place = 0
    while linear.extreme[place] != NONE:
        before = Sample(linear.values[place], linear.slopes[place])
        slope, after = _slope_at(place, later, linear)
        linear.values[place], linear.slopes[place] = after
        place += 1
        sign = 1.0 if before.value > 0.0 else -1.0
        falling, rising = _times(sign, before), _times(sign, after)
        if rising.value < 0.0:
            _record_extreme(t, span, phase, (falling, rising), _scaled(slope, sign), linear, recorder)
        elif may_graze(falling, rising, span):
            _record_two(t, span, phase, (falling, rising), _scaled(slope, sign), linear, recorder)


@inlined
def _times(sign, sample):
    return Sample(sign * sample.value, sign * sample.slope)


@traced
def _scaled(quantity, factor):
    return Quantity(*(factor * each for each in quantity))


@inner
def _record_extreme(t, span, phase, ends, slope, linear, recorder):
    """Record the point in an interval where a slope that is positive at its start is zero.

    ``ends``: samples of the slope at both ends.
    """
    before, after = ends
    bracket = Bracket(0.0, before.value, span, after.value)
    near, close = crossing(before, after, span), PLACE_OF_EXTREME * span
    time = zero_near(_Function(slope, phase, linear.motion), bracket, near, close)
    _record_point(t + time, 0.0, _advanced(phase, time, linear.motion), linear, recorder)


@inner
def _record_two(t, span, phase, ends, slope, linear, recorder):
    """Record both extremes in an interval if a slope that is positive at both ends is negative between."""
    before, after = ends
    function = _Function(slope, phase, linear.motion)
    time = minimum(function, 0.0, span, PLACE_OF_EXTREME * span)
    middle = sample(time, function)
    if middle.value < 0.0:
        _record_extreme(t, time, phase, (before, middle), slope, linear, recorder)
        there, back = _advanced(phase, time, linear.motion), _scaled(slope, -1.0)
        rest = _times(-1.0, middle), _times(-1.0, after)
        _record_extreme(t + time, span - time, there, rest, back, linear, recorder)
