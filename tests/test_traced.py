"""Python functions that run on symbols and become compiled straight lines."""

from typing import NamedTuple

import pytest

from wedgesweep.compiled import compiled
from wedgesweep.traced import traced


class Pair(NamedTuple):
    """Two numbers."""

    first: float
    second: float


def operations(numbers):
    (a, b), pair = numbers
    total = 0.0
    for k in range(1, 4):
        total = total + k * a - b / k
    return Pair(2.0 - pair.first, 3.0 / pair.second), (total, a * b, 1.0 + b)


line = traced(operations)


@compiled
def called(a, b, first, second):
    return line(((a, b), Pair(first, second)))


def test_every_operation_is_that_of_python():
    numbers = 1.3, -0.7, 2.5, 0.4
    found = called(*numbers)
    exact = operations((numbers[:2], Pair(*numbers[2:])))
    assert isinstance(found[0], Pair)
    assert found[0] == pytest.approx(exact[0], rel=1e-15)
    assert found[1] == pytest.approx(exact[1], rel=1e-15)


def test_a_decision_by_a_value_is_refused():
    decided = traced(lambda numbers: numbers[0] if numbers[0] else numbers[1])

    @compiled
    def call(a, b):
        return decided((a, b))

    with pytest.raises(TypeError, match="decides nothing"):
        call(1.0, 2.0)
