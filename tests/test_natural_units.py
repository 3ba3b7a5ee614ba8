"""Search ranges are in natural units of the model: at another size they are in proportion."""

from pathlib import Path

import numpy as np
import pytest

from tests.scaling import BENCH_SIZE, SIZES, Size
from wedgesweep.config import load
from wedgesweep.diagnose.fit_parameters import Hypothesis
from wedgesweep.effects import EFFECTS, candidates
from wedgesweep.natural_units import BENCH, FREQUENCY, LENGTH, natural_units
from wedgesweep.quantity import UNITS
from wedgesweep.systems.suspension.parameters import natural_units_of, record, regularised_velocity

QUANTITIES = [(name, q) for name, effect in EFFECTS.items() for q in effect.quantities if q.search]
RIGS = SIZES | {"fast": Size(0.1, 1e-3, 0.2), "slow": Size(1e4, 300.0, 30.0)}


def units(size):
    return natural_units_of(size.suspension())


def test_the_bench_is_the_one_of_table_1():
    assert units(BENCH_SIZE) == BENCH
    for _, dimension in UNITS.values():
        assert BENCH.ratio(dimension) == 1.0


def test_the_config_of_a_bogie_is_that_of_the_bench_at_another_size():
    bogie = load(Path(__file__).parents[1] / "configs" / "bogie.toml").natural_units()
    assert bogie.ratio(LENGTH) == pytest.approx(36.0, rel=1e-3)
    assert bogie.ratio(FREQUENCY) == pytest.approx(1.0 / 6.0, rel=1e-3)


@pytest.mark.parametrize("size", RIGS.values(), ids=RIGS)
def test_ranges_and_the_places_where_fits_start_are_in_proportion(size):
    """The fitted vector is the same at every size; what is simulated is in proportion, and comes back."""
    for name, quantity in QUANTITIES:
        expected = np.array(quantity.search) * size.factor(quantity.dimension)
        assert quantity.searched(units(size)) == pytest.approx(expected, rel=1e-12), name
        assert quantity.searched() == quantity.search
    for name in candidates():
        bench, rig = Hypothesis((name,)), Hypothesis((name,), units=units(size))
        np.testing.assert_array_equal(rig.starts(), bench.starts())
        np.testing.assert_array_equal(rig.scale, bench.scale)
        for x in bench.starts():
            known, found = bench.in_key_units(x)[name], rig.in_key_units(x)[name]
            expected = size.numbers(EFFECTS[name].quantities, known)
            assert found == pytest.approx(expected, rel=1e-12)
            np.testing.assert_allclose(rig.at({name: found}), bench.at({name: known}), rtol=1e-9, atol=1e-12)


def test_amplitudes_start_on_either_side_beside_a_logarithm_and_at_zero_without():
    """Where all amplitudes are zero every wavelength gives the same response."""
    assert not Hypothesis(("input_distortion",)).starts().any()
    *first, length, cosine, sine = Hypothesis(("position_friction",)).starts().T
    assert len(set(length)) == 12
    assert len(set(map(tuple, np.sign(first).T))) == 4
    assert not np.any([cosine, sine])


@pytest.mark.parametrize("size", RIGS.values(), ids=RIGS)
def test_numbers_that_are_not_fitted_are_in_proportion(size):
    """Load at which friction is nominal, mass of a column, width of a regularised ramp."""
    effects = {"load_dependent_friction": {"exponent": 0.2}, "column_compliance": {"stiffness": 6e4}}

    def numbers(rig):
        p = record("coulomb", 1.0, 1.0, rig.suspension(), rig.friction(), rig.effects(effects))[0]
        reference, mass = p["load_dependent_friction"]["reference"], p["column_compliance"]["mass"]
        return np.array([mass, reference, p["friction"]["v_t"]])

    mass, length, time = size
    expected = numbers(BENCH_SIZE) * [mass, mass * length / time**2, length / time]
    np.testing.assert_allclose(numbers(size), expected, rtol=1e-12)
    assert numbers(BENCH_SIZE)[0] == 0.23
    assert regularised_velocity(BENCH_SIZE.suspension()) == 1e-6


def test_without_weight_lengths_follow_the_travel_and_without_a_spring_times_the_tests():
    stiff, far = natural_units(2.0, 800.0, travel=1e-3), natural_units(2.0, 800.0, travel=2e-3)
    assert far.ratio(LENGTH) == pytest.approx(2.0 * stiff.ratio(LENGTH))
    assert far.ratio(FREQUENCY) == stiff.ratio(FREQUENCY)
    free = natural_units(2.0, 0.0, travel=1e-3, omega=20.0)
    assert free.ratio(FREQUENCY) == pytest.approx(stiff.ratio(FREQUENCY))


UNIT_NAMES = {
    "_N_per_mm3": r"$k_b/\ell^2$",
    "_N_per_mm": r"$k_b$",
    "_N_s2_per_m2": r"$M_b/\ell$",
    "_N_s_per_m": r"$M_b\omega_n$",
    "_m_per_s2": r"$g$",
    "_mm_per_s": r"$\ell\omega_n$",
    "_mm": r"$\ell = g/\omega_n^2$",
    "_hz": r"$\omega_n/2\pi$",
    "_N": r"$M_b g$",
    "_s": r"$1/\omega_n$",
}


def row(name, quantity):
    """Line of the table of ranges: on the bench, and over the natural unit."""
    mass, length, time = quantity.dimension
    unit = BENCH.mass**mass * BENCH.length**length * BENCH.time**time
    unit /= 2.0 * np.pi if quantity.suffix == "_hz" else 1.0
    low, high = quantity.search
    shares = " to ".join(f"{end * quantity.factor / unit:.3g}" for end in (low, high))
    return f"| `{name}.{quantity.key}` | {low:g} to {high:g} | {UNIT_NAMES[quantity.suffix]} | {shares} |"


def test_the_page_has_the_ranges_in_natural_units():
    page = (Path(__file__).parents[1] / "docs" / "diagnosis.md").read_text()
    rows = [row(name, each) for name, each in QUANTITIES if each.suffix in UNIT_NAMES]
    assert "\n".join(rows) in page
