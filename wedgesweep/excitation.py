"""Motion of the side frame (the paper's Eq. 4): u = a sin(omega t), and with the effects on it."""

from math import cos, pi, sin

from wedgesweep.compiled import compiled, inlined


@compiled
def displacement(t, p):
    """U in m."""
    return p.amplitude * sin(p.omega * t)


@inlined
def acceleration(t, p):
    """U'' in m/s^2."""
    return -p.amplitude * p.omega**2 * sin(p.omega * t)


@compiled
def jerk(t, p):
    """U''' in m/s^3."""
    return -p.amplitude * p.omega**3 * cos(p.omega * t)


@compiled
def table_acceleration(t, p):
    """U'' in m/s^2 with ``input_distortion`` and ``stray_vibration``: of the side frame, or of its table."""
    phase = p.omega * t
    wave = sin(phase)
    if p.input_distortion_second != 0.0:
        wave += 4.0 * p.input_distortion_second * sin(2.0 * phase + p.input_distortion_second_phase)
    if p.input_distortion_third != 0.0:
        wave += 9.0 * p.input_distortion_third * sin(3.0 * phase + p.input_distortion_third_phase)
    stray = 0.0
    if p.stray_vibration_acceleration != 0.0:
        turn = 2.0 * pi * p.stray_vibration_frequency * t + p.stray_vibration_phase
        stray = p.stray_vibration_acceleration * sin(turn)
    return stray - p.amplitude * p.omega**2 * wave


@compiled
def fastest(p):
    """Highest angular frequency (rad/s) in the motion of the side frame."""
    fast = p.omega
    if p.input_distortion_second != 0.0:
        fast = 2.0 * p.omega
    if p.input_distortion_third != 0.0:
        fast = 3.0 * p.omega
    if p.stray_vibration_acceleration != 0.0:
        fast = max(fast, 2.0 * pi * p.stray_vibration_frequency)
    return fast
