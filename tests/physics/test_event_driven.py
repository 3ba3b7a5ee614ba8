"""The event-driven solver: closed forms to near rounding error, and the same answers as Radau."""

import numpy as np
import pytest

from tests.physics import test_den_hartog as den_hartog
from tests.physics.cases import OMEGA_N
from tests.physics.test_reference import ROWS
from wedgesweep import parameters, response
from wedgesweep.solvers import event_driven, radau
from wedgesweep.solvers.trajectory import CaseError, Window


def respond(record, settle_periods=60, periods=2, rtol=1e-9, solve=event_driven.solve):
    window = Window(float(record["omega"][0]), settle_periods, periods, 256)
    return response.evaluate(solve(record, window, rtol, 60.0), record, harmonics=9)


@pytest.mark.parametrize("row", ROWS)
def test_reference(row):
    record = parameters.record(row["friction_law"], row["amplitude_mm"] * 1e-3, row["beta"] * OMEGA_N)
    numbers = respond(record).numbers
    assert numbers["amplitude_ratio"] == pytest.approx(row["amplitude_ratio"], abs=3e-6)
    assert numbers["stick_fraction"] == pytest.approx(row["stick_fraction"], abs=3e-4)


@pytest.mark.parametrize("share", [0.1, 0.5, 0.95])
@pytest.mark.parametrize("r", den_hartog.ONSETS)
def test_den_hartog(r, share):
    force_ratio = share * den_hartog.ONSETS[r]
    record = den_hartog.driven(r, force_ratio)
    numbers = respond(record, settle_periods=3000).numbers
    exact = den_hartog.closed_form(r, force_ratio)
    assert den_hartog.magnification(r, numbers) == pytest.approx(exact, rel=1e-8)


@pytest.mark.parametrize(
    ("law", "beta", "amplitude"),
    [
        ("coulomb", 0.4, 1e-3),
        ("coulomb", 2.208, 0.1e-3),
        ("coulomb", 0.9, 3e-3),
        ("static-dynamic", 0.4, 1e-3),
        ("static-dynamic", 2.208, 0.1e-3),
        ("exponential", 1.472, 0.1e-3),
    ],
)
def test_energy_balance(law, beta, amplitude):
    record = parameters.record(law, amplitude, beta * OMEGA_N)
    numbers = respond(record, settle_periods=1000, rtol=1e-10).numbers
    assert numbers["dissipated_energy"] == pytest.approx(numbers["supplied_energy"], rel=1e-8)


def random_records(number, seed=7):
    generator = np.random.default_rng(seed)
    for _ in range(number):
        yield parameters.record(
            str(generator.choice(["coulomb", "static-dynamic", "exponential"])),
            10 ** generator.uniform(-5, -2.5),
            generator.uniform(0.2, 3.0) * OMEGA_N,
            suspension={
                "column_angle": np.radians(generator.choice([4.0, -4.0, 8.0])),
                "wedge_preload": generator.choice([0.0, 1.0, -1.0]),
            },
            effects={"guide_friction": {"force": generator.choice([0.0, 0.2])}},
        )


def test_agrees_with_radau():
    for record in random_records(12):
        ours = respond(record, settle_periods=5, rtol=1e-9).numbers["amplitude_ratio"]
        radaus = respond(record, settle_periods=5, rtol=1e-8, solve=radau.solve)
        assert ours == pytest.approx(radaus.numbers["amplitude_ratio"], abs=1e-5)


def test_a_locked_wedge_is_told_as_by_radau():
    record = parameters.record(
        "coulomb",
        1e-3,
        40.0,
        suspension={"column_angle": np.radians(-4.0)},
        friction={"dynamic": 0.5},
    )
    for solve in (radau.solve, event_driven.solve):
        with pytest.raises(CaseError, match="locks") as caught:
            respond(record, solve=solve)
        assert caught.value.status == "locked"
