"""Polynomials: their coefficients c are a tuple, and stand for c[0] + c[1] s + c[2] s^2 + ..."""

from wedgesweep.traced import traced


def _horner(terms, s):
    """The sum terms[0] + terms[1] s + ..., without powers."""
    total = terms[-1]
    for term in reversed(terms[:-1]):
        total = total * s + term
    return total


@traced
def polynomial(c, s):
    """Value at s."""
    return _horner(c, s)


@traced
def slope(c, s):
    """Derivative at s."""
    return _horner([i * c[i] for i in range(1, len(c))], s)


@traced
def largest_change(c, s):
    """Bound of how far the value moves from c[0] between 0 and s > 0."""
    return s * _horner([abs(each) for each in c[1:]], s)
