"""The test plan of a data set: below and above resonance, without lift-off or permanent sticking.

Where lift-off is what the set hides, the tests are louder; see draft.py.
"""

import numpy as np

from validation import response
from validation.response import System, Test
from validation.rigs import Rig, frequency_ratio
from wedgesweep.effects import lift_off
from wedgesweep.natural_units import Dimension

# Frequencies (Hz, of a rig with the bench's natural frequency) and the number of amplitudes at each.
TWELVE = ((5.0, 2), (8.0, 2), (11.0, 1), (20.0, 2), (24.0, 2), (28.0, 1), (32.0, 2))
PAPER = ((20.0, 1), (30.0, 1))
# Above resonance, where motion alone does not tell more load of the wedges from more friction.
FOUR = ((20.0, 1), (24.0, 1), (28.0, 1), (32.0, 1))
# Every data set of twelve tests shifts the frequencies by up to this share.
SHIFT = 0.05
# Limits of the base model's response: smallest normal force (N, on the bench) and share of time stuck.
LEAST_FORCE, MOST_STUCK = 0.3, 0.7
FORCE = Dimension(mass=1, length=1, time=-2)


def draw(law: str, rig: Rig, grid: tuple, random: np.random.Generator) -> list[Test] | None:
    """Draw tests at the frequencies of ``grid``; None if no amplitude is suitable at one of them."""
    system, tests = System(law, rig), []
    ratio, least = frequency_ratio(rig), LEAST_FORCE * rig.units.ratio(FORCE)
    shift = 0.0 if grid is PAPER else SHIFT
    for nominal, count in grid:
        frequency = round(ratio * nominal * (1.0 + random.uniform(-shift, shift)), 3)
        amplitudes = rig.amplitudes(frequency)
        force, stuck = _force_and_sticking(system, [Test(frequency, a) for a in amplitudes.tolist()])
        suitable = amplitudes[(force > least) & (stuck < MOST_STUCK)]
        if suitable.size < 2:
            return None
        low, high = suitable[0], suitable[-1]
        for share in (0.1, 0.85) if count == 2 else (0.45,):
            position = share + random.uniform(-0.1, 0.1)
            tests.append(Test(frequency, float(f"{low * (high / low) ** position:.4g}")))
    return tests


def suits(system: System, tests: list[Test]) -> bool:
    """Whether a system moves in every test, and keeps its wedges pressed unless its joints open."""
    force, stuck = _force_and_sticking(system, tests)
    valid = (force > 0.0) | (lift_off.NAME in system.effects)
    return bool((valid & (stuck < 0.95)).all())


def slips(system: System, tests: list[Test]) -> bool:
    """Whether a system never sticks in any test."""
    return bool((_force_and_sticking(system, tests)[1] == 0.0).all())


def _force_and_sticking(system: System, tests: list[Test]) -> tuple[np.ndarray, np.ndarray]:
    """Smallest normal force (N; inf where it is constant) and share of time stuck, shape (tests,) each."""
    ds = response.run(system, tests)
    constant = np.full(len(tests), np.inf)
    force = constant if system.rig.is_oscillator else ds["minimum_normal_force"].values
    return force, ds["stick_fraction"].values
