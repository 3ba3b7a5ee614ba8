"""The input: motion of the base (the paper's Eq. 4: u = a sin(omega t)) or a force, with the effects on it.

A recorded input is a Fourier series in place of the sine:

    u = a sum_h (cosine_h cos(h omega t) + sine_h sin(h omega t)),  h = 1..count

with time counted so that its fundamental is the sine (cosine_1 = 0, sine_1 = 1). An input that does not
repeat is known by samples (``sampled_input``). Code for records without the part ``series`` contains neither.
"""

from math import pi

import numpy as np

from wedgesweep import sampled_input
from wedgesweep.compiled import contracted, inlined, term
from wedgesweep.effects import hooks
from wedgesweep.hybrid.vectors import combination, weighted
from wedgesweep.sampled_input import is_sampled
from wedgesweep.traced import traced
from wedgesweep.trigonometry import cosine, sine

# Harmonics that a record has room for, a multiple of the CHAINS that are summed at a time.
HARMONICS, CHAINS = 16, 4
# Coefficients of an input as a power series.
TERMS = 7
# Share of the mean square acceleration above the highest order that the steps of a solver must resolve.
# What lies above is as small as the noise of a record: it shifts an event, but causes none of its own.
UNRESOLVED = 0.04
SERIES_FIELDS = [
    ("count", np.int64),
    ("resolved", np.int64),
    ("cosine", np.float64, (HARMONICS,)),
    ("sine", np.float64, (HARMONICS,)),
    *sampled_input.FIELDS,
]
# Shape of the paper's base motion, as ``set_series`` takes it.
SINE = np.array([-1j])


def set_series(rows: np.ndarray, harmonics: np.ndarray) -> None:
    """Put the shape of a base motion into full records, shape (n,), in place.

    Parameters
    ----------
    rows : structured array, shape (n,)
        Their input amplitude and frequency stay as they are.
    harmonics : ndarray, shape (n, H) or (H,)
        Complex, over the amplitude: u = a Re sum_h harmonics_h exp(i h omega t); the first is -i, H <= 16.
    """
    part = rows["series"]
    orders = np.arange(1, harmonics.shape[-1] + 1)
    part["count"] = np.maximum((orders * (harmonics != 0.0)).max(axis=-1), 1)
    part["resolved"] = _resolved(harmonics)
    part["cosine"], part["sine"] = 0.0, 0.0
    part["cosine"][..., : orders.size] = harmonics.real
    part["sine"][..., : orders.size] = -harmonics.imag


def _resolved(harmonics: np.ndarray) -> np.ndarray:
    """Highest order that steps must resolve, shape (n,) for harmonics of shape (n, H)."""
    orders = np.arange(1, harmonics.shape[-1] + 1)
    power = np.abs(orders**2 * harmonics) ** 2
    from_here_on = np.cumsum(power[..., ::-1], axis=-1)[..., ::-1]
    return np.maximum((from_here_on > UNRESOLVED * from_here_on[..., :1]).sum(axis=-1), 1)


def set_no_motion(rows: np.ndarray, length: float) -> None:
    """Let no input act in full records, shape (n,), in place; motions are compared with a length (m)."""
    rows["input"]["amplitude"] = length
    part = rows["series"]
    part["count"], part["resolved"], part["cosine"], part["sine"] = 2, 1, 0.0, 0.0


def has_series(rows: np.ndarray) -> np.ndarray:
    """Whether the input of full records, shape (n,), is not just a sine."""
    return (rows["series"]["count"] > 1) | is_sampled(rows)


@term("series", off="True")
def is_sine(p):
    """Whether the input is a sine, or none."""
    if p.series.rows > 0:
        return False
    for order in range(1, p.series.count):
        if p.series.cosine[order] != 0.0 or p.series.sine[order] != 0.0:
            return False
    return True


@term("series", off="True")
def is_harmonic(p):
    """Whether the input is a sum of harmonics, or none."""
    return p.series.rows == 0


@term("input_gain", off="p.input.amplitude")
def amplitude(p):
    """Amplitude of a sine (m or N), which the samples of other inputs are multiples of."""
    return p.input_gain.scale * p.input.amplitude


@term("series", off="amplitude(p)", amplitude=amplitude)
def sine_amplitude(p):
    """Amplitude of an input that is a sine (m or N); 0 where there is none."""
    return p.series.sine[0] * amplitude(p)


@inlined
def _turned(turn, by):
    """Cosine and sine of the sum of two angles, both given by theirs."""
    return turn[0] * by[0] - turn[1] * by[1], turn[1] * by[0] + turn[0] * by[1]


@inlined
def _harmonic(order, power, turn, p):
    """order**power times the cosine and sine parts of a harmonic, and times its quadrature."""
    c, s, weight = p.series.cosine[order - 1], p.series.sine[order - 1], 1.0
    for _ in range(power):
        weight *= order
    return weight * (c * turn[0] + s * turn[1]), weight * (s * turn[0] - c * turn[1])


@contracted
def _series(t, power, p):
    """Sums of h**power times the cosine and sine parts, and times the quadrature, over all harmonics.

    Four chains of rotations, of which none waits for another.
    """
    first = cosine(p.input.omega * t), sine(p.input.omega * t)
    second = _turned(first, first)
    third, fourth = _turned(second, first), _turned(second, second)
    a, b, c, d = first, second, third, fourth
    in_phase, quadrature = 0.0, 0.0
    for order in range(1, p.series.count + 1, CHAINS):
        one, two = _harmonic(order, power, a, p), _harmonic(order + 1, power, b, p)
        three, four = _harmonic(order + 2, power, c, p), _harmonic(order + 3, power, d, p)
        in_phase += (one[0] + two[0]) + (three[0] + four[0])
        quadrature += (one[1] + two[1]) + (three[1] + four[1])
        a, b, c, d = _turned(a, fourth), _turned(b, fourth), _turned(c, fourth), _turned(d, fourth)
    return in_phase, quadrature


@term("series", off="sine(p.input.omega * t)", sine=sine)
def _shape(t, p):
    """Displacement over amplitude."""
    if p.series.rows > 0:
        return sampled_input.value(t, p)
    return _series(t, 0, p)[0]


@term("series", off="cosine(p.input.omega * t)", cosine=cosine)
def _slope(t, p):
    """Velocity over amplitude and angular frequency."""
    if p.series.rows > 0:
        return sampled_input.slope(t, p) / p.input.omega
    return _series(t, 1, p)[1]


@term("series", off="sine(p.input.omega * t)", sine=sine)
def _bend(t, p):
    """Negative acceleration over amplitude and squared angular frequency."""
    if p.series.rows > 0:
        return -sampled_input.bend(t, p) / (p.input.omega * p.input.omega)
    return _series(t, 2, p)[0]


@traced
def _expanded(sine_part, cosine_part, omega):
    """Coefficients by powers of time (s), shape (TERMS,), of a sum of a sine and a cosine.

    ``sine_part``: its value; ``cosine_part``: its rate over the angular frequency ``omega``.
    """
    terms, value, rate = [], sine_part, cosine_part
    for k in range(TERMS):
        terms.append(value)
        value, rate = rate * omega * (1.0 / (k + 1)), value * omega * (-1.0 / (k + 1))
    return tuple(terms)


@inlined
def _sine_expanded(t, p):
    return _expanded(sine(p.input.omega * t), cosine(p.input.omega * t), p.input.omega)


@term("series", off="_sine_expanded(t, p)", _sine_expanded=_sine_expanded)
def _bend_expanded(t, p):
    """``_bend`` of harmonics from a time on, by powers of time (s)."""
    first = cosine(p.input.omega * t), sine(p.input.omega * t)
    turn, total = first, _expanded(0.0, 0.0, p.input.omega)
    for order in range(1, p.series.count + 1):
        in_phase, quadrature = _harmonic(order, 2, turn, p)
        total = weighted(total, 1.0, (1.0,), (_expanded(in_phase, quadrature, order * p.input.omega),))
        turn = _turned(turn, first)
    return total


@term("series", off="1.0")
def _largest_bend(p):
    """A bound of ``_bend`` of harmonics."""
    total = 0.0
    for order in range(1, p.series.count + 1):
        total += order**2 * (p.series.cosine[order - 1] ** 2 + p.series.sine[order - 1] ** 2) ** 0.5
    return total


@term("series", off="p.input.omega")
def _highest(p):
    """Highest angular frequency (rad/s) of the input, or of the motions that it causes if that is higher."""
    if p.series.rows > 0:
        return max(p.series.fastest, p.input.omega)
    return max(p.series.resolved, 1) * p.input.omega


@term("series", off="2.0 * pi / p.input.omega", pi=pi)
def cycle(p):
    """Period of the input (s); the span of one that is known by samples."""
    return p.series.span if p.series.rows > 0 else 2.0 * pi / p.input.omega


@inlined
def displacement(t, p):
    """Displacement u (m) of the side frame, or of the table that carries it."""
    return hooks.base_displacement(p.input.amplitude * _shape(t, p), t, p)


@inlined
def velocity(t, p):
    """Velocity u' (m/s) of the side frame, or of the table that carries it."""
    return hooks.base_velocity(p.input.amplitude * p.input.omega * _slope(t, p), t, p)


@inlined
def acceleration(t, p):
    """Acceleration u'' (m/s^2) of the side frame, or of the table that carries it."""
    return hooks.base_acceleration(-p.input.amplitude * p.input.omega**2 * _bend(t, p), t, p)


@inlined
def acceleration_expanded(t, p):
    """Acceleration of harmonics from a time on, by powers of time (s), where effects only scale it."""
    size = hooks.base_acceleration(-p.input.amplitude * p.input.omega**2, t, p)
    return combination(size, (1.0,), (_bend_expanded(t, p),))


@inlined
def largest_acceleration(p):
    """A bound (m/s^2) of the same."""
    return abs(hooks.base_acceleration(p.input.amplitude * p.input.omega**2 * _largest_bend(p), 0.0, p))


@inlined
def force(t, p):
    """Force on the mass in N, where the input is one and its amplitude in N."""
    return hooks.input_force(p.input.amplitude * _shape(t, p), t, p)


@inlined
def fastest(p):
    """Highest angular frequency (rad/s) of the input."""
    return hooks.fastest(_highest(p), p)
