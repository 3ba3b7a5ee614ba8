"""Every figure of a diagnosis draws every verdict, few and many tests, and says what it cannot draw."""

import numpy as np
import pytest

from tests import fixture_diagnosis
from wedgesweep.diagnosed import Diagnosed
from wedgesweep.figures import diagnosis, svg
from wedgesweep.figures.diagnosis import candidates, gain, leftover, look, misfit, plateaus, swing

KINDS = sorted(diagnosis.DESCRIPTIONS)
BY_TEST = ("harmonics", "leftover-force", "phase-plane", "waveforms")


def found(verdict="named", **options):
    return Diagnosed(*fixture_diagnosis.build(verdict, **options))


def draw(kind, diagnosed):
    figure = diagnosis.FIGURES[kind].draw(diagnosed)
    figure.draw_without_rendering()
    return figure


@pytest.mark.parametrize("kind", KINDS)
def test_draws_and_says_what_it_shows(kind):
    figure = draw(kind, found())
    assert figure.get_suptitle()
    words = [text for ax in figure.axes for text in (ax.get_xlabel(), ax.get_ylabel()) if text]
    assert words
    assert [text for text in words if "[" not in text] == []
    assert diagnosis.FIGURES[kind].draw.__doc__.count("To see:") == 1


@pytest.mark.parametrize("verdict", fixture_diagnosis.WAYS)
@pytest.mark.parametrize("kind", KINDS)
def test_every_verdict(kind, verdict):
    diagnosed = found(verdict, tests=2 if verdict == "data-insufficient" else 4)
    lacking = (kind == "gain" and diagnosed.gain is None) or (
        kind == "energy" and verdict == "data-insufficient"
    )
    if lacking:
        with pytest.raises(ValueError, match=f"^{kind}: no"):
            draw(kind, diagnosed)
    else:
        draw(kind, diagnosed)


@pytest.mark.parametrize("kind", KINDS)
def test_many_tests_without_velocity_and_amplitude(kind):
    diagnosed = found(tests=40, velocity=False, known=False)
    if kind == "energy":
        with pytest.raises(ValueError, match="known input"):
            draw(kind, diagnosed)
        return
    figure = draw(kind, diagnosed)
    # On paper and on the page it is not shrunk beyond reading.
    assert figure.get_figwidth() < 11.5


def test_responses_that_were_not_found_and_channels_that_are_missing():
    diagnosed = found()
    data = diagnosed.data
    data["simulated_harmonics"][1, 3] = np.nan
    data["simulated_waveform"][1, 3] = np.nan
    for name in ("q", "simulated_peak_to_peak", "simulated_energy", "simulated_plateau"):
        data[name][1, 3] = np.nan
    for name in ("measured_harmonics", "noise_std", "measured_waveform", "waveform_noise"):
        data[name][5, 1] = np.nan
    for row in diagnosed.document["gain"]["held_out"][:2]:
        row["rmse_extended"] = None
    for kind in KINDS:
        draw(kind, diagnosed)


def test_noise_alone_is_one_in_the_map_and_what_is_missing_is_far_off():
    diagnosed = found("named", tests=12)
    base, extended = (misfit.deviations(diagnosed, model) for model in ("base", "extended"))
    assert np.sqrt(np.mean(extended**2)) == pytest.approx(1.0, abs=0.05)
    assert np.sqrt(np.mean(base**2)) > 10.0
    # The map and the total are one misfit: each harmonic has two parts.
    assert 2.0 * (base**2).sum(axis=1) == pytest.approx(diagnosed.data["q"].sel(model="base").values)


def test_the_tests_with_the_largest_misfit_are_shown():
    diagnosed = found(tests=20)
    ratio = (diagnosed.data["q"].sel(model="base") / diagnosed.data["dof"]).values
    chosen = look.choose(diagnosed, None)
    assert len(chosen) == look.SHOWN
    assert ratio[chosen].min() >= np.delete(ratio, chosen).max()
    figure = diagnosis.FIGURES["waveforms"].draw(diagnosed, tests=[4])
    assert "run-04" in figure.axes[0].get_title()
    assert len(figure.axes) == 3


def test_velocity_is_the_rate_of_displacement_where_there_is_no_channel():
    with_channel, without = found().data, found(velocity=False).data
    for test in (0, 7):
        simulated = [each["simulated_waveform"].sel(model="base") for each in (with_channel, without)]
        _, sensed = look.motion(with_channel, simulated[0], test)
        _, derived = look.motion(without, simulated[1], test)
        assert derived == pytest.approx(sensed, abs=1e-9 * np.abs(sensed).max())


def test_legends_tell_a_cause_from_an_attempt():
    assert look.names(found("named"))["extended"] == "extended: stribeck + guide_friction"
    assert look.names(found("none-of-mine"))["extended"] == "best attempt: stribeck"
    assert list(look.names(found("nothing-missing"))) == ["base"]


def test_candidates_keep_the_base_model_and_leave_out_what_failed(monkeypatch):
    monkeypatch.setattr(candidates, "MOST", 3)
    shown = [each["effects"] for each in candidates.shown(found())]
    assert [] in shown
    assert ["cross_slip"] not in shown
    assert len(shown) == 4


def test_a_sine_has_the_plateau_that_is_drawn_for_it():
    velocity = np.cos(2.0 * np.pi * (np.arange(100_000) + 0.5) / 100_000)
    assert pytest.approx((np.abs(velocity) < 0.05).mean(), abs=1e-4) == plateaus.SINE


def test_like_amplitudes_are_joined():
    groups = swing.groups(np.array([1e-4, 1e-3, 1.02e-4, 1.05e-3]))
    assert [sorted(group.tolist()) for group in groups] == [[0, 2], [1, 3]]


def test_leftover_force_that_no_test_gives():
    diagnosed = found()
    diagnosed.data["leftover_force"][:] = np.nan
    with pytest.raises(ValueError, match="leftover-force: the tests"):
        leftover.draw(diagnosed)


def test_held_out_tests_by_place_or_by_name():
    diagnosed = found()
    by_name = gain.draw(diagnosed)
    for row in diagnosed.document["gain"]["held_out"]:
        row["test"] = diagnosed.place(row["test"])
    by_place = gain.draw(diagnosed)
    lines = [[line.get_xydata().tolist() for line in figure.axes[0].lines] for figure in (by_name, by_place)]
    assert lines[0] == lines[1]


def test_svg_is_the_same_each_time():
    assert svg(draw("plateaus", found())) == svg(draw("plateaus", found()))
