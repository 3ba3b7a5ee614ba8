"""Friction of variable and constant damping, over the load and over displacement: docs/damping-kinds.png.

    .venv/bin/python scripts/damping_kinds.py

The bolster moves steadily down and up against the side frame. Half the difference of the forces that this
takes at a place is the friction force of both wedges there. The bench of Table 1, both faces in full slip.
"""

from math import radians
from pathlib import Path

import numpy as np
from matplotlib import pyplot as plt

from wedgesweep.figures import style
from wedgesweep.solvers import imposed_motion
from wedgesweep.systems.suspension import parameters

PICTURE = Path(__file__).parents[1] / "docs" / "damping-kinds.png"
# Force of each wedge's spring at z = 0 (N); for constant damping about that of variable damping at rest.
KINDS = {"variable": (0.0, style.BLUE), "constant": (2.6, style.VERMILLION)}
# Angle of the column (deg) and its line.
LEANS = {0.0: "-", 4.0: "--"}
# Mass of the bolster (kg): loads, and that of Table 1. Displacement (m), and its rate: both faces slip fast.
MASSES, EMPTY = np.linspace(0.6, 1.6, 21), 0.7
TRAVEL, SPEED = np.linspace(-2e-4, 2e-4, 41), 0.02
GRAVITY = 9.80665  # m/s^2


def friction(kind, lean, mass):
    """Friction force (N) of both wedges along TRAVEL."""
    suspension = {"damping": kind, "wedge_preload": KINDS[kind][0], "column_angle": radians(lean)}
    record = parameters.record("static-dynamic", 1e-3, 1.0, suspension | {"bolster_mass": mass})
    step, rate, nothing = (TRAVEL[1] - TRAVEL[0]) / SPEED, np.full(TRAVEL.size, SPEED), np.zeros(TRAVEL.size)
    up = imposed_motion.forces(record, TRAVEL, rate, nothing, step)[0]
    return 0.5 * (up - imposed_motion.forces(record, TRAVEL[::-1], -rate, nothing, step)[0][::-1])


def main() -> None:
    """Draw the figure."""
    figure, (left, right) = plt.subplots(1, 2, figsize=(7.0, 2.8), layout="constrained", sharey=True)
    for kind, (_, colour) in KINDS.items():
        for lean, line in LEANS.items():
            label = f"{kind}, column at {lean:g}°"
            at_rest = [friction(kind, lean, mass)[TRAVEL.size // 2] for mass in MASSES]
            left.plot(GRAVITY * MASSES, at_rest, line, color=colour, label=label)
            right.plot(1e3 * TRAVEL, friction(kind, lean, EMPTY), line, color=colour)
    left.set_xlabel("weight of the bolster, at rest [N]", fontsize=9)
    left.set_ylabel("friction force [N]", fontsize=9)
    right.set_xlabel("displacement of the bolster, up [mm]", fontsize=9)
    right.set_xticks(np.linspace(-0.2, 0.2, 5))
    for ax in (left, right):
        style.dress(ax)
        ax.set_ylim(bottom=0.0)
    left.legend(fontsize=8, frameon=False)
    figure.savefig(PICTURE, dpi=150)


if __name__ == "__main__":
    main()
