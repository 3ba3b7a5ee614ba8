"""Contact states: on which smooth piece of the equations the system is, and when it leaves it.

An integrator follows one ``Contact`` while all ``switches`` are positive. When one of them reaches
zero it asks for the ``successor`` and goes on from there; it needs to know nothing else.

A regularised law jumps from mu_s to mu_d at v_t. Where the acceleration points to the jump from both
sides it holds the slip velocity there, as static friction holds a face at rest (Filippov, 1988): the
face is then on a branch of its own, and the acceleration is zero.
"""

from math import inf, nan

from wedgesweep import excitation, friction
from wedgesweep.compiled import compiled, inlined
from wedgesweep.damper import Contact, Forces, forces, loads, reactions

# Places of the switches. For each face: leave the branch toward lower, toward higher slip velocity.
COLUMN, BOLSTER, GUIDE, COLUMN_NORMAL, BOLSTER_NORMAL = 0, 2, 4, 6, 7
SWITCHES = 8

# Branch of a face whose slip velocity a jump at +-v_t holds, with the sign of that velocity.
AT_JUMP = 2

# Normal forces below this share of the loads count as zero when the consistent signs are sought.
ROUNDING = 1e-11
# Phase (rad) after which a normal force that has changed sign is safely away from zero.
LOOK_AHEAD = 1e-8


@inlined
def stuck(contact, p):
    """Whether set-valued friction holds the bolster."""
    return p.set_valued and contact.column == 0


@inlined
def held(contact):
    """Whether the jump of a regularised law holds the slip velocity of a face."""
    return abs(contact.column) == AT_JUMP or abs(contact.bolster) == AT_JUMP or abs(contact.guide) == AT_JUMP


@compiled
def _side(branch, higher):
    """Branch on the lower or the higher side of a jump; any other branch is itself."""
    if abs(branch) != AT_JUMP:
        return branch
    return (0 if branch > 0 else -1) + higher


@compiled
def beside_jump(contact, higher):
    """Contact on the lower (0) or higher (1) side of the jump that holds a face."""
    return Contact(
        _side(contact.column, higher),
        _side(contact.bolster, higher),
        _side(contact.guide, higher),
        1,
        1,
    )


@compiled
def held_between(x, velocity, base_acceleration, contact, p):
    """Contacts and forces on both sides of a jump, and the share of the lower one at which z'' = 0."""
    low, below, low_unique = closed(x, velocity, base_acceleration, beside_jump(contact, 0), p)
    high, above, high_unique = closed(x, velocity, base_acceleration, beside_jump(contact, 1), p)
    apart = above.acceleration - below.acceleration
    share = above.acceleration / apart if apart != 0.0 else 0.5
    return low, below, high, above, share, low_unique and high_unique


@inlined
def acting(x, velocity, base_acceleration, contact, p):
    """Acceleration and normal forces on any contact."""
    if not held(contact):
        return forces(x, velocity, base_acceleration, contact, p)
    _, below, _, above, share, _ = held_between(x, velocity, base_acceleration, contact, p)
    return Forces(
        0.0,
        share * below.column + (1.0 - share) * above.column,
        share * below.bolster + (1.0 - share) * above.bolster,
    )


@compiled
def closed(x, velocity, base_acceleration, contact, p):
    """The contact with the signs of its normal forces, these forces, and whether they are unique.

    Friction acts with |N|, so each combination of signs is its own linear problem; one that returns
    the signs it assumed is a solution. None, or more than one, means that the wedge locks.
    """
    along, into, vertical = loads(x, velocity, base_acceleration, contact.guide, p)
    column_mu = friction.coefficient(p.column_ratio * velocity, contact.column, p)
    bolster_mu = friction.coefficient(p.bolster_ratio * velocity, contact.bolster, p)
    zero = ROUNDING * (abs(along) + abs(into) + abs(vertical))
    found, result, certain = contact, Forces(nan, nan, nan), 0
    possible = False
    for column_sign in (1, -1):
        for bolster_sign in (1, -1):
            trial = Contact(contact.column, contact.bolster, contact.guide, column_sign, bolster_sign)
            now = reactions(along, into, vertical, column_sign * column_mu, bolster_sign * bolster_mu, p)
            smallest = min(column_sign * now.column, bolster_sign * now.bolster)
            if smallest > zero:
                if p.never_locks:
                    return trial, now, True
                certain += 1
            if smallest >= -zero and (smallest > zero or not possible):
                found, result, possible = trial, now, True
    return found, result, possible and certain <= 1


@compiled
def with_consistent_signs(x, velocity, base_acceleration, contact, p):
    """The contact with the signs of its normal forces, and whether they are unique."""
    found, _, unique = closed(x, velocity, base_acceleration, contact, p)
    return found, unique


@compiled
def slipping(direction, p):
    """Contact of a set-valued law with all faces slipping as z' has the given sign."""
    bolster = direction if p.bolster_ratio > 0.0 else -direction
    if p.bolster_ratio == 0.0:
        bolster = 0
    return Contact(direction, bolster, direction, 1, 1)


@compiled
def breakaway(x, base_acceleration, direction, p):
    """Acceleration z'' (m/s^2) if set-valued friction let go in a direction, and whether it is unique."""
    _, now, unique = closed(x, 0.0, base_acceleration, slipping(direction, p), p)
    return now.acceleration, unique


@compiled
def from_rest(x, base_acceleration, p):
    """Contact that follows z' = 0 under a set-valued law, and whether it is unique."""
    forward, now, forward_unique = closed(x, 0.0, base_acceleration, slipping(1, p), p)
    rising = now.acceleration
    backward, now, backward_unique = closed(x, 0.0, base_acceleration, slipping(-1, p), p)
    falling = now.acceleration
    unique = forward_unique and backward_unique and not (rising > 0.0 and falling < 0.0)
    nearly_none = ROUNDING * (p.gravity + abs(base_acceleration))
    if rising <= nearly_none and falling >= -nearly_none:
        return Contact(0, 0, 0, 1, 1), unique
    return (forward if rising > 0.0 else backward), unique


@compiled
def initial(t, x, velocity, p):
    """Contact at the start of a run, and whether it is unique."""
    base_acceleration = excitation.acceleration(t, p)
    if p.set_valued:
        if velocity == 0.0:
            return from_rest(x, base_acceleration, p)
        contact = slipping(1 if velocity > 0.0 else -1, p)
    else:
        contact = Contact(
            friction.branch_at(p.column_ratio * velocity, p),
            friction.branch_at(p.bolster_ratio * velocity, p),
            friction.branch_at(velocity, p),
            1,
            1,
        )
    return with_consistent_signs(x, velocity, base_acceleration, contact, p)


@compiled
def _face(velocity, branch, p, place, out):
    """Write the distances of a regularised face to the lower and the upper end of its branch."""
    if branch >= 0:
        out[place] = velocity - p.threshold_velocity if branch else velocity + p.threshold_velocity
    if branch <= 0:
        out[place + 1] = -p.threshold_velocity - velocity if branch else p.threshold_velocity - velocity


@compiled
def _held_face(contact, p):
    """Place of the switches of the face that a jump holds, and its slip velocity per z'."""
    if abs(contact.column) == AT_JUMP:
        return COLUMN, p.column_ratio
    if abs(contact.bolster) == AT_JUMP:
        return BOLSTER, p.bolster_ratio
    return GUIDE, 1.0


@compiled
def switches(t, x, velocity, contact, p, out):
    """Write the switching functions, shape (SWITCHES,): positive while the contact holds.

    Units are m/s for slip velocities, N for normal forces, m/s^2 for the release of a stuck bolster;
    a switch that the contact does not have is inf.
    """
    base_acceleration = excitation.acceleration(t, p)
    if stuck(contact, p):
        out[:] = inf
        out[COLUMN] = breakaway(x, base_acceleration, -1, p)[0]
        out[COLUMN + 1] = -breakaway(x, base_acceleration, 1, p)[0]
    elif held(contact):
        out[:] = inf
        place, ratio = _held_face(contact, p)
        _, below, _, above, _, _ = held_between(x, velocity, base_acceleration, contact, p)
        out[place], out[place + 1] = ratio * below.acceleration, -ratio * above.acceleration
    else:
        slip_switches(velocity, forces(x, velocity, base_acceleration, contact, p), contact, p, out)


@compiled
def slip_switches(velocity, now, contact, p, out):
    """``switches`` of a bolster that slips, from the forces ``now`` on it."""
    out[:] = inf
    if p.set_valued:
        out[COLUMN if contact.column > 0 else COLUMN + 1] = contact.column * velocity
    else:
        _face(p.column_ratio * velocity, contact.column, p, COLUMN, out)
        _face(p.bolster_ratio * velocity, contact.bolster, p, BOLSTER, out)
        if p.guide_friction_force > 0.0:
            _face(velocity, contact.guide, p, GUIDE, out)
    out[COLUMN_NORMAL] = contact.column_sign * now.column
    out[BOLSTER_NORMAL] = contact.bolster_sign * now.bolster


@compiled
def unique(t, x, velocity, contact, p):
    """Whether the state has exactly one pair of normal forces; if not, the wedge locks."""
    if p.never_locks:
        return True
    base_acceleration = excitation.acceleration(t, p)
    if stuck(contact, p):
        return from_rest(x, base_acceleration, p)[1]
    if held(contact):
        return held_between(x, velocity, base_acceleration, contact, p)[5]
    return with_consistent_signs(x, velocity, base_acceleration, contact, p)[1]


@compiled
def _beyond(contact, switch, to_jump):
    """Contact of a regularised law with the face of a switch on its next branch, or at the jump."""
    column, bolster, guide, column_sign, bolster_sign = contact
    if switch < BOLSTER:
        column = _next_branch(column, switch, to_jump)
    elif switch < GUIDE:
        bolster = _next_branch(bolster, switch, to_jump)
    else:
        guide = _next_branch(guide, switch, to_jump)
    return Contact(column, bolster, guide, column_sign, bolster_sign)


@compiled
def _next_branch(branch, switch, to_jump):
    """Branch beyond the lower (even) or upper (odd) switch of a face, or the jump between both."""
    upward = switch % 2
    if to_jump:
        return AT_JUMP if branch + upward > 0 else -AT_JUMP
    return _side(branch, upward) if abs(branch) == AT_JUMP else branch + 2 * upward - 1


@compiled
def _over_jump(x, velocity, base_acceleration, contact, switch, p):
    """Contact after a regularised face has reached the end of its branch, and whether it is unique.

    Behind the jump the acceleration may point back to it: then the jump holds the face.
    """
    if held(contact):
        return with_consistent_signs(x, velocity, base_acceleration, _beyond(contact, switch, False), p)
    across, now, unique = closed(x, velocity, base_acceleration, _beyond(contact, switch, False), p)
    ratio = p.column_ratio if switch < BOLSTER else p.bolster_ratio if switch < GUIDE else 1.0
    onward = ratio * now.acceleration if switch % 2 else -ratio * now.acceleration
    if onward < 0.0:
        return _beyond(contact, switch, True), unique
    return across, unique


@compiled
def _released(t, x, direction, p):
    """Direction in which the bolster leaves rest; with next to no friction the switch may be noise."""
    base_acceleration = excitation.acceleration(t + LOOK_AHEAD / p.omega, p)
    onward = direction * breakaway(x, base_acceleration, direction, p)[0]
    back = -direction * breakaway(x, base_acceleration, -direction, p)[0]
    return -direction if onward <= 0.0 < back else direction


@compiled
def _past_zero_force(t, x, velocity, contact, p):
    """Contact after a normal force has become zero, and whether it is unique.

    Both forces may vanish at once, a force may only touch zero, and signs at zero are noise: look a
    moment ahead, and further where the force is still too small to have a sign.
    """
    ahead = LOOK_AHEAD / p.omega
    rate = forces(x, velocity, excitation.acceleration(t, p), contact, p).acceleration
    found, unique_signs = contact, True
    for _ in range(4):
        base_acceleration = excitation.acceleration(t + ahead, p)
        found, now, unique_signs = closed(
            x + ahead * (velocity + 0.5 * ahead * rate),
            velocity + ahead * rate,
            base_acceleration,
            contact,
            p,
        )
        weight = p.bolster_mass * (p.gravity + abs(base_acceleration))
        if min(abs(now.column), abs(now.bolster)) > ROUNDING * weight:
            break
        ahead *= 30.0
    return found, unique_signs


@compiled
def successor(t, x, velocity, contact, switch, p):
    """Contact after a switch has reached zero, and whether it is unique (if not: locked)."""
    base_acceleration = excitation.acceleration(t, p)
    if switch >= COLUMN_NORMAL:
        return _past_zero_force(t, x, velocity, contact, p)
    if not p.set_valued:
        return _over_jump(x, velocity, base_acceleration, contact, switch, p)
    if stuck(contact, p):
        contact = slipping(_released(t, x, 1 if switch == COLUMN + 1 else -1, p), p)
    else:
        return from_rest(x, base_acceleration, p)
    return with_consistent_signs(x, velocity, base_acceleration, contact, p)


def breakaway_acceleration(p) -> float:
    """Smallest base acceleration (m/s^2) at which set-valued friction slips from the rest position.

    0 without friction. The normal forces stay positive on the way there, so that z'' is linear in the
    base acceleration.
    """
    limits = []
    for direction in (1, -1):
        at_rest = forces(0.0, 0.0, 0.0, slipping(direction, p), p).acceleration
        driven = forces(0.0, 0.0, 1.0, slipping(direction, p), p).acceleration
        limits.append(abs(at_rest / (driven - at_rest)))
    return min(limits)
