"""Springs with sliders along a motion: in parallel they take the shape of any friction that builds up.

Sources: Prandtl (1928), Iwan (1966).
"""

import numpy as np

# Elongations at which they slip, over half the range of the motion: half as many leave 1 to 5 % of the force
# of an elastic friction damper in an earthquake.
ELONGATIONS = np.geomspace(0.003, 0.6, 24)


def forces(displacement: np.ndarray, half_range: float) -> np.ndarray:
    """Forces (k, n) over those at which they slip; none at the start."""
    force = np.diff(displacement, prepend=displacement[0])[:, None] / (half_range * ELONGATIONS)
    before = np.zeros(ELONGATIONS.size)
    for now in force:
        now += before
        before = np.minimum(np.maximum(now, -1.0, out=now), 1.0, out=now)
    return force.T


def known(displacement: np.ndarray, half_range: float) -> np.ndarray:
    """Samples (n,) from where on no force depends any more on what it was at the start."""
    travelled = np.maximum.accumulate(displacement) - np.minimum.accumulate(displacement)
    return np.asarray(travelled > 2.0 * half_range * ELONGATIONS[-1])
