"""The engineer's quantities against closed forms: Den Hartog's friction, statics, a linear suspension."""

import csv
from math import pi, sqrt
from pathlib import Path

import numpy as np
import pytest
import xarray as xr
from matplotlib.text import Text

from tests.command import invoke
from tests.physics.cases import TABLE_1
from wedgesweep import config, figures, units
from wedgesweep.engineering_quantities import OF_CYCLE, OF_WHEEL, QUANTITIES, engineering
from wedgesweep.solvers import imposed_motion
from wedgesweep.sweep.run import Sweep
from wedgesweep.systems.suspension.parameters import DAMPING

G = TABLE_1["gravity"]
MASS = TABLE_1["bolster_mass"] + 2.0 * TABLE_1["wedge_mass"]
STEADY = {"method": "event-driven", "settle": "steady", "rtol": 1e-10, "steady_tolerance": 1e-10}
AMPLITUDE = 1e-3
SWEEP_OF_ONE = {"friction_law": "coulomb", "beta": 1.0, "amplitude_mm": 1.0}


def solved(beta, law="coulomb", settings=STEADY, **tables):
    sweep = {"friction_law": law, "beta": beta, "amplitude_mm": AMPLITUDE * 1e3}
    made = config.from_document({**tables, "sweep": sweep | tables.get("sweep", {}), "solver": settings})
    return engineering(Sweep(made, None).run_here())


def test_friction_alone_takes_4_times_its_force_times_travel():
    force = 0.2
    ds = solved(
        [0.8, 1.9],
        suspension={"column_angle_deg": 0.0},
        friction={"dynamic": 0.0, "static": 0.0},
        effects={"guide_friction": {"force_N": force}},
    )
    stiffness, travel = TABLE_1["bolster_spring"] + 2 * TABLE_1["wedge_spring"], 0.5 * ds["peak_to_peak"]
    assert ds["relative_friction"].values == pytest.approx(force / (MASS * G), rel=1e-8)
    assert ds["snubbing_ratio"].values == pytest.approx(force / (MASS * G), rel=1e-14)
    damping = 2.0 * force / (pi * stiffness * travel)
    assert ds["equivalent_damping_ratio"].values == pytest.approx(damping.values, rel=1e-8)


@pytest.mark.parametrize("law", ["coulomb", "static-dynamic"])
def test_energy_a_cycle_is_what_the_base_supplies(law):
    ds = solved([0.4, 1.75], law)
    lost = ds["relative_friction"] * 4.0 * 0.5 * ds["peak_to_peak"] * ds["static_load"]
    assert lost.values == pytest.approx(ds["supplied_energy"].values, rel=1e-6)


@pytest.mark.parametrize("damping", DAMPING)
@pytest.mark.parametrize("gamma", [4.0, -4.0])
def test_friction_up_and_down_are_the_forces_that_a_slow_motion_takes(gamma, damping):
    suspension = {"damping": damping, "column_angle_deg": gamma, "wedge_preload_N": 3.0, "wear_mm": 0.2}
    ds = solved(1.0, suspension=suspension)
    case = config.from_document({"suspension": suspension, "sweep": SWEEP_OF_ONE}).records()
    still = np.zeros(3)
    up, down = (
        imposed_motion.forces(case, still, still + sense * 1e-9, still, 1e-3)[0, 1] for sense in (1.0, -1.0)
    )
    assert ds["friction_force_up"].item() == pytest.approx(up, rel=1e-10)
    assert ds["friction_force_down"].item() == pytest.approx(-down, rel=1e-10)


def test_massless_wedges_have_the_closed_form_of_friction_angles():
    mu = 0.25
    ds = solved(1.0, suspension={"wedge_mass_kg": 0.0}, friction={"dynamic": mu})
    alpha, gamma, phi = TABLE_1["wedge_angle"], TABLE_1["column_angle"], np.arctan(mu)
    spring = 0.5 * ds["wedge_load_share"].item() * ds["static_load"].item()

    def wedges(column, bolster):
        """Force on the bolster, by the triangle of spring force and both reactions on a wedge."""
        return (
            2.0 * spring * np.cos(gamma + column) * np.sin(alpha + bolster)
            / np.sin(alpha + gamma + column + bolster)
        )  # fmt: skip

    assert ds["friction_force_up"].item() == pytest.approx(wedges(0, 0) - wedges(phi, -phi), rel=1e-12)
    assert ds["friction_force_down"].item() == pytest.approx(wedges(-phi, phi) - wedges(0, 0), rel=1e-12)


def test_wedges_that_lock_have_no_friction_force():
    ds = solved(1.0, suspension={"column_angle_deg": -4.0}, friction={"dynamic": 1.5, "static": 1.5})
    assert np.isnan(ds["friction_force_down"].item())
    assert ds["static_load"].item() == MASS * G


def test_a_linear_suspension_unloads_by_its_harmonic_inertia():
    damper, beta = 20.0, 1.3
    ds = solved(
        beta,
        suspension={"column_angle_deg": 0.0},
        friction={"dynamic": 0.0, "static": 0.0},
        effects={"viscous_damping": {"coefficient_N_s_per_m": damper}},
        settings=STEADY | {"samples_per_period": 2048},
    )
    stiffness = TABLE_1["bolster_spring"] + 2 * TABLE_1["wedge_spring"]
    omega = beta * sqrt(TABLE_1["bolster_spring"] / TABLE_1["bolster_mass"])
    z = MASS * omega**2 * AMPLITUDE / (stiffness - MASS * omega**2 + 1j * omega * damper)
    whole = MASS + TABLE_1["side_frame_mass"]
    inertia = abs(whole * omega**2 * AMPLITUDE + MASS * omega**2 * z)
    assert ds["minimum_load_ratio"].item() == pytest.approx(1.0 - inertia / (whole * G), rel=1e-5)
    # Mean forces on the faces are those at rest, their extremes lie evenly about them.
    rest = 0.5 * ds["wedge_load_share"].item() * MASS * G - TABLE_1["wedge_mass"] * G
    alpha = TABLE_1["wedge_angle"]
    assert ds["bolster_force_mean"].item() == pytest.approx(rest / np.sin(alpha), rel=1e-6)
    assert ds["column_force_mean"].item() == pytest.approx(rest / np.tan(alpha), rel=1e-6)
    swing = [ds[f"column_force_{name}"].item() - ds["column_force_mean"].item() for name in ("min", "max")]
    assert swing[0] == pytest.approx(-swing[1], rel=1e-5)


@pytest.mark.few(1)
@pytest.mark.parametrize("law", ["coulomb", "static-dynamic", "exponential"])
@pytest.mark.parametrize("beta", [0.4, 1.75])
def test_forces_on_faces_are_those_of_fine_waveforms_by_both_solvers(law, beta):
    settings = {"method": "event-driven", "settle_periods": 5, "samples_per_period": 16384}
    ds = solved(beta, law, settings)
    smallest = min(ds["column_force_min"].item(), ds["bolster_force_min"].item())
    assert smallest == ds["minimum_normal_force"].item()
    other = {"method": "radau", "settle_periods": 5, "rtol": 1e-8, "samples_per_period": 32}
    radau = solved(beta, law, other)
    for face in ("column", "bolster"):
        wave = ds[f"normal_force_{face}"].astype(float)
        mean, low, high = (ds[f"{face}_force_{name}"].item() for name in ("mean", "min", "max"))
        assert mean == pytest.approx(wave.mean().item(), rel=2e-4)
        # Samples miss short peaks, where a regularised face leaves its ramp.
        swing = wave.max().item() - wave.min().item()
        missed = 0.001 if law == "coulomb" else 0.1
        assert -1e-4 <= (wave.min().item() - low) / swing <= missed
        assert -1e-4 <= (high - wave.max().item()) / swing <= missed
        for name, expected in (("mean", mean), ("min", low), ("max", high)):
            assert radau[f"{face}_force_{name}"].item() == pytest.approx(expected, rel=1e-4)


def test_every_axis_of_a_model_counts_also_after_a_selection():
    axes = {"suspension.bolster_mass_kg": [0.7, 1.4], "suspension.wear_mm": [0.0, 0.2]}
    ds = solved(
        1.0, ["coulomb", "exponential"], sweep={"axes": axes}, settings=STEADY | {"keep_waveforms": False}
    )
    assert set(QUANTITIES) & set(ds) == set(QUANTITIES) - set(OF_WHEEL)
    assert all(ds[name].dims == ds["status"].dims for name in QUANTITIES if name in ds)
    single = ds.sel(bolster_mass_kg=1.4, friction_law="exponential")
    again = engineering(single.drop_vars([name for name in QUANTITIES if name in ds]))
    for name in set(QUANTITIES) & set(ds):
        assert again[name].values.tolist() == single[name].values.tolist()
    heavy = ds["static_load"].sel(bolster_mass_kg=1.4) - ds["static_load"].sel(bolster_mass_kg=0.7)
    assert heavy.values == pytest.approx(0.7 * G, rel=1e-14)
    assert ds["wedge_load_share"].diff("wear_mm").max() < 0.0


@pytest.mark.acceptance
def test_inputs_without_a_period_have_no_loss_a_cycle_and_oscillators_nothing():
    tables = {"sweep": {"friction_law": "coulomb"}, "solver": {"method": "event-driven"}}
    release = {"kind": "release", "displacement_mm": 0.4, "duration_s": 0.1}
    ds = engineering(Sweep(config.from_document(tables | {"input": release}), None).run_here())
    assert set(QUANTITIES) & set(ds) == set(QUANTITIES) - set(OF_CYCLE) - set(OF_WHEEL)
    assert (
        0.0 < ds["column_force_min"].item() < ds["column_force_mean"].item() < ds["column_force_max"].item()
    )
    mass = {"mass_kg": 1.0, "spring_N_per_mm": 1.0, "normal_force_N": 1.0}
    other = Sweep(config.from_document({"oscillator": mass, "sweep": SWEEP_OF_ONE, "solver": STEADY}), None)
    with pytest.raises(ValueError, match="of a suspension; this is an oscillator"):
        engineering(other.run_here())


def test_customary_units_are_exact():
    values = {
        "inch": (25.4, "mm", 1.0, "in"),
        "foot": (0.3048, "m", 12.0, "in"),
        "pound": (0.45359237 * 9.80665, "N", 1.0, "lbf"),
        "mass": (0.45359237, "kg", 1.0, "lb"),
        "rate": (4.4482216152605 / 25.4, "N mm-1", 1.0, "lbf in-1"),
        "work": (0.0254 * 4.4482216152605, "J", 1.0, "in lbf"),
        "fall": (9.144, "m s-2", 360.0, "in s-2"),
        "angle": (30.0, "degree", 30.0, "degree"),
    }
    ds = xr.Dataset({name: ((), value, {"units": unit}) for name, (value, unit, *_) in values.items()})
    for name, (*_, expected, unit) in values.items():
        found = units.in_system(ds, "us")[name]
        assert (found.item(), found.attrs["units"]) == (pytest.approx(expected, rel=4e-16), unit)
    kip = units.in_system(ds, "us-kip")["pound"]
    assert (kip.item(), kip.attrs["units"]) == (1e-3, "kip")
    assert ds["inch"].attrs["units"] == "mm"


@pytest.mark.parametrize(
    ("given", "wanted"),
    [
        ("$a$ = 25.4 mm; 2 faces", "$a$ = 1 in; 2 faces"),
        ("0.254 to 2.54 mm", "0.01 to 0.1 in"),
        ("-4.448 N, 45.4 kg", "-1 lbf, 100 lb"),
        ("1.00e-05 m", "0.000394 in"),
        ("force [N/mm]", "force [lbf/in]"),
        ("velocity [mm/s] and [m s-2]", "velocity [in/s] and [in s-2]"),
        ("3 mm/s^2", "0.118 in/s^2"),
        ("12 min, 4 Nm-like, 38 Hz [1]", "12 min, 4 Nm-like, 38 Hz [1]"),
    ],
)
def test_numbers_in_texts_are_converted(given, wanted):
    assert units.in_text(given, "us") == wanted


@pytest.fixture
def worn(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    axes = {"suspension.wear_mm": [0.0, 0.127, 0.254], "friction.dynamic": [0.2, 0.3]}
    tables = {"sweep": {**SWEEP_OF_ONE, "axes": axes}, "solver": STEADY | {"keep_waveforms": False}}
    ds = Sweep(config.from_document(tables), None).run_here()
    ds.to_netcdf("worn.nc")
    return ds


def test_export_and_figures_derive_quantities_and_show_them_in_units_of_choice(worn):
    columns = "friction_force_up,amplitude_ratio"
    invoke("export", "worn.nc", "-o", "out.csv", "--variables", columns, "--units", "us")
    with Path("out.csv").open() as file:
        rows = list(csv.DictReader(file))
    assert list(rows[0])[-4:] == [
        "wear_mm [in]",
        "friction_dynamic",
        "friction_force_up [lbf]",
        "amplitude_ratio",
    ]
    up = engineering(worn)["friction_force_up"].values.ravel() / units.POUND
    assert [float(row["friction_force_up [lbf]"]) for row in rows] == up.tolist()
    assert {float(row["wear_mm [in]"]) for row in rows} == {0.0, 0.005, 0.01}

    picks = {"x": "wear_mm", "color": "friction_dynamic", "variable": "friction_force_up"}
    figure = figures.draw(worn, "lines", units="us", **picks)
    (ax,) = figure.axes
    assert (ax.get_xlabel(), ax.get_ylabel()) == ("wear of each column face [in]", "friction force up [lbf]")
    for axis, values, own in (
        (ax.xaxis, ax.lines[0].get_xdata(), [0.0, 0.005, 0.01]),
        (ax.yaxis, ax.lines[0].get_ydata(), up.reshape(3, 2)[:, 0]),
    ):
        write = axis.get_major_formatter()
        assert [float(write(value, 0)) for value in values] == pytest.approx(own, rel=1e-5)
        ticks = [float(write(tick, 0)) for tick in axis.get_major_locator()()]
        assert np.diff(ticks, 2) == pytest.approx(0.0, abs=1e-4)
    picked = figures.draw(worn, "map", units="us", x="amplitude", y="friction_dynamic", at={"wear_mm": 0.254})
    assert picked.axes[0].get_xlabel() == "input amplitude $a$ [in]"
    assert "wear 0.01 in" in "".join(text.get_text() for text in picked.findobj(Text))


def test_a_quantity_that_the_data_do_not_give_says_what_it_needs(worn):
    for words in (
        ("export", "worn.nc", "--variables", "minimum_load_ratio"),
        ("plot", "lines", "worn.nc", "--variable", "minimum_load_ratio"),
    ):
        assert "minimum_load_ratio: needs waveforms (keep_waveforms = true)" in invoke(*words, code=2)
