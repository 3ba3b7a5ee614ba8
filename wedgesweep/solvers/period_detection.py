"""After how many forcing periods a response repeats."""

from wedgesweep.compiled import inner

# Longest period that is detected, in forcing periods.
LONGEST_PERIOD = 8
# A response has a period of several forcing periods only if its state comes back this many times closer than
# it moves in one of them.
CLOSER = 1e3
# While a response settles, the same ratio for the period that Newton's method tries.
SEEMS = 10.0


@inner
def detected_period(distances, tolerance):
    """Number of periods after which a state came back within the tolerance, 0 if it did not.

    ``distances`` (LONGEST_PERIOD,): of the state from those one period before, two periods before, and so on.
    A spiral into a fixed point also comes close to itself after a few periods: a longer period counts only if
    the state moves far away in between.
    """
    if distances[0] <= tolerance:
        return 1
    for n in range(2, LONGEST_PERIOD + 1):
        if distances[n - 1] <= min(tolerance, distances[0] / CLOSER):
            return n
    return 0


@inner
def guessed_period(distances):
    """Likely period of a response that has not settled yet, from the same distances."""
    for n in range(2, LONGEST_PERIOD + 1):
        if distances[n - 1] * SEEMS < distances[0]:
            return n
    return 1
