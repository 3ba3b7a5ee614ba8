"""Symbols that equations of several modules share: what they mean and their SI unit, by system."""

import re
from typing import NamedTuple

# Numbers that need no explanation.
CONSTANTS = ("pi",)


class Meaning(NamedTuple):
    """What a symbol stands for; ``unit`` is empty for what has none, as a vector or a share."""

    text: str
    unit: str = ""


FRICTION = {
    "mu": Meaning("coefficient of friction of a face, with the sign of its slip"),
    "mu_s": Meaning("static coefficient of friction"),
    "mu_d": Meaning("dynamic coefficient of friction"),
    "v": Meaning("slip velocity of a face", "m/s"),
    "v_t": Meaning("threshold velocity", "m/s"),
    "N": Meaning("normal force on a face", "N"),
    "t": Meaning("time", "s"),
    "omega": Meaning("angular frequency of the input", "rad/s"),
}
SUSPENSION = {
    **FRICTION,
    "z": Meaning("displacement of the bolster against the side frame, up; z′ is its rate", "m"),
    "z_r": Meaning("z, counted from rest", "m"),
    "u": Meaning("displacement of the side frame", "m"),
    "a": Meaning("amplitude of the input", "m"),
    "R": Meaning("force added on the bolster, up", "N"),
    "g": Meaning("gravity", "m/s²"),
    "r": Meaning("slip of the column face per displacement of the bolster"),
    "M_b": Meaning("mass of the bolster", "kg"),
    "M_w": Meaning("mass of a wedge", "kg"),
    "M_sf": Meaning("mass of the side frame", "kg"),
    "k_b": Meaning("stiffness under the bolster", "N/m"),
    "k_w": Meaning("stiffness under a wedge", "N/m"),
    "F_w0": Meaning("force of a wedge's spring at z = 0", "N"),
    "F_b": Meaning("force of the bolster's springs and of what is added to them", "N"),
    "F_w": Meaning("force of a wedge's spring", "N"),
    "s_b": Meaning("1 where the springs of the wedges stand on the bolster (constant damping), else 0"),
    "gamma": Meaning("angle of the column", "rad"),
    "mu_c": Meaning("coefficient of friction of the column face, with the sign of its slip"),
    "mu_b": Meaning("coefficient of friction of the bolster face, with the sign of its slip"),
    "v_c": Meaning("slip velocity of the column face", "m/s"),
    "N_c": Meaning("normal force on the column face", "N"),
    "N_b": Meaning("normal force on the bolster face", "N"),
    "n_c": Meaning("unit vector into the column"),
    "t_c": Meaning("unit vector along the column face, up"),
    "p_b": Meaning("unit vector from the bolster into the wedge"),
    "t_b": Meaning("unit vector along the bolster face, up"),
    "e_x": Meaning("unit vector outward"),
    "e_z": Meaning("unit vector upward"),
    "t_stuck": Meaning("time since the column face last slipped", "s"),
}
# The oscillator has one face, and a spring of its own.
OSCILLATOR = {
    **FRICTION,
    "z": Meaning("displacement of the mass against its base; z′ is its rate", "m"),
    "z_r": Meaning("z, counted from rest", "m"),
    "x": Meaning("displacement of the mass", "m"),
    "u": Meaning("displacement of the base", "m"),
    "a": Meaning("amplitude of the input", "m"),
    "R": Meaning("force added on the mass", "N"),
    "F": Meaning("force of the input on the mass", "N"),
    "c": Meaning("damping constant", "N s/m"),
    "m": Meaning("mass", "kg"),
    "k": Meaning("stiffness of the spring", "N/m"),
    "mu": Meaning("coefficient of friction, with the sign of the slip"),
    "v": Meaning("slip velocity", "m/s"),
    "N": Meaning("normal force on the rubbing surface", "N"),
    "t_stuck": Meaning("time since the surface last slipped", "s"),
}
SYSTEMS = {"suspension": SUSPENSION, "oscillator": OSCILLATOR}
# What effects call otherwise than a system does. v_z: the velocity that has the sign of all slip.
NAMED = {
    "suspension": {"v_z": "z'"},
    "oscillator": {"M_b": "m", "k_b": "k", "mu_c": "mu", "v_c": "v", "v_z": "v"},
}


def as_named(text: str, system: str) -> str:
    """An equation of an effect in the symbols of a system."""
    for name, own in NAMED[system].items():
        text = re.sub(rf"\b{name}\b", own, text)
    return text
