"""Published recordings of a frame that rubs on a wall: the diagnosis finds the friction."""

from pathlib import Path

import pytest
import real_frame

DATA = Path(__file__).parents[3] / "shared" / "real"

# Friction (N) that fits the recordings in the time domain, for both discs.
PUBLISHED = {250: 0.700, 450: 1.344}


@pytest.mark.skipif(not DATA.is_dir(), reason="the recordings are not here")
def test_wall_friction_leads_and_predicts_the_other_recording(tmp_path):
    real_frame.copy(DATA, tmp_path)
    discs = real_frame.DISCS
    found = {grams: real_frame.linear(tmp_path, real_frame.AS_RECORDED, grams) for grams in discs}
    for grams, other in (discs, discs[::-1]):
        here = found[grams]
        assert here.leading == "guide_friction"
        assert here.force == pytest.approx(PUBLISHED[grams], rel=0.03)
        assert here.leading_accuracy < here.next_accuracy / 3.0
        # The other recording, scaled by the weights of the discs, says as much as this one.
        foreseen = real_frame.Frame(friction=found[other].force).under(grams / other)
        accuracy, _ = real_frame.evaluated(tmp_path, foreseen, real_frame.AS_RECORDED, grams)
        assert accuracy < 1.15 * here.leading_accuracy
