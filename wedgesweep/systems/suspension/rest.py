"""Base accelerations under which a wedge suspension can rest: Coulomb's law leaves a band, not a number.

At rest four contact forces (normal and tangential, on two faces) meet three equations: friction on one face
is independent of friction on the other. With z'' = 0 and |T| <= mu N on both faces,

    (W - M_w u'') cos g = T_c + N_b sin(a+g) + T_b cos(a+g)     wedge, along the column
    (W - M_w u'') sin g = N_c - N_b cos(a+g) + T_b sin(a+g)     wedge, normal to the column
    V - M_b u''         = -2 (N_b sin a + T_b cos a) - G        bolster

where W and V are the forces of springs and weight, and G that of a guide with friction. The admissible u''
are an interval; its ends are vertices of a linear programme. Slip of both faces together is one vertex for
each direction: the least sticking that Coulomb's law allows.
"""

from itertools import combinations

import numpy as np

from wedgesweep.systems.suspension.parameters import spring_at_rest

# Unknown are N_c, T_c, N_b, T_b, friction G of the guide on the bolster, and u''. The limits are those of T
# on two faces and of G, in both directions.
UNKNOWNS = LIMITS = 6
# Share of the largest unknown by which a limit may be missed: rounding of a solution.
ROUNDING = 1e-10


def rest_interval(rows: np.ndarray, mu: np.ndarray | float) -> tuple[np.ndarray, np.ndarray]:
    """Smallest and largest base acceleration u'' (m/s^2) under which the frictionless equilibrium may rest.

    ``rows``: full records, shape (n,); ``mu``: coefficient of friction of both faces. An end is infinite
    where the wedge jams, so that no acceleration of that direction moves it; both are NaN where rest is
    impossible.
    Of the effects only the guide's friction is regarded.
    """
    equations, limits = _equations(rows), _limits(np.broadcast_to(np.asarray(mu, float), rows.shape))
    loads, room = _loads(rows), np.zeros((*rows.shape, LIMITS))
    room[:, 4:] = rows["guide_friction"]["force"][:, np.newaxis]
    vertices = _vertices(equations, loads, limits, room)
    lowest, highest = np.fmin.reduce(vertices), np.fmax.reduce(vertices)
    possible = np.isfinite(lowest)
    lowest[possible & _jams(-1.0, equations, limits)] = -np.inf
    highest[possible & _jams(1.0, equations, limits)] = np.inf
    return lowest, highest


def breakaway_inputs(rows: np.ndarray, mu: np.ndarray | float) -> tuple[np.ndarray, np.ndarray]:
    """Base accelerations u'' (m/s^2) from which both faces can slip up and down; else as ``rest_interval``.

    Without friction both are 0. The normal forces stay positive on the way there.
    """
    up, down = (_verge(direction, rows, np.asarray(mu, float)) for direction in (1.0, -1.0))
    return up, down


def breakaway_accelerations(rows: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Least and most amplitude of u'' (m/s^2) at which set-valued friction mu_d slips from the equilibrium.

    The least is that of the solvers unless forces are locked in; see effects/jamming.py.
    """
    mu = rows["friction"]["mu_d"]
    least, most = (np.abs(ends).min(axis=0) for ends in (breakaway_inputs(rows, mu), rest_interval(rows, mu)))
    return least, most


def _verge(direction: float, rows: np.ndarray, mu: np.ndarray) -> np.ndarray:
    """Base acceleration (m/s^2) at which both faces and the guide are at the limit, as in slip."""
    limits = np.zeros((*rows.shape, 3, UNKNOWNS))
    limits[:, [0, 1, 2], [1, 3, 4]] = 1.0
    limits[:, 0, 0] = -direction * mu
    limits[:, 1, 2] = -direction * np.sign(rows["geometry"]["bolster_ratio"]) * mu
    right = np.zeros((*rows.shape, 3))
    right[:, 2] = -direction * rows["guide_friction"]["force"]
    matrix = np.concatenate([_equations(rows), limits], axis=1)
    return _solutions(matrix, np.concatenate([_loads(rows), right], axis=1))[:, -1]


def _equations(rows: np.ndarray) -> np.ndarray:
    """Contributions of the unknowns to the three equations, shape (n, 3, 6)."""
    s, g = rows["suspension"], rows["geometry"]
    matrix = np.zeros((*rows.shape, 3, UNKNOWNS))
    matrix[:, 0, 1] = matrix[:, 1, 0] = 1.0
    matrix[:, 0, 2], matrix[:, 0, 3] = g["sin_included"], g["cos_included"]
    matrix[:, 1, 2], matrix[:, 1, 3] = -g["cos_included"], g["sin_included"]
    matrix[:, 2, 2], matrix[:, 2, 3] = -2.0 * g["sin_wedge"], -2.0 * g["cos_wedge"]
    matrix[:, 2, 4] = -1.0
    matrix[:, 0, 5], matrix[:, 1, 5] = s["wedge_mass"] * g["cos_column"], s["wedge_mass"] * g["sin_column"]
    matrix[:, 2, 5] = s["bolster_mass"]
    return matrix


def _loads(rows: np.ndarray) -> np.ndarray:
    """Forces of springs and weight (N) in the three equations, shape (n, 3)."""
    s, g = rows["suspension"], rows["geometry"]
    spring = spring_at_rest(rows)
    wedge = spring - s["wedge_mass"] * s["gravity"]
    bolster = -s["bolster_spring"] * g["rest"] - s["bolster_mass"] * s["gravity"]
    bolster -= 2.0 * g["spring_on_bolster"] * spring
    return np.stack([wedge * g["cos_column"], wedge * g["sin_column"], bolster], axis=-1)


def _limits(mu: np.ndarray) -> np.ndarray:
    """Rows mu N - T and mu N + T of both faces, and -G and G of the guide, shape (n, 6, 6)."""
    limits = np.zeros((*mu.shape, LIMITS, UNKNOWNS))
    limits[:, [0, 1], 0] = limits[:, [2, 3], 2] = mu[:, np.newaxis]
    limits[:, [0, 1, 2, 3, 4, 5], [1, 1, 3, 3, 4, 4]] = [-1.0, 1.0, -1.0, 1.0, -1.0, 1.0]
    return limits


def _vertices(equations: np.ndarray, loads: np.ndarray, limits: np.ndarray, room: np.ndarray) -> np.ndarray:
    """Values of u'' where three limits are reached and the others kept, else NaN, shape (vertices, n).

    A limit is kept where its row and ``room``, shape (n, 6), are not negative together.
    """
    ends = []
    for reached in map(list, combinations(range(LIMITS), 3)):
        matrix = np.concatenate([equations, limits[:, reached]], axis=1)
        unknowns = _solutions(matrix, np.concatenate([loads, -room[:, reached]], axis=1))
        ends.append(np.where(_within(unknowns, limits, room), unknowns[:, -1], np.nan))
    return np.array(ends)


def _jams(direction: float, equations: np.ndarray, limits: np.ndarray) -> np.ndarray:
    """Whether contact forces without any load carry a base acceleration of a direction, shape (n,).

    They are a ray of the linear programme, on which one limit is reached and the guide does nothing.
    """
    unit = np.zeros((len(equations), 2, UNKNOWNS))
    unit[:, 0, 4] = unit[:, 1, 5] = 1.0
    right = np.tile([0.0, 0.0, 0.0, 0.0, direction, 0.0], (len(equations), 1))
    jams = np.zeros(len(equations), bool)
    for i in range(4):
        matrix = np.concatenate([equations, unit, limits[:, i : i + 1]], axis=1)
        jams |= _within(_solutions(matrix, right), limits, 0.0)
    return jams


def _solutions(matrix: np.ndarray, right: np.ndarray) -> np.ndarray:
    """Solutions of square systems, NaN where one is singular."""
    scale = np.abs(matrix).max(axis=-1, keepdims=True)
    scale[scale == 0.0] = 1.0
    singular = np.abs(np.linalg.det(matrix / scale)) < ROUNDING
    matrix = np.where(singular[:, np.newaxis, np.newaxis], np.eye(matrix.shape[-1]), matrix)
    solution = np.linalg.solve(matrix, right[..., np.newaxis])[..., 0]
    solution[singular] = np.nan
    return solution


def _within(unknowns: np.ndarray, limits: np.ndarray, room: np.ndarray | float) -> np.ndarray:
    """Whether forces, shape (n, 6), keep all limits, to rounding."""
    rounding = ROUNDING * np.abs(unknowns).max(axis=-1, keepdims=True)
    return ((limits @ unknowns[..., np.newaxis])[..., 0] + room >= -rounding).all(axis=-1)
