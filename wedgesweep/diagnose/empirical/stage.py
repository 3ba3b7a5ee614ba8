"""The step of a diagnosis that fits an empirical force, and says whether it predicts better than any name."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from math import inf

import numpy as np

from wedgesweep.diagnose import accuracy
from wedgesweep.diagnose.cross_validation import (
    Each,
    Prediction,
    accuracy_of,
    held_out_groups,
    with_own_nuisances,
)
from wedgesweep.diagnose.empirical.force_map import ForceMap, force_map
from wedgesweep.diagnose.empirical.hypothesis import EmpiricalHypothesis, Ranges, at_nodes, half_step
from wedgesweep.diagnose.empirical.nearest import Nearest, nearest
from wedgesweep.diagnose.empirical.smooth_fit import SmoothFit, fit
from wedgesweep.diagnose.evaluation import Evaluation
from wedgesweep.diagnose.explanation import NOTABLE
from wedgesweep.diagnose.fit_data import Motion
from wedgesweep.diagnose.fit_parameters import Values
from wedgesweep.diagnose.ladder import Level, Rated
from wedgesweep.diagnose.model import Fit, Model
from wedgesweep.effects.empirical_force import NAME, TABLE

# The force is fitted again with the weights of the accuracy reached, at most this many times, as long as that
# gets notably smaller: far from the tests a force is found step by step.
REFITS = 8


@dataclass(frozen=True)
class EmpiricalForce:
    """An empirical force, beside the named explanation that predicts best.

    ``accuracy`` and ``held_out``: see ladder.Rated; ``named``: effects of that explanation with the same two;
    ``step``: half the step (N) of friction at zero velocity beyond the base model's.
    """

    fit: SmoothFit
    map: ForceMap
    accuracy: float
    held_out: float
    named: Rated
    step: float
    nearest: tuple[Nearest, ...]

    @property
    def offered(self) -> bool:
        """Whether it predicts tests that were left out better than the best named explanation."""
        named = self.named.held_out
        return self.held_out < inf and named is not None and self.held_out < NOTABLE * named

    @property
    def next_place(self) -> tuple[float, float]:
        """Displacement (m) and velocity (m/s) in the measured range at which the force is known least."""
        own = self.map
        place, speed = (np.linspace(-1.0, 1.0, each.size) for each in (own.places, own.speeds))
        ellipse = place[:, None] ** 2 + speed**2 <= 1.0
        i, j = np.unravel_index(np.argmax(np.where(ellipse, own.std, -1.0)), own.std.shape)
        return float(own.places[i]), float(own.speeds[j])

    def values(self) -> dict[str, dict[str, object]]:
        """Numbers of its effects by their keys, as a config has them."""
        hypothesis, size = self.fit.hypothesis, self.fit.model.size
        x = self.fit.x[:size]
        found: dict[str, dict[str, object]] = {
            name: dict(own) for name, own in hypothesis.in_key_units(x).items() if name != NAME
        }
        ranges = hypothesis.ranges
        found[NAME] = {
            "displacement_mm": 1e3 * ranges.displacement,
            "velocity_mm_per_s": 1e3 * ranges.velocity,
            "centre_mm": 1e3 * ranges.centre,
            TABLE: (ranges.force * x[hypothesis.nodes]).tolist(),
        }
        return found


def empirical_force(base: Fit, levels: Sequence[Level], each: Each) -> EmpiricalForce | None:
    """The empirical force beside the base model; None where tests cannot show one.

    It takes a measured motion, tests to leave out, a model that can have such a force, and an explanation to
    compare it with.
    """
    data, groups = base.model.data, held_out_groups(base.model.data)
    moved = data.motion(base)
    named = min((level.best for level in levels), key=_left_out)
    if moved is None or not groups or _left_out(named) == inf or NAME not in data.model.possible_effects:
        return None
    if data.model.system != "oscillator":  # a suspension's sensors show minus its state
        moved = Motion(-moved.displacement, -moved.velocity)
    hypothesis = EmpiricalHypothesis.of(data.model, Ranges.of(data, moved), units=data.units)
    rows = [tests for _, tests in groups]
    size = named.accuracy if named.accuracy < inf else 1.0
    start = _start(Model(data.with_model_error(size), hypothesis), base, named)
    if start is None:
        return None
    found = fit(*start, rows)
    own = _accuracy(found)
    for _ in range(REFITS):
        if own == 0.0 or own > NOTABLE * size:
            break
        size, weighted = own, data.with_model_error(own)
        again = weighted.compared_again(found.evaluation)
        found = min(found, fit(found.model.on(weighted), again, rows), key=_accuracy)
        own = _accuracy(found)
    step, slope = _step(found)
    shown = force_map(found, moved, step, slope)
    left_out = _held_out(found, groups, each)
    return EmpiricalForce(found, shown, own, left_out, named, step, tuple(nearest(shown)))


def _left_out(rated: Rated) -> float:
    return inf if rated.held_out is None else rated.held_out


def _start(model: Model, base: Fit, named: Rated) -> tuple[Model, Evaluation] | None:
    """The better of two starts: no force, and that of the named explanation; None if none has a response."""
    hypothesis = model.hypothesis
    assert isinstance(hypothesis, EmpiricalHypothesis)
    own, neutral = hypothesis.nodes, np.array([each.neutral for each in hypothesis.parameters])
    starts = [(base, np.clip(neutral, hypothesis.low, hypothesis.high))]
    values, without = _values(named.fit)
    forces, step = at_nodes(model.data, values, without, hypothesis.ranges)
    if np.isfinite(forces).all():
        x = neutral.copy()
        x[own] = forces.ravel() / hypothesis.ranges.force
        unit = _step_of(model, x + np.eye(1, x.size)[0]) if hypothesis.step else 0.0
        x[0] += step / unit if unit else 0.0
        starts.append((named.fit, np.clip(x, hypothesis.low, hypothesis.high)))
    tried = [model.evaluate(model.start(one, x)) for one, x in starts]
    best = min(tried, key=lambda evaluation: evaluation.chi2)
    return (model, best) if best.found else None


def _values(fitted: Fit) -> tuple[Values, Values]:
    """Numbers of all effects of a fit, and those of its uncertain ones alone."""
    model = fitted.model
    return model.values(fitted.x), model.uncertain.values(fitted.x[model.size :])


def _step_of(model: Model, x: np.ndarray) -> float:
    """Half the step (N) at zero velocity beyond that of the base model, of parameters (k,)."""
    assert isinstance(model.hypothesis, EmpiricalHypothesis)
    values = model.hypothesis.values(x)
    del values[NAME]
    return half_step(model.data, values, {}, model.hypothesis.ranges)


def _step(found: SmoothFit) -> tuple[float, float]:
    """Half the step of a fit (N), and its derivative by the parameter of friction."""
    model, x = found.model, found.x[: found.model.size]
    if found.hypothesis.step is None:
        return 0.0, 0.0
    step = _step_of(model, x)
    return step, (_step_of(model, x + model.scale[0] * np.eye(1, x.size)[0]) - step) / model.scale[0]


def _accuracy(found: SmoothFit) -> float:
    """Accuracy of a fit where it ended, with its effective number of parameters."""
    return accuracy.of_fit(found.as_fit, float(found.model.data.dof.sum()) - found.freedom)


def _held_out(found: SmoothFit, groups: Sequence[tuple[str, np.ndarray]], each: Each) -> float:
    """Accuracy of simulations of tests that were left out, as in cross_validation.held_out_accuracy."""

    def predicted(group: tuple[str, np.ndarray]) -> Prediction:
        scheme, rows = group
        model = found.model.on(found.model.data.subset(rows))
        point = replace(found.evaluation.point.subset(rows), x=found.without(rows))
        return Prediction(scheme, rows, model.data, with_own_nuisances(model, point), model.effects, point.x)

    return accuracy_of(each(predicted, list(groups)), found.as_fit)
