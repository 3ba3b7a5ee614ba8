"""The independent simulator of the validation campaign agrees with the base model."""

import numpy as np
import pytest
from validation import response, rigs, simulator

from wedgesweep.friction import LAW_NAMES

PHASES, SETTLE = 128, 60


@pytest.mark.acceptance
@pytest.mark.parametrize("law", LAW_NAMES)
@pytest.mark.parametrize(("frequency", "amplitude"), [(8.0, 0.8e-3), (24.0, 0.1e-3)])
def test_without_its_effects_it_is_the_base_model(law, frequency, amplitude):
    system = simulator.system(law, 4.0, frequency, amplitude, {})
    stride = round(1.0 / frequency / 5e-6 / PHASES)
    step = 1.0 / frequency / PHASES / stride
    signal, force = simulator.simulate(system, step, SETTLE * PHASES * stride, stride, PHASES)
    ds = response.run(
        response.System(law, rigs.bench(4.0)), [response.Test(frequency, 1e3 * amplitude)]
    ).isel(case=0)
    ours = ds["displacement_harmonics"].values @ [1.0, 1j]
    theirs = response.harmonics(-signal[0])[: ours.size]
    np.testing.assert_allclose(theirs, ours, atol=1e-3 * abs(ours[0]))
    assert force == pytest.approx(float(ds["minimum_normal_force"]), abs=2e-3)


@pytest.mark.parametrize("effect", [{"width": 0.0}, {"coefficient": 0.0}, {"friction": 1.0}])
def test_effects_are_absent_at_zero(effect):
    base = simulator.system("exponential", 4.0, 20.0, 1e-4, {})
    assert simulator.system("exponential", 4.0, 20.0, 1e-4, effect) == base


def test_backlash_removes_its_width_from_the_spring_deflection():
    loose = simulator.system("coulomb", 4.0, 20.0, 1e-4, {"width": 2e-5, "coefficient": 1.0})
    tight = loose._replace(width=0.0)

    def pull(z, v, system):
        return simulator.solve_newton(system.equilibrium + z, v, 0.0, (0.0, 0.0), system)[0]

    per_newton = pull(0.0, -1.0, tight)  # a drag of 1 N pushes up
    for z, slack in ((5e-5, 1e-5), (5e-6, 5e-6), (-3e-5, -1e-5)):
        given = simulator.BOLSTER_SPRING * slack * per_newton
        assert pull(z, 0.0, loose) == pytest.approx(pull(z, 0.0, tight) + given, rel=1e-9)
