"""The size of a rig changes nothing in a diagnosis but its numbers, and costs no simulations."""

import numpy as np
import pytest

from tests.diagnose.synthetic import MODEL, drawn, measurement, record, steady_test
from tests.scaling import BENCH_SIZE, FROUDE, HEAVIER, SIZES
from wedgesweep import config
from wedgesweep.diagnose import stages, verdict
from wedgesweep.diagnose.search import Search
from wedgesweep.diagnose.steady import simulation
from wedgesweep.diagnose.steady.from_measurement import harmonic_data

# Rounding may end a fit an iteration earlier or later.
MORE = 1.1
GUIDE, SPRING = {"guide_friction": {"force": 0.25}}, {"cubic_stiffness": {"coefficient": 0.6e9}}
# Few candidates each: ranges and responses of all effects are compared one by one elsewhere.
OF_FRICTION = ("guide_friction", "friction_level", "stribeck", "fixture_resonance", "displacement_gain")
OF_SPRINGS = ("cubic_stiffness", "bolster_stiffness", "preload", "end_stop", "velocity_lag")


class Answer:
    """What a search says of six tests of a rig under an effect, and how many responses it simulated."""

    def __init__(self, effects, size, candidates, monkeypatch):
        self.size, self.simulated = size, 0
        respond = simulation.respond

        def counted(rows, *arguments, **more):
            self.simulated += len(rows)
            return respond(rows, *arguments, **more)

        with monkeypatch.context() as patch:
            patch.setattr(simulation, "respond", counted)
            data = drawn(effects, size=size)
            explained = stages.explain(Search.of(data, candidates))
            self.base, self.explanations = explained.base, explained.explanations
            self.next = steady_test(self.explanations[:3])
        self.finding = verdict.decide(self.base, self.explanations, verdict.DEFAULT)

    def numbers(self, explanation):
        """Fitted numbers of an explanation as they would be on the bench."""
        inverse = type(self.size)(*(1.0 / each for each in self.size))
        return inverse.effects(explanation.values)


@pytest.mark.acceptance
@pytest.mark.parametrize(
    ("effects", "size", "candidates"),
    [(GUIDE, FROUDE, OF_FRICTION), (SPRING, HEAVIER, OF_SPRINGS)],
    ids=["guide-froude", "spring-heavier"],
)
def test_verdict_causes_numbers_and_next_test_are_those_of_the_bench(effects, size, candidates, monkeypatch):
    bench, rig = (Answer(effects, each, candidates, monkeypatch) for each in (BENCH_SIZE, size))
    (cause,) = effects
    assert bench.finding.best.effects == (cause,)
    assert rig.finding.verdict == bench.finding.verdict
    assert [each.effects for each in rig.explanations[:3]] == [
        each.effects for each in bench.explanations[:3]
    ]
    assert rig.base.chi2 == pytest.approx(bench.base.chi2, rel=1e-6)
    assert rig.finding.best.chi2 == pytest.approx(bench.finding.best.chi2, rel=1e-4)
    found, expected = (each.numbers(each.finding.best) for each in (rig, bench))
    assert found[cause] == pytest.approx(expected[cause], rel=1e-4)
    assert rig.next.closest.names == bench.next.closest.names
    mine, its = bench.next.numbers, rig.next.numbers
    assert its["frequency_hz"] * size.time == pytest.approx(mine["frequency_hz"])
    assert its["amplitude_mm"] / size.length == pytest.approx(mine["amplitude_mm"])
    assert rig.simulated <= MORE * bench.simulated


def measured(size, tone):
    """Records of two tests, with a slow tone (Hz on the bench) and noise."""
    random, records = np.random.default_rng(0), []
    for hertz, amplitude in ((17.0, 0.2e-3), (23.0, 0.1e-3)):
        time = np.arange(6000) * 5e-4
        signal = amplitude * np.sin(2.0 * np.pi * hertz * time) + 2e-5 * np.sin(2.0 * np.pi * tone * time)
        signal += 1e-5 * random.normal(size=time.size)
        stated = {"amplitude": amplitude * size.length, "amplitude_std": 0.01}
        scaled = time * size.time, signal * size.length
        records.append(
            record(f"{hertz:g} Hz", hertz / size.time, scaled[0], displacement=scaled[1], **stated)
        )
    return measurement(size.config(config.parse(MODEL)), "static-dynamic", records, {})


@pytest.mark.few(1)
@pytest.mark.parametrize("size", SIZES.values(), ids=SIZES)
@pytest.mark.parametrize("tone", [0.6, 3.7])
def test_a_slow_tone_is_found_where_it_is_no_drift_on_a_rig_of_that_size(size, tone):
    bench, rig = (harmonic_data(measured(each, tone)) for each in (BENCH_SIZE, size))
    assert (bench.tone is not None) == (tone > 1.0)
    if bench.tone is None:
        assert rig.tone is None
    else:
        assert rig.tone == pytest.approx(bench.tone / size.time, rel=1e-6)
        assert rig.tone_std == pytest.approx(bench.tone_std / size.time, rel=1e-3)
