"""Springs that begin or end at a clearance either way from the rest position: end stops and play.

Their clearances cut the travel into segments, in each of which all forces are smooth. A segment is named by
the number of clearances that the mass is beyond, with the sign of the side: -2, ..., 2.
"""

from math import inf

from wedgesweep.compiled import inlined
from wedgesweep.effects import backlash, end_stop


@inlined
def acts(p):
    """Whether the travel has more than one segment."""
    return end_stop.acts(p) or backlash.acts(p)


@inlined
def _bound(number, p):
    """Distance (m) from rest at which a number of clearances is passed."""
    stop = end_stop.clearance(p) if end_stop.acts(p) else inf
    play = backlash.clearance(p) if backlash.acts(p) else inf
    if number == 1:
        return min(stop, play)
    return max(stop, play) if number == 2 else inf


@inlined
def segment_at(x, p):
    """Segment at x (m); at a bound the outer one if the inner one has no width, on the upper side of 0."""
    beyond = 0
    for number in (1, 2):
        if abs(x) > _bound(number, p) or (x == 0.0 and _bound(number, p) == 0.0):
            beyond = number
    return beyond if x >= 0.0 else -beyond


@inlined
def next_segment(segment, upward, p):
    """The segment beyond the upper (1) or the lower (0) end of one; segments without width are left out."""
    step = 2 * upward - 1
    segment += step
    inner = abs(segment)
    if inner < 2 and _bound(inner + 1, p) == (_bound(inner, p) if inner else 0.0):
        segment += step
    return segment


@inlined
def ends(segment, p):
    """Lower and upper end (m) of a segment."""
    inner, outer = _bound(abs(segment), p), _bound(abs(segment) + 1, p)
    return inner if segment > 0 else -outer, -inner if segment < 0 else outer


@inlined
def write_events(x, segment, p, place, out):
    """Write the distances (m) to the lower and the upper end of a segment."""
    low, high = ends(segment, p)
    out[place], out[place + 1] = x - low, high - x


@inlined
def _side(segment, clearance, p):
    """The side (-1, 1) on which a segment is beyond a clearance, 0 if it is within."""
    number = 1 if clearance == _bound(1, p) else 2
    if abs(segment) < number:
        return 0
    return 1 if segment > 0 else -1


@inlined
def force(x, segment, spring, p):
    """Force on the mass (N, up positive) of stops, and of play in a spring of stiffness ``spring`` (N/m)."""
    total = 0.0
    if end_stop.acts(p):
        total += end_stop.force(x, _side(segment, end_stop.clearance(p), p), p)
    if backlash.acts(p):
        total += backlash.force(x, _side(segment, backlash.clearance(p), p), spring, p)
    return total
