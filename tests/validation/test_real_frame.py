"""Published recordings of a frame that rubs on a wall: the diagnosis finds the friction."""

from pathlib import Path

import pytest
import real_frame

DATA = Path(__file__).parents[3] / "shared" / "real"

# Friction (N) that fits the recordings in the time domain, for both discs.
PUBLISHED = {250: 0.700, 450: 1.344}


@pytest.mark.skipif(not DATA.is_dir(), reason="the recordings are not here")
def test_wall_friction_leads_and_predicts_the_other_recording(tmp_path):
    for grams, (found, (accuracy, _), _) in real_frame.run(DATA, tmp_path).items():
        assert found.leading == "guide_friction"
        assert found.force == pytest.approx(PUBLISHED[grams], rel=0.03)
        assert found.leading_accuracy < found.next_accuracy / 3.0
        # The other recording, scaled by the weights of the discs, says as much as this one.
        assert accuracy < 1.15 * found.leading_accuracy
