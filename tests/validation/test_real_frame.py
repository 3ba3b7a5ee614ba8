"""Published recordings of a frame that rubs on a wall: the diagnosis finds the friction."""

from pathlib import Path

import pytest
import real_frame

from wedgesweep.diagnose import verdict

DATA = Path(__file__).parents[3] / "shared" / "real"

# Friction (N) that fits the recordings in the time domain, for both discs.
PUBLISHED = {250: 0.700, 450: 1.344}


# Accuracy with friction fitted, and with stiffness and damping as well, that others reached.
ASKED = {250: (0.073, 0.058), 450: (0.102, 0.072)}
here = pytest.mark.skipif(not DATA.is_dir(), reason="the recordings are not here")


@pytest.mark.acceptance
@here
def test_wall_friction_leads_and_predicts_the_other_recording(tmp_path):
    real_frame.copy(DATA, tmp_path)
    discs, place = real_frame.DISCS, (tmp_path, real_frame.AS_RECORDED)
    found = {grams: real_frame.linear(*place, grams) for grams in discs}
    for grams, other in (discs, discs[::-1]):
        linear = found[grams]
        assert linear.leading == "guide_friction"
        assert linear.force == pytest.approx(PUBLISHED[grams], rel=0.03)
        # Late channels turn phases, as friction does, but leave the amplitudes of harmonics.
        assert linear.next_best == "channel_delay" or grams != 250
        assert linear.leading_accuracy < linear.next_accuracy / verdict.CLEAR
        # The other recording, scaled by the weights of the discs, says as much as this one.
        foreseen = real_frame.Frame(friction=found[other].force).under(grams / other)
        accuracy, _ = real_frame.evaluated(tmp_path, foreseen, real_frame.AS_RECORDED, grams)
        assert accuracy < 1.15 * linear.leading_accuracy
        rubbing, (friction, with_damping) = real_frame.rubbing(*place, grams, linear.force), ASKED[grams]
        assert round(rubbing.friction.accuracy, 3) <= friction
        assert round(rubbing.with_damping.accuracy, 3) <= with_damping


@pytest.mark.acceptance
@here
def test_an_effect_that_explains_both_recordings_and_predicts_neither_is_refused(tmp_path, monkeypatch):
    monkeypatch.setattr(real_frame, "FURTHER", ("viscous_damping", "input_distortion"))
    real_frame.copy(DATA, tmp_path)
    found = real_frame.extensions(tmp_path, real_frame.AS_RECORDED, PUBLISHED[250])
    assert found["input_distortion"].accuracy < 0.02 < found[""].accuracy
    assert found["input_distortion"].held_out > found[""].held_out > found["viscous_damping"].held_out
