"""An input that is known by evenly spaced samples: a piecewise polynomial of degree 5.

Its derivatives are the rates of the input, so that u, u' and u'' agree exactly:

    displacement or force:  spline of degree 5 through the samples
    velocity, acceleration: spline of degree 3 through the samples, integrated once or twice

Parameter records hold the address of the coefficients, not the coefficients themselves. Whoever runs records
keeps the ``SampledInput`` alive, and puts it into them (``set_sampled``) in the process that runs them.
"""

from dataclasses import dataclass
from math import factorial, pi
from typing import Any, cast

import numpy as np
from numba import types
from numba.extending import intrinsic

from wedgesweep.compiled import inlined, inner

DEGREE = 5
# How often each quantity is integrated to become what acts: a displacement of the base, or a force.
INTEGRATED = {"displacement": 0, "force": 0, "velocity": 1, "acceleration": 2}
# Least number of a solver's steps in a period of the fastest input: none is longer than the time between
# samples.
STEPS = 12.0
# Error of a place between two samples, as a share of their distance.
PLACE_ERROR = 1e-13
# What a record says of its samples; ``rows`` = 0: nothing. ``gain``: of the samples, over the amplitude.
FIELDS: list[tuple] = [
    *((name, np.int64) for name in ("rows", "address")),
    *((name, np.float64) for name in ("begin", "step", "gain", "fastest", "span")),
]


@dataclass(frozen=True, eq=False)
class SampledInput:
    """Displacement of the base (m) or force (N) as a polynomial between each two of n samples.

    ``coefficients`` (n - 1, 6) of the powers of the share of an interval; ``begin`` (s): time of the first
    sample, ``step`` (s) between them; ``fastest`` (rad/s): the highest angular frequency that a solver must
    resolve. Beyond its ends the displacement goes on at a constant velocity.
    """

    coefficients: np.ndarray
    begin: float
    step: float
    fastest: float

    @property
    def end(self) -> float:
        """Time (s) of the last sample."""
        return self.begin + self.step * len(self.coefficients)

    def __call__(self, t: np.ndarray, derivative: int = 0) -> np.ndarray:
        """The input, or a derivative of it by time, at some times (s), shape (k,)."""
        place = (np.asarray(t, dtype=float) - self.begin) / self.step
        row = np.clip(np.floor(place).astype(int), 0, len(self.coefficients) - 1)
        share = np.clip(place - row, 0.0, 1.0)
        powers = [factorial(k) / factorial(k - derivative) for k in range(derivative, DEGREE + 1)]
        found = np.zeros_like(share)
        for k in range(DEGREE, derivative - 1, -1):
            found = found * share + powers[k - derivative] * self.coefficients[row, k]
        beyond = place - row - share
        if derivative == 0:
            found = found + beyond * self(np.clip(t, self.begin, self.end), 1) * self.step
        return np.where((beyond != 0.0) & (derivative == 2), 0.0, found) / self.step**derivative


def from_samples(
    values: np.ndarray,
    step: float,
    quantity: str = "displacement",
    *,
    begin: float = 0.0,
    start: tuple[float, float] = (0.0, 0.0),
    fastest: float | None = None,
) -> SampledInput:
    """The input through samples.

    Parameters
    ----------
    values : ndarray, shape (n,), n >= 2
        Samples in SI units.
    step : float
        Time (s) between them.
    quantity : str
        "displacement", "velocity" or "acceleration" of the base, or "force" on the mass.
    begin : float
        Time (s) of the first sample.
    start : tuple of float
        Displacement (m) and velocity (m/s) at the first sample, as far as the quantity leaves them open.
    fastest : float, optional
        Highest angular frequency (rad/s) that a solver must resolve; by default steps of a solver are no
        longer than ``step``.
    """
    times, coefficients = INTEGRATED[quantity], polynomials(values, step, quantity)
    if times > 1:
        coefficients[:, 0] += start[1] * step * np.arange(values.size - 1)
        coefficients[:, 1] += start[1] * step
    if times > 0:
        coefficients[:, 0] += start[0]
    return SampledInput(coefficients, begin, step, fastest or 2.0 * pi / (STEPS * step))


def polynomials(values: np.ndarray, step: float, quantity: str = "displacement") -> np.ndarray:
    """Coefficients of the polynomials between samples of a quantity, see ``SampledInput``.

    ``values`` (n, ...): one record, or several with coefficients (..., n - 1, 6); displacement and velocity
    are 0 at the first sample where the quantity leaves them open.
    """
    from scipy.interpolate import make_interp_spline

    times, n = INTEGRATED[quantity], len(values)
    degree = min(DEGREE if times == 0 else 3, (n - 2) // 2 * 2 + 1)
    places = np.arange(n, dtype=float)
    spline = make_interp_spline(places, values, k=degree)
    if times:
        spline = spline.antiderivative(times)
    coefficients = np.zeros((*values.shape[1:], n - 1, DEGREE + 1))
    # Knots lie at samples, so that the derivatives at a sample give the whole polynomial after it.
    for k in range(degree + times + 1):
        coefficients[..., k] = np.moveaxis(spline(places[:-1], k), 0, -1) * (step**times / factorial(k))
    return coefficients


def set_sampled(
    rows: np.ndarray,
    sampled: SampledInput,
    length: float | np.ndarray,
    omega: float,
    span: float,
    gain: float | np.ndarray = 1.0,
) -> None:
    """Let a sampled input act in full records, shape (n,), in place; it must outlive them.

    Parameters
    ----------
    rows : structured array, shape (n,)
        Full records (see systems.suspension.parameters.record).
    sampled : SampledInput
        The input, a force if that is what the input of the records is.
    length : float or ndarray, shape (n,)
        What motions are compared with (m), more than 0; under a force the force (N) that causes it.
    omega : float
        Angular frequency (rad/s) of the motions to expect, such as the natural one.
    span : float
        Time (s) that counts as one period: a run of one period goes from 0 to ``span``.
    gain : float or ndarray, shape (n,)
        What the input is multiplied by.
    """
    rows["input"]["amplitude"], rows["input"]["omega"] = length, omega
    part = rows["series"]
    part["rows"], part["address"] = len(sampled.coefficients), sampled.coefficients.ctypes.data
    part["begin"], part["step"], part["span"] = sampled.begin, sampled.step, span
    part["gain"], part["fastest"] = np.asarray(gain) / length, sampled.fastest


def is_sampled(rows: np.ndarray) -> np.ndarray:
    """Whether the input of full records, shape (n,), is known by samples."""
    return rows["series"]["rows"] > 0


def _number_at(typing_context: Any, address: Any, place: Any) -> Any:
    """The float at a place of the array of floats that begins at an address."""

    def code(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        number = context.get_value_type(types.float64)
        start = builder.inttoptr(arguments[0], number.as_pointer())
        return builder.load(builder.gep(start, [arguments[1]]))

    return types.float64(types.int64, types.int64), code


number_at = cast(Any, intrinsic(_number_at))


@inlined
def _located(t, p):
    """Place of the coefficients for a time, its share of the interval, and by how many it is beyond."""
    place = (t - p.series.begin) / p.series.step
    row = min(max(int(place), 0), p.series.rows - 1)
    share = min(max(place - row, 0.0), 1.0)
    return (DEGREE + 1) * row, share, place - row - share


@inlined
def value(t, p):
    """The input over its amplitude; beyond the samples it goes on at a constant rate."""
    first, s, beyond = _located(t, p)
    a = p.series.address
    found = number_at(a, first + 5)
    for k in range(4, -1, -1):
        found = found * s + number_at(a, first + k)
    return p.series.gain * found + beyond * p.series.step * slope(t, p)


@inlined
def slope(t, p):
    """Rate of ``value`` (1/s)."""
    first, s, _ = _located(t, p)
    a = p.series.address
    found = 5.0 * number_at(a, first + 5)
    for k in range(4, 0, -1):
        found = found * s + k * number_at(a, first + k)
    return p.series.gain * found / p.series.step


@inlined
def bend(t, p):
    """Rate of ``slope`` (1/s^2)."""
    first, s, beyond = _located(t, p)
    if beyond != 0.0:
        return 0.0
    a = p.series.address
    found = 20.0 * number_at(a, first + 5)
    for k in range(4, 1, -1):
        found = found * s + k * (k - 1) * number_at(a, first + k)
    return p.series.gain * found / (p.series.step * p.series.step)


@inlined
def _hull(a2, a3, a4, a5, share, width):
    """Least and largest Bernstein coefficient of a polynomial's second derivative, on a part of it."""
    value = 2.0 * a2 + share * (6.0 * a3 + share * (12.0 * a4 + share * 20.0 * a5))
    first = width * (6.0 * a3 + share * (24.0 * a4 + share * 60.0 * a5))
    second = width * width * (12.0 * a4 + 60.0 * a5 * share)
    third = width * width * width * 20.0 * a5
    b1, b2 = value + first / 3.0, value + (2.0 * first + second) / 3.0
    b3 = value + first + second + third
    return min(min(value, b1), min(b2, b3)), max(max(value, b1), max(b2, b3))


@inner
def bend_leaves(t, stop, low, high, p):
    """First time from t on at which ``bend`` is below ``low`` (side -1) or above ``high`` (1), and that side.

    It is ``stop`` and 0 if that does not happen before. A cubic lies between its least and largest Bernstein
    coefficient: a part of an interval where these are within the range is passed at once, others are halved.
    """
    own = p.series
    outside = -1 if low > 0.0 else 1 if high < 0.0 else 0
    if t < own.begin:
        if outside != 0:
            return t, outside
        t = min(own.begin, stop)
    scale, end = own.gain / (own.step * own.step), (stop - own.begin) / own.step
    place = (t - own.begin) / own.step
    row = int(place)
    share = place - row
    while row < own.rows and row + share < end:
        first, last = (DEGREE + 1) * row, min(end - row, 1.0)
        a2, a3 = scale * number_at(own.address, first + 2), scale * number_at(own.address, first + 3)
        a4, a5 = scale * number_at(own.address, first + 4), scale * number_at(own.address, first + 5)
        width = last - share
        while share < last:
            least, largest = _hull(a2, a3, a4, a5, share, width)
            if low <= least and largest <= high:
                share += width
                width = min(2.0 * width, last - share)
            elif width < PLACE_ERROR:
                return min(own.begin + (row + share) * own.step, stop), -1 if least < low else 1
            else:
                width *= 0.5
        row, share = row + 1, 0.0
    if outside != 0 and row + share < end:
        return own.begin + row * own.step, outside
    return stop, 0
