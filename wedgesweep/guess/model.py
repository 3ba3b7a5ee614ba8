"""First numbers of a mass on a spring, by what a linear law explains of its records."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from math import pi
from typing import NamedTuple

import numpy as np
from scipy.optimize import nnls

from wedgesweep.diagnose import sliders
from wedgesweep.diagnose.noise_spectrum import white_noise
from wedgesweep.diagnose.smoothing import LOWEST, LowPass, derivative
from wedgesweep.measured import Measurement, TestRecord, contact_load
from wedgesweep.measured.declarations import MOTIONS, RELATIVE, TRANSIENT
from wedgesweep.measured.kinds import HIGHEST

# Cut-offs over the frequency of the motion, noise of the acceleration over itself that is small enough, and
# the share of the force below which a part of it is none.
HARMONICS, NOISY, LEAST = (12.0, 8.0, 5.0, 3.0, 2.0), 0.05, 0.01
# Lines of a spectrum that count, by their power over that of the highest one.
LINES = 1e-3
# Force of inertia over all force for a mass that no record shows: far below what a force is measured to.
UNSEEN = 1e-6
# Correlation from which acceleration and place are one motion at one frequency.
ALIKE = 0.99
# Share of the largest velocity beyond which friction has its sign (a convention).
MOVING = 0.1
# The same share where motions are known at a few frequencies only, which smears reversals: of a mass that an
# earthquake shakes the spring is then right to 1 and to 16 %, with 0.1 it is 30 % too soft.
CLEAR = 0.3
# Part of a free motion at its end that shows where it rests, and how much finer than a line spectra are read.
TAIL, PADDED = 0.1, 8
# What one explanation leaves over what another one does, below which it is clearly better. As relative
# motion over absolute, random motion has 0.17 if it is relative, and 4 if it is not; absolute motion at one
# frequency of a frame that rubs on a wall 0.7.
CLEARLY = 0.5
# The same above which a spring is none of a shaken mass: the drift of one that slides leaves 0.99 of what
# friction alone does, and the spring of a frame that rubs on a wall 0.90.
HARDLY = 0.95
# Tests that are looked at.
TESTS = 6

# A restoring force over its factor, of places (n,).
Restoring = Callable[[np.ndarray], np.ndarray]


@dataclass(frozen=True)
class Numbers:
    """SI numbers of an oscillator; ``friction`` is what dry friction takes beside them.

    It is a force (N) or, where each test states its load, a coefficient; ``load`` (N) is the first one then.
    ``unseen``: numbers that do not come from the records; ``swings``: as a pendulum does, with k sin(x).
    """

    mass: float
    spring: float
    damping: float
    friction: float = 0.0
    unseen: tuple[str, ...] = ()
    load: float = 0.0
    swings: bool = False


def numbers(measurement: Measurement) -> Numbers:
    """Mass, spring and damper that explain the records best; a free motion tells their ratio only."""
    tests = measurement.tests[:TESTS]
    if all(test.force is not None or measurement.recorded_input == "force" for test in tests):
        law = _under_force
    elif all(test.input is not None for test in tests) and measurement.recorded_input is not None:
        return _on_base(tests, measurement)
    else:
        law = _free
    left, found = law(tests, _spring)
    if measurement.model.turns and all({"displacement", "velocity"} & {*test.responses} for test in tests):
        left_by_pendulum, pendulum = law(tests, np.sin)
        if left_by_pendulum**2 < CLEARLY * left**2:  # powers, as noise is in both of them
            return replace(pendulum, swings=True)
    return found


def _spring(place: np.ndarray) -> np.ndarray:
    return place


def _free(tests: Sequence[TestRecord], restoring: Restoring) -> tuple[float, Numbers]:
    """Share of the acceleration that is left without a force, and the spring over the mass.

    A spring shows best in the frequency, which friction and noise hardly move.
    """
    moving = [_moving(test, 1.0, restoring) for test in tests]
    design = np.vstack([each.parts for each in moving])
    left, (_, spring, _) = _fitted(design[:, 1:], -design[:, 0])
    if all(np.ptp(np.sign(each.parts[:, 1])) == 0.0 for each in moving):  # it never turns back: is there any?
        if _fitted(design[:, [1, 3]], -design[:, 0])[0] * CLEARLY < left:
            spring = 0.0
    elif restoring is _spring:
        spring = (2.0 * pi * float(np.median([_frequency(test) for test in tests]))) ** 2
    return left, Numbers(1.0, spring, 0.0, unseen=("mass", "damping"))


def _fitted(design: np.ndarray, force: np.ndarray) -> tuple[float, list[float]]:
    """Share of a force (n,) that the parts (n, k) of it leave, and their factors, which are >= 0."""
    size = np.maximum(np.linalg.norm(design, axis=0), 1e-300)
    whole = max(float(np.linalg.norm(force)), 1e-300)
    parts, left = nnls(design / size, force)
    return float(left / whole), np.where(parts < LEAST * whole, 0.0, parts / size).tolist()


def _frequency(test: TestRecord) -> float:
    """Frequency (Hz) of a motion: at which it has most of its power, about where it ends."""
    signal = next(iter(test.responses.values()))
    about = signal - _end(signal)
    if test.force is not None or test.input is not None:
        about = signal - signal.mean()
    power = np.abs(np.fft.rfft(about, PADDED * signal.size))
    slowest = PADDED  # one period over the record
    return (slowest + int(power[slowest:].argmax())) / (PADDED * test.duration)


def _end(signal: np.ndarray) -> float:
    """Where a free motion (n,) ends."""
    return float(np.median(signal[-max(int(TAIL * signal.size), 1) :]))


class _Moving(NamedTuple):
    """Samples of a test in which its mass moves.

    ``parts`` (n, 3 + k): acceleration, velocity, restoring force over its factor (or 0), and friction over
    its largest: the direction, or the forces of springs with sliders; ``force`` (n,).
    """

    parts: np.ndarray
    force: np.ndarray


def _under_force(tests: Sequence[TestRecord], restoring: Restoring) -> tuple[float, Numbers]:
    """Share of the force that is left, and numbers by its parts: one is velocity's sign times a stated load.

    Joints are elastic before they slip: after a reversal friction builds up over some of the stroke, which
    looks like damping. Springs with sliders take the place of its sign if they explain the force clearly
    better, or friction differs from test to test if that does; of several such laws that with least damping
    counts, as effects can add a damper but take none away. At one speed friction of each test may be all
    there is.
    """
    loads = [test.model.get(contact_load.KEY, 0.0) for test in tests]
    loaded = min(loads) > 0.0
    factors = loads if loaded else [1.0] * len(tests)
    moving = [_moving(test, factor, restoring) for test, factor in zip(tests, factors, strict=True)]
    all_of_it = _explained(moving)
    others = []
    places = [test.displacement for test in tests if test.displacement is not None]
    if len(places) == len(tests):
        half = 0.5 * max(float(np.ptp(place)) for place in places)
        elastic = [
            _moving(test, factor, restoring, half) for test, factor in zip(tests, factors, strict=True)
        ]
        others.append(_explained(elastic))
    if not loaded:
        damped, undamped = (_explained(each, apart=True) for each in (moving, [_undamped(m) for m in moving]))
        others.append(damped if damped[0] < CLEARLY * undamped[0] else undamped)
    clearer = [each for each in others if each[0] < CLEARLY * all_of_it[0]]
    left, found = min(clearer, key=lambda each: each[1].damping, default=all_of_it)
    return left, replace(found, load=loads[0] if loaded else 0.0)


def negated(measurement: Measurement) -> list[TestRecord]:
    """Transients, if mass, spring and damper explain them clearly better under a force of the other sign."""
    tests = [test for test in measurement.tests if test.kind == TRANSIENT and test.input is not None]
    if not tests or measurement.recorded_input != "force":
        return []
    turned = [replace(test, input=-test.input) for test in tests if test.input is not None]
    left, otherwise = (_under_force(each[:TESTS], _spring)[0] for each in (tests, turned))
    return tests if otherwise < CLEARLY * left else []


def _undamped(test: _Moving) -> _Moving:
    """A test in which no damper can explain anything."""
    return test._replace(parts=test.parts * [1.0, 0.0, 1.0, 1.0])


def _explained(tests: Sequence[_Moving], apart: bool = False) -> tuple[float, Numbers]:
    """Share of the force that a linear law leaves, and the numbers of that law.

    ``apart``: with a friction of its own in each test, of which the law has the mean.
    """
    design = np.vstack([each.parts - each.parts.mean(axis=0) for each in tests])
    if apart:
        test = np.repeat(np.arange(len(tests)), [each.force.size for each in tests])
        design = np.column_stack([design[:, :3], design[:, 3:] * (test[:, None] == np.arange(len(tests)))])
    force = np.concatenate([each.force - each.force.mean() for each in tests])
    size, scatter = np.maximum(design.std(axis=0), 1e-300), float(force.std())
    found = _not_negative(design / size, force) / size
    left = float(np.std(force - design @ found)) / max(scatter, 1e-300)
    found[found * size < LEAST * scatter] = 0.0
    mass, damping, spring = found[:3].tolist()
    unseen, friction = ("mass",) if mass == 0.0 else (), float(found[3:].mean() if apart else found[3:].sum())
    return left, Numbers(mass or UNSEEN * scatter / float(size[0]), spring, damping, friction, unseen)


def _not_negative(design: np.ndarray, force: np.ndarray) -> np.ndarray:
    """Factors >= 0 (k,) of acceleration, velocity, place and directions (n, k) that explain a force best.

    At one frequency acceleration is opposite to place: then only the larger of inertia and spring shows,
    unless both explain clearly more, as they do near a resonance, where they are nearly opposite.
    """

    def fit(*motions: int) -> tuple[float, np.ndarray]:
        used = [*motions, *range(3, design.shape[1])]
        factors, left = nnls(design[:, used], force)
        return left, np.bincount(used, factors, design.shape[1])

    left, both = fit(0, 1, 2)
    if abs(design[:, 0] @ design[:, 2]) <= ALIKE * force.size:
        return both
    left_by_one, one = min(fit(1, 2), fit(0, 1), key=lambda found: found[0])
    return both if left < CLEARLY * left_by_one else one


def _moving(test: TestRecord, load: float, restoring: Restoring, half_range: float = 0.0) -> _Moving:
    """The samples of a test in which friction has its sign, which is multiplied by a load.

    A free motion is about where it ends, and its force is 0. With half the range (m) of the largest motion
    friction is that of springs with sliders, from where on it does not depend on the start, if that is most
    of the test.
    """
    rate = test.sampling_rate
    force, zero = test.force if test.force is not None else test.input, 0.0
    if force is None:
        free = next(iter(test.responses.values()))
        force, zero = np.zeros(free.size), _end(free)
    low_pass = _low_pass(test)
    ends = slice(low_pass.settling, -low_pass.settling)
    if 3 * low_pass.settling > force.size:
        ends = slice(None)
    if test.displacement is not None:
        place = low_pass(test.displacement - zero)
        velocity, acceleration = (derivative(place, rate, order) for order in (1, 2))
    elif test.velocity is not None:
        velocity = low_pass(test.velocity)
        acceleration, place = derivative(velocity, rate), np.zeros(force.size)
        direction = np.sign(velocity[np.abs(velocity) >= MOVING * np.abs(velocity).max()])
        if test.force is None and test.input is None and np.ptp(direction):  # a free motion that turns back
            place = low_pass(_travelled(test.velocity, rate))
    else:
        assert test.acceleration is not None
        acceleration = low_pass(test.acceleration)
        velocity, place = (_integral(test.acceleration, rate, order) for order in (1, 2))
    friction, counted = np.sign(velocity)[None], np.ones(force.size, bool)
    if half_range:
        assert test.displacement is not None
        friction, known = (each(test.displacement, half_range) for each in (sliders.forces, sliders.known))
        counted = known if known[ends].mean() > 0.5 else counted
    parts = np.column_stack([acceleration, velocity, restoring(place), *(load * low_pass(friction))])
    every = _Moving(*(each[ends][counted[ends]] for each in (parts, low_pass(force))))
    speed = np.abs(every.parts[:, 1])
    return _Moving(*(each[speed >= MOVING * speed.max()] for each in every))


def _travelled(velocity: np.ndarray, rate: float) -> np.ndarray:
    """Integral (n,) of a velocity without the drift of its second half, in which a motion comes to rest."""
    travelled, samples = np.cumsum(velocity) / rate, np.arange(velocity.size)
    later = samples >= velocity.size // 2
    return np.asarray(travelled - np.polynomial.Polynomial.fit(samples[later], travelled[later], 1)(samples))


def _low_pass(test: TestRecord) -> LowPass:
    """The widest filter that keeps the noise of the acceleration small against the acceleration."""
    rate, frequency = test.sampling_rate, _frequency(test)
    order, signal = (0, test.displacement) if test.displacement is not None else (1, test.velocity)
    cut_offs = (min(max(harmonics * frequency, LOWEST * rate), HIGHEST * rate) for harmonics in HARMONICS)
    filters = [LowPass(cut_off, rate) for cut_off in cut_offs]
    if signal is None:
        return filters[0]
    noise = white_noise(signal)
    for low_pass in filters:
        acceleration = derivative(low_pass(signal), rate, 2 - order)
        if low_pass.noise(noise, 2 - order) < NOISY * acceleration.std():
            return low_pass
    return filters[-1]


def _integral(acceleration: np.ndarray, rate: float, order: int) -> np.ndarray:
    """An acceleration (n,), integrated at the frequencies at which it has power."""
    line = np.fft.rfft(acceleration - acceleration.mean())
    omega = _frequencies(acceleration, rate)
    power = np.abs(line) ** 2
    line[power < LINES * power.max()] = 0.0
    omega[0] = 1.0  # where there is no power
    return np.fft.irfft(line / (1j * omega) ** order, acceleration.size)


def _on_base(tests: tuple[TestRecord, ...], measurement: Measurement) -> Numbers:
    """Spring, damper and friction over the mass, by motions of mass and base."""
    name = next(iter(tests[0].responses))
    relative = measurement.motion_of(name) == RELATIVE
    _, (spring, damping, friction) = _shaken(tests, name, relative, str(measurement.recorded_input), CLEAR)
    return Numbers(1.0, spring, damping, friction, unseen=("mass",))


def against_input(measurement: Measurement) -> frozenset[str]:
    """Responses that a mass on a moving base explains better if they are relative to the base."""
    tests, quantity = measurement.tests[:TESTS], str(measurement.recorded_input)
    if quantity not in MOTIONS or any(test.input is None for test in tests):
        return frozenset()
    names = set.intersection(*(set(test.responses) for test in tests))
    left = {(name, of): _shaken(tests, name, of, quantity)[0] for name in names for of in (False, True)}
    return frozenset(name for name in names if left[name, True] < CLEARLY * left[name, False])


def _shaken(
    tests: tuple[TestRecord, ...], name: str, relative: bool, quantity: str, clear: float = 0.0
) -> tuple[float, list[float]]:
    """What spring, damper and friction over the mass leave of its acceleration, and they.

    ``relative``: whether the response is the motion against the base, whose ``quantity`` is recorded; motions
    become one another at the frequencies at which the response has power. ``clear``: share of the largest
    velocity on the base below which samples do not count, as the mass may stick there. Friction opposes
    velocity as a damper does, and less of it where the mass sticks. So there is no damper unless it explains
    the records clearly better: effects can add one but take none away. A spring must explain something.
    """
    designs, values = [], []
    for test in tests:
        response = test.responses[name]
        assert test.input is not None
        omega, window = _frequencies(response, test.sampling_rate), np.hanning(response.size)
        y, u = (np.fft.rfft((each - each.mean()) * window) for each in (response, test.input))
        used = (np.abs(y) ** 2 > LINES * np.max(np.abs(y) ** 2)) & (omega > 0.0)
        rate = np.where(used, 1j * omega, 1.0)
        y, u = used * y / rate ** MOTIONS.index(name), used * u / rate ** MOTIONS.index(quantity)
        stretch, absolute = (y, y + u) if relative else (y - u, y)
        velocity = np.fft.irfft(rate * stretch, response.size)
        direction = used * np.fft.rfft(np.sign(velocity) * window)
        lines = (stretch, rate * stretch, direction, -(rate**2) * absolute)
        parts = np.column_stack([np.fft.irfft(each, response.size) for each in lines])
        moving = parts[np.abs(velocity) >= clear * np.abs(velocity).max()]
        designs.append(moving[:, :3] / np.linalg.norm(moving[:, 3]))
        values.append(moving[:, 3] / np.linalg.norm(moving[:, 3]))
    design, value = np.vstack(designs), np.concatenate(values)
    left, found = _fitted(design, value)
    left_undamped, (spring, friction) = _fitted(design[:, [0, 2]], value)
    left_of_friction, (friction_alone,) = _fitted(design[:, [2]], value)
    if left_undamped > HARDLY * left_of_friction:
        spring, friction = 0.0, friction_alone
    return left, found if left < CLEARLY * left_undamped else [spring, 0.0, friction]


def _frequencies(signal: np.ndarray, rate: float) -> np.ndarray:
    """Angular frequencies (rad/s) of the spectrum of a signal (n,)."""
    return 2.0 * pi * np.fft.rfftfreq(signal.size, 1.0 / rate)
