"""After how many forcing periods a response repeats."""

from wedgesweep.compiled import inner

# Periods that are told apart from a response that does not repeat.
LONGEST_PERIOD = 8
# A state of a longer period comes back this many times closer than it goes away in between.
CLOSER = 1e3
# A response seems to take several periods where its state comes back this many times closer after them than
# after one.
SEEMS = 10.0


@inner
def detected_period(distances, tolerance):
    """Number of periods after which a state came back within the tolerance, 0 if it did not.

    ``distances`` (LONGEST_PERIOD,): from where it was one period before, two, and so on. A spiral into a
    fixed point comes close to itself every few turns, but ever closer to its last state, too: a longer
    period counts only where the state goes far away in between.
    """
    if distances[0] <= tolerance:
        return 1
    for n in range(2, LONGEST_PERIOD + 1):
        if distances[n - 1] <= min(tolerance, distances[0] / CLOSER):
            return n
    return 0


@inner
def guessed_period(distances):
    """Periods that a response seems to take, from the same distances."""
    for n in range(2, LONGEST_PERIOD + 1):
        if distances[n - 1] * SEEMS < distances[0]:
            return n
    return 1
