"""Examples of an independent simulator come out right, and at the size of a wagon alike, at the same cost."""

import pytest

from tests.scaling import FROUDE, HEAVIER
from tests.validation import examples
from tests.validation.laboratory import diagnose
from tests.validation.resized import resized
from wedgesweep.diagnose.steady import simulation
from wedgesweep.effects import EFFECTS
from wedgesweep.quantity import Quantity

# Rounding may end a fit an iteration earlier or later.
MORE = 1.1
# What is hidden, and what may look like it.
FEW = ["velocity_lag", "viscous_damping", "displacement_gain"]
HIDDEN, CLEAN = ("set-052", FROUDE), ("set-017", HEAVIER)


class Count:
    """Responses that were simulated."""

    def __init__(self, monkeypatch):
        self.rows = []
        respond = simulation.respond

        def counted(rows, *arguments, **more):
            self.rows.append(len(rows))
            return respond(rows, *arguments, **more)

        monkeypatch.setattr(simulation, "respond", counted)

    def take(self):
        """How many since it was last asked."""
        total = sum(self.rows)
        self.rows.clear()
        return total


def quantity(cause, key) -> Quantity:
    return next(each for each in EFFECTS[cause].quantities if each.key == key)


def same_answer(name, size, candidates, folder, monkeypatch):
    """Diagnose an example at both sizes, and compare."""
    count, answers, simulated = Count(monkeypatch), [], []
    example = examples.EXAMPLES / name
    for measured in (example / "measured.toml", resized(example, size, folder / "rig")):
        answers.append(diagnose(measured, folder / f"found-{len(answers)}", candidates, "--no-report"))
        simulated.append(count.take())
    bench, rig = answers
    examples.is_right(name, bench)
    assert rig.verdict == bench.verdict
    assert rig.explanations == bench.explanations
    for cause, other in zip(bench.document["causes"], rig.document["causes"], strict=True):
        for key, number in cause["parameters"].items():
            factor = size.factor(quantity(cause["effect"], key).dimension)
            found = other["parameters"][key]
            assert found["value"] == pytest.approx(factor * number["value"], rel=1e-3)
            assert found["ci95"] == pytest.approx([factor * end for end in number["ci95"]], rel=2e-2)
    assert 0 < simulated[1] <= MORE * simulated[0]


@pytest.mark.acceptance
@pytest.mark.skipif(not examples.TRUTH, reason="no ../shared/blind-examples beside the checkout")
def test_an_example_has_the_same_answer_at_the_size_of_a_wagon(tmp_path, monkeypatch):
    same_answer(*HIDDEN, FEW, tmp_path, monkeypatch)


@pytest.mark.acceptance
@pytest.mark.skipif(not examples.TRUTH, reason="no ../shared/blind-examples beside the checkout")
def test_nothing_is_missing_at_either_size(tmp_path, monkeypatch):
    same_answer(*CLEAN, None, tmp_path, monkeypatch)
