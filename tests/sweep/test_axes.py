"""Any number of the model as an axis: one dimension each, cases known by their numbers, sweeps that grow."""

import shutil
from datetime import UTC, datetime
from itertools import product

import numpy as np
import pytest
import xarray as xr

from tests import small_sweep
from wedgesweep import config, figures
from wedgesweep.config.physics import breakaway
from wedgesweep.errors import MismatchError
from wedgesweep.figures import models
from wedgesweep.sweep import dataset, outcomes, unfinished, variables
from wedgesweep.sweep.journal import Journal
from wedgesweep.sweep.run import CaseFailedError, Sweep

SOLVER = """
[solver]
method = "event-driven"
settle_periods = 3
kept_periods = 2
samples_per_period = 32
keep_waveforms = false
"""
SWEEP = """
[sweep]
friction_law = "coulomb"
frequency_hz = [10.0, 20.0]
amplitude_mm = 0.3
"""
ANGLES = """
[sweep.axes]
"suspension.wedge_angle_deg" = [30, 37.5]
friction.dynamic = [0.1, 0.2, 0.3]
"""


def sweep(folder, axes=ANGLES, **more):
    text = SWEEP
    for name, value in more.items():
        text = text.replace(f"{name} = ", f"{name} = {value} #")
    return Sweep(config.parse(text + axes + SOLVER), folder / "axes.nc")


def solved(made: Sweep) -> list[int]:
    """Run a sweep; the indices of the cases that were solved, not taken from an earlier run."""
    parts = []
    made.run(n_jobs=1, progress=lambda records, total: parts.append(records["index"].tolist()))
    return sorted(index for part in parts[1:] for index in part)


def fixed(wedge: float, dynamic: float, mass: float = 0.7) -> xr.Dataset:
    """A sweep of the same frequencies with these numbers in its tables."""
    numbers = f"wedge_angle_deg = {wedge}\nbolster_mass_kg = {mass}\n[friction]\ndynamic = {dynamic}\n"
    return Sweep(config.parse("[suspension]\n" + numbers + SWEEP + SOLVER), None).run_here()


@pytest.fixture(scope="module")
def angles(tmp_path_factory) -> Sweep:
    """The sweep of three numbers of friction and two angles, run once; others get a copy of its file."""
    made = sweep(tmp_path_factory.mktemp("angles"))
    made.run(n_jobs=1)
    return made


@pytest.fixture
def copied(angles, tmp_path):
    """A folder with the dataset of ``angles``."""
    shutil.copy(angles.out, tmp_path)
    return tmp_path


def test_each_axis_is_a_dimension_with_units_and_values_are_those_of_single_configs(angles):
    ds = xr.load_dataset(angles.out)
    assert ds["amplitude_ratio"].dims == (
        *("friction_law", "wedge_angle_deg", "friction_dynamic"),
        *("frequency", "amplitude"),
    )
    angle = ds["wedge_angle_deg"]
    assert (angle.attrs["units"], angle.attrs["key"]) == ("degree", "suspension.wedge_angle_deg")
    for wedge, dynamic in product(ds["wedge_angle_deg"].values, ds["friction_dynamic"].values):
        here = ds.sel(wedge_angle_deg=wedge, friction_dynamic=dynamic)
        alone = fixed(wedge, dynamic)
        assert here["amplitude_ratio"].values.tolist() == alone["amplitude_ratio"].values.tolist()
        assert here["frequency"].values.tolist() == alone["frequency"].values.tolist()
    assert dataset.read_sweep(angles.out)["status"].shape == (1, 2, 3, 2, 1)


def test_frequencies_in_hertz_are_common_where_omega_n_varies(tmp_path):
    ds = sweep(tmp_path, "[sweep.axes]\nsuspension.bolster_mass_kg = [0.5, 0.7]\n").run(n_jobs=1)
    assert ds["frequency"].values.tolist() == [10.0, 20.0]
    assert ds["beta"].dims == ("bolster_mass_kg", "frequency")
    assert ds["omega_n"].values == pytest.approx(np.sqrt(5100.0 / np.array([0.5, 0.7])), rel=1e-15)
    light = fixed(37.5, 0.29, mass=0.5)
    assert (
        ds.sel(bolster_mass_kg=0.5)["amplitude_ratio"].values.tolist()
        == light["amplitude_ratio"].values.tolist()
    )


def test_a_given_beta_is_that_of_each_model(tmp_path):
    text = SWEEP.replace("frequency_hz = [10.0, 20.0]", "beta = [0.8, 1.5]")
    axes = "[sweep.axes]\nsuspension.bolster_spring_N_per_mm = [4.0, 5.1]\n"
    read = config.parse(text + axes + SOLVER)
    omega = read.records()["input"]["omega"].reshape(2, 2)
    assert omega == pytest.approx(np.outer(np.sqrt(np.array([4000.0, 5100.0]) / 0.7), [0.8, 1.5]), rel=1e-15)
    assert read.case_coordinates()["frequency"][0] == ("bolster_spring_N_per_mm", "beta")


def test_axes_that_go_together_are_one_dimension(tmp_path):
    axes = """
[sweep.axes]
suspension.bolster_mass_kg = [0.5, 0.7, 0.9]
suspension.bolster_spring_N_per_mm = [5.0, 4.0, 5.0]
zip = ["suspension.bolster_mass_kg", "suspension.bolster_spring_N_per_mm"]
"""
    read = sweep(tmp_path, axes).config
    assert read.sweep.dims == ("friction_law", "bolster_mass_kg", "frequency", "amplitude")
    coordinates = read.case_coordinates()
    assert coordinates["bolster_spring_N_per_mm"][0] == coordinates["omega_n"][0] == ("bolster_mass_kg",)
    assert config.parse(read.to_toml()) == read


def test_listed_cases_have_numbers_too(tmp_path):
    """Also those that have no default, if all cases give them."""
    case = '[[sweep.case]]\nfriction_law = "coulomb"\nfrequency_hz = {}\namplitude_mm = 0.3\n{}\n'
    listed = case.format(20.0, "suspension.wedge_angle_deg = 30.0")
    listed += case.format(10.0, '"suspension.wedge_angle_deg" = 37.5')
    ds = Sweep(config.parse(listed + SOLVER), tmp_path / "listed.nc").run(n_jobs=1)
    assert ds["wedge_angle_deg"].dims == ("case",)
    expected = [fixed(30.0, 0.29).isel(beta=1), fixed(37.5, 0.29).isel(beta=0)]
    assert ds["amplitude_ratio"].values.tolist() == [each["amplitude_ratio"].item() for each in expected]
    read = config.parse("".join(case.format(1.0, f"suspension.locked_in = {each}") for each in (0.5, 1.0)))
    assert read.case_coordinates()["locked_in"][1].tolist() == [0.5, 1.0]


def test_effects_vary_from_off_to_on_and_need_no_table(tmp_path):
    axes = "[sweep.axes]\neffects.guide_friction.force_N = [0.0, 2.0]\n"
    ds = sweep(tmp_path, axes).run(n_jobs=1)
    assert ds["guide_friction_force_N"].attrs["units"] == "N"
    off = ds.sel(guide_friction_force_N=0.0)["amplitude_ratio"].values
    assert off.tolist() == fixed(37.5, 0.29)["amplitude_ratio"].values.tolist()
    assert (ds.sel(guide_friction_force_N=2.0)["amplitude_ratio"].values < off).any()


@pytest.mark.parametrize(
    ("axes", "words"),
    [
        ('[sweep.axes]\n"suspension.wedge_angel_deg" = [1]', 'did you mean "suspension.wedge_angle_deg"?'),
        ("[sweep.axes]\nfriction.dynamic = [0.2, 0.1]", "increasing order"),
        ("[sweep.axes]\nfriction.dynamic = [0.2, -0.1]", 'sweep.axes."friction.dynamic"[1]'),
        ("[sweep.axes]\nsuspension.column_angle_deg = [-40, 4]", "column_angle_deg = -40"),
        ("[sweep.axes]\nsuspension.column_angle_deg = [-4, 0, 4]", "bolster face does not slip"),
        ('[sweep.axes]\nfriction.dynamic = [0.1]\nzip = ["friction.dynamic", "a.b"]', "a.b is no axis"),
        ("[sweep.axes]\nsolver.rtol = [1e-6]", "no number of a model"),
    ],
)
def test_wrong_axes_are_named(axes, words):
    (fault,) = small_sweep.faults(SWEEP + axes + SOLVER)
    assert "sweep" in fault
    assert words in fault


def test_a_longer_axis_computes_new_cases_only(copied):
    small = xr.load_dataset(copied / "axes.nc")
    grown = sweep(copied, ANGLES.replace("37.5]", "37.5, 40.0]"))
    assert grown.stored() is None
    assert len(solved(grown)) == 6
    ds = xr.load_dataset(copied / "axes.nc")
    kept = ds.sel(wedge_angle_deg=[30.0, 37.5])
    for name in small.data_vars:
        is_float = small[name].dtype.kind == "f"
        assert np.array_equal(kept[name].values, small[name].values, equal_nan=is_float), name
    small_sweep.assert_same_numbers(ds, Sweep(grown.config, None).run_here())


def test_an_axis_added_to_a_plain_sweep_reuses_its_cases(tmp_path):
    plain = sweep(tmp_path, "")
    plain.run(n_jobs=1)
    assert solved(sweep(tmp_path, "[sweep.axes]\nfriction.dynamic = [0.1, 0.29]\n")) == [0, 1]


def test_an_interrupted_sweep_grows_and_resumes(tmp_path):
    small = sweep(tmp_path)
    with Journal(small.journal_path, small.dtype, small.journal_header) as journal:
        journal.append(small.solve(np.array([0, 5, 7])))
    more = ANGLES.replace("0.3]", "0.3, 0.4]")
    grown = sweep(tmp_path, more)
    assert len(solved(grown)) == 16 - 3
    fresh = Sweep(grown.config, tmp_path / "fresh.nc").run(n_jobs=1)
    small_sweep.assert_same_numbers(xr.load_dataset(tmp_path / "axes.nc"), fresh)


def test_another_sweep_never_reuses_a_case_and_discards_nothing_and_a_new_title_does_neither(copied):
    path, text = copied / "axes.nc", SWEEP + ANGLES + SOLVER
    before = path.read_bytes()
    changed = "[friction]\nstatic = 0.4\n" + text
    for other in (changed, text.replace(", 0.3]", "]"), text + "rtol = 1e-8\n"):
        with pytest.raises(MismatchError, match="there"):
            Sweep(config.parse(other), path).stored()
    with pytest.raises(MismatchError):
        Sweep(config.parse(changed), path).run(n_jobs=1)
    assert path.read_bytes() == before
    renamed = Sweep(config.parse('title = "new"\n' + text), path)
    assert renamed.stored() is None
    assert solved(renamed) == []
    assert xr.load_dataset(path).attrs["title"] == "new"


def test_rows_of_a_continuation_are_reused_whole_or_not_at_all(tmp_path):
    text = """
[sweep]
friction_law = "coulomb"
frequency_hz = [30.0, 31.0]
amplitude_mm = [0.3]
[sweep.axes]
suspension.wedge_angle_deg = [37.5]
[solver]
method = "event-driven"
settle = "steady"
continuation = true
keep_waveforms = false
"""
    Sweep(config.parse(text), tmp_path / "rows.nc").run(n_jobs=1)
    wider = Sweep(config.parse(text.replace("[37.5]", "[37.5, 38.0]")), tmp_path / "rows.nc")
    assert solved(wider) == [2, 3]
    longer = Sweep(config.parse(text.replace("31.0]", "31.0, 32.0]")), tmp_path / "rows.nc")
    with pytest.raises(MismatchError):
        longer.stored()


def test_status_export_and_errors_name_the_numbers(tmp_path):
    # With this lean and friction the normal forces are not unique.
    axes = "[sweep.axes]\nsuspension.column_angle_deg = [-4.0, 4.0]\nfriction.dynamic = [0.29, 0.5]\n"
    made = sweep(tmp_path, axes, amplitude_mm="2.0", frequency_hz="15.0")
    ds = made.run(n_jobs=1)
    words = "suspension.column_angle_deg -4, friction.dynamic 0.5"
    assert [words in outcomes.described(ds, place) for place in outcomes.failures(ds)] == [True]
    with pytest.raises(CaseFailedError, match=words):
        made.run(n_jobs=1, fail_fast=True, fresh=True)
    made.out.unlink()
    begun = unfinished.dataset_of(made.out)
    assert words in outcomes.described(begun, outcomes.failures(begun)[0])
    assert begun["status"].dims == ds["status"].dims


def test_both_ends_of_breakaway_are_told_along_the_axes_that_change_them():
    text = SWEEP.replace('"coulomb"', '["coulomb", "exponential"]')
    text += '[sweep.axes]\n"suspension.column_angle_deg" = [-4.0, 4.0]\n'
    told = breakaway(config.parse(text))
    for name, expected in (("breakaway_min", (0.455585, 0.395971)), ("breakaway_max", (0.947180, 0.736869))):
        dims, values, _ = told[name]
        values = xr.DataArray(values, dims=dims).transpose("friction_law", ...)
        np.testing.assert_allclose(values[0], expected, atol=1e-6)
        assert values[1].isnull().all()  # a regularised law creeps at any input


def test_figures_draw_any_axes_and_pick_the_rest(angles):
    ds = xr.load_dataset(angles.out)
    drawn = figures.draw(ds, "map", x="suspension.wedge_angle_deg", y="friction_dynamic", facet="frequency")
    titles = [ax.get_title() for ax in drawn.axes]
    assert titles[:2] == ["frequency 10 Hz", "frequency 20 Hz"]
    assert drawn.axes[0].get_xlabel().endswith("[deg]")
    lines = figures.draw(ds, "lines", x="frequency", color="friction_dynamic", at={"wedge_angle_deg": 30})
    assert len(lines.axes[0].lines) >= 3
    assert "wedge angle 30 deg" in lines.get_suptitle()
    with pytest.raises(ValueError, match="no axis wedge_angel_deg"):
        figures.draw(ds, "lines", x="wedge_angel_deg")
    with pytest.raises(ValueError, match="friction_law: has names, no numbers; give it to --facet"):
        figures.draw(ds, "map", y="friction_law")
    picked = figures.draw(ds, "amplitude-ratio", at={"friction_dynamic": 0.2})
    assert "friction.dynamic = 0.2" in picked.get_suptitle().replace("\n", " ")


def test_one_model_of_a_dataset_is_that_of_its_own_config(tmp_path):
    axes = "[sweep.axes]\nsuspension.bolster_mass_kg = [0.5, 0.7]\nfriction.dynamic = [0.2]\n"
    ds = sweep(tmp_path, axes).run(n_jobs=1)
    one, alone = models.of_one(ds, {"suspension.bolster_mass_kg": 0.5}), fixed(37.5, 0.2, mass=0.5)
    assert one["amplitude_ratio"].dims == alone["amplitude_ratio"].dims
    assert one["amplitude_ratio"].values.tolist() == alone["amplitude_ratio"].values.tolist()
    assert one["beta"].values == pytest.approx(alone["beta"].values, rel=1e-15)
    for name in ("omega_n", "frictionless_resonance", "breakaway_acceleration", "rest_position"):
        assert one.attrs[name] == alone.attrs[name]


def test_the_model_drawn_by_default_moves(tmp_path):
    ds = sweep(tmp_path, "[sweep.axes]\nfriction.dynamic = [0.1, 0.29, 0.3]\n", amplitude_mm="0.05").run(
        n_jobs=1
    )
    assert (ds["stick_fraction"].sel(friction_dynamic=0.29) == 1.0).any()
    stuck = ds.assign(stick_fraction=ds["stick_fraction"].where(ds["friction_dynamic"] < 0.2, 1.0))
    assert "friction.dynamic = 0.1" in models.of_one(stuck).attrs["model"]


def test_kinds_of_damping_are_an_axis_of_names(tmp_path):
    model = "[suspension]\nwedge_preload_N = 4.0\n"
    axes = '[sweep.axes]\nsuspension.damping = ["constant", "variable"]\n'
    made = Sweep(config.parse(model + SWEEP + axes + SOLVER), tmp_path / "axes.nc")
    made.run(n_jobs=1)
    ds = xr.load_dataset(made.out)
    for damping in ("constant", "variable"):
        alone = Sweep(config.parse(f'{model}damping = "{damping}"\n{SWEEP}{SOLVER}'), None).run_here()
        here = ds.sel(damping=damping)["amplitude_ratio"].values
        assert here.tolist() == alone["amplitude_ratio"].values.tolist()
    assert "suspension.damping constant" in made.config.case_in_words(0)
    assert (
        figures.draw(ds, "lines", color="suspension.damping").legends[0].get_texts()[0].get_text()
        == "constant"
    )
    with pytest.raises(ValueError, match="no foo; the dataset has constant, variable"):
        figures.draw(ds, "lines", at={"damping": "foo"})
    (fault,) = small_sweep.faults(SWEEP + axes + SOLVER)
    assert "suspension.damping = constant: suspension.wedge_preload_N" in fault


TURNING = """
[oscillator]
motion = "rotation"
spring_N_m_per_rad = 5.0
friction_N_m = 0.2
[effects.end_stop]
stiffness_N_m_per_rad = 3.0
[sweep]
friction_law = "coulomb"
frequency_hz = [2.0, 3.0]
amplitude_rad = 0.1
[sweep.axes]
oscillator.inertia_kg_m2 = [0.01, 0.02]
effects.end_stop.clearance_deg = [9, 18]
zip = ["oscillator.inertia_kg_m2", "effects.end_stop.clearance_deg"]
"""


def test_a_rotation_has_axes_with_its_own_keys(tmp_path):
    read = config.parse(TURNING + SOLVER)
    assert config.parse(read.to_toml()) == read
    made = Sweep(read, tmp_path / "turn.nc")
    ds = made.assembled(variables.blank(made.dtype, np.arange(4)), datetime(2026, 1, 1, tzinfo=UTC))
    assert ds["status"].dims == ("friction_law", "inertia_kg_m2", "frequency", "amplitude")
    assert ds["end_stop_clearance_rad"].values == pytest.approx(np.radians([9.0, 18.0]))
    units = [ds[name].attrs["units"] for name in ("inertia_kg_m2", "end_stop_clearance_rad")]
    assert units == ["kg m2", "rad"]
    assert "0.1 rad, oscillator.inertia_kg_m2 0.01" in read.case_in_words(0)
    for place, (inertia, clearance) in enumerate(((0.01, 9.0), (0.02, 18.0))):
        given = TURNING.partition("[sweep.axes]")[0]
        given = given.replace("motion", f"inertia_kg_m2 = {inertia}\nmotion")
        alone = config.parse(given.replace("stiffness", f"clearance_deg = {clearance}\nstiffness"))
        assert alone.records().tobytes() == read.records(np.array([0, 1]) + 2 * place).tobytes()
        model = models.of_one(ds, {"oscillator.inertia_kg_m2": inertia})
        assert model.attrs["omega_n"] == pytest.approx(np.sqrt(5.0 / inertia))
    both = TURNING.replace("zip", "effects.end_stop.clearance_rad = [0.1, 0.2]\n#")
    assert "exclude each other" in small_sweep.faults(both + SOLVER)[-1]
