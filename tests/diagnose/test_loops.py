"""Loops: the force under an imposed motion, from files to a verdict."""

from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest

from tests.command import invoke
from tests.diagnose.answers import diagnosed, is_told
from tests.diagnose.rigs import FORCE, HEAD, LOOP, PLACE, TEST, oscillator, saved
from wedgesweep.config import parse
from wedgesweep.diagnose.explanation import POSSIBLE
from wedgesweep.diagnose.loop import motion_noise
from wedgesweep.diagnose.loop.loop_data import loop_data
from wedgesweep.diagnose.noise_spectrum import white_noise
from wedgesweep.diagnose.search import Search, base_fit
from wedgesweep.diagnose.smoothing import (
    LowPass,
    chosen_cutoff,
    continuous,
    derivative,
    highest_cutoff,
    motion,
)
from wedgesweep.effects import merge
from wedgesweep.errors import InputError
from wedgesweep.measured import MeasuredError, read
from wedgesweep.report.sentence import sentence
from wedgesweep.solvers import imposed_motion

OSCILLATOR = oscillator(mass_kg=2.0, spring_N_per_mm=0.5, damping_N_s_per_m=3.0, normal_force_N=10.0)
RATE, CELLS = 500.0, 10
# Zero of the force (N), and of an oscillator's displacement (m): the tool does not know them.
ZERO, BESIDE = 0.5, 3e-3


def motion_of(amplitude, frequency, duration):
    """A motion of two tones, whose loops have reversals of many sizes; (3, n CELLS): within each sample."""
    t = (np.arange(round(duration * RATE) * CELLS) + 0.5) / RATE / CELLS
    parts = [(amplitude, 2.0 * np.pi * frequency, 0.0), (0.3 * amplitude, 0.74 * np.pi * frequency, 1.0)]
    return np.array(
        [
            sum(a * w**order * np.sin(w * t + p + 0.5 * np.pi * order) for a, w, p in parts)
            for order in range(3)
        ]
    )


def write(
    folder,
    model=OSCILLATOR,
    effects=None,
    motions=((0.01, 1.1, 12.0),),
    noise=(1e-6, 0.02),
    seed=0,
    more="",
    deflected=0.0,
):
    """Files of a bench that imposes motions and has some effects; returns the path of measured.toml.

    ``deflected``: share of their largest deflection that bristles have where each record begins.
    """
    rng = np.random.default_rng(seed)
    config = parse(model, "model")
    values = merge(config.effects, effects or {})
    record = config.record_with(values, config.case_list()[0].law, 0.0)
    sign, place = (1.0, BESIDE) if config.system == "oscillator" else (-1.0, 0.0)
    tests = {}
    for i, each in enumerate(motions):
        fine = motion_of(*each)
        force = imposed_motion.forces(record, *(sign * fine), 1.0 / RATE / CELLS, deflected)[0]
        n = force.size // CELLS
        x = fine[0].reshape(n, CELLS).mean(1) + place + noise[0] * rng.standard_normal(n)
        force = force.reshape(n, CELLS).mean(1) + noise[1] * rng.standard_normal(n) + ZERO
        tests[f"loop{i}"] = (np.arange(n) / RATE, 1e3 * x, force), LOOP
    return saved(folder, model, HEAD + PLACE + FORCE + more, "t,x,F", tests)


# Force (N) at which a friction damper slips, stiffness (N/mm) in series with it, and noise (N) of its force.
SLIPS, STIFF, FORCE_NOISE = 28.0, 15.0, 0.15


def earthquake(folder, left_over=0.0):
    """Files of an elastic friction damper in an earthquake; returns the path of measured.toml.

    Strokes that do not slip keep what was built up; ``left_over``: force (N) where the record begins.
    """
    rng, rate, samples = np.random.default_rng(4), 100.0, 2000
    t, frequency = np.arange(samples) / rate, np.fft.rfftfreq(samples, 1.0 / rate)
    passed = (frequency > 0.3) & (frequency < 2.0)
    x = np.fft.irfft(passed * np.exp(2j * np.pi * rng.random(frequency.size)), samples)
    x *= np.minimum(t / 4.0, 1.0)
    x *= 15.0 / np.abs(x).max()
    force, built_up = np.empty(samples), left_over
    for i, step in enumerate(np.diff(x, prepend=x[0])):
        force[i] = built_up = np.clip(built_up + STIFF * step, -SLIPS, SLIPS)
    noisy = [each + s * rng.standard_normal(samples) for each, s in ((x, 4e-3), (force, FORCE_NOISE))]
    model = oscillator(mass_kg=1e-3, spring_N_per_mm=0.0, normal_force_N=0.0)
    return saved(folder, model, HEAD + PLACE + FORCE, "t,x,F", {"one": ((t, *noisy), LOOP)})


def test_noise_of_an_elastic_friction_damper_in_an_earthquake_is_that_of_its_force(tmp_path):
    (found,) = loop_data(read(earthquake(tmp_path, -SLIPS))).recordings
    assert 1.0 < found.noise / found.low_pass.noise(FORCE_NOISE) < 3.0


def test_noise_of_the_displacement_reaches_bristles_by_their_stiffness(tmp_path):
    """Errors of the simulated force are those that noise makes, drawn many times."""
    values, std = {"presliding": {"length": 5e-3}}, 1e-5
    light = oscillator(mass_kg=1e-3, spring_N_per_mm=0.0, normal_force_N=10.0)
    path = write(tmp_path, light, values, ((0.01, 1.1, 6.0),), (std, 0.02))
    own = loop_data(read(path)).recordings[0]
    zeros, rng = np.zeros((1, len(own.blocks))), np.random.default_rng(3)
    told = np.sqrt(own.with_noise_of_motion(values, zeros[0]).passed_on[0])
    noisy = own.motion.displacement + std * rng.standard_normal((30, own.motion.displacement.size))
    moved = [replace(own, motion=motion(each, std, own.low_pass)) for each in noisy]
    found = np.std([each.simulated([values], zeros)[0] for each in moved], axis=0)
    assert 0.8 < np.median(told / found) < 1.25


@pytest.mark.acceptance
@pytest.mark.parametrize("left_over", [0.0, -SLIPS])
def test_an_elastic_friction_damper_is_named_in_an_earthquake(tmp_path, left_over):
    others = ("guide_friction", "viscous_damping", "series_compliance")
    found = diagnosed(earthquake(tmp_path, left_over), ("maxwell_presliding", *others))
    assert (found.verdict, [each["effect"] for each in found.causes]) == ("named", ["maxwell_presliding"])
    numbers = {key: each["value"] for key, each in found.causes[0]["parameters"].items()}
    assert numbers["force_N"] == pytest.approx(SLIPS, rel=2e-3)
    assert numbers["stiffness_N_per_mm"] == pytest.approx(STIFF, rel=5e-3)


def test_noise_of_a_filter_and_of_derivatives():
    rng = np.random.default_rng(0)
    rate, std = 1000.0, 1e-6
    low_pass = LowPass(40.0, rate)
    noise = std * rng.standard_normal(200_000)
    found = low_pass(motion(noise, std, low_pass).acceleration)[100:-100].std()
    assert low_pass.noise(std, 2) == pytest.approx(found, rel=0.05)
    assert motion(noise, std, low_pass).noise[1] == pytest.approx(
        motion(noise, std, low_pass).velocity[100:-100].std(), rel=0.05
    )
    assert low_pass.noise(std) == pytest.approx(low_pass(noise)[100:-100].std(), rel=0.05)
    # Neither a motion whose acceleration jumps twice a cycle nor a hum is noise.
    angle = 2.0 * np.pi * 1.1 * np.arange(200_000) / rate
    moving = np.pi * np.abs(angle / np.pi % 2.0 - 1.0) + 1e-3 * np.sin(300.0 * angle)
    assert white_noise(1e-3 * moving + noise) == pytest.approx(std, rel=0.05)
    # Dry friction jumps twice a cycle: that is no noise of the force.
    assert white_noise(continuous(5.0 * np.sign(np.sin(angle)) + noise)) == pytest.approx(std, rel=0.05)


@pytest.mark.parametrize("order", [1, 2])
def test_derivatives_of_a_sine_are_right_at_twenty_samples_a_period(order):
    rate, omega = 100.0, 10.0 * np.pi
    angle = omega * np.arange(400) / rate
    exact = omega**order * np.sin(angle + 0.5 * np.pi * order)
    assert derivative(np.sin(angle), rate, order)[10:-10] == pytest.approx(
        exact[10:-10], abs=1e-4 * omega**order
    )


def test_the_cutoff_is_where_the_noise_of_the_inertia_is_small():
    cutoff = highest_cutoff(1e-6, 3.0, 2.0, 1000.0)
    assert 2.0 * LowPass(cutoff, 1000.0).noise(1e-6, 2) == pytest.approx(0.005 * 3.0, rel=1e-2)
    assert highest_cutoff(1e-12, 3.0, 2.0, 1000.0) == 200.0


@pytest.mark.parametrize("hum", [0.0, 5e-5])
def test_the_cutoff_leaves_little_noise_of_the_velocity_and_passes_the_motion(hum):
    rate, std, omega = 300.0, 2e-5, 2.0 * np.pi * 1.7
    t = np.arange(3000) / rate
    x = 0.02 * (np.sin(omega * t) + 0.1 * np.sin(3.0 * omega * t)) + hum * np.sin(2.0 * np.pi * 50.0 * t)
    x += std * np.random.default_rng(0).normal(size=t.size)
    cutoff = chosen_cutoff(x, std, 100.0, 1e-3, rate)
    speed = float(np.gradient(x, t).std())
    assert LowPass(cutoff, rate).noise(std, 1) <= 0.0055 * speed
    assert 3.0 * 1.7 < cutoff < 40.0


# A damper makes more force of the noise of the motion than inertia does.
DAMPER = OSCILLATOR.replace("damping_N_s_per_m = 3.0", "damping_N_s_per_m = 3000.0")
WEDGE = '[sweep]\nfriction_law = "coulomb"\nbeta = [1.0]\namplitude_mm = [0.1]\n'
DROPS = OSCILLATOR.replace("static = 0.3", "static = 0.36")
# Model, law, motions, and noise of displacement (m) and force (N): clean, with much noise of either.
TRUTHS = {
    "oscillator, clean": (DROPS, "static-dynamic", ((0.01, 1.1, 12.0),), (1e-6, 0.02)),
    "oscillator, noisy motion": (DROPS, "exponential", ((0.01, 1.1, 40.0),), (1e-4, 0.02)),
    "damper": (DAMPER, "coulomb", ((0.01, 1.1, 12.0),), (5e-6, 0.02)),
    "wedge, noisy motion": (WEDGE, "static-dynamic", ((2e-4, 1.5, 10.0),), (1e-6, 0.01)),
    "wedge, noisy force": (WEDGE, "exponential", ((2e-4, 1.5, 10.0),), (1e-6, 0.1)),
}


@pytest.mark.few(1)
@pytest.mark.parametrize("bench", TRUTHS)
def test_misfit_of_the_true_model_is_noise(tmp_path, bench):
    model, law, motions, noise = TRUTHS[bench]
    model = model.replace('"coulomb"', f'"{law}"')
    fits = []
    for seed in range(4):
        (tmp_path / str(seed)).mkdir()
        data = loop_data(read(write(tmp_path / str(seed), model, motions=motions, noise=noise, seed=seed)))
        assert data.recordings[0].known.mean() > 0.75  # reversals are compared, too
        fits.append(base_fit(Search.of(data, [])).base)
    # The noise that is assumed is the upper end of its interval.
    assert 0.8 < np.mean([fit.chi2 / fit.dof for fit in fits]) < 1.1
    assert min(fit.p for fit in fits) > POSSIBLE


@pytest.mark.acceptance
def test_an_effect_of_a_few_times_the_noise_is_found(tmp_path):
    weak = {"friction_level": {"scale": 1.02}}
    path = write(tmp_path, WEDGE, weak, motions=((2e-4, 1.5, 10.0),), noise=(1e-6, 0.01))
    data = loop_data(read(path))
    fit = base_fit(Search.of(data, [])).base
    left = float(np.sqrt((fit.evaluation.residual**2).sum() / data.weight.sum()))
    assert left < 7.0  # of the noise
    found = diagnosed(path, ("preload", "bolster_stiffness", "presliding", *weak))
    assert found.verdict in ("named", "consistent-with")
    is_told(found, weak, 0.05)


@pytest.mark.acceptance
def test_bristles_are_found_that_turn_over_within_a_sample(tmp_path):
    # Around a reversal the motion goes 2e-7 m in a sample. Nobody knows how the bristles begin.
    effects, motions = {"presliding": {"length": 3e-7}}, ((2e-4, 1.5, 10.0),)
    path = write(tmp_path, WEDGE, effects, motions, (1e-9, 0.003), deflected=-0.9)
    found = diagnosed(path, ("presliding", "friction_level"))
    assert found.verdict == "named"
    is_told(found, effects, 0.02)


def test_a_motion_that_is_no_faster_than_its_noise_is_refused(tmp_path):
    path = write(tmp_path, WEDGE, motions=((1e-5, 1.5, 20.0),), noise=(1e-4, 0.01))
    with pytest.raises(InputError, match=r"\.csv: its motion is no faster than its noise"):
        loop_data(read(path))


@pytest.mark.acceptance
def test_an_error_of_a_reversal_is_an_error_of_the_force(tmp_path):
    """Covariance of what noise of the motion makes of the force, against what it made in 100 records."""
    data = loop_data(read(write(tmp_path, noise=(2e-5, 0.02))))
    own, rng = data.recordings[0], np.random.default_rng(1)
    zeros = np.zeros((1, len(own.blocks)))
    exact = own.simulated([{}], zeros)[0]
    errors = []
    for _ in range(100):
        noise = own.noise_of_displacement * rng.standard_normal(own.motion.velocity.size)
        moved = motion(own.motion.displacement + noise, 0.0, own.low_pass)
        errors.append(replace(own, motion=moved).simulated([{}], zeros)[0] - exact)
    inner = np.arange(5, own.places.size - 5)
    found = np.mean(np.square(errors), axis=0)[inner]
    known = motion_noise.covariance(
        own.low_pass, own.places, own.noise_of_displacement, own._derivatives({}, zeros)
    )
    turns = np.abs(own.motion.velocity[own.places][inner]) < 0.1 * np.abs(own.motion.velocity).max()
    assert found[turns].mean() > 3.0 * found[~turns].mean()
    for some in (turns, ~turns):
        assert np.sqrt(found[some].mean() / known[0][inner][some].mean()) == pytest.approx(1.0, abs=0.3)


def test_blocks_are_whole_cycles(tmp_path):
    data = loop_data(read(write(tmp_path)))
    assert data.tests == len(data.names) > 3
    for (number, block), weight in zip(data.chosen, data.weight, strict=True):
        own = data.recordings[number]
        velocity = own.motion.velocity[own.places][own.blocks[block]]
        assert (velocity > 0.0).any()
        assert (velocity < 0.0).any()
        assert 0.5 < weight.mean() <= 1.0
    covered = sorted((own.start, own.stop) for own in data.recordings[0].blocks)
    assert covered[0][0] == 0
    assert all(first[1] == second[0] for first, second in pairwise(covered))
    assert covered[-1][1] == data.recordings[0].places.size


@pytest.mark.filterwarnings("error")
def test_a_loop_that_rests_all_along_says_nothing(tmp_path):
    """As one of those that are considered as a next test."""
    data = loop_data(read(write(tmp_path)))
    resting = [replace(own, known=np.zeros(own.known.shape, bool)) for own in data.recordings]
    data = replace(data, recordings=tuple(resting))
    assert not data.size.any()
    assert not data.zero(data.padded([own.force for own in data.recordings])).any()


def test_nothing_is_missing_where_nothing_is(tmp_path):
    found = diagnosed(write(tmp_path), ["viscous_damping", "friction_level"])
    assert found.verdict == "nothing-missing"
    assert found.document["kind"] == "loop"
    assert found.document["next_test"] is None


HIDDEN = {
    "stribeck": {"peak": 0.3, "velocity": 0.02},
    "presliding": {"length": 2e-3},
    "viscous_damping": {"coefficient": 6.0},
    "cubic_stiffness": {"coefficient": 4e5},
}


@pytest.mark.few(1)
@pytest.mark.parametrize("effect", ["stribeck", "presliding"])
def test_a_hidden_effect_is_found(tmp_path, effect):
    path = write(tmp_path, effects={effect: HIDDEN[effect]})
    found = diagnosed(path, [*HIDDEN, "friction_level"])
    assert found.verdict in ("named", "tied")
    assert found.gain["scheme"] == "leave-one-block-out"
    assert found.gain["excess_removed"] > 0.95
    is_told(found, {effect: HIDDEN[effect]}, 0.1)


# A damper, and what may be missing of it: SI numbers, and neighbours that they are confounded with.
STRUT = DAMPER.replace("normal_force_N = 10.0", "normal_force_N = 200.0")
OF_DAMPERS = {
    "series_compliance": {"stiffness": 1e5, "coefficient": 500.0},
    "degressive_damping": {"coefficient": 8e3, "velocity": 0.02, "asymmetry": 0.3},
    "asymmetric_spring": {"asymmetry": 0.3},
    "position_friction": {
        **{"share": 0.5, "share_phase": 0.5, "wavelength": 0.04},
        **{"second": 0.3, "second_phase": -1.0},
    },
    "maxwell_presliding": {"force": 100.0, "stiffness": 1e5, "spread": 1.5},
}
NEIGHBOURS = (
    *("friction_level", "viscous_damping", "directional_damping", "quadratic_drag", "damper_play"),
    *("directional_friction", "presliding", "bolster_stiffness", "cubic_stiffness", "backlash"),
)


# ``make validate`` hides each of them (campaign damper).
@pytest.mark.acceptance
@pytest.mark.parametrize("effect", ["degressive_damping", "position_friction", "maxwell_presliding"])
def test_what_is_missing_of_a_damper_is_found_among_its_neighbours(tmp_path, effect):
    hidden = {effect: OF_DAMPERS[effect]}
    found = diagnosed(
        write(tmp_path, STRUT, hidden, motions=((0.01, 1.1, 6.0),), noise=(1e-6, 0.5)),
        [*OF_DAMPERS, *NEIGHBOURS],
    )
    assert found.verdict == "named"
    is_told(found, hidden, 0.03)


@pytest.mark.acceptance
@pytest.mark.parametrize("effect", [{"presliding": {"length": 5e-4}}, {}], ids=["elastic", "rigid"])
def test_friction_that_the_model_lacks_may_be_elastic(tmp_path, effect):
    smooth = OSCILLATOR.replace("normal_force_N = 10.0", "normal_force_N = 0.0")
    hidden = {"guide_friction": {"force": 3.0}} | effect
    path = write(tmp_path, smooth, hidden, motions=((0.01, 1.1, 6.0), (0.004, 0.7, 6.0)))
    found = diagnosed(path, ["guide_friction", "presliding", "viscous_damping"])
    told = {cause["effect"]: cause["parameters"].values() for cause in found.causes}
    expected = {"guide_friction": 3.0, "presliding": 0.5}
    assert set(told) == set(hidden)
    for name, (number,) in told.items():
        assert number["value"] == pytest.approx(expected[name], rel=0.03)


@pytest.mark.parametrize(
    "bristles",
    [
        {"presliding": {"length": 1e-4}},
        pytest.param(
            {"maxwell_presliding": {"force": 3.0, "stiffness": 1e4, "spread": 1.0}},
            marks=pytest.mark.acceptance,  # code of its own is compiled for a quarter of a minute
        ),
    ],
    ids=lambda bristles: next(iter(bristles)),
)
def test_a_record_may_begin_with_a_reversal(tmp_path, bristles):
    """The force of bristles is known all along, although that before the first sample is not."""
    path = write(tmp_path, noise=(1e-9, 0.02), motions=((0.01, 1.1, 6.0),))
    header, *lines = (tmp_path / "loop0.csv").read_text().splitlines()
    last = int(np.argmax([float(line.split(",")[1]) for line in lines[:1500]]))
    for first in range(last - 2, last + 2):
        (tmp_path / "loop0.csv").write_text("\n".join([header, *lines[first:]]))
        own = loop_data(read(path)).recordings[0]
        assert np.isfinite(own.simulated([bristles], np.zeros((1, len(own.blocks))))).all()


@pytest.mark.parametrize(("samples", "lost"), [(1, False), (40, True)])
def test_a_force_is_lost_where_a_face_lifts_off_not_where_noise_touches_zero(tmp_path, samples, lost):
    own = loop_data(read(write(tmp_path, motions=((0.01, 1.1, 6.0),)))).recordings[0]
    force = np.full((1, own.motion.velocity.size), 7.0)
    force[0, 1000 : 1000 + samples] = np.nan
    found = own._compared(force)[0]
    assert np.isnan(found).any() == lost
    assert found[np.isfinite(found)] == pytest.approx(7.0, rel=1e-3)


def test_strokes_in_one_direction_are_loops(tmp_path):
    path = write(tmp_path)
    header, *lines = (tmp_path / "loop0.csv").read_text().splitlines()
    rows = np.array([line.split(",") for line in lines], float)
    first = int(rows[:, 1].argmin())
    last = first + int(rows[first : first + round(RATE / 1.1), 1].argmax())
    stroke = [",".join(map(str, row)) for row in rows[first:last]]
    (tmp_path / "loop0.csv").write_text("\n".join([header, *stroke]))
    assert "goes one way only" in invoke("check", path)


def test_a_force_of_noise_alone_is_refused(tmp_path):
    path = write(tmp_path)
    header, *lines = (tmp_path / "loop0.csv").read_text().splitlines()
    random = np.random.default_rng(0)
    noise = [f"{line.rpartition(',')[0]},{random.normal():.4f}" for line in lines]
    (tmp_path / "loop0.csv").write_text("\n".join([header, *noise]))
    with pytest.raises(InputError, match=r"its noise is \d+ % of the force"):
        loop_data(read(path))


FAULTS = {
    "amplitude": ('kind = "loop"\namplitude_mm = 1.0', "not for kind = .loop."),
    "cut-off": ('kind = "loop"\nlowpass_hz = 300.0', "times the sampling rate"),
}


@pytest.mark.parametrize("fault", FAULTS)
def test_what_is_wrong_is_told(tmp_path, fault):
    path = write(tmp_path)
    written, told = FAULTS[fault]
    path.write_text(path.read_text().replace('kind = "loop"', written))
    with pytest.raises(MeasuredError, match=told):
        read(path)


def test_a_jump_may_be_in_the_sample_before_it_or_after_it():
    """Errors of its time reach both alike: the compared forces do not know which sample was off."""
    low_pass, places = LowPass(50.0, 500.0), np.arange(41, 161)
    jumps = np.zeros(201)
    jumps[100] = 1.0  # between the samples 100 and 101
    nothing = (np.zeros(201),) * 3
    variance = motion_noise.covariance(low_pass, places, 0.0, motion_noise.Derivatives(nothing, jumps))[0]
    assert variance == pytest.approx(variance[::-1], abs=1e-12)
    assert variance.argmax() in (59, 60)


@pytest.mark.acceptance
def test_a_cause_whose_size_differs_from_record_to_record_is_told_with_each_size(tmp_path):
    forces, path = (2.0, 4.0), tmp_path / "measured.toml"
    text, model = HEAD + PLACE + FORCE, OSCILLATOR.replace("normal_force_N = 10.0", "normal_force_N = 0.0")
    for i, force in enumerate(forces):
        folder = tmp_path / str(i)
        folder.mkdir()
        write(folder, model, effects={"guide_friction": {"force": force}}, seed=i)
        text += TEST.format(f"{i}/loop0") + LOOP
    path.write_text(text)
    (tmp_path / "model.toml").write_text(model)
    found = diagnosed(path, ["guide_friction", "viscous_damping"])
    assert found.verdict == "none-of-mine"
    first, *_ = found.document["record_by_record"]
    assert first["effects"] == ["guide_friction"]
    assert first["accuracy"] < 0.1 * found.document["ladder"][1]["accuracy"]
    for own, force in zip(first["records"], forces, strict=True):
        low, high = own["parameters"]["guide_friction.force_N"]["ci95"]
        assert low < force < high
        assert high - low < 0.2
    assert "force 2, 4\N{NO-BREAK SPACE}N" in sentence(found)
