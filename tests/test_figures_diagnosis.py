"""Every figure of a diagnosis draws every verdict with few and many tests, or says what is missing."""

import re

import numpy as np
import pytest
from matplotlib.figure import Figure

from tests import fixture_diagnosis, fixture_transient
from wedgesweep import figures
from wedgesweep.diagnosis_result import DiagnosisResult
from wedgesweep.figures import diagnosis, svg
from wedgesweep.figures.diagnosis import (
    candidates,
    decays,
    marks,
    misfit,
    peak_to_peak,
    plateaus,
    selection,
    spectrogram,
)
from wedgesweep.figures.diagnosis.selection import motion

# Figures of steady tests without a load; tests/diagnose draws loops and loads.
OF_TRANSIENTS = ("decays", "spectrogram")
KINDS = sorted(set(diagnosis.FIGURES) - {"loops", "column-load", *OF_TRANSIENTS})
BY_TEST = ("harmonics", "leftover-force", "phase-plane", "waveforms")


def build(verdict="named", **options):
    return DiagnosisResult(*fixture_diagnosis.build(verdict, **options))


def test_explanations_by_more_than_two_effects_have_a_colour_of_their_own():
    result = build("none-of-mine")
    ladder = result.document["ladder"]
    ladder += [{**ladder[-1], "effects": ["a", "b", "c", "d"][:n], "accuracy": 0.01 / n} for n in (3, 4)]
    figure = draw("ladder", result)
    (legend,) = figure.legends
    assert "best with more effects" in [text.get_text() for text in legend.get_texts()]
    labels = [text.get_text() for text in figure.axes[0].get_yticklabels()]
    assert {"a + b + c", "a + b + c + d"} <= {*labels}


def draw(kind, result):
    """Draw a figure without its layout, which takes longest, and which pages of reports have."""
    figure = figures.draw(result, kind)
    figure.set_layout_engine("none")
    figure.draw_without_rendering()
    return figure


@pytest.mark.parametrize("kind", KINDS)
def test_draws_and_says_what_it_shows(kind):
    """The page of a report renders all of them (test_report.py)."""
    figure = figures.draw(build(), kind)
    assert figure.get_suptitle()
    words = [text for ax in figure.axes for text in (ax.get_xlabel(), ax.get_ylabel()) if text]
    assert words
    assert [text for text in words if "[" not in text] == []
    assert diagnosis.FIGURES[kind].load().draw.__doc__.count("To see:") == 1


def test_a_diagnosis_is_drawn_in_units_of_choice_and_the_same_each_time():
    figure = figures.draw(build(), "waveforms", units="us")
    words = {text for ax in figure.axes if (text := ax.get_ylabel())}
    assert {text.partition("[")[2] for text in words} == {"in]", "in/s]", "mil]"}
    assert " in\n" in figure.axes[0].get_title()
    assert svg(draw("plateaus", build())) == svg(draw("plateaus", build()))


# Without a cause, without known amplitudes, with an attempt. That of a cause is drawn above, and all figures
# of one with rivals by the command line (test_cli.py).
@pytest.mark.few(2)
@pytest.mark.parametrize("verdict", ["nothing-missing", "data-insufficient", "none-of-mine"])
@pytest.mark.parametrize("kind", KINDS)
def test_every_verdict(kind, verdict):
    result = build(verdict, tests=2 if verdict == "data-insufficient" else 3)
    lacking = (kind == "gain" and result.gain is None) or (
        kind == "energy" and verdict == "data-insufficient"
    )
    if lacking:
        with pytest.raises(ValueError, match=f"^{kind}: no"):
            draw(kind, result)
    else:
        draw(kind, result)


@pytest.mark.few(2)
@pytest.mark.parametrize("kind", KINDS)
def test_many_tests_without_velocity_and_amplitude(kind):
    result = build(tests=40, velocity=False, known=False)
    if kind == "energy":
        with pytest.raises(ValueError, match="known motion of the side frame"):
            draw(kind, result)
        return
    figure = figures.draw(result, kind)
    # On paper and on the page it is not shrunk beyond reading.
    assert figure.get_figwidth() < 11.5


@pytest.mark.acceptance
def test_responses_that_were_not_found_and_channels_that_are_missing():
    result = build(tests=3)
    data = result.data
    data["simulated_harmonics"][1, 0] = np.nan
    data["simulated_waveform"][1, 0] = np.nan
    for name in ("q", "simulated_peak_to_peak", "simulated_energy", "simulated_plateau"):
        data[name][1, 0] = np.nan
    for name in ("measured_harmonics", "noise_std", "measured_waveform", "waveform_noise"):
        data[name][2, 1] = np.nan
    for row in result.document["gain"]["held_out"][:2]:
        row["rmse_extended"] = None
    for kind in KINDS:
        draw(kind, result)


def test_noise_alone_is_one_in_the_map_and_what_is_missing_is_far_off():
    result = build("named", tests=12)
    base, extended = (misfit.deviations(result, model) for model in ("base", "extended"))
    assert np.sqrt(np.mean(extended**2)) == pytest.approx(1.0, abs=0.05)
    assert np.sqrt(np.mean(base**2)) > 10.0
    # The map and the total are one misfit: each harmonic has two parts.
    assert 2.0 * (base**2).sum(axis=1) == pytest.approx(result.data["q"].sel(model="base").values)


def test_the_tests_with_the_largest_misfit_are_shown():
    result = build(tests=20)
    ratio = (result.data["q"].sel(model="base") / result.data["dof"]).values
    chosen = selection.choose(result, None)
    assert len(chosen) == selection.TESTS_SHOWN
    assert ratio[chosen].min() >= np.delete(ratio, chosen).max()
    figure = figures.draw(result, "waveforms", tests=[4])
    assert "run-04" in figure.axes[0].get_title()
    assert len(figure.axes) == 3


def test_velocity_is_the_rate_of_displacement_where_there_is_no_channel():
    with_channel, without = build().data, build(velocity=False).data
    for test in (0, 7):
        simulated = [each["simulated_waveform"].sel(model="base") for each in (with_channel, without)]
        _, sensed = motion(with_channel, simulated[0], test)
        _, derived = motion(without, simulated[1], test)
        assert derived == pytest.approx(sensed, abs=1e-9 * np.abs(sensed).max())


def test_legends_distinguish_a_cause_from_an_attempt():
    assert marks.names(build("named"))["extended"] == "extended: stribeck + guide_friction"
    assert marks.names(build("none-of-mine"))["extended"] == "best attempt: stribeck"
    assert list(marks.names(build("nothing-missing"))) == ["base"]


def test_candidates_keep_the_base_model_and_leave_out_what_failed(monkeypatch):
    monkeypatch.setattr(candidates, "MOST_ROWS", 3)
    shown = [each["effects"] for each in candidates.shown(build())]
    assert [] in shown
    assert ["cross_slip"] not in shown
    assert len(shown) == 4


def test_what_is_drawn_beside_the_tests():
    velocity = np.cos(2.0 * np.pi * (np.arange(100_000) + 0.5) / 100_000)
    assert pytest.approx((np.abs(velocity) < 0.05).mean(), abs=1e-4) == plateaus.SINE
    # Like amplitudes are joined.
    groups = peak_to_peak.groups(np.array([1e-4, 1e-3, 1.02e-4, 1.05e-3]))
    assert [sorted(group.tolist()) for group in groups] == [[0, 2], [1, 3]]
    # A force that no test gives is told.
    result = build()
    result.data["leftover_force"][:] = np.nan
    with pytest.raises(ValueError, match="leftover-force: the tests"):
        draw("leftover-force", result)


def test_held_out_tests_by_place_or_by_name():
    result = build()
    by_name = draw("gain", result)
    for row in result.document["gain"]["held_out"]:
        row["test"] = result.test_index(row["test"])
    by_place = draw("gain", result)
    lines = [[line.get_xydata().tolist() for line in figure.axes[0].lines] for figure in (by_name, by_place)]
    assert lines[0] == lines[1]


def test_one_panel_is_drawn_into_given_axes():
    figure, result = Figure(layout="constrained"), build()
    left, right = figure.subfigures(1, 2)
    ax = left.subplots()
    assert figures.draw(result, "plateaus", ax=ax) is figure
    figure.draw_without_rendering()
    assert ax.has_data()
    assert ax.get_title().startswith("Plateaus")
    with pytest.raises(ValueError, match=r"^waveforms: 3 panels do not fit into one Axes"):
        figures.draw(result, "waveforms", ax=ax, tests=[0])
    assert figures.draw(result, "phase-plane", ax=right.subplots(), tests=[0]) is figure


def test_figures_are_those_of_the_kind_of_tests():
    transients = fixture_transient.build()
    for kind in OF_TRANSIENTS:
        figure = draw(kind, transients)
        assert figure.get_suptitle()
        words = [text for ax in figure.axes for text in (ax.get_xlabel(), ax.get_ylabel()) if text]
        assert [text for text in words if "[" not in text] == []
        with pytest.raises(ValueError, match=f"^{kind}: the tests are no transients"):
            draw(kind, build())
    for kind in (name for name, each in diagnosis.FIGURES.items() if each.tests == "steady"):
        with pytest.raises(ValueError, match=f"^{kind}: no test is of steady vibration"):
            figures.draw(transients, kind)


def test_swings_reach_from_one_turning_point_to_the_next():
    time = np.linspace(0.0, 10.0, 100_001)
    noise = 1e-3 * np.random.default_rng(0).standard_normal(time.size)
    when, size = decays.swings(time, (1.0 - 0.05 * time) * np.sin(2.0 * np.pi * time) + noise, 1e-3)
    # The first one began before the first sample.
    assert size[0] == pytest.approx(1.0 - 0.05 * when[0], abs=5e-3)
    assert np.diff(when[1:]) == pytest.approx(0.5, abs=1e-2)
    assert size[1:] == pytest.approx(1.0 - 0.05 * when[1:], abs=5e-3)


def test_swings_of_dry_friction_fall_evenly_though_the_last_ones_do_not_pass_zero():
    step, start = 0.13, 1.0  # of F/k, and where the mass is released
    share = np.arange(1000) / 1000.0
    centre = step * (-1.0) ** np.arange(4)
    turns = np.array([(-1.0) ** n * (start - 2.0 * step * n) for n in range(4)])
    motion = np.concatenate([c + (a - c) * np.cos(np.pi * share) for a, c in zip(turns, centre, strict=True)])
    resting = np.r_[motion, np.full(1000, start - 8.0 * step)]
    when, size = decays.swings(np.arange(resting.size) / 1000.0, resting - 0.3, 1e-4)
    # After the last one the mass rests where it stopped, and does not turn.
    assert size == pytest.approx(start - step - 2.0 * step * np.arange(3), abs=1e-3)
    assert when == pytest.approx([0.5, 1.5, 2.5], abs=1e-2)


def test_a_spectrogram_shows_the_sweep_and_the_harmonic_that_the_base_model_lacks():
    sweep, _ = spectrogram.records(fixture_transient.build(), [0, 1])
    of = spectrogram.spectra(sweep)
    rate = (fixture_transient.LAST - fixture_transient.FIRST) / sweep.time[-1]
    expected = fixture_transient.FIRST + rate * of.time
    measured, base, extended = of.power
    # Within two lines of the spectrum.
    two = 2.0 * of.frequency[1]
    assert of.frequency[measured.argmax(axis=0)] == pytest.approx(expected, abs=two)
    assert of.frequency[base.argmax(axis=0)] == pytest.approx(3.0 * expected, abs=two)
    assert extended.sum() < 1e-3 * base.sum() < 0.1 * measured.sum()


def test_parts_of_one_record_are_one_spectrogram():
    whole, cut = fixture_transient.build(), fixture_transient.build(parts=4)
    # Two records of four parts: the second begins where the clock of the first began.
    joined = spectrogram.records(cut, range(8))
    assert [each.test for each in joined] == [0, 4]
    for one, other in zip(joined, spectrogram.records(whole, range(2)), strict=True):
        assert one.time == pytest.approx(other.time)
        assert np.array_equal(one.signals, other.signals)
    assert [each.test for each in spectrogram.records(cut, [0, 2])] == [0, 2]
    short = fixture_transient.build(parts=20)
    assert spectrogram.possible(short)  # the whole record is long enough
    assert not spectrogram.possible(build())
    with pytest.raises(ValueError, match="no record has 1024 samples or more"):
        figures.draw(short, "spectrogram", tests=[0, 2])


@pytest.mark.acceptance
def test_figures_of_an_oscillator_say_what_it_has():
    """Axes and titles of a mass under a force name neither bolster nor side frame."""
    result = build(tests=4)
    result.data.attrs |= {
        **{"system": "oscillator", "contact": "ground", "excitation": "force"},
        "reference": "force amplitude over k",
    }
    result.data["amplitude"].attrs["units"] = "N"
    told = {}
    for kind in KINDS:
        figure = figures.draw(result, kind)
        axes = [text for ax in figure.axes for text in (ax.get_xlabel(), ax.get_ylabel(), ax.get_title())]
        told[kind] = " ".join([figure.get_suptitle(), *axes])
        assert not re.search("x-y|bolster|side frame|mm,|[0-9] mm", told[kind]), told[kind]
    assert "$x$ [mm]" in told["phase-plane"]
    assert "$x'$ [mm/s]" in told["waveforms"]
    assert "on the mass (positive along $x$)" in told["leftover-force"]
    assert "the force puts in" in told["energy"]
