"""Effects at typical strength, and the dense equations that they obey, for several physics tests."""

from math import cos, exp, hypot, log, sin

import numpy as np
from scipy.interpolate import BSpline, make_interp_spline

from tests.physics.compiled_mechanics import owned
from wedgesweep.effects import EFFECTS, empirical_force, of_system
from wedgesweep.effects.base import SUSPENSION

# Where in the range that a fit searches a quantity is taken; not its middle, which may be neutral.
PLACE = 0.6
# Out of the input's rhythm: its response does not repeat.
NOT_PERIODIC = "stray_vibration"
OF_SUSPENSION = of_system(SUSPENSION)
REPEATING = [name for name in OF_SUSPENSION if name != NOT_PERIODIC]
# Has contacts of its own: see test_unilateral.py.
OPENS = "lift_off"
EXTENDING = [name for name in OF_SUSPENSION if EFFECTS[name].extends and name != OPENS]


def typical(name, place=PLACE):
    """SI numbers of an effect at typical strength."""
    if name == empirical_force.NAME:
        return tabulated(1e-3, 0.05, place)
    found = {}
    for quantity in EFFECTS[name].quantities:
        value = quantity.default
        if quantity.search is not None:
            low, high = quantity.search
            value = low * (high / low) ** place if quantity.logarithmic else low + place * (high - low)
        found[quantity.name] = value * quantity.factor
    return found


def tabulated(displacement, velocity, place=PLACE):
    """SI numbers of an empirical force: a damper that grows with travel, and a spring that stiffens.

    The centre is a node away from rest, where the force is 0.
    """
    centre = 1.0 / 3.0
    z, v = np.meshgrid(*empirical_force.nodes(1.0, 1.0, centre), indexing="ij")
    forces = -0.5 * place * (v * (1.0 + z**2) + z**3)
    return {
        "displacement": displacement,
        "velocity": velocity,
        "centre": centre * displacement,
        empirical_force.COEFFICIENTS: empirical_force.coefficients(forces),
    }


def mild(name):
    """``typical`` where that would drive the paper's suspension far out of its range."""
    changes = {
        "preload": {"force": 1.0},
        "cubic_stiffness": {"coefficient": 1e9},
        "viscous_damping": {"coefficient": 5.0},
        "directional_damping": {"coefficient": 5.0},
        "quadratic_drag": {"coefficient": 100.0},
        "backlash": {"clearance": 2e-5},
        "guide_friction": {"force": 0.3},
        "end_stop": {"clearance": 2e-4},
        "friction_level": {"scale": 0.9},
        "damping_level": {"scale": 0.9},
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
    law, stribeck, ageing = p["friction"], p["stribeck"], p["ageing"]
    threshold = law["v_t"]
    speed = hypot(velocity, across)
    static = law["mu_s"] + stribeck["peak"]
    if at_rest is not None:
        static += ageing["rate"] * log(1.0 + at_rest / ageing["time"])
    if not law["set_valued"] and speed <= threshold:
        return static * velocity / threshold
    mu = law["mu_d"]
    if law["law"] == 2:
        mu *= (speed / threshold) ** law["exponent"]
    if stribeck["velocity"] > 0.0:
        beyond = speed - (0.0 if law["set_valued"] else threshold)
        mu += (law["mu_s"] - law["mu_d"] + stribeck["peak"]) * exp(-beyond / stribeck["velocity"])
    return mu * velocity / speed if speed else 0.0


def _tabulated(table, x, velocity):
    """The force of a table by scipy's splines; a suspension's counts displacement from rest."""
    if table["velocity"] == 0.0:
        return 0.0
    counts = empirical_force.PLACES, empirical_force.SPEEDS
    force = table[empirical_force.COEFFICIENTS].reshape(counts)
    at = (x - table["centre"]) / table["displacement"], velocity / table["velocity"]
    for value, nodes in zip(at, empirical_force.nodes(1.0, 1.0), strict=True):
        knots = make_interp_spline(nodes, nodes).t
        force = BSpline(knots, force, 3)(np.clip(value, -1.0, 1.0))
    return force


def base_acceleration(t, p):
    w = p["input"]["omega"]
    wave = sin(w * t)
    wave += 4 * p["input_distortion"]["second"] * sin(2 * w * t + p["input_distortion"]["second_phase"])
    wave += 9 * p["input_distortion"]["third"] * sin(3 * w * t + p["input_distortion"]["third_phase"])
    stray = p["stray_vibration"]["acceleration"] * sin(
        2 * np.pi * p["stray_vibration"]["frequency"] * t + p["stray_vibration"]["phase"]
    )
    return stray - p["input_gain"]["scale"] * p["input"]["amplitude"] * w**2 * wave


def residual(t, y, mode, p, result):
    """Left minus right of Newton's equations as vectors: wedge (2), bolster, column, side frame."""
    s, own = p["suspension"], owned(y, p)
    a, g = s["wedge_angle"], s["column_angle"]
    along_column, into_column = np.array([-sin(g), cos(g)]), np.array([cos(g), sin(g)])
    along_bolster, into_wedge = np.array([sin(a), cos(a)]), np.array([cos(a), -sin(a)])
    outward, up = np.array([1.0, 0.0]), np.array([0.0, 1.0])

    def wedge(bolster, column):
        """Wedge that keeps both contacts closed: (w - Q e_x).n_c = 0, (w - z e_z).p_b = 0."""
        return np.linalg.solve([into_column, into_wedge], [column * cos(g), -bolster * sin(a)])

    (x, velocity), (bristle,), (age,) = own[""], own["presliding"], own["ageing"]
    (way, way_rate), (frame_way, frame_rate) = own["column_compliance"], own["fixture_resonance"]
    z, way = p["geometry"]["rest"] + x, p["column_compliance"]["rest"] + way
    rate = wedge(velocity, way_rate)
    column_slip = (rate - way_rate * outward) @ along_column
    bolster_slip = (rate - velocity * up) @ along_bolster
    if abs(bolster_slip) <= 1e-14 * abs(velocity):  # rounding: without lean this face does not slip
        bolster_slip = 0.0
    across = p["cross_slip"]["velocity"] * cos(p["input"]["omega"] * t + p["cross_slip"]["phase"])
    at_rest = age if mode.clock else None
    column_mu = coefficient(column_slip, across, at_rest, p)
    if p["presliding"]["length"] > 0.0:
        column_mu = p["friction"]["mu_d"] * bristle
    bolster_mu = coefficient(bolster_slip, across, at_rest, p)
    direction = 1.0 + p["directional_friction"]["asymmetry"] * np.sign(velocity)
    exponent, reference = p["load_dependent_friction"]["exponent"], p["load_dependent_friction"]["reference"]

    def friction(mu, load):
        return mu * direction * abs(load) * (abs(load) / reference) ** -exponent

    base = base_acceleration(t, p)
    frame = base + result.frame_acceleration
    moved = wedge(result.acceleration, result.column_acceleration)
    pocket = p["geometry"]["spring_on_bolster"]  # constant damping: shorter by the bolster's rise
    spring = s["wedge_preload"] - s["wedge_spring"] * (wedge(z, way) @ up - pocket * z)
    on_column = result.column * into_column + friction(column_mu, result.column) * along_column
    on_bolster = result.bolster * into_wedge - friction(bolster_mu, result.bolster) * along_bolster
    weight = s["wedge_mass"] * s["gravity"]
    wedges = s["wedge_mass"] * (frame * up + moved) - (spring - weight) * up + on_column - on_bolster
    guide = np.clip(velocity / p["friction"]["v_t"], -1.0, 1.0)
    if p["friction"]["set_valued"]:
        guide = np.sign(velocity)
    beyond = x - np.clip(x, -p["end_stop"]["clearance"], p["end_stop"]["clearance"])
    bolster = (
        s["bolster_mass"] * (frame + result.acceleration + s["gravity"])
        + s["bolster_spring"] * z
        + p["cubic_stiffness"]["coefficient"] * z**3
        + p["viscous_damping"]["coefficient"] * velocity
        + p["directional_damping"]["coefficient"]
        * (1.0 + p["directional_damping"]["asymmetry"] * np.sign(velocity))
        * velocity
        + p["quadratic_drag"]["coefficient"] * abs(velocity) * velocity
        + p["end_stop"]["stiffness"] * beyond
        - _tabulated(p["empirical_force"], x, velocity)
        - s["bolster_spring"] * np.clip(x, -p["backlash"]["clearance"], p["backlash"]["clearance"])
        + p["guide_friction"]["force"] * guide
        + 2 * on_bolster @ up
        + 2 * pocket * spring
    )
    column = 0.0
    if p["column_compliance"]["stiffness"] > 0.0:
        mass, stiffness = p["column_compliance"]["mass"], p["column_compliance"]["stiffness"]
        damping = 2 * p["column_compliance"]["damping_ratio"] * (stiffness * mass) ** 0.5
        column = mass * result.column_acceleration - on_column @ outward
        column += stiffness * way + damping * way_rate
    carried = 0.0
    if p["fixture_resonance"]["frequency"] > 0.0:
        natural = 2 * np.pi * p["fixture_resonance"]["frequency"]
        damping = 2 * p["fixture_resonance"]["damping_ratio"] * natural
        carried = s["side_frame_mass"] * (frame + natural**2 * frame_way + damping * frame_rate)
        carried += s["bolster_mass"] * (frame + result.acceleration)
        carried += 2 * s["wedge_mass"] * (frame + moved @ up)
    return np.array([*wedges, bolster, column, carried])
