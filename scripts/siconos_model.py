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


def springs(preload):
    """Stiffness of the springs, and their forces at zero, on wedge (x, z) and bolster.

    With a ``preload`` (N) the wedge's spring stands on the bolster (constant damping), else on the side
    frame.
    """
    lengthens = np.array([0.0, 1.0, -1.0 if preload else 0.0])
    stiffness = np.diag([0.0, 0.0, BOLSTER_SPRING]) + WEDGE_SPRING * np.outer(lengthens, lengthens)
    return stiffness, preload * lengthens


def equilibrium(stiffness, force):
    """Displacements of wedge and bolster at the frictionless equilibrium, under a force on each."""
    ratio = sin(ALPHA) / sin(ALPHA + GAMMA)
    path = np.array([-ratio * sin(GAMMA), ratio * cos(GAMMA), 1.0])
    return path * (path @ force) / (path @ stiffness @ path)


def run(beta, amplitude, restitution, settle, keep, steps, preload=0.0):
    """Amplitude ratio, and shares of time with column and bolster contact open."""
    omega, masses = beta * OMEGA_N, np.array([WEDGE, WEDGE, BOLSTER])
    stiffness, force = springs(preload)
    up = masses * [0.0, 1.0, 1.0]
    rest = equilibrium(stiffness, force - GRAVITY * up)
    step, count = 2.0 * pi / omega / steps, (settle + keep) * steps
    body = kernel.LagrangianLinearTIDS(
        rest,
        np.zeros(3),
        np.diag(masses),
        stiffness,
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
        body.setFExtPtr((force - down * up).tolist())
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
