"""What a validation campaign draws, how it judges, and the results on record."""

import json
from pathlib import Path

import numpy as np
import pytest
import xarray as xr
from validation import empirical, hidden_force, hiding, judge, ranges, response, rigs, run, sets, strength
from validation.__main__ import main
from validation.judge import Share
from validation.time_records import LOOP, MIXED, TRANSIENT

from tests.measured.test_steadiness import UNSTEADY, only_fault, written
from wedgesweep.effects import EFFECTS, candidates
from wedgesweep.figures.diagnosis.marks import STDS

DOCS = Path(__file__).parents[2] / "docs"
RECORDS, RESULTS = DOCS / "validation-records.jsonl", DOCS / "validation.md"
RIGS_RECORDS = DOCS / "validation-rigs-records.jsonl"
TIME_RECORDS, LOOP_RECORDS = (DOCS / f"validation-{name}-records.jsonl" for name in ("time", "loop"))
RIGS = ("imperfect", "errors-only", "random-rig", "oscillator")
IDEAL = ("clean", "strong", "weak", "pair", "unknown", "poor", "added")


def test_every_effect_is_hidden_within_the_range_of_the_fit():
    assert {*ranges.ALL, *ranges.NOT_HIDDEN} == set(candidates())
    for name in ranges.ALL:
        effect = EFFECTS[name]
        for seed in range(20):
            path = ranges.path(name, np.random.default_rng(seed))
            for s in (0.0, 0.5, 1.0):
                numbers = path(s)
                for quantity in effect.quantities:
                    if quantity.search and quantity.key in numbers:
                        low, high = quantity.search
                        assert low <= numbers[quantity.key] <= high, f"{name}.{quantity.key}"


def test_an_effect_is_nearly_neutral_at_the_weak_end():
    for name, leading in ranges.ALL.items():
        quantity = next(each for each in EFFECTS[name].quantities if each.key == leading.key)
        weak = ranges.path(name, np.random.default_rng(0))(0.0)[leading.key]
        if np.isfinite(quantity.default):
            width = quantity.search[1] - quantity.search[0]
            assert weak == pytest.approx(quantity.default, abs=2e-3 * width), name


def test_a_smaller_campaign_has_sets_of_the_full_one():
    whole = {one for chain in sets.chains(3, 1.0) for one in chain}
    part = {one for chain in sets.chains(3, 0.1) for one in chain}
    assert part < whole
    assert len(whole) == sum(kind.size for kind in sets.ALL.values())
    other = {one for chain in sets.chains(4, 1.0) for one in chain}
    assert not whole & other


def test_an_effect_that_contains_the_unknown_one_is_no_candidate():
    assert set(candidates()) - set(hiding.candidates_without("stribeck")) == {"stribeck"}
    left_out = {"viscous_damping", "directional_damping", "degressive_damping", "series_compliance"}
    assert set(candidates()) - set(hiding.candidates_without("viscous_damping")) == left_out
    assert hiding.candidates_without(None) == candidates()


def test_an_added_test_follows_its_poor_set():
    for chain in sets.chains(1, 0.2, ("added",)):
        assert [one.kind for one in chain] == ["poor", "added"]
        assert chain[0].noise_seed == chain[1].noise_seed


@pytest.mark.parametrize(
    ("hits", "n", "low", "high"), [(0, 60, 0.0, 0.0602), (8, 10, 0.4902, 0.9433), (84, 84, 0.9563, 1.0)]
)
def test_wilson_intervals(hits, n, low, high):
    assert Share(hits, n).wilson == pytest.approx((low, high), abs=1e-4)


@pytest.mark.acceptance
def test_a_cause_that_uncertain_numbers_make_up_for_is_weak():
    """A wedge spring 17 % too stiff looks much like a mass and a friction that are off within reason."""
    frequencies = np.repeat([5.078, 7.837, 19.011, 23.715, 33.364], 2)
    amplitudes = (0.8128, 3.058, 0.3343, 0.7686, 0.05382, 0.1316, 0.0401, 0.1426, 0.01879, 0.0683)
    tests = [response.Test(*each) for each in zip(frequencies, amplitudes, strict=True)]
    rig, hidden = rigs.bench(4.0), {"wedge_stiffness": {"scale": 1.1745}}
    true = strength.true_spectra(response.System("coulomb", rig, hidden), tests)

    def excess(**uncertain):
        bench = strength.Bench(tests, "adc", 0.01, uncertain, model_error=0.02)
        return strength.excess(true, 0.0, response.System("coulomb", rig), bench)

    known = {"bolster_mass": 0.01, "bolster_stiffness": 0.02, "friction_level": 0.06}
    assert excess() > 10.0 * excess(**known)
    # A number that is the cause itself is off by so many standard deviations at most.
    assert excess(wedge_stiffness=0.1) < 1.745**2


def test_the_strength_wanted_is_found():
    for target in (200.0, 3000.0):
        s = strength.reach(target, lambda s: 1e5 * s**4)
        assert 1e5 * s**4 == pytest.approx(target, rel=0.25)
    assert strength.reach(200.0, lambda s: 10.0 * s) is None
    assert strength.reach(200.0, lambda s: 1e4 if s > 0.3 else 1.0) is None


def record(verdict, causes, rivals=(), truth=("stribeck",)):
    return {
        "verdict": verdict,
        "causes": [{"effect": name, "parameters": {}} for name in causes],
        "rivals": [{"effects": list(names), "gap": 1.0} for names in rivals],
        "truth": sorted(truth),
    }


def test_verdicts_are_judged():
    right, wrong = record("named", ["stribeck"]), record("named", ["presliding"])
    tied = record("tied", ["presliding"], [["ageing"], ["stribeck"]])
    pair = record("named", ["preload", "stribeck"], truth=("stribeck", "preload"))
    assert [judge.exact(r) for r in (right, wrong, tied, pair)] == [True, False, False, True]
    assert [judge.exact_or_tied(r) for r in (right, wrong, tied)] == [True, False, True]
    assert [judge.wrongly_named(r) for r in (right, wrong, tied)] == [False, True, False]
    assert [judge.right_family(r) for r in (right, wrong, tied)] == [True, True, True]
    half = record("named", ["stribeck"], truth=("stribeck", "preload"))
    assert judge.wrongly_named(half)
    assert not judge.right_family(half)
    assert not judge.right_family(record("data-insufficient", [], truth=()))


def test_the_leading_cause_is_judged_by_the_ladder():
    def led(*levels):
        return judge.leads_ladder({"truth": ["stribeck"], "ladder": [{"effects": list(r)} for r in levels]})

    assert led((), ("stribeck",), ("ageing", "preload"))
    assert led((), ("ageing",), ("preload", "stribeck"))
    assert not led((), ("ageing",), ("ageing", "preload"))
    assert not led(())


def test_an_empirical_force_is_judged_by_the_hidden_one(tmp_path):
    places, speeds = np.linspace(-0.01, 0.01, 25), np.linspace(-0.05, 0.05, 33)
    numbers = {"force_N": 2.0, "displacement_mm": 10.0, "velocity_mm_per_s": 50.0}
    shapes = range(len(hidden_force.NAMES))
    forces = [hidden_force.on_mass(numbers | {"shape": which}, places, speeds) for which in shapes]
    assert all(0.5 <= np.abs(each).max() / 2.0 <= 1.5 for each in forces)
    numbers, force = numbers | {"shape": 10}, forces[10]
    off = np.where(np.arange(force.size) % 4 == 0, 0.3, 0.1).reshape(force.shape)
    grid = ("force_place", "force_speed")
    found = {
        "missing_force": (grid, force - force.mean() + off - off.mean()),
        "missing_force_std": (grid, np.full(force.shape, 0.1 / STDS)),
        "missing_force_density": (grid, np.ones(force.shape)),
    }
    data = xr.Dataset(found, {"force_place": places, "force_speed": speeds})
    data.to_netcdf(tmp_path / empirical.FILE)
    stages = [{"stage": "single effects", "work": 30.0}, {"stage": empirical.STAGE, "work": 10.0}]
    named = {"accuracy_held_out": 0.03}
    told = {"offered": True, "accuracy_held_out": 0.01, "named": named, "degrees_of_freedom": 9.0}
    document = json.dumps({"empirical_force": told, "stages": stages})
    (tmp_path / "diagnosis.json").write_text(document)
    kept = empirical.told(tmp_path, {"hidden_force": numbers}, 0.01)
    assert kept["left"] == pytest.approx(2.0**0.5)
    assert kept["work"] == pytest.approx(4.0 / 3.0)
    assert kept["in_band"] == pytest.approx(0.75, abs=0.01)
    assert kept["error"] == pytest.approx(off.std() / (force - force.mean()).std())


def test_an_error_that_is_there_may_be_named_beside_the_cause():
    alone, both = record("named", ["stribeck"]), record("named", ["input_distortion", "stribeck"])
    other, error = record("named", ["ageing", "stribeck"]), record("named", ["input_distortion"])
    assert [judge.names_cause(r) for r in (alone, both, other, error)] == [True, True, False, False]
    assert [judge.names_another_cause(r) for r in (alone, both, other, error)] == [False, False, True, True]
    assert not judge.names_another_cause(record("tied", ["ageing"]))
    there = [record("named", given) for given in (["input_distortion"], ["input_distortion", "ageing"])]
    assert [judge.names_what_is_there(r) for r in (*there, record("tied", ["bolster_mass"]))] == [
        True,
        False,
        False,
    ]


def test_coverage_allows_for_full_turns_of_angles():
    found = record("named", ["cross_slip"], truth=("cross_slip",))
    found["numbers"] = {"cross_slip": {"velocity_mm_per_s": 5.0, "phase_deg": 179.0}}
    found["causes"][0]["parameters"] = {
        "velocity_mm_per_s": {"value": 4.0, "ci95": [3.5, 4.5]},
        "phase_deg": {"value": -178.0, "ci95": [-182.0, -174.0]},
    }
    assert judge.coverage(found) == [
        ("cross_slip.velocity_mm_per_s", False),
        ("cross_slip.phase_deg", True),
    ]


def test_a_test_that_check_refuses_as_not_steady_gets_more_input(tmp_path):
    """It is recognised by the message of the reader."""
    ring_down, _ = UNSTEADY["ring-down"]
    _, _, told = only_fault(written(tmp_path, ring_down)).partition(".csv")
    (found,) = run.REFUSED.finditer(f"made/test-07.csv{told}")
    assert int(found[2]) == 7


@pytest.mark.parametrize(
    ("seed", "size", "records", "kinds"),
    [
        (107, 1.0, RECORDS, IDEAL),
        (107, 1.0, RIGS_RECORDS, RIGS),
        (107, 1.0, TIME_RECORDS, (TRANSIENT, LOOP, MIXED)),
        (713, 0.7, LOOP_RECORDS, ("damper", "warm", LOOP)),
    ],
    ids=["bench", "rigs", "time", "loops"],
)
def test_the_results_page_is_what_the_records_say(seed, size, records, kinds, capsys):
    only = [word for kind in kinds for word in ("--only", kind)]
    main(["--seed", str(seed), "--size", str(size), *only, "--records", str(records), "--tables"])
    printed = capsys.readouterr().out
    assert f"```text\n{printed}```\n" in RESULTS.read_text()


def test_a_campaign_resumes_from_its_records(tmp_path, capsys):
    only = [
        "--seed",
        "107",
        "--only",
        "added",
        "--size",
        "0.05",
        "--records",
        str(RECORDS),
        "-o",
        str(tmp_path),
    ]
    main([*only, "--jobs", "1"])
    printed = capsys.readouterr().out
    assert "2/2 added-000" in printed
    assert (tmp_path / "validation.txt").read_text() in printed
    assert len((tmp_path / "validation-records.jsonl").read_text().splitlines()) == 2
    with pytest.raises(SystemExit, match="has the seed 107, not 14"):
        main(["--seed", "14", "--records", str(RECORDS), "--tables"])
