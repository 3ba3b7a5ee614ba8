"""After how many forcing periods a response repeats."""

from wedgesweep.compiled import compiled

# Periods that are told apart from a response that does not repeat.
LONGEST = 8
# A state of a longer period comes back this many times closer than it goes away in between.
APART = 1e3


@compiled
def repetition(back, tolerance):
    """Number of periods after which a state came back within the tolerance, 0 if it did not.

    ``back`` (LONGEST,): its distances from where it was one period before, two, and so on. A spiral into a
    fixed point comes close to itself every few turns, but ever closer to its last state, too: a longer
    period counts only where the state goes far away in between.
    """
    if back[0] <= tolerance:
        return 1
    for n in range(2, LONGEST + 1):
        if back[n - 1] <= min(tolerance, back[0] / APART):
            return n
    return 0
