"""A first measured.toml that is written after a look at the data."""

import re
from pathlib import Path

import numpy as np
import pytest
from scipy import signal
from scipy.integrate import solve_ivp
from scipy.io import savemat, wavfile

from tests import fixture_formats
from tests.command import invoke
from tests.fixture_measured import vibration
from wedgesweep import measured
from wedgesweep.diagnose.loop.loop_data import loop_data
from wedgesweep.diagnose.transient.from_measurement import transient_data
from wedgesweep.guess import first_files
from wedgesweep.measured import consistency, quality
from wedgesweep.measured.signals import spikes

REAL = Path(__file__).parents[2] / "shared" / "real"
RATE = 1000.0


def begun(directory, *files):
    """The measurement that init writes for files; it is valid."""
    path, _ = first_files.write(directory / "measured.toml", files)
    return measured.read(path)


def loop(mass=3.0, damping=40.0, friction=20.0, seed=0):
    """Time (s), displacement (mm) and force (N) of a mass that is moved to and fro on a bed that rubs."""
    t = np.arange(6000) / RATE
    omega = 2.0 * np.pi * 1.3
    x, v, a = np.sin(omega * t), omega * np.cos(omega * t), -(omega**2) * np.sin(omega * t)
    random = np.random.default_rng(seed)
    force = mass * 0.05 * a + damping * 0.05 * v + friction * np.sign(v) + 0.2 * random.normal(size=t.size)
    return t, 50.0 * x + 1e-3 * random.normal(size=t.size), force


def decay():
    """Time (s) and displacement (mm) of a free motion that friction ends, after a push."""
    t = np.arange(3000) / RATE
    swing = 10.0 * np.maximum(1.0 - t / 2.5, 0.0)
    x = swing * np.cos(2.0 * np.pi * 4.0 * t)
    pushed = np.linspace(0.0, 10.0, 200)
    return np.arange(3200) / RATE, np.r_[pushed, x] + 0.01 * np.random.default_rng(0).normal(size=3200)


def text(path, *columns, header="", delimiter=",", decimals=6):
    rows = (delimiter.join(f"{cell:.{decimals}f}" for cell in row) for row in zip(*columns, strict=True))
    path.write_text("\n".join([*header.splitlines(), *rows]) + "\n")
    return path


@pytest.mark.few(4)
@pytest.mark.parametrize(("name", "write"), fixture_formats.SPECIMENS)
def test_every_format_gets_in_as_it_is(tmp_path, name, write):
    t, d, v = vibration()
    write(tmp_path / name, {"t": np.round(t, 4), "d": d, "v": v})
    found = begun(tmp_path, tmp_path / name)
    test = found.tests[0]
    assert test.kind == "steady"
    assert found.model.system == "oscillator"
    assert "amplitude_mm" in (tmp_path / "measured.toml").read_text()
    assert "from_s" not in (tmp_path / "measured.toml").read_text()
    np.testing.assert_allclose(test.displacement, 1e-3 * d, rtol=1e-6)
    np.testing.assert_allclose(test.velocity, 1e-3 * v, rtol=1e-6)


def test_formats_without_names(tmp_path):
    t, d, f = loop()
    np.save(tmp_path / "one.npy", np.column_stack([t, d, f]))
    savemat(tmp_path / "two.mat", {"fs": RATE, "position": d, "force": f})
    sound = np.column_stack([d / 100.0, f / 100.0])
    wavfile.write(tmp_path / "three.wav", int(RATE), (32767 * sound).astype("i2"))
    fixture_formats.uff(tmp_path / "four.uff", {"t": t, "d": d, "f": f})
    savemat(tmp_path / "five.mat", {"ans": np.vstack([t, d, f])})
    for name in ("one.npy", "two.mat", "three.wav", "four.uff", "five.mat"):
        (tmp_path / name[:3]).mkdir()
        found = begun(tmp_path / name[:3], tmp_path / name)
        test = found.tests[0]
        assert test.kind == "loop", name
        assert np.corrcoef(test.displacement, d)[0, 1] > 0.999
        assert np.corrcoef(test.force, f)[0, 1] > 0.999
        assert test.sampling_rate == pytest.approx(RATE)


@pytest.mark.parametrize("name", ["dspace.mat", "pandas.h5"])
def test_names_may_stand_beside_the_samples(tmp_path, name):
    """An array of structs of MATLAB and a block of pandas hold the names of channels beside their samples."""
    t, d, _ = vibration()
    names, columns = ["x_mass", "x_base"], [d, 0.3 * np.cos(2.0 * np.pi * 20.0 * t)]
    if name == "pandas.h5":
        with pytest.importorskip("h5py").File(tmp_path / name, "w") as file:
            file["df/axis1"] = np.arange(t.size)
            file["df/block0_items"] = np.array(["t", *names], "S")
            file["df/block0_values"] = np.column_stack([t, *columns])
    else:
        recorded = np.array(
            [(name, each, "mm") for name, each in zip(names, columns, strict=True)],
            [("Name", object), ("Data", object), ("Unit", object)],
        )
        savemat(tmp_path / name, {"rec": {"X": {"Data": t, "Name": "Time"}, "Y": recorded}})
    found = begun(tmp_path, tmp_path / name)
    assert found.recorded_input == "displacement"
    assert found.tests[0].kind == "steady"
    np.testing.assert_allclose(found.tests[0].displacement, 1e-3 * d, rtol=1e-6)


def test_one_column_of_volts_is_the_motion(tmp_path):
    """Numbers by name far above it, as in a header of LabVIEW, are no names of columns."""
    t, x = decay()
    header = "Separator\tTab\nTime\t14:02:55\nX_Dimension\tTime\n***End_of_Header***\nX_Value\tVoltage"
    text(tmp_path / "one.lvm", t, x, header=header, delimiter="\t")
    found = begun(tmp_path, tmp_path / "one.lvm")
    assert found.tests[0].kind == "transient"
    assert found.tests[0].time.size < t.size  # from the release on


def test_files_of_one_layout_are_read_in_one_way(tmp_path):
    """Also where the numbers of another file look as if its channels were the other way round."""
    t, d, f = loop()
    files = [text(tmp_path / "one.csv", t, d, f), text(tmp_path / "two.csv", t, f, d)]
    written, _ = first_files.write(tmp_path / "measured.toml", files)
    assert "columns.force.column" not in written.read_text()


@pytest.mark.few(2)
@pytest.mark.parametrize(
    "header", ["", "time (s);weg [mm];kraft [N]", "# t, s\n# run 7", "t;pos;load\ns;mm;N", "t/s;Pos/mm;Ft/mV"]
)
def test_numbers_of_the_model_are_those_of_the_record(tmp_path, header):
    text(tmp_path / "one.csv", *loop(), header=header, delimiter=";")
    found = begun(tmp_path, tmp_path / "one.csv")
    own = found.model.oscillator
    assert own["mass"] == pytest.approx(3.0, rel=0.15)
    assert own["damping"] == pytest.approx(40.0, rel=0.15)
    assert own["spring"] == pytest.approx(0.0, abs=20.0)
    assert "shows about 2" in (tmp_path / "model.toml").read_text()


@pytest.mark.parametrize(
    "above", ["Rig 7\nSample rate: 1000 Hz\n\n", "# Sampling frequency [kHz]; 1.0\n", "dt = 1 ms\n", ""]
)
def test_a_number_in_a_text_file_is_its_rate(tmp_path, above):
    _, d, f = loop()
    rows = [f"{a:.6f},{b:.6f}" for a, b in zip(d, f, strict=True)]
    if not above:  # in a column of its own
        rows = [f"{row},{'1000' if i == 0 else ''}" for i, row in enumerate(rows)]
    header = "Position (mm),Force (N)" + ("" if above else ",Fs")
    (tmp_path / "one.csv").write_text(above + "\n".join([header, *rows]) + "\n")
    assert begun(tmp_path, tmp_path / "one.csv").tests[0].sampling_rate == pytest.approx(1000.0)
    assert "as a number in the file says" in (tmp_path / "measured.toml").read_text()


@pytest.mark.parametrize(
    ("sweep", "within"), [((2.0, 0.2), 0.03), ((5.0, 0.07), 0.05)], ids=["wide", "about the resonance"]
)
def test_an_acceleration_under_a_force_tells_mass_spring_and_damper(tmp_path, sweep, within):
    mass, spring, damping = 2.0, 3200.0, 8.0
    t = np.arange(0.0, 20.0, 0.0025)
    force = 5.0 * np.sin(2.0 * np.pi * (sweep[0] * t + sweep[1] * t**2))
    system = signal.TransferFunction([1.0, 0.0, 0.0], [mass, damping, spring])
    _, acceleration, _ = signal.lsim(system, force, t)
    noise = 0.01 * np.random.default_rng(0).normal(size=(2, t.size))
    columns = t, force + noise[0], acceleration + noise[1]
    found = begun(tmp_path, text(tmp_path / "a.csv", *columns, header="s,Force (N),Acc (m/s^2)"))
    assert found.uncertain.keys() == {"bolster_mass", "bolster_stiffness", "damping_level"}
    own = found.model.oscillator
    assert own["mass"] == pytest.approx(mass, rel=within)
    assert own["spring"] == pytest.approx(spring, rel=within)
    assert own["damping"] == pytest.approx(damping, rel=0.1)


def pendulum(driven, seed=0, start=1.2):
    """Time (s), angle (rad) and torque (N m) of a pendulum (0.0125 kg m^2, 0.6 N m), driven or let go."""
    t = np.arange(0.0, 12.0, 0.005)

    def torque(t):
        return 0.4 * np.sin(2.0 * np.pi * 0.5 * t) if driven else 0.0 * t

    def rate(t, y):
        return y[1], (torque(t) - 0.6 * np.sin(y[0]) - 0.02 * np.tanh(y[1] / 0.005)) / 0.0125

    first = (0.0, 0.0) if driven else (start, 0.0)
    angle = solve_ivp(rate, (0.0, t[-1]), first, method="LSODA", t_eval=t, rtol=1e-7, max_step=0.01).y[0]
    noise = np.random.default_rng(seed).normal(size=(2, t.size))
    return t, angle + 2e-4 * noise[0], torque(t) + 0.002 * noise[1]


def test_what_swings_is_a_pendulum(tmp_path):
    for name, driven in ("driven", True), ("free", False):
        (tmp_path / name).mkdir()
        t, angle, torque = pendulum(driven)
        columns, header = (t, angle, torque), "t (s),theta (rad),torque_nm"
        if not driven:
            columns, header = columns[:2], header.rpartition(",")[0]
        own = begun(tmp_path / name, text(tmp_path / f"{name}.csv", *columns, header=header)).model.oscillator
        assert own["restoring_force"] == "pendulum"
        assert own["spring"] / own["mass"] == pytest.approx(0.6 / 0.0125, rel=0.03)
    # Steps of an encoder are more noise of the acceleration than what a spring leaves of it.
    t, coarse, _ = pendulum(driven=False, start=0.9)
    turned = np.rint(coarse / 2.0 / np.pi * 2048.0) / 2048.0
    begun(tmp_path, text(tmp_path / "encoder.csv", t[::2], turned[::2], header="t (s),angle (rev)"))
    assert "restoring_force" in (tmp_path / "model.toml").read_text()
    # A gyroscope alone tells it as well, and no spring that turns.
    for swings, turn in (True, angle), (False, np.exp(-0.1 * t) * np.cos(6.9 * t)):
        rate = np.gradient(turn, t) + 0.01
        begun(tmp_path, text(tmp_path / "gyro.csv", t, rate, header="t (s),gyro (rad/s)"))
        assert ("restoring_force" in (tmp_path / "model.toml").read_text()) == swings
    columns, header = (t, angle, 0.6 * angle), "t (s),theta (rad),torque (N m)"
    begun(tmp_path, text(tmp_path / "spring.csv", *columns, header=header))
    assert "restoring_force" not in (tmp_path / "model.toml").read_text()


def test_what_coasts_to_rest_has_no_spring(tmp_path):
    t = np.arange(0.0, 5.0, 0.02)
    slowing = 0.9 - 0.3 * t  # m/s: it is pushed, and friction stops it after 3 s
    x = np.where(slowing > 0.0, 0.9 * t - 0.15 * t**2, 1.35)
    x += 3e-4 * np.random.default_rng(0).normal(size=t.size)
    found = begun(tmp_path, text(tmp_path / "cart.csv", t, x, header="Time (s),Position (m)"))
    assert found.model.oscillator["spring"] == 0.0
    assert transient_data(found).tests == 1  # nothing cuts what has no period


@pytest.mark.parametrize("samples", [1900, 3200])
def test_six_swings_that_friction_ends_are_three_windows(tmp_path, samples):
    t, x = (each[:samples] for each in decay())
    found = begun(tmp_path, text(tmp_path / "swings.csv", t, x, header="s,mm"))
    assert found.model.oscillator["spring"] == pytest.approx((2.0 * np.pi * 4.0) ** 2, rel=0.05)
    data = transient_data(found)
    assert data.tests == 3
    # Model errors are shares of the whole record, also in the window in which it comes to rest.
    assert np.ptp(data.size[:, 0]) == 0.0


def test_an_elastic_joint_does_not_stand_for_a_damper(tmp_path):
    strokes = ((5.0, 0.2, 20.0), (12.0, 0.2, 20.0), (25.0, 0.1, 30.0))  # mm, Hz, s
    x = np.concatenate(
        [a * np.sin(2.0 * np.pi * f * np.arange(0.0, duration, 0.01)) for a, f, duration in strokes]
    )
    t = 0.01 * np.arange(x.size)
    friction = np.zeros(t.size)
    for i in range(1, t.size):  # Dahl (1968): it builds up over 1.1 mm, whatever the velocity
        towards = 30.0 * np.sign(x[i] - x[i - 1])
        friction[i] = towards + (friction[i - 1] - towards) * np.exp(-abs(x[i] - x[i - 1]) / 1.1)
    noise = np.random.default_rng(0).normal(size=(2, t.size))
    columns = t, x + 0.003 * noise[0], 5.0 * x + friction + 0.1 * noise[1]
    own = begun(tmp_path, text(tmp_path / "joint.csv", *columns, header="s,mm,N")).model.oscillator
    # By all samples alike, damping would be a quarter of the 30 N, and by three quarters of each stroke 2 %.
    assert own["damping"] * 2.0 * np.pi * 0.2 * 0.012 < 0.01 * 30.0
    assert own["spring"] == pytest.approx(5e3, rel=0.03)
    # No record shows a mass: its inertia (N) is far below the noise of the force.
    assert own["mass"] * (2.0 * np.pi * 0.2) ** 2 * 0.012 < 1e-3


def test_a_jerk_before_a_long_creep_is_no_obstacle(tmp_path):
    t = np.arange(4000) / RATE
    noise = np.random.default_rng(0).normal(size=(2, t.size))
    away = np.exp(-t / 0.05)
    columns = t, 10.0 * (1.0 - away) + 3.0 * t + 1e-3 * noise[0], 20.0 * away + 0.1 * noise[1]
    found = begun(tmp_path, text(tmp_path / "jerk.csv", *columns, header="s,mm,N"))
    assert found.model.oscillator["damping"] >= 0.0


def test_the_load_of_two_faces_belongs_to_the_model_of_each_test(tmp_path):
    files, random = [], np.random.default_rng(1)
    for load in (20.0, 60.0):
        t, d, f = loop(mass=0.0, damping=0.0, friction=0.12 * load)
        columns = t, d, f, load * (1.0 + 0.02 * random.normal(size=t.size))
        files.append(text(tmp_path / f"{load:g}N.csv", *columns, header="t,Stroke mm,Friction N,Load N"))
    found = begun(tmp_path, *files)
    loads = [test.model["oscillator.normal_force_N"] for test in found.tests]
    assert loads == pytest.approx([20.0, 60.0], rel=1e-3)
    assert found.model.friction["dynamic"] == pytest.approx(0.12, rel=0.02)
    # Motion of one frequency shows the spring less the inertia, here neither.
    assert found.model.oscillator["spring"] == 0.0
    assert "no record shows it" in (tmp_path / "model.toml").read_text()


def test_a_load_that_one_file_lacks_is_not_used(tmp_path):
    t, d, f = loop()
    loaded = text(tmp_path / "a.csv", t, d, f, 0.0 * t + 20.0, header="t,Stroke mm,Friction N,Load N")
    found = begun(tmp_path, loaded, text(tmp_path / "b.csv", t, d, f, header="t,Stroke mm,Friction N"))
    assert not any(test.model for test in found.tests)
    assert found.model.oscillator["normal_force"] == 0.0
    assert '"Load N"' in (tmp_path / "measured.toml").read_text()


def test_friction_that_differs_from_file_to_file_is_no_damping(tmp_path):
    """As that of a damper with a current, or of a seal under pressure."""
    files = []
    for friction, size in ((60.0, 0.5), (5.0, 1.0)):
        t, d, f = loop(friction=friction)
        _, _, less = loop(friction=0.0)
        files.append(text(tmp_path / f"{friction}.csv", t, size * d, size * less + f - less, header="t,d,F"))
    own = begun(tmp_path, *files).model.oscillator
    assert own["damping"] == pytest.approx(40.0, rel=0.15)
    shown = re.search(r"shows about (\S+) N", (tmp_path / "model.toml").read_text())
    assert float(shown[1]) == pytest.approx(32.5, rel=0.05)


@pytest.mark.acceptance
def test_a_damper_does_not_stand_for_the_friction_of_a_shaken_mass(tmp_path):
    files, t, spring, damping, friction = [], np.arange(4000) / 250.0, 1400.0, 2.3, 1.2
    fastest = 0.0
    for frequency in (3.0, 5.5, 8.0):
        omega = 2.0 * np.pi * frequency

        def rate(t, y, omega=omega):
            dry = friction * np.tanh(y[1] / 1e-3)
            return [y[1], -3.0 * np.sin(omega * t) - spring * y[0] - damping * y[1] - dry]

        x, v = solve_ivp(rate, (0.0, t[-1]), [0.0, 0.0], t_eval=t, method="LSODA", rtol=1e-6).y
        mass = -spring * x - damping * v - friction * np.tanh(v / 1e-3)
        fastest = max(fastest, np.abs(v).max())
        name, header = tmp_path / f"{frequency:g}.csv", "t,table m/s^2,mass m/s^2,x mm"
        files.append(text(name, t, 3.0 * np.sin(omega * t), mass, 1e3 * x, header=header))
    # The run-up from rest is cut off: free vibration dies away with damping / 2 = 1.15 /s and by friction.
    measurement = begun(tmp_path, *files)
    assert all(8.0 < each.duration < 15.9 for each in measurement.tests)
    assert measurement.columns["acceleration"]["of"] == "absolute"
    assert measurement.columns["displacement"]["of"] == "relative"
    first = (tmp_path / "model.toml").read_text()
    found = {
        key: float(re.search(rf"{key} = (\S+)", first)[1]) for key in ("spring_N_per_mm", "damping_N_s_per_m")
    }
    # Higher harmonics of a displacement are too small to count; the numbers are said to be good to 10 %.
    assert found["spring_N_per_mm"] == pytest.approx(1e-3 * spring, rel=0.1)
    assert found["damping_N_s_per_m"] < 2.0 * damping
    # Where no damper is needed clearly, friction takes its part.
    assert friction < float(re.search(r"shows about (\S+) N", first)[1]) < friction + damping * fastest


def test_an_earthquake_tells_a_spring_whose_mass_sticks_in_between(tmp_path):
    """The base is read as such although the mass keeps what it moved when it sticks at last."""
    t, random = np.arange(0.0, 40.0, 5e-3), np.random.default_rng(8)
    band = signal.butter(2, (0.3, 6.0), "band", fs=200.0, output="sos")
    base = signal.sosfilt(band, random.normal(size=t.size)) * np.minimum(t / 4.0, np.exp((12.0 - t) / 6.0))
    base *= 3.0 / np.abs(base).max()
    x, v, substeps = np.zeros(t.size), 0.0, 4
    for i in range(1, t.size):  # by Moreau's steps, in which friction stops the mass at most
        place = x[i - 1]
        for _ in range(substeps):
            step = 5e-3 / substeps
            free = v - step * (14.2 * place + 0.38 * v + base[i])
            v = np.sign(free) * max(abs(free) - 0.35 * step, 0.0)
            place += step * v
        x[i] = place
    names = "Time (s),Table Acc (m/s^2),Drift (mm)"
    file = text(tmp_path / "one.csv", t, base, 1e3 * x + 0.05 * random.normal(size=t.size), header=names)
    found = begun(tmp_path, file)
    assert found.columns["displacement"]["of"] == "relative"
    assert found.model.oscillator["spring"] == pytest.approx(14.2, rel=0.2)


def test_a_block_on_a_shaken_table_has_no_spring(tmp_path):
    """It slips all the time: friction accelerates it until it meets the table's velocity."""
    files, t, friction = [], np.arange(0.0, 6.0, 1e-3), 0.5
    for i, (size, frequency) in enumerate(((8.0, 2.0), (16.0, 3.0), (12.0, 5.0))):
        omega = 2.0 * np.pi * frequency
        # The block's velocity is a triangle, lowest where it meets the table's, -size cos(omega t) / omega.
        phase = np.arccos(0.5 * np.pi * friction / size)
        block = friction * np.sign(np.sin(omega * t - phase))
        header = "Time (s),Table Acc (m/s^2),Block Acc (m/s^2)"
        files.append(text(tmp_path / f"{i}.csv", t, size * np.sin(omega * t), block, header=header))
    own = begun(tmp_path, *files).model.oscillator
    assert (own["spring"], own["damping"]) == (0.0, 0.0)
    shown = re.search(r"shows about (\S+) N", (tmp_path / "model.toml").read_text())
    assert float(shown[1]) == pytest.approx(friction, rel=0.02)


def test_a_block_that_drifts_on_a_shaken_table_has_no_spring(tmp_path):
    """Under random motion it has windows of ten of the table's periods, whatever the length of the record."""
    random, step, friction = np.random.default_rng(3), 0.01, 2.0
    t = np.arange(0.0, 25.0, step)
    table = signal.sosfiltfilt(
        signal.butter(2, (0.7, 6.0), "bandpass", fs=1 / step, output="sos"), random.normal(size=t.size)
    )
    table *= 3.0 / table.std()
    speed, slid = 0.0, []
    for each in table:
        free = speed - step * each
        speed = free - np.clip(free, -step * friction, step * friction)
        slid.append(step * speed + (slid[-1] if slid else 0.0))
    found = begun(
        tmp_path,
        text(
            tmp_path / "one.csv",
            t,
            table,
            1e3 * np.array(slid) + 0.02 * random.normal(size=t.size),
            header="t [s],Table acc [m/s^2],Block rel [mm]",
        ),
    )
    assert found.model.oscillator["spring"] == 0.0
    windows = transient_data(found).windows
    assert len(windows) >= 4
    assert 0.2 < windows[0].model.natural_units(1.0, windows[0].grid.omega).time * 2.0 * np.pi < 0.7


def test_a_free_motion_begins_when_it_is_let_go(tmp_path):
    text(tmp_path / "one.txt", *decay(), delimiter="\t")
    found = begun(tmp_path, tmp_path / "one.txt")
    test = found.tests[0]
    assert test.kind == "transient"
    assert test.time[0] == pytest.approx(0.2, abs=0.05)
    natural = np.sqrt(found.model.oscillator["spring"] / found.model.oscillator["mass"])
    assert natural == pytest.approx(2.0 * np.pi * 4.0, rel=0.05)


def test_a_release_on_the_clock_of_a_telephone(tmp_path):
    """Nanoseconds since 1970, and a rate of a gyroscope without a unit, which can be no length."""
    t, x = decay()
    stamps = 1731234567.8e9 + 1e9 * t
    text(tmp_path / "one.csv", stamps, np.gradient(1e-2 * x, t), header="timestamp_ns,gyro_z")
    found = begun(tmp_path, tmp_path / "one.csv")
    assert found.model.turns
    assert 2.7 < found.tests[0].duration < 3.1  # let go after 0.2 s of 3.2 s


def test_a_force_that_gives_out_energy_is_turned(tmp_path):
    t, d, f = loop()
    files = [
        text(tmp_path / "one.csv", t, d, f, header="t,d,F"),
        text(tmp_path / "two.csv", t, d, -f, header="t,d,F"),
    ]
    found = begun(tmp_path, *files)
    assert consistency.warnings(found) == []
    np.testing.assert_allclose(found.tests[0].force, found.tests[1].force, atol=1e-6)


def test_runs_side_by_side_and_between_pauses_are_tests(tmp_path):
    t, x = decay()
    header = "Time (s) Run #1;Angle (rad) Run #1;Time (s) Run #2;Angle (rad) Run #2"
    text(tmp_path / "one.csv", t, x, t, 0.5 * x, header=header, delimiter=";")
    assert len(begun(tmp_path, tmp_path / "one.csv").tests) == 2
    (tmp_path / "two").mkdir()
    t, d, f = loop()
    twice = np.r_[t, t + 20.0], np.r_[d, d], np.r_[f, f]
    text(tmp_path / "two.csv", *twice, header="t,d,F")
    found = begun(tmp_path / "two", tmp_path / "two.csv")
    assert [test.time.size for test in found.tests] == [t.size, t.size]
    t, d, _ = vibration()  # steady, and once more after an hour
    text(tmp_path / "two.csv", np.r_[t, t + 3600.0], np.r_[d, d], header="t,d")
    found = begun(tmp_path / "two", tmp_path / "two.csv")
    assert [test.kind for test in found.tests] == ["steady", "steady"]


def test_sheets_with_titles_and_summaries_are_runs(tmp_path):
    openpyxl = pytest.importorskip("openpyxl")
    book = openpyxl.Workbook()
    for sheet in (book.active, book.create_sheet("fast")):
        sheet.append(["Fork on a dyno"])
        sheet.merge_cells("A1:C1")
        for row in (
            [],
            ["Rate", 500],
            ["Time", "Stroke", "Load"],
            ["s", "mm", "N"],
            *zip(*(each[::2] for each in loop()), strict=True),
        ):
            sheet.append([*row])
        sheet.append(["Max", 50.0, 33.0])
    book.save(tmp_path / "one.xlsx")
    found = begun(tmp_path, tmp_path / "one.xlsx")
    assert [test.time.size for test in found.tests] == [3000, 3000]
    assert found.model.oscillator["mass"] == pytest.approx(3.0, rel=0.15)


def test_groups_of_a_recorder_are_runs(tmp_path):
    tdms = pytest.importorskip("nptdms")
    _, x = decay()
    wave = {"wf_increment": 1.0 / RATE, "unit_string": "mm"}
    with tdms.TdmsWriter(tmp_path / "one.tdms") as writer:
        writer.write_segment([tdms.ChannelObject(f"Hit {i}", "LVDT", i * x, wave) for i in (1, 2, 3)])
    found = begun(tmp_path, tmp_path / "one.tdms")
    assert [np.ptp(test.displacement) for test in found.tests] == pytest.approx([0.02, 0.04, 0.06], rel=0.05)


def test_structures_of_an_array_are_runs(tmp_path):
    """Each with its time, and a matrix of its channels in a structure within."""
    t, d, f = loop()
    kinds = [("time", object), ("signals", object)]
    runs = [(t, {"values": np.column_stack([size * d, size * f])}) for size in (1.0, 2.0, 3.0)]
    savemat(tmp_path / "one.mat", {"data": {"test": np.array(runs, kinds)[None], "specimen": "RFD"}})
    found = begun(tmp_path, tmp_path / "one.mat")
    sizes = [(np.ptp(test.displacement), np.ptp(test.force)) for test in found.tests]
    assert np.array(sizes) == pytest.approx(np.outer((1, 2, 3), (1e-3 * np.ptp(d), np.ptp(f))))


def test_a_cell_array_names_the_columns_of_a_matrix_and_their_units(tmp_path):
    t, d, f = loop()
    columns = {"label": np.array(["piston", "load"], object), "units": np.array(["cm", "kN"], object)}
    signals = {"values": np.column_stack([0.1 * d, 1e-3 * f]), **columns}
    savemat(tmp_path / "one.mat", {"test": {"time": t, "signals": signals}})
    (test,) = begun(tmp_path, tmp_path / "one.mat").tests
    assert test.displacement == pytest.approx(1e-3 * d)
    assert test.force == pytest.approx(f)
    assert 'column = "test.signals.values[2]", unit = "kN"' in (tmp_path / "measured.toml").read_text()


def test_a_time_that_begins_anew_parts_runs(tmp_path):
    """Each is a mass that is held for half a second before it is let go."""
    t, x = decay()
    held = np.r_[np.full(500, 10.0), x[200:-300]]
    text(
        tmp_path / "one.csv", np.tile(t, 3), np.r_[held, 0.5 * held, held], header="Time (s),String Pot (in)"
    )
    found = begun(tmp_path, tmp_path / "one.csv")
    assert [test.time[0] for test in found.tests] == pytest.approx([0.52, 10.52, 20.52], abs=0.02)
    natural = np.sqrt(found.model.oscillator["spring"] / found.model.oscillator["mass"])
    assert natural == pytest.approx(2.0 * np.pi * 4.0, rel=0.05)
    assert "time begins anew in the file" in invoke("check", tmp_path / "measured.toml")


def test_power_flows_from_the_base_to_the_mass(tmp_path):
    """Of two accelerometers without a name, whichever comes first."""
    t = np.arange(20000) / RATE
    base = np.sin(2.0 * np.pi * (3.0 * t + 0.4 * t**2))
    natural, ratio = 2.0 * np.pi * 9.0, 0.03
    filtered = signal.lti([2.0 * ratio * natural, natural**2], [1.0, 2.0 * ratio * natural, natural**2])
    _, mass, _ = signal.lsim(filtered, base, t)
    for place, columns in enumerate(((base, mass), (mass, base)), 1):
        text(tmp_path / "one.csv", t, *columns, header="Time [s],A1 [g],A2 [g]")
        assert begun(tmp_path, tmp_path / "one.csv").columns["input"]["column"] == f"A{place} [g]"


@pytest.mark.parametrize(
    ("header", "columns"),
    [
        ("sample,t_us,pos_cmd_mm,pos_act_mm,i_q_mA,drive_status", ("pos_act_mm", "i_q_mA")),
        (
            "n,t [us],Setpoint (%),Travel (%),Actuator Pressure (psi),Mode",
            ("Travel (%)", "Actuator Pressure (psi)"),
        ),
    ],
)
def test_what_stands_for_a_force_is_neither_a_count_nor_a_command(tmp_path, header, columns):
    t, d, f = loop()
    text(tmp_path / "one.csv", np.arange(t.size), 1e6 * t, d, d, f, 7.0 + 0.0 * t, header=header)
    found = begun(tmp_path, tmp_path / "one.csv").columns
    assert (found["displacement"]["column"], found["force"]["column"]) == columns


def test_a_bridge_and_a_clock_of_pandas_are_known(tmp_path):
    t, d, f = loop()
    rows = [f"0 days 00:00:{a:09.6f},{b:.5f},{c:.6f}" for a, b, c in zip(t, d, 0.01 * f, strict=True)]
    (tmp_path / "one.csv").write_text("\n".join([",Weg [mm],Brücke [mV/V]", *rows]))
    found = begun(tmp_path, tmp_path / "one.csv")
    assert (found.tests[0].kind, found.tests[0].sampling_rate) == ("loop", pytest.approx(RATE))
    assert "how many N are 1 mV/V" in (tmp_path / "measured.toml").read_text()


def test_a_table_of_runs_is_no_record(tmp_path):
    text(tmp_path / "one.csv", *decay(), header="time_s,angle_rev")
    text(tmp_path / "runs.csv", np.arange(20.0), np.linspace(20, 60, 20), header="run,release_deg")
    found = begun(tmp_path, tmp_path / "one.csv", tmp_path / "runs.csv")
    assert [test.file for test in found.tests] == ["one.csv"]
    assert np.ptp(found.tests[0].displacement) == pytest.approx(20 * 2.0 * np.pi, rel=0.05)
    assert (
        "left out, as they have too few numbers for records: runs.csv"
        in (tmp_path / "measured.toml").read_text()
    )


def test_velocity_and_displacement_tell_the_rate(tmp_path):
    t, d, f = loop()
    velocity = np.gradient(50.0 * np.sin(2.0 * np.pi * 1.3 * t), t)
    text(tmp_path / "one.csv", d / 25.4, velocity / 25.4, f, header="Stroke (in),Speed (in/sec),Force (N)")
    assert begun(tmp_path, tmp_path / "one.csv").tests[0].sampling_rate == pytest.approx(RATE, rel=0.005)


def test_noise_beside_a_motion_is_no_force(tmp_path):
    t, x = decay()
    np.save(tmp_path / "one.npy", np.column_stack([t, x, np.random.default_rng(1).normal(size=t.size)]))
    found = begun(tmp_path, tmp_path / "one.npy")
    assert (found.tests[0].kind, [*found.tests[0].responses]) == ("transient", ["displacement"])


def test_a_steady_motion_is_without_run_up_and_run_down(tmp_path):
    """Whose growth makes lines beside that of the frequency: their common divisor is none of the motion."""
    t = np.arange(0.0, 24.0, 0.005)
    base = np.clip(np.minimum(t / 3.0, (24.0 - t) / 2.0), 0.0, 1.0) * np.sin(2.0 * np.pi * 6.5 * t)
    natural = 2.0 * np.pi * 5.0
    relative = signal.lti([-1e3], [1.0, 0.1 * natural, natural**2])
    _, drift, _ = signal.lsim(relative, base, t)
    drift += 0.01 * np.random.default_rng(2).normal(size=t.size)
    text(tmp_path / "one.csv", t, base, drift, header="Time [s],Table acc [m/s^2],Drift [mm]")
    test = begun(tmp_path, tmp_path / "one.csv").tests[0]
    assert (test.kind, test.refined_frequency) == ("steady", pytest.approx(6.5, rel=1e-4))
    assert 2.5 < test.time[0] < 5.0
    assert 20.5 < test.time[-1] < 22.5


def test_a_summary_below_the_data_is_left_out(tmp_path):
    file = text(tmp_path / "one.csv", *loop(), header="Zeit [s];Weg [mm];Kraft [daN]", delimiter=";")
    file.write_text(file.read_text() + "\nMittelwert;0,01;0,02\n------;;\nMax;50;3\n")
    begun(tmp_path, file)
    assert "3 lines of text below the data left out" in invoke("check", tmp_path / "measured.toml")


def test_channels_of_two_loggers_are_one_test(tmp_path):
    t, d, f = loop()
    text(tmp_path / "one.csv", 1e3 * t, d, header="Time,Position\nms,mm")
    text(tmp_path / "two.csv", t[::2], f[::2] / 200.0, header="Date,Load\ns,V")
    found = begun(tmp_path, tmp_path / "one.csv", tmp_path / "two.csv")
    assert found.tests[0].kind == "loop"
    assert "scale = 1.0" in (tmp_path / "measured.toml").read_text()
    assert np.corrcoef(found.tests[0].force, f[: found.tests[0].force.size])[0, 1] > 0.99


def test_a_model_turns_where_its_units_were_corrected(tmp_path):
    """Counts of an encoder are an angle; what no name tells is a length until somebody says otherwise."""
    t, d, f = loop()
    text(tmp_path / "one.csv", t, d, f, header="t,position,effort")
    invoke("init", tmp_path / "measured.toml", "--data", tmp_path / "one.csv")
    path = tmp_path / "measured.toml"
    path.write_text(
        path.read_text().replace('unit = "mm"', 'unit = "rad"').replace('unit = "N"', 'unit = "N m"')
    )
    invoke("init", tmp_path / "model.toml", "--data", path, "--force")
    model = measured.read(path).model
    assert model.turns
    assert model.oscillator["mass"] == pytest.approx(3e-3, rel=0.15)  # 1 rad where 1 mm was
    text(tmp_path / "two.csv", t, d, f, header="t,encoder_counts,current_mA")
    invoke("init", tmp_path / "measured.toml", "--data", tmp_path / "two.csv", "--force")
    assert "how many deg are 1 counts" in path.read_text()


@pytest.mark.parametrize(
    "header", ["time_s,plate_mm,base_mm", "X,bolster_z [mm],sideframe_z [mm]", "t,Floor 1 [mm],Table [mm]"]
)
def test_what_drives_a_rig_is_its_input(tmp_path, header):
    """And what rises in even steps is time, if nothing else is, though its letter is that of a place."""
    t, d, _ = vibration()
    text(tmp_path / "one.csv", t, d, 0.3 * np.cos(2.0 * np.pi * 20.0 * t), header=header)
    found = begun(tmp_path, tmp_path / "one.csv")
    assert found.recorded_input == "displacement"
    assert found.columns["displacement"]["of"] == "absolute"
    assert not found.model.forced


def test_what_is_not_known_is_asked(tmp_path):
    _, d, f = loop()
    text(tmp_path / "one.csv", d, f, header="position_mm,motor current [A]")
    begun(tmp_path, tmp_path / "one.csv")
    path = tmp_path / "measured.toml"
    asked = path.read_text()
    assert "# ? No column looks like time" in asked
    assert "how many N are 1 A" in asked
    path.write_text(asked.replace("scale = 1.0", "scale = 2.0"))
    test = measured.read(path).tests[0]
    np.testing.assert_allclose(test.force, 2.0 * f, atol=1e-5)
    # The numbers of the model follow once the lines are edited.
    invoke("init", tmp_path / "model.toml", "--data", path, "--force")
    assert measured.read(path).model.oscillator["mass"] == pytest.approx(6.0, rel=0.15)


def test_nothing_is_overwritten(tmp_path):
    file = text(tmp_path / "one.csv", *loop(), header="t,d,F")
    (tmp_path / "model.toml").write_text("mine")
    assert "exists; --force overwrites it" in invoke(
        "init", tmp_path / "measured.toml", "--data", file, code=2
    )
    assert (tmp_path / "model.toml").read_text() == "mine"
    assert not (tmp_path / "measured.toml").exists()
    told = invoke("init", "--force", tmp_path / "measured.toml", "--data", file)
    assert "wrote" in told
    assert "valid" in told


@pytest.mark.parametrize("content", ["", "a,b\n", "\n".join(["x,y"] * 50), "1,2\n3,4\n"])
def test_a_file_without_numbers_is_named(tmp_path, content):
    (tmp_path / "one.csv").write_text(content)
    told = invoke("init", tmp_path / "measured.toml", "--data", tmp_path / "one.csv", code=2)
    assert "one.csv" in told
    assert not (tmp_path / "measured.toml").exists()


# Files of each set, the kind, the number of tests, and words of the remarks on the first one.
SETS = {
    "emps": (["emps.csv"], "loop", 1, ""),
    "frame": (["frame-250g.csv", "frame-450g.csv"], "steady", 2, ""),
    "seal": ([f"pneumatic-seal/Circle_{bar}bar.csv" for bar in (1, 3, 5, 7)], "loop", 5, "scatter"),
    "torsion": (["torsion-oscillator/free-decays.csv"], "transient", 10, "decimal commas"),
    "rack": (["rack-pinion/a3MR.csv", "rack-pinion/a3NI.csv"], "transient", 1, "1500 Hz"),
    "dyno": (
        [f"damper-dyno/t1_{name}psi.csv" for name in ("1_1_18_18_s5_n10_50", "2_2_24_24_s5_n10_100")],
        "loop",
        2,
        "",
    ),
    "spring": (
        [f"spring-mass/experiment_{i}.csv" for i in (1, 2, 3)],
        "transient",
        3,
        "data from line 1",
    ),
}


@pytest.mark.few(3)
@pytest.mark.skipif(not REAL.is_dir(), reason="the recordings are not here")
@pytest.mark.parametrize("name", SETS)
def test_recordings_get_in_as_delivered(tmp_path, name):
    files, kind, count, words = SETS[name]
    found = begun(tmp_path, *(REAL / file for file in files))
    assert [test.kind for test in found.tests] == [kind] * count
    for test in found.tests:
        assert all(np.isfinite(samples).all() for samples in test.channels.values())
    assert words in "; ".join(found.tests[0].remarks)


# Those of the small sets that are not as the others to init.
SMALL = ("excel-days", "force-negated-one-loop", "input-negated", "iso-time", "two-rates")
SMALL += ("units-row-unknown",)


@pytest.mark.few(2)
@pytest.mark.skipif(not REAL.is_dir(), reason="the recordings are not here")
@pytest.mark.parametrize("name", SMALL)
def test_small_sets_get_in(tmp_path, name):
    is_loop = name == "force-negated-one-loop"
    found = begun(tmp_path, *sorted((REAL / "small" / name).glob("*.csv"))[:2])
    assert {test.kind for test in found.tests} == {"loop" if is_loop else "steady"}
    assert ("input" in found.columns) != is_loop


def test_names_without_units_units_without_names_and_times_of_day(tmp_path):
    t, d, f = loop()
    header = "Uhrzeit;Winkel;Strom [A]"
    rows = (f"10:00:{x:06.3f};{y:.5f};{z:.4f}" for x, y, z in zip(t, d / 50.0, f, strict=True))
    (tmp_path / "one.csv").write_text("\n".join([header, *rows]))
    found = begun(tmp_path, tmp_path / "one.csv")
    assert found.columns["displacement"]["unit"] == "rad"
    assert found.columns["force"]["unit"] == "N m"
    assert found.tests[0].sampling_rate == pytest.approx(RATE)


def test_a_resonance_is_not_read_the_wrong_way_round(tmp_path):
    t = np.arange(4000) / RATE
    omega, f = 2.0 * np.pi * 5.0, 20.0 * np.sin(2.0 * np.pi * (2.0 * t + t**2))
    response = 1.0 / (2.0 * (omega**2 - (2.0 * np.pi * np.fft.rfftfreq(t.size, 1e-3)) ** 2) + 60j * omega)
    d = 1e3 * np.fft.irfft(np.fft.rfft(f) * response, t.size)
    text(tmp_path / "one.csv", t, d, f)
    found = begun(tmp_path, tmp_path / "one.csv")
    np.testing.assert_allclose(found.tests[0].force, f, atol=1e-5)
    assert found.model.oscillator["spring"] == pytest.approx(2.0 * omega**2, rel=0.1)


def test_a_counter_of_samples_is_no_time(tmp_path):
    t, x = decay()
    text(tmp_path / "one.csv", np.arange(t.size), x, header="n,x", decimals=3)
    assert "holds no time" in invoke(
        "init", tmp_path / "measured.toml", "--data", tmp_path / "one.csv", code=2
    )


@pytest.mark.parametrize(("damaged", "places"), [(1, [100, 101]), (0, [-1, 0])])
def test_numbers_of_any_size_are_no_obstacle(tmp_path, damaged, places):
    """A damaged byte of a binary file may be an exponent."""
    t, d, v = signals = vibration()
    signals[damaged][places] = 1.7e308, -1.7e308
    np.savez(tmp_path / "one.npz", t=t, d=d, v=v)
    told = invoke("init", tmp_path / "measured.toml", "--data", tmp_path / "one.npz", code=2)
    assert "in SI units is too large" in told
    assert 'kind = "steady"' in (tmp_path / "measured.toml").read_text()


def test_an_oscilloscope_names_channels_by_number_and_states_its_interval(tmp_path):
    """Which one is the motion shows in the numbers; the counter of samples is neither."""
    t, d, f = loop()
    rows = "\n".join(f"{i},{x / 20.0:.4e},{y / 10.0:.4e}," for i, (x, y) in enumerate(zip(d, f, strict=True)))
    step = t[1] - t[0]
    head = f"X,CH1,CH2,Start,Increment\nSequence,Volt,Volt,-1.5e+00,{step:e}\n"
    (tmp_path / "NewFile1.csv").write_text(head + rows + "\n")
    found = begun(tmp_path, tmp_path / "NewFile1.csv")
    (test,) = found.tests
    assert test.kind == "loop"
    assert test.sampling_rate == pytest.approx(RATE)
    np.testing.assert_allclose(test.displacement, 1e-3 * d / 20.0, atol=1e-7)
    np.testing.assert_allclose(test.force, f / 10.0, atol=1e-3)


def test_a_force_that_strikes_a_mass_has_the_sign_that_explains_its_motion(tmp_path):
    """From rest under a half sine, with an accelerometer that points the other way."""
    mass, omega, width = 2.0, 2.0 * np.pi * 12.0, 0.01
    t = np.arange(4096) / 2048.0
    pulse = np.where((t >= 0.2) & (t < 0.2 + width), 100.0 * np.sin(np.pi * (t - 0.2) / width), 0.0)
    filtered = signal.lti([1.0, 0.0, 0.0], [mass, 0.02 * mass * omega, mass * omega**2])
    _, a, _ = signal.lsim(filtered, pulse, t)
    noise = np.random.default_rng(0).normal(size=(2, t.size))
    text(
        tmp_path / "one.csv",
        t,
        pulse + 0.1 * noise[0],
        -a + 0.02 * noise[1],
        header="t,Hammer (N),Acc (m/s^2)",
    )
    found = begun(tmp_path, tmp_path / "one.csv")
    assert found.model.oscillator["mass"] == pytest.approx(mass, rel=0.06)
    assert found.tests[0].input.min() < -90.0


def test_columns_on_two_clocks_in_one_file_meet(tmp_path):
    """The second time has fewer samples and begins later; both motions are one sine."""
    t, slow = np.arange(4000) / 1000.0, 0.5 + np.arange(800) / 250.0
    force, place = (size * np.sin(2.0 * np.pi * 2.0 * each) for size, each in ((30.0, t), (5.0, slow)))
    rows = [f"{a:.4f}\t{b:.4f}" for a, b in zip(t, force + 3.0 * np.cos(4.0 * np.pi * t), strict=True)]
    rows = [
        f"{row}\t{slow[i]:.4f}\t{place[i]:.5f}" if i < slow.size else f"{row}\t\t"
        for i, row in enumerate(rows)
    ]
    (tmp_path / "one.txt").write_text("\n".join(["Time (a)\tLoad (N)\tTime (b)\tLVDT (mm)", *rows]))
    found = begun(tmp_path, tmp_path / "one.txt").tests[0]
    ratio = np.sin(2.0 * np.pi * 2.0 * found.time)
    np.testing.assert_allclose(1e3 * found.displacement, 5.0 * ratio, atol=1e-3)


def test_each_release_in_a_record_is_a_test(tmp_path):
    _, x = decay()
    both = np.r_[x, 0.7 * x, x]
    path = text(tmp_path / "one.csv", np.arange(both.size) / RATE, both, header="t (s),x (mm)")
    found = begun(tmp_path, path)
    assert [test.duration for test in found.tests] == pytest.approx([3.0] * 3, abs=0.3)
    one = tmp_path / "measured.toml"
    one.write_text(
        one.read_text().partition("[[measurement.test]]")[0] + '[[measurement.test]]\nfile = "one.csv"\n'
    )
    with pytest.raises(measured.MeasuredError, match=r"the motion grows again at 3\.\d* s, 6\.\d* s"):
        measured.read(one)


@pytest.mark.parametrize("name", ["x (mm)", "v (mm/s)"])
def test_what_a_hand_does_between_releases_is_no_test(tmp_path, name):
    """It pulls slowly, holds for a while, and lets go; noise hides nothing of it."""
    motion, lets_go, rests = [], [], []
    for start in (10.0, -7.0, 9.0):
        t = np.arange(6000) / RATE
        free = start * np.exp(-t) * np.cos(2.0 * np.pi * 3.0 * t)
        pull = start * np.sin(np.linspace(0.0, 0.5 * np.pi, 1500)) ** 2
        before = np.r_[np.zeros(1000), pull, np.full(900, start)]
        lets_go.append((sum(map(len, motion)) + before.size) / RATE)
        rests.append(lets_go[-1] + t[-1] + 1.0)
        motion += [before, free]
    x = np.concatenate(motion)
    signal = x if name.startswith("x") else np.gradient(x, 1.0 / RATE)
    signal = signal + 0.01 * signal.max() * np.random.default_rng(0).normal(size=x.size) + 3.0 * (signal is x)
    found = begun(
        tmp_path, text(tmp_path / "one.csv", np.arange(x.size) / RATE, signal, header=f"t (s),{name}")
    )
    begins = [test.time[0] for test in found.tests]
    assert begins == pytest.approx(lets_go, abs=0.15)
    for test, rest in zip(found.tests, rests, strict=True):
        assert test.duration > 2.0
        assert test.time[-1] < rest + 0.3


def test_a_spike_is_a_missing_sample_and_begins_no_test(tmp_path):
    t, x = decay()
    x[1500] = 400.0
    found = begun(tmp_path, text(tmp_path / "one.csv", t, x, header="t (s),x (mm)")).tests[0]
    assert found.time[0] < 0.3
    assert np.abs(found.displacement).max() < 0.011
    assert "displacement has a spike at 1.5 s that no motion makes: it counts as missing" in found.remarks


@pytest.mark.parametrize("samples", [4, 5, 40])
def test_no_motion_that_is_sampled_four_times_a_period_has_a_spike(samples):
    t = np.arange(40 * samples) / samples
    for damping in (0.0, 0.05, 0.4):
        assert not spikes(np.exp(-2.0 * np.pi * damping * t) * np.cos(2.0 * np.pi * t + 0.1)).any()
    assert not spikes(np.sign(np.sin(0.1 * t + 0.01))).any()


def test_two_speeds_without_names_are_base_and_mass_and_an_accelerometer_on_a_shaft_is_left_out(tmp_path):
    t = np.arange(20000) / RATE
    base, mass = (np.gradient(each, t) for each in (np.sin(19.0 * t), 1.3 * np.sin(19.0 * t - 0.3)))
    header = "t (s),n1 (1/min),n2 (1/min),a (g)"
    path = text(tmp_path / "one.csv", t, 800.0 + base, 800.0 + mass, 0.01 * mass, header=header)
    columns = begun(tmp_path, path).columns
    assert columns["velocity"]["column"] == "n2 (1/min)"
    assert columns["input"]["column"] == "n1 (1/min)"
    assert "acceleration" not in columns


def test_a_number_that_stands_for_missing_samples_is_stated(tmp_path):
    """In text that is Chinese, in its own encoding, with the load that makes friction a coefficient."""
    t, d, f = loop(mass=0.0, damping=0.0)
    load = np.where(
        np.arange(t.size) % 500 == 7, -999.0, 100.0 + 0.1 * np.random.default_rng(1).normal(size=t.size)
    )
    f = np.where(load < 0.0, load, f)
    text(tmp_path / "one.csv", t, d, f, load, header="时间(s),位移(mm),摩擦力(N),载荷(N)")
    (tmp_path / "one.csv").write_bytes((tmp_path / "one.csv").read_text().encode("gbk"))
    found = begun(tmp_path, tmp_path / "one.csv")
    assert found.columns["force"]["missing"] == ["-999"]
    assert found.tests[0].model == {"oscillator.normal_force_N": pytest.approx(100.0, abs=0.1)}
    assert np.abs(found.tests[0].force).max() < 30.0


def test_a_force_under_a_velocity_alone_is_a_loop(tmp_path):
    """The integral of the velocity is the displacement, whatever the zero of its sensor."""
    t = np.arange(6000) / 500.0
    omega, (one, other) = 2.0 * np.pi * 1.6, np.random.default_rng(0).normal(size=(2, t.size))
    speed = 0.025 * omega * np.cos(omega * t)
    force = 600.0 * speed + 40.0 * np.sign(speed) - 180.0 + 2.0 * one
    text(
        tmp_path / "one.csv", t, 1e3 * speed + 7.0 + 0.2 * other, force, header="t_s,shaft_speed_mm_s,load_N"
    )
    found = begun(tmp_path, tmp_path / "one.csv")
    test = found.tests[0]
    assert test.kind == "loop"
    np.testing.assert_allclose(
        test.displacement - test.displacement.mean(), 0.025 * np.sin(omega * t), atol=5e-4
    )
    assert found.model.oscillator["damping"] == pytest.approx(600.0, rel=0.05)
    (recorded,) = loop_data(found).recordings
    assert 0.05e-3 < recorded.motion.noise[1] < 0.2e-3


def test_a_force_that_drifts_and_a_wrong_unit_of_time_are_told(tmp_path):
    t, d, f = loop()
    found = begun(tmp_path, text(tmp_path / "one.csv", t, d, f, header="t (s),d (mm),F (N)"))
    assert quality.warnings(found.tests[0]) == []
    found = begun(tmp_path, text(tmp_path / "one.csv", t, d, f + 4.0 * t, header="t (s),d (mm),F (N)"))
    assert [each[:22] for each in quality.warnings(found.tests[0])] == ["force: its mean drifts"]
    found = begun(tmp_path, text(tmp_path / "one.csv", t, d, f, header="t (ms),d (mm),F (N)"))
    (warning,) = quality.warnings(found.tests[0])
    assert re.search(
        r"displacement: its acceleration is about .*at 1\.\d+e\+03 Hz; is its unit right", warning
    )


def test_a_delay_of_a_force_beside_a_damper_is_told(tmp_path):
    """A mass below zero would explain it as well."""
    late, random, files = 0.005, np.random.default_rng(1), []
    for rate in (0.5, 1.0, 2.0):
        t, omega = np.arange(0.0, 8.0 / rate, 0.002), 2.0 * np.pi * rate
        force = 400.0 * np.sin(omega * (t - late)) + 12.0 * omega * np.cos(omega * (t - late))
        columns = t, 20.0 * np.sin(omega * t), force + random.normal(size=t.size)
        files.append(text(tmp_path / f"{rate}.csv", *columns, header="t (s),d (mm),F (N)"))
    (warning,) = consistency.warnings(begun(tmp_path, *files))
    told = re.search(r"delay_ms = (\S+) at force", warning)
    assert float(told[1]) == pytest.approx(1e3 * late, rel=0.05)


def test_a_force_that_was_clipped_does_not_count(tmp_path):
    """But one as flat as friction alone, without noise, does."""
    t, d, f = loop()
    found = begun(
        tmp_path, text(tmp_path / "one.csv", t, d, np.minimum(f, 20.0), header="t (s),d (mm),F (N)")
    )
    (recorded,) = loop_data(found).recordings
    assert recorded.force[recorded.known].max() < 20.0
    assert 0.5 < recorded.known.mean() < 0.8
    assert not quality.clipped(20.0 * np.sign(d)).any()
    assert not quality.clipped(np.round(f)).any()
