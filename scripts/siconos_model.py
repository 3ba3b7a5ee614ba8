"""The suspension with unilateral joints in siconos: Moreau-Jean time stepping of free bodies in the plane.

A second formulation of the same model, in coordinates of its own: the wedge moves freely against the side
frame, the bolster up and down; both contacts are relations with friction and Newton's restitution. It runs
under the system's python3 (Debian: apt-get install python3-siconos), which knows nothing of wedgesweep: cases
come as JSON from standard input, results go to the file that the first argument names.
"""

import json
import sys
from math import cos, pi, radians, sin, sqrt
from pathlib import Path
from time import process_time

import numpy as np
import siconos.kernel as kernel
import siconos.numerics as numerics

# Table 1 of the paper, SI; one wedge, and half of the bolster.
BOLSTER, WEDGE, BOLSTER_SPRING, WEDGE_SPRING, GRAVITY, MU = 0.35, 0.17, 2550.0, 2550.0, 9.80665, 0.29
ALPHA, GAMMA = radians(37.5), radians(4.0)
OMEGA_N = sqrt(BOLSTER_SPRING / BOLSTER)
# Integration by the implicit midpoint rule between impacts.
THETA = 0.5


def relations():
    """Rows of gap rate and slip of both contacts, by the velocities of wedge (x, z) and bolster."""
    along, into = (-sin(GAMMA), cos(GAMMA)), (cos(GAMMA), sin(GAMMA))
    face, normal = (sin(ALPHA), cos(ALPHA)), (cos(ALPHA), -sin(ALPHA))
    column = np.array([[-into[0], -into[1], 0.0], [*along, 0.0]])
    bolster = np.array([[*normal, -normal[1]], [*face, -face[1]]])
    return column, bolster


def equilibrium():
    """Displacements of wedge and bolster at the frictionless equilibrium."""
    ratio = sin(ALPHA) / sin(ALPHA + GAMMA)
    rise = ratio * cos(GAMMA)
    z = -GRAVITY * (BOLSTER + WEDGE * rise) / (BOLSTER_SPRING + WEDGE_SPRING * rise**2)
    return np.array([-ratio * z * sin(GAMMA), rise * z, z])


def run(beta, amplitude, restitution, settle, keep, steps):
    """Amplitude ratio, and shares of time with column and bolster contact open."""
    omega, rest = beta * OMEGA_N, equilibrium()
    step, count = 2.0 * pi / omega / steps, (settle + keep) * steps
    body = kernel.LagrangianLinearTIDS(
        rest,
        np.zeros(3),
        np.diag([WEDGE, WEDGE, BOLSTER]),
        np.diag([0.0, WEDGE_SPRING, BOLSTER_SPRING]),
        np.zeros((3, 3)),
    )
    law = kernel.NewtonImpactFrictionNSL(restitution, restitution, MU, 2)
    contacts = [kernel.Interaction(law, kernel.LagrangianLinearTIR(rows)) for rows in relations()]
    model = kernel.NonSmoothDynamicalSystem(0.0, count * step)
    model.insertDynamicalSystem(body)
    for contact in contacts:
        model.link(contact, body)
    problem = kernel.FrictionContact(2, numerics.SICONOS_FRICTION_2D_LEMKE)
    discretisation = kernel.TimeDiscretisation(0.0, step)
    stepping = kernel.TimeStepping(model, discretisation, kernel.MoreauJeanOSI(THETA), problem)
    kept = np.empty((keep * steps, 3))
    for i in range(count):
        down = GRAVITY - amplitude * omega**2 * sin(omega * (i + THETA) * step)
        body.setFExtPtr([0.0, -WEDGE * down, -BOLSTER * down])
        stepping.computeOneStep()
        if i >= count - len(kept):
            impulses = [contact.lambda_(1)[0] for contact in contacts]
            kept[i - count + len(kept)] = body.q()[2], *impulses
        stepping.nextStep()
    return 0.5 * np.ptp(kept[:, 0]) / amplitude, *(kept[:, 1:] <= 0.0).mean(axis=0).tolist()


if __name__ == "__main__":
    cases = json.load(sys.stdin)
    began = process_time()
    results = [run(**case) for case in cases]
    Path(sys.argv[1]).write_text(json.dumps({"results": results, "seconds": process_time() - began}))
