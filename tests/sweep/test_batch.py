"""The event-driven solver in a sweep: the same bits however it is cut, and no number that is not one."""

import random
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, strategies
from hypothesis import settings as hypothesis_settings

from tests import small_sweep
from tests.small_sweep import LOCKED, assert_same_numbers
from wedgesweep.friction import LAW_NAMES
from wedgesweep.response import NUMBERS
from wedgesweep.simulate import Settings
from wedgesweep.solvers.integrate import EVENTS_PER_PERIOD
from wedgesweep.sweep import cases, chunks, variables
from wedgesweep.sweep.variables import FORCES_OF_FACES, STATUSES
from wedgesweep.systems.suspension import parameters

EVENT_DRIVEN = small_sweep.FAST
STEADY = EVENT_DRIVEN.replace("settle_periods = 3", 'settle = "steady"\nsteady_tolerance = 1e-9\nrtol = 1e-9')
WAVEFORMS = {"displacement", "velocity", "normal_force_column", "normal_force_bolster", "stuck"}
OMEGA_N = 85.0


def run(directory, text=EVENT_DRIVEN, **options):
    return small_sweep.sweep(directory, text).run(**{"n_jobs": 1, "fresh": True, **options})


@pytest.fixture(scope="module")
def expected(tmp_path_factory):
    return run(tmp_path_factory.mktemp("expected"))


@pytest.mark.parametrize("chunk", [1, 5, 200])
def test_chunks_change_no_bit(tmp_path, expected, monkeypatch, chunk):
    monkeypatch.setattr(chunks, "CHUNK", chunk)
    monkeypatch.setattr(chunks, "CHUNKS", 1)
    told = []
    ds = run(tmp_path, progress=lambda records, total: told.append(len(records)))
    assert_same_numbers(ds, expected)
    assert max(told) == min(chunk, small_sweep.CASES)


def test_order_of_the_cases_changes_no_bit(tmp_path, expected):
    listed = small_sweep.sweep(tmp_path).config.case_list()
    order = random.Random(3).sample(range(len(listed)), len(listed))
    text = EVENT_DRIVEN[EVENT_DRIVEN.index("[solver]") :] + "".join(
        f'[[sweep.case]]\nfriction_law = "{law}"\nbeta = {beta}\namplitude_mm = {amplitude * 1e3!r}\n'
        for law, beta, amplitude, _ in (listed[place] for place in order)
    )
    shuffled = run(tmp_path, text)
    for name in set(expected.data_vars) - set(small_sweep.KNOWN_OF_LOCKED):
        values = expected[name].values.reshape(len(listed), *expected[name].shape[3:])
        is_float = values.dtype.kind == "f"
        assert np.array_equal(shuffled[name].values, values[order], equal_nan=is_float), name


def test_agrees_with_radau_in_every_variable(tmp_path):
    few = EVENT_DRIVEN.replace("0.3, 1.1, ", "").replace("0.02, 0.2, 0.6, ", "")
    few = few.replace("[solver]", "[solver]\nrtol = 1e-9")
    ours, radaus = run(tmp_path, few), run(tmp_path, few.replace('"event-driven"', '"radau"'))
    assert set(ours) == set(radaus)
    assert (ours["status"] == radaus["status"]).all()
    assert np.array_equal(ours["settled_periods"], radaus["settled_periods"])
    # Radau reads the peak off at its quadrature nodes, and so do both with the force.
    tolerances = {"peak_velocity": 5e-6, "minimum_normal_force": 1e-5}
    compared = {name for name in ours if ours[name].dtype.kind == "f"} - {"wall_time"}
    assert len(compared) > 15
    for name in compared:
        a, b = ours[name].values, radaus[name].values
        largest = np.nanmax(np.abs(b))
        assert np.array_equal(np.isnan(a), np.isnan(b)), name
        assert np.nanmax(np.abs(a - b)) <= tolerances.get(name, 1e-6) * largest, name


def test_without_waveforms_the_numbers_are_the_same(tmp_path, expected):
    ds = run(tmp_path, EVENT_DRIVEN + "keep_waveforms = false\n")
    assert not WAVEFORMS & set(ds)
    assert "phase" not in ds.coords
    assert_same_numbers(ds, expected.drop_vars([*WAVEFORMS, "phase"]))


def test_steady_cases_repeat_and_balance_their_energy(tmp_path):
    ds = run(tmp_path, STEADY)
    assert (ds["status"] == 0).all()
    assert (ds["period"] == 1).all()
    assert (ds["settled_periods"] > 0).all()
    assert float(ds["periodicity"].max()) < 1e-7
    moving = ds.where(ds["amplitude_ratio"] > 1e-3)
    assert int(moving["status"].notnull().sum()) > small_sweep.CASES / 2
    share = moving["dissipated_energy"] / moving["supplied_energy"]
    assert float(abs(share - 1.0).max()) < 1e-6


SUBHARMONIC = """\
title = "friction that falls steeply"
[friction]
dynamic = 0.1
static = 0.6
[solver]
method = "event-driven"
settle = "steady"
kept_periods = 12
samples_per_period = 32
rtol = 1e-9
[[sweep.case]]
friction_law = "static-dynamic"
beta = 0.716
amplitude_mm = 0.37
[[sweep.case]]
friction_law = "exponential"
beta = 0.51
amplitude_mm = 0.55
"""


def test_subharmonic_responses_are_told_by_their_period(tmp_path):
    ds = run(tmp_path, SUBHARMONIC)
    assert ds["period"].values.tolist() == [3, 2]
    for case, n in enumerate([3, 2]):
        one = ds.isel(case=case)
        poincare = one["displacement"].values[::32] / one["amplitude"].item()
        assert np.abs(poincare[n:] - poincare[:-n]).max() < 1e-6
        for shorter in range(1, n):
            assert np.abs(poincare[shorter:] - poincare[:-shorter]).max() > 1e-3
        assert one["dissipated_energy"].item() == pytest.approx(one["supplied_energy"].item(), rel=1e-6)


def test_what_does_not_repeat_in_time_has_period_0_and_numbers(tmp_path):
    ds = run(tmp_path, STEADY + "max_periods = 10\n")
    late = ds["period"] == 0
    assert 0 < late.sum() < small_sweep.CASES
    assert (ds["status"] == 0).all()
    assert (ds["settled_periods"].where(late, 10) == 10).all()
    for name in ("amplitude_ratio", "dissipated_energy", "stick_fraction"):
        assert np.isfinite(ds[name]).all()


def test_locked_cases_have_a_status_and_no_numbers(tmp_path):
    short = "settle_periods = 3"
    for method, settle in (("radau", short), ("event-driven", short), ("event-driven", 'settle = "steady"')):
        text = LOCKED.replace(short, f'method = "{method}"\n{settle}')
        ds = run(tmp_path, text).sel(friction_law="coulomb").squeeze()
        assert STATUSES[ds["status"].item()] == "locked"
        assert "not unique" in ds["message"].item()
        assert ds["period"].item() == -1
        for name, variable in ds.data_vars.items():
            if variable.dtype.kind == "f" and name not in small_sweep.KNOWN_OF_LOCKED:
                assert np.isnan(variable).all(), name


SHORT = Settings("event-driven", 1e-7, None, settle_periods=3, kept_periods=2, samples_per_period=32)


def solved(record, settings=SHORT):
    sizes = {"phase": 64, "harmonic": variables.HARMONICS, "part": 2}
    return cases.solve_cases(record, np.array([0]), settings, 60.0, variables.record_dtype(sizes))[0]


@strategies.composite
def records(draw):
    def number(low, high):
        return draw(strategies.floats(low, high))

    law = draw(strategies.sampled_from(LAW_NAMES))
    angle = number(-8.0, 8.0)
    if law == "coulomb" and abs(angle) < 0.1:
        # Without lean the bolster face does not slip, and coulomb does not determine its friction.
        angle = 0.1
    return parameters.record(
        law,
        10.0 ** number(-6.0, np.log10(5e-3)),
        number(0.1, 4.0) * OMEGA_N,
        suspension={"column_angle": np.radians(angle), "wedge_preload": number(-1.0, 5.0)},
        friction={"dynamic": number(0.0, 0.6), "static": number(0.0, 0.6)},
        effects={"guide_friction": {"force": draw(strategies.sampled_from([0.0, 0.2, 2.0]))}},
    )


def test_without_friction_there_are_numbers():
    frictionless = {"dynamic": 0.0, "static": 0.0}
    upright = {"column_angle": np.radians(0.1)}
    record = parameters.record("coulomb", 1e-3, 42.5, upright, frictionless)
    assert STATUSES[solved(record)["status"]] == "ok"
    suspension = {"column_angle": 0.0978704313781991}
    omega, amplitude = 195.35324097317206, 7.227765780030118e-05  # a face turns back just at v_t
    record = parameters.record("static-dynamic", amplitude, omega, suspension, frictionless)
    found = solved(record, replace(SHORT, steady=True, settle_periods=None, max_periods=30))
    assert found["dissipated_energy"] == 0.0


def test_a_release_that_grazes_ends_where_rounding_is_coarser_than_the_search():
    # At t = 0.26 s doubles lie farther apart than the search for the minimum of an event function asked for.
    suspension = {"column_angle": 0.004395868272498038, "wedge_preload": 1e-6}
    friction = {"dynamic": 0.4154653590797869, "static": 0.48060306205586123}
    record = parameters.record("coulomb", 1e-5, 325.0258722265154, suspension, friction)
    found = solved(record, replace(SHORT, steady=True, settle_periods=None, max_periods=30))
    assert STATUSES[found["status"]] == "ok"
    assert found["dissipated_energy"] == pytest.approx(found["supplied_energy"], rel=1e-5)


@hypothesis_settings(max_examples=300, deadline=None)
@given(records(), strategies.booleans())
def test_ends_with_numbers_that_can_be_or_with_a_reason(record, steady):
    settled = replace(SHORT, steady=True, settle_periods=None, max_periods=30)
    found = solved(record, settled if steady else SHORT)
    status = STATUSES[found["status"]]
    # The switch count bounds the time that a case takes.
    assert found["switches"] <= EVENTS_PER_PERIOD * 200
    if status != "ok":
        assert status in ("locked", "solver_failure")
        assert found["message"]
        assert np.isnan([found[name] for name in NUMBERS.names]).all()
        return
    # These are not defined for what does not move.
    undefined = {"phase_lag", "minimum_normal_force", "lift_off_fraction", *FORCES_OF_FACES}
    assert np.isfinite([found[name] for name in NUMBERS.names if name not in undefined]).all()
    assert np.isfinite(found["displacement_harmonics"]).all()
    assert 0.0 <= found["stick_fraction"] <= 1.0
    assert found["peak_to_peak"] >= 0.0
    assert found["dissipated_energy"] >= 0.0
    assert found["peak_velocity"] >= 0.0
    assert np.isnan(found["lift_off_fraction"]) or 0.0 <= found["lift_off_fraction"] <= 1.0
