"""Effects at typical strength, and the dense equations that they obey, for several physics tests."""

from math import cos, exp, hypot, log, sin

import numpy as np

from wedgesweep.effects import EFFECTS

# Where in the range that a fit searches a quantity is taken; not its middle, which may be neutral.
PLACE = 0.6
# Out of the input's rhythm: its response does not repeat.
NOT_PERIODIC = "stray_vibration"
REPEATING = [name for name in EFFECTS if name != NOT_PERIODIC]
EXTENDING = [name for name, effect in EFFECTS.items() if effect.extends]


def typical(name, place=PLACE):
    """SI numbers of an effect at typical strength."""
    found = {}
    for quantity in EFFECTS[name].quantities:
        value = quantity.default
        if quantity.search is not None:
            low, high = quantity.search
            value = low * (high / low) ** place if quantity.logarithmic else low + place * (high - low)
        found[quantity.name] = value * quantity.factor
    return found


def mild(name):
    """``typical`` where that would drive the paper's suspension far out of its range."""
    changes = {
        "preload": {"force": 1.0},
        "cubic_stiffness": {"coefficient": 1e9},
        "viscous_damping": {"coefficient": 5.0},
        "guide_friction": {"force": 0.3},
        "end_stop": {"clearance": 2e-4},
        "friction_level": {"scale": 0.9},
        "input_distortion": {"second": 0.05, "third": 0.05},
        "stray_vibration": {"acceleration": 0.5, "frequency": 37.0},
        "fixture_resonance": {"frequency": 40.0},
        "cross_slip": {"velocity": 5e-3},
        "stribeck": {"peak": 0.05, "velocity": 5e-3},
        "ageing": {"rate": 0.05},
    }
    return typical(name) | changes.get(name, {})


def coefficient(velocity, across, at_rest, p):
    """Signed coefficient of a face by PHYSICS.md and DIAGNOSIS.md; ``at_rest`` (s), None while it slips."""
    threshold = p["threshold_velocity"]
    speed = hypot(velocity, across)
    static = p["static"] + p["stribeck_peak"]
    if at_rest is not None:
        static += p["ageing_rate"] * log(1.0 + at_rest / p["ageing_time"])
    if not p["set_valued"] and speed <= threshold:
        return static * velocity / threshold
    mu = p["dynamic"]
    if p["law"] == 2:
        mu *= (speed / threshold) ** p["velocity_exponent"]
    if p["stribeck_velocity"] > 0.0:
        beyond = speed - (0.0 if p["set_valued"] else threshold)
        mu += (p["static"] - p["dynamic"] + p["stribeck_peak"]) * exp(-beyond / p["stribeck_velocity"])
    return mu * velocity / speed


def base_acceleration(t, p):
    w = p["omega"]
    wave = sin(w * t)
    wave += 4 * p["input_distortion_second"] * sin(2 * w * t + p["input_distortion_second_phase"])
    wave += 9 * p["input_distortion_third"] * sin(3 * w * t + p["input_distortion_third_phase"])
    stray = p["stray_vibration_acceleration"] * sin(
        2 * np.pi * p["stray_vibration_frequency"] * t + p["stray_vibration_phase"]
    )
    return stray - p["amplitude"] * w**2 * wave


def residual(t, y, mode, p, result):
    """Left minus right of Newton's equations as vectors: wedge (2), bolster, column, side frame."""
    a, g = p["wedge_angle"], p["column_angle"]
    along_column, into_column = np.array([-sin(g), cos(g)]), np.array([cos(g), sin(g)])
    along_bolster, into_wedge = np.array([sin(a), cos(a)]), np.array([cos(a), -sin(a)])
    outward, up = np.array([1.0, 0.0]), np.array([0.0, 1.0])

    def wedge(bolster, column):
        """Wedge that keeps both contacts closed: (w - Q e_x).n_c = 0, (w - z e_z).p_b = 0."""
        return np.linalg.solve([into_column, into_wedge], [column * cos(g), -bolster * sin(a)])

    x, velocity, bristle, way, way_rate, frame_way, frame_rate, age = y
    z, way = p["rest"] + x, p["column_rest"] + way
    rate = wedge(velocity, way_rate)
    column_slip = (rate - way_rate * outward) @ along_column
    bolster_slip = (rate - velocity * up) @ along_bolster
    across = p["cross_slip_velocity"] * cos(p["omega"] * t + p["cross_slip_phase"])
    at_rest = age if mode.clock else None
    column_mu = coefficient(column_slip, across, at_rest, p)
    if p["presliding_length"] > 0.0:
        column_mu = p["dynamic"] * bristle
    bolster_mu = coefficient(bolster_slip, across, at_rest, p)
    direction = 1.0 + p["directional_friction_asymmetry"] * np.sign(velocity)
    exponent, reference = p["load_dependent_friction_exponent"], p["load_dependent_friction_reference"]

    def friction(mu, load):
        return mu * direction * abs(load) * (abs(load) / reference) ** -exponent

    base = base_acceleration(t, p)
    frame = base + result.frame_acceleration
    moved = wedge(result.acceleration, result.column_acceleration)
    spring = p["wedge_preload"] - p["wedge_spring"] * (wedge(z, way) @ up)
    on_column = result.column * into_column + friction(column_mu, result.column) * along_column
    on_bolster = result.bolster * into_wedge - friction(bolster_mu, result.bolster) * along_bolster
    weight = p["wedge_mass"] * p["gravity"]
    wedges = p["wedge_mass"] * (frame * up + moved) - (spring - weight) * up + on_column - on_bolster
    guide = np.clip(velocity / p["threshold_velocity"], -1.0, 1.0)
    if p["set_valued"]:
        guide = np.sign(velocity)
    beyond = x - np.clip(x, -p["end_stop_clearance"], p["end_stop_clearance"])
    bolster = (
        p["bolster_mass"] * (frame + result.acceleration + p["gravity"])
        + p["bolster_spring"] * z
        + p["cubic_stiffness_coefficient"] * z**3
        + p["viscous_damping_coefficient"] * velocity
        + p["end_stop_stiffness"] * beyond
        + p["guide_friction_force"] * guide
        + 2 * on_bolster @ up
    )
    column = 0.0
    if p["column_compliance_stiffness"] > 0.0:
        mass, stiffness = p["column_compliance_mass"], p["column_compliance_stiffness"]
        damping = 2 * p["column_compliance_damping_ratio"] * (stiffness * mass) ** 0.5
        column = mass * result.column_acceleration - on_column @ outward
        column += stiffness * way + damping * way_rate
    carried = 0.0
    if p["fixture_resonance_frequency"] > 0.0:
        natural = 2 * np.pi * p["fixture_resonance_frequency"]
        damping = 2 * p["fixture_resonance_damping_ratio"] * natural
        carried = p["side_frame_mass"] * (frame + natural**2 * frame_way + damping * frame_rate)
        carried += p["bolster_mass"] * (frame + result.acceleration)
        carried += 2 * p["wedge_mass"] * (frame + moved @ up)
    return np.array([*wedges, bolster, column, carried])
