"""Numbers from the kept window of one run, with the paper's sign: displacement x - y = -z."""

from dataclasses import dataclass
from math import nan

import numpy as np

from wedgesweep import excitation, friction
from wedgesweep.compiled import compiled
from wedgesweep.contact import stuck
from wedgesweep.damper import Contact, forces
from wedgesweep.effects import guide_friction
from wedgesweep.solvers.trajectory import Points, Trajectory, Window

# A fundamental below this share of the input amplitude has no meaningful phase.
NO_MOTION = 1e-9


@compiled
def friction_power(velocity, now, contact, p):
    """Power (W) that friction takes from the suspension on all faces."""
    column_slip, bolster_slip = p.column_ratio * velocity, p.bolster_ratio * velocity
    column = friction.coefficient(column_slip, contact.column, p) * abs(now.column) * column_slip
    bolster = friction.coefficient(bolster_slip, contact.bolster, p) * abs(now.bolster) * bolster_slip
    return 2.0 * (column + bolster) - guide_friction.force(velocity, contact.guide, p) * velocity


@compiled
def along(t, x, velocity, contacts, parameters):
    """Normal forces on column and bolster (N; NaN while stuck) and friction power (W), shape (3, n)."""
    p = parameters[0]
    out = np.empty((3, t.size))
    for i in range(t.size):
        row = contacts[i]
        contact = Contact(int(row[0]), int(row[1]), int(row[2]), int(row[3]), int(row[4]))
        now = forces(x[i], velocity[i], excitation.acceleration(t[i], p), contact, p)
        out[0, i], out[1, i] = now.column, now.bolster
        out[2, i] = friction_power(velocity[i], now, contact, p)
        if stuck(contact, p):
            out[0, i] = out[1, i] = nan
            out[2, i] = 0.0
    return out


@dataclass(frozen=True)
class Response:
    """Variables of dataset.VARIABLES that follow from one trajectory, by name (SI units)."""

    numbers: dict[str, float]
    spectra: dict[str, np.ndarray]
    waveforms: dict[str, np.ndarray]


def evaluate(
    trajectory: Trajectory, window: Window, parameters: np.ndarray, harmonics: int
) -> Response:
    """Reduce a trajectory to its numbers, spectra (shape (harmonics,), complex) and waveforms."""
    amplitude = float(parameters["amplitude"][0])
    nodes, samples = trajectory.nodes, trajectory.samples
    displacement, velocity = -samples.x, -samples.velocity
    column, bolster, _ = _along(samples, parameters)
    spectra = {
        "displacement_harmonics": _spectrum(displacement, window, harmonics),
        "velocity_harmonics": _spectrum(velocity, window, harmonics),
    }
    numbers = {
        **_motion(nodes, amplitude),
        **_sticking(nodes, window),
        **_contact_forces(nodes, parameters, window),
        "phase_lag": _phase_lag(spectra["displacement_harmonics"][0], amplitude),
        "periodicity": _change(displacement, window) / amplitude,
    }
    waveforms = {
        "displacement": displacement,
        "velocity": velocity,
        "normal_force_column": column,
        "normal_force_bolster": bolster,
        "stuck": samples.contact[:, 0] == 0,
    }
    return Response(numbers, spectra, waveforms)


def _along(points: Points, parameters: np.ndarray) -> np.ndarray:
    return along(points.t, points.x, points.velocity, points.contact, parameters)


def _motion(nodes: Points, amplitude: float) -> dict[str, float]:
    peak_to_peak = float(np.ptp(nodes.x))
    return {
        "amplitude_ratio": 0.5 * peak_to_peak / amplitude,
        "peak_to_peak": peak_to_peak,
        "peak_velocity": float(np.abs(nodes.velocity).max()),
        "mean_displacement": -float(np.average(nodes.x, weights=nodes.weight)),
    }


def _sticking(nodes: Points, window: Window) -> dict[str, float]:
    lasting = nodes.weight > 0.0
    is_stuck, weight = nodes.contact[lasting, 0] == 0, nodes.weight[lasting]
    onsets = np.count_nonzero(is_stuck & ~np.roll(is_stuck, 1))
    return {
        "stick_fraction": float(weight[is_stuck].sum() / weight.sum()),
        "stick_phases": onsets / window.periods,
    }


def _contact_forces(nodes: Points, parameters: np.ndarray, window: Window) -> dict[str, float]:
    column, bolster, power = _along(nodes, parameters)
    numbers = {
        "dissipated_energy": float(power @ nodes.weight / window.periods),
        "minimum_normal_force": nan,
        "lift_off_fraction": nan,
    }
    slips = ~np.isnan(column)
    if slips.any():
        lifted = slips & (nodes.contact[:, 3:].min(axis=1) < 0)
        share = nodes.weight[lifted].sum() / nodes.weight[slips].sum()
        numbers["minimum_normal_force"] = float(np.minimum(column, bolster)[slips].min())
        numbers["lift_off_fraction"] = float(share)
    return numbers


def _spectrum(signal: np.ndarray, window: Window, harmonics: int) -> np.ndarray:
    """Coefficients D_h of signal = Re sum D_h exp(i h omega t), h = 1..harmonics."""
    return 2.0 * np.fft.rfft(signal)[window.periods :: window.periods][:harmonics] / signal.size


def _phase_lag(fundamental: complex, amplitude: float) -> float:
    """Lag (rad, -pi to pi) behind u = a sin(omega t) = Re -i a exp(i omega t)."""
    if abs(fundamental) < NO_MOTION * amplitude:
        return nan
    return float(np.angle(-1j * amplitude / fundamental))


def _change(signal: np.ndarray, window: Window) -> float:
    """Largest difference between the last period and the one before it."""
    periods = signal.reshape(window.periods, window.samples_per_period)
    return float(np.abs(periods[-1] - periods[-2]).max())
