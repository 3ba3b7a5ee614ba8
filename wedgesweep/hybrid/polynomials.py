"""Polynomials: their coefficients c are a tuple, and stand for c[0] + c[1] s + c[2] s^2 + ..."""

from wedgesweep.compiled import by_type, contracted_of


def _horner(terms: list[str]) -> str:
    """The expression for terms[0] + terms[1] s + ..., without powers."""
    body = terms[-1]
    for term in reversed(terms[:-1]):
        body = f"({body}) * s + {term}"
    return body


def polynomial(c, s):
    """Value at s."""
    raise NotImplementedError


@by_type(polynomial)
def _polynomial(c, s):
    return contracted_of(("c", "s"), _horner([f"c[{i}]" for i in range(len(c))]))


def slope(c, s):
    """Derivative at s."""
    raise NotImplementedError


@by_type(slope)
def _slope(c, s):
    return contracted_of(("c", "s"), _horner([f"{i} * c[{i}]" for i in range(1, len(c))]))


def largest_change(c, s):
    """Bound of how far the value moves from c[0] between 0 and s > 0."""
    raise NotImplementedError


@by_type(largest_change)
def _largest_change(c, s):
    return contracted_of(("c", "s"), _horner(["0.0", *(f"abs(c[{i}])" for i in range(1, len(c)))]))
