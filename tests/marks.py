"""What of a test runs in ``make test``, and what in ``make acceptance`` only."""

from itertools import product

import pytest


def few_or_all(few):
    """Parameters of a test that diagnoses with a few candidates, or (acceptance) with all effects."""
    return [pytest.param(few, id="few"), pytest.param(None, marks=pytest.mark.acceptance, id="all")]


def each_nth(n, *lists):
    """Parameters of a test: all combinations of some lists' values, of which ``make test`` has one in n.

    Those whose places add up to a multiple of n: each value is among them where any other list has n values.
    """
    found = []
    for places in product(*(range(len(values)) for values in lists)):
        values = [each[place] for each, place in zip(lists, places, strict=True)]
        later = (pytest.mark.acceptance,) if sum(places) % n else ()
        found.append(pytest.param(*values, marks=later))
    return found
