"""Sweeps whose input does not repeat: config, dataset, resuming, figures."""

import re
from functools import cache

import numpy as np
import pytest
import xarray as xr

from tests.command import invoke
from tests.small_sweep import faults
from wedgesweep import config, figures
from wedgesweep.config.physics import physics
from wedgesweep.figures.transient import loop, ring_down
from wedgesweep.sweep.run import Sweep

HEAD = """\
[oscillator]
mass_kg = 2.0
spring_N_per_mm = 0.8
normal_force_N = 4.0
"""
TAIL = """
[friction]
dynamic = 0.5
static = 0.6
[sweep]
friction_law = ["coulomb", "static-dynamic"]
scale = [0.5, 1.0, 2.0]
[solver]
method = "event-driven"
rtol = 1e-8
"""
RELEASE = """
[input]
kind = "release"
displacement_mm = 30.0
duration_s = 1.5
"""
RECORD = """
[input]
kind = "record"
file = "bump.csv"
column = "base"
unit = "mm"
time = "t"
"""
SWEPT = """
[input]
kind = "sine-sweep"
amplitude_m_per_s2 = 4.0
start_hz = 1.0
stop_hz = 6.0
duration_s = 4.0
fade_s = 0.2
"""
RANDOM = '[input]\nkind = "random"\nrms_N = 1.0\nduration_s = 2.0\n'


@pytest.fixture
def folder(tmp_path, monkeypatch):
    """A working directory with configs of some kinds, and a recorded bump."""
    monkeypatch.chdir(tmp_path)
    t = np.arange(200) * 0.005
    rows = "".join(f"{a:.3f},{5.0 + 3.0 * np.sin(np.pi * min(a / 0.3, 1.0)) ** 2:.9f}\n" for a in t)
    (tmp_path / "bump.csv").write_text("t,base\n" + rows)
    for name, given in (("release", RELEASE), ("record", RECORD), ("swept", SWEPT)):
        (tmp_path / f"{name}.toml").write_text(HEAD + given + TAIL)
    return tmp_path


@cache
def ran(given):
    """The dataset of the sweep with this input."""
    return Sweep(config.parse(HEAD + given + TAIL), None).run_here()


def test_a_recorded_input_is_found_beside_its_config_and_counts_from_its_first_sample(folder, monkeypatch):
    (folder / "elsewhere").mkdir()
    monkeypatch.chdir(folder / "elsewhere")
    assert "6 ok" in invoke("run", "../record.toml", "--n-jobs", 1)
    ds = xr.load_dataset("record.nc")
    assert ds.sizes == {"friction_law": 2, "scale": 3, "time": 199}
    assert ds["time"].values == pytest.approx(np.arange(199) * 0.005)
    assert ds["input"].values[:60] == pytest.approx(3e-3 * np.sin(np.pi * np.arange(60) / 60) ** 2, abs=1e-10)
    assert ds["input"].attrs["units"] == "m"
    peaks = ds["peak_displacement"].values
    assert np.abs(ds["displacement"]).max("time").values == pytest.approx(peaks, rel=1e-2)
    # Friction of 2 N holds 2 kg on all but the largest bump.
    assert peaks[0, :2] == pytest.approx(0.0, abs=1e-15)
    assert (peaks[:, 2] > 1e-4).all()


def test_a_file_that_changed_is_another_sweep(folder):
    invoke("run", "record.toml", "--n-jobs", 1)
    assert "already complete" in invoke("run", "record.toml")
    text = (folder / "bump.csv").read_text()
    (folder / "bump.csv").write_text(text.replace("0.995,5.0", "0.995,5.1"))
    assert "input.sha256" in invoke("run", "record.toml", code=2)
    found = config.parse(xr.load_dataset("record.nc").attrs["config"])
    with pytest.raises(config.ConfigError, match="has changed"):
        _ = found.input


def test_the_work_of_friction_is_the_energy_that_is_lost():
    ds = ran(RELEASE)
    start = 0.5 * 800.0 * (0.03 * ds["scale"]) ** 2
    left = 0.5 * 800.0 * ds["displacement"][..., -1] ** 2 + 0.5 * 2.0 * ds["velocity"][..., -1] ** 2
    assert ds["dissipated_energy"].values == pytest.approx(
        (start - left).transpose(*ds["dissipated_energy"].dims).values, rel=0.02
    )
    x, force = ds["displacement"].sel(scale=2.0), ds["force"].sel(scale=2.0)
    for law in ("coulomb", "static-dynamic"):
        motion, resistance = x.sel(friction_law=law).values, force.sel(friction_law=law).values
        cycle = loop.largest_cycle(motion)
        travel = np.abs(np.diff(motion[cycle])).sum()
        # Friction is 2 N; the cycle is not closed, as the motion decays.
        work = loop.area(motion[cycle], resistance[cycle])
        assert work == pytest.approx(2.0 * travel, rel=0.15)


@pytest.mark.acceptance
def test_the_force_is_that_of_spring_and_friction_whatever_shakes_the_base(folder):
    tone = "[effects.stray_vibration]\nacceleration_m_per_s2 = 3.0\nfrequency_hz = 9.0\n"
    gain = "[effects.input_gain]\nscale = 1.5\n"
    (folder / "shaken.toml").write_text(HEAD + SWEPT + TAIL + tone + gain)
    ds = Sweep(config.load("shaken.toml"), folder / "a.nc").run_here()
    friction = ds["force"] - 800.0 * ds["displacement"]
    # Coulomb and static friction are 2 N and 2.4 N; ten times as much would be left of the tone.
    assert float(np.abs(friction.sel(friction_law="coulomb")).max()) < 2.0 * 1.02
    assert float(np.abs(friction.sel(friction_law="static-dynamic")).max()) < 2.4 * 1.02
    yielding = "[effects.column_compliance]\nstiffness_N_per_mm = 50.0\n"
    (folder / "yielding.toml").write_text(SWEPT.replace("4.0\nstart", "1.0\nstart") + TAIL + yielding)
    assert Sweep(config.load("yielding.toml"), folder / "b.nc").run_here()["force"].isnull().all()


def test_an_exported_row_has_its_scale(folder):
    ran(RELEASE).to_netcdf(folder / "whole.nc")
    invoke("export", "whole.nc", "-o", "out.csv", "--variables", "peak_displacement")
    table = np.genfromtxt("out.csv", delimiter=",", names=True, dtype=None, encoding="utf-8")
    assert table["scale"].tolist() == [0.5, 1.0, 2.0] * 2
    assert "a waveform of" in invoke(
        "export", "whole.nc", "-o", "b.csv", "--variables", "displacement", code=2
    )
    assert "beta: no such variable" in invoke(
        "export", "whole.nc", "-o", "b.csv", "--variables", "beta", code=2
    )


def test_a_release_at_rest_on_a_belt_is_measured_by_the_motion_on_the_belt():
    text = HEAD + 'contact = "belt"\nbelt_velocity_mm_per_s = 10.0\n' + RELEASE + TAIL
    given = config.parse(text.replace("displacement_mm = 30.0", "displacement_mm = 0.0"))
    assert given.solver.transient.length == pytest.approx(0.01 / 20.0)


def test_peaks_of_a_decay_fall_by_four_friction_over_stiffness():
    ds = ran(RELEASE)
    assert ds.attrs["friction_decay_per_cycle"] == pytest.approx(4.0 * 2.0 / 800.0)
    case = ds.sel(friction_law="coulomb", scale=2.0)
    _, peaks = ring_down.peaks(case["time"].values, case["displacement"].values)
    assert np.abs(peaks[:5]) == pytest.approx(0.06 - 0.005 * np.arange(1, 6), abs=2e-5)
    assert ring_down.decrement(np.array([4.0, -3.0, 2.0]))[0] == pytest.approx(np.log(2.0))
    # Where friction is not constant there is no such decay.
    text = (HEAD + RELEASE + TAIL).replace("[sweep]", "[effects.ageing]\nrate = 0.02\ntime_s = 0.1\n[sweep]")
    assert np.isnan(physics(config.parse(text))["friction_decay_per_cycle"])


@pytest.mark.few(3)
@pytest.mark.parametrize("kind", sorted(figures.transient.FIGURES))
@pytest.mark.parametrize("given", [RELEASE, SWEPT], ids=["release", "swept"])
def test_every_figure_draws_and_has_units(kind, given):
    ds = ran(given)
    if (kind, given) == ("backbone", SWEPT):
        with pytest.raises(ValueError, match="an input drives the motion"):
            figures.draw(ds, kind)
        return
    figure = figures.draw(ds, kind)
    figure.draw_without_rendering()
    labels = [text for ax in figure.axes for text in (ax.get_xlabel(), ax.get_ylabel()) if text]
    assert figure.get_suptitle()
    assert len(labels) >= 2
    assert all("[" in text for text in labels)
    figures.draw(ds.sel(scale=1.0, friction_law="coulomb"), kind).draw_without_rendering()


@pytest.mark.usefixtures("empty_pictures")
def test_figures_of_sines_are_not_offered(folder):
    invoke("run", "swept.toml", "--n-jobs", 1)
    told = invoke("plot", "all", "swept.nc", "-o", "drawn")
    assert told.count("wrote") == 4
    assert "there are backbone, envelope, loop, ring-down, lines, map" in invoke(
        "plot", "stick-map", "swept.nc", code=2
    )
    assert "the dataset has no beta" in invoke("plot", "loop", "swept.nc", "--beta", "1", code=2)
    assert "6 = 2 friction laws x 3 scales" in invoke("check", "swept.toml")


@pytest.mark.parametrize(
    ("old", "new", "told"),
    [
        ('kind = "sine-sweep"', 'kind = "chirp"', 'input.kind: unknown name "chirp"'),
        ('kind = "sine-sweep"', "", "input.kind: missing; valid here: sine-sweep, random, record"),
        ("start_hz = 1.0", "start_hz = -1.0", "input.start_hz: -1.0 is out of range"),
        ("start_hz = 1.0", "start = 1.0", 'input.start: unknown key; did you mean "start_hz"?'),
        ("fade_s = 0.2", "fade_s = 3.0", "input.fade_s: 3 is more than half of duration_s"),
        ("duration_s = 4.0", "duration_s = 1e8", "input.duration_s: 1e+08 s with frequencies up to 6 Hz"),
        ("fade_s = 0.2", "sampling_hz = 1e9", "input.sampling_hz: more than 2e+07 samples"),
        ("amplitude_m_per_s2 = 4.0", "", "input.amplitude_mm: missing; write amplitude_mm"),
        ("scale = [0.5, 1.0, 2.0]", "beta = 1.0", "sweep.beta: no key of a [sweep] beside an [input]"),
        ("scale = [0.5, 1.0, 2.0]", "scale = 0.0", "sweep.scale: 0.0 is out of range"),
        ("rtol = 1e-8", 'settle = "steady"', "solver.settle: an [input] does not repeat; remove it"),
        (HEAD, "", None),
        (HEAD + SWEPT, RANDOM + "start_hz = 1.0\nstop_hz = 4.0\n", "driven by its side frame"),
        ("[friction]", "[effects.input_distortion]\nsecond = 0.1\n[friction]", "belongs to a sine"),
    ],
)
def test_faults_of_a_swept_sine_are_told(old, new, told):
    text = (HEAD + SWEPT + TAIL).replace(old, new)
    if told is None:
        assert config.parse(text).transient
        return
    assert told in "\n".join(faults(text))


@pytest.mark.parametrize(
    ("given", "told"),
    [
        (RANDOM, "input.start_hz: missing; write start_hz and stop_hz, or frequency_hz and level"),
        (RANDOM + "start_hz = 5.0", "input.stop_hz: missing; write start_hz and stop_hz"),
        (RANDOM + "frequency_hz = [5.0]", "input.level: missing; write start_hz and stop_hz"),
        (RANDOM + "frequency_hz = [5.0]\nlevel = [1.0]", "input.frequency_hz: a single one has no band"),
        (RANDOM + "start_hz = 5.0\nstop_hz = 2.0", "input.stop_hz: 2 is not above 5"),
        (RANDOM + "start_hz = 1.1\nstop_hz = 1.2", "holds no multiple of 1/duration_s"),
        (RANDOM + "start_hz = 1\nstop_hz = 2\nlevel = [1.0]", "a band and a table exclude each other"),
        (RANDOM + "frequency_hz = [1.0, 2.0]\nlevel = [1.0]", "input.level: 1 level for 2 frequencies"),
        (RANDOM + "frequency_hz = [1.0, 2.0]\nlevel = [-1.0, 2.0]", "input.level[0]: -1.0 is out of range"),
        (
            RANDOM + "frequency_hz = [1.0, -2.0]\nlevel = [1.0, 2.0]",
            "input.frequency_hz[1]: -2.0 is out of range",
        ),
        (RELEASE.replace("30.0", "0.0"), "0 without a velocity is rest"),
        (
            '[input]\nkind = "ramp"\nvelocity_mm_per_s = 1.0\nduration_s = 1.0',
            "moves nothing that rubs on it",
        ),
        (RECORD.replace('"mm"', '"N"'), "input.unit: N is no unit of displacement; valid here: m, mm, um"),
    ],
)
def test_faults_of_other_kinds_are_told(given, told):
    (fault,) = faults(HEAD + given + TAIL)
    assert told in fault


@pytest.mark.parametrize(
    ("name", "text", "told"),
    [
        ("missing.csv", None, "missing.csv: No such file"),
        ("one.csv", "t,base\n0.0,1.0\n", "holds 1 samples"),
        ("uneven.csv", "t,base\n0.0,1.0\n0.1,2.0\n0.3,1.0\n", "not sampled at an even rate"),
        ("other.csv", "t,table\n0.0,1.0\n0.1,2.0\n", "base"),
        ("words.csv", "t,base\n0.0,one\n0.1,2.0\n", "words.csv:2"),
    ],
)
def test_faults_of_a_recorded_input_are_told(tmp_path, name, text, told):
    if text is not None:
        (tmp_path / name).write_text(text)
    (tmp_path / "a.toml").write_text(HEAD + RECORD.replace("bump.csv", name) + TAIL)
    with pytest.raises(config.ConfigError, match=re.escape(told)):
        config.load(tmp_path / "a.toml")


def test_a_case_of_a_sine_and_a_check_by_radau_are_refused(folder):
    told = invoke("case", "swept.toml", "--beta", "1", "--amplitude", "1", code=2)
    assert "remove [input]" in told
    assert "--verify" in invoke("run", "swept.toml", "--verify", "2", code=2)


def test_the_template_shows_all_kinds_of_inputs_and_a_config_with_one_reads_back(folder):
    text = config.template()
    for name, kind in config.inputs.KINDS.items():
        assert f'kind = "{name}"' in text
        assert all(f"# {key} = " in text for key in kind.keys)
    assert config.inputs.SCALE.key in text
    for name in ("release", "record", "swept"):
        read = config.load(f"{name}.toml")
        assert config.parse(read.to_toml()) == read
    # Units are read in any spelling, and written in one.
    for unit in ("m/s^2", "m/s2", "m/s²"):
        given = RECORD.replace('"mm"', f'"{unit}"\nquantity = "acceleration"')
        found = config.parse(HEAD + given + TAIL, directory=folder)
        assert 'unit = "m/s^2"' in found.to_toml()
        assert found.input.given.max() == pytest.approx(8.0)


AXES = "[sweep.axes]\ninput.start_hz = [1.0, 2.0]\ninput.stop_hz = [4.0, 6.0]\n"


def of_band(start, stop):
    """A sweep like that of the axes, of one band."""
    own = SWEPT.replace("start_hz = 1.0", f"start_hz = {start}").replace("stop_hz = 6.0", f"stop_hz = {stop}")
    rate = "sampling_hz = 192.0\n"  # what the highest frequency of the axes needs
    return Sweep(config.parse(HEAD + own + rate + TAIL), None).run_here()


def test_each_case_of_a_varied_input_is_that_of_its_own_config(tmp_path):
    given = SWEPT.replace("stop_hz = 6.0", "stop_hz = 4.0")
    made = Sweep(config.parse(HEAD + given + TAIL.replace("[solver]", f"{AXES}[solver]")), tmp_path / "a.nc")
    ds = made.run(n_jobs=1)
    assert ds["input"].dims == ds["input_frequency"].dims == ("input_start_hz", "input_stop_hz", "time")
    assert ds["input_start_hz"].attrs["units"] == "Hz"
    assert np.array_equal(made.run_here()["displacement"].values, ds["displacement"].values)
    for start, stop in ((1.0, 4.0), (2.0, 6.0)):
        here, alone = ds.sel(input_start_hz=start, input_stop_hz=stop), of_band(start, stop)
        for name in ("displacement", "dissipated_energy", "input", "input_frequency"):
            assert np.array_equal(here[name].values, alone[name].values), name
    grown = Sweep(config.parse(made.config.to_toml().replace("[4.0, 6.0]", "[4.0, 5.0, 6.0]")), made.out)
    parts = []
    grown.run(n_jobs=1, progress=lambda records, total: parts.append(len(records)))
    assert (parts[0], sum(parts)) == (24, 36)
    figures.draw(xr.load_dataset(made.out), "envelope", at={"input.start_hz": 2.0}).draw_without_rendering()
    figures.draw(xr.load_dataset(made.out), "map", variable="peak_velocity").draw_without_rendering()


@pytest.mark.parametrize(
    ("axis", "told"),
    [
        ("input.duration_s = [1.0, 2.0]", "share their times"),
        ("input.rms_mm = [1.0, 2.0]", "input.rms_mm: unknown key"),
        ("input.amplitude_mm = [1.0, 2.0]", "exclude each other"),
        ("input.fade_s = [0.1, 3.0]", "input.fade_s = 3: input.fade_s: 3 is more than half"),
    ],
)
def test_inputs_that_cannot_vary_are_told(axis, told):
    fault = faults(HEAD + SWEPT + TAIL.replace("[solver]", f"[sweep.axes]\n{axis}\n[solver]"))[-1]
    assert told in fault


def test_seeds_are_an_axis_of_random_motion():
    axes = "[sweep.axes]\ninput.seed = [3, 1]\n"
    band = "start_hz = 1.0\nstop_hz = 4.0\n"
    read = config.parse(HEAD + RANDOM + band + TAIL.replace("[solver]", f"{axes}[solver]"))
    runs = read.transients(np.arange(read.sweep.count))
    alone = config.parse(HEAD + RANDOM + band + "seed = 1\n" + TAIL).solver.transient
    t = np.linspace(0.0, 2.0, 50)
    assert np.array_equal(runs[3].sampled(t), alone.sampled(t))
    assert not np.array_equal(runs[0].sampled(t), alone.sampled(t))
