"""Releases and swept sines of wedges that may lift off."""

import numpy as np
import pytest

from tests.command import invoke
from wedgesweep import config
from wedgesweep.outcome import lifted
from wedgesweep.sweep import unfinished
from wedgesweep.sweep.journal import Journal
from wedgesweep.sweep.run import Sweep

RELEASE = 'kind = "release"\ndisplacement_mm = 10.0\nduration_s = 0.6\nsampling_hz = 1000.0\n'
LAWS = '["coulomb", "static-dynamic", "exponential"]'
SWEPT = (
    'kind = "sine-sweep"\namplitude_m_per_s2 = 12.0\nstart_hz = 5.0\nstop_hz = 20.0\nduration_s = 0.5\n'
    "sampling_hz = 1000.0\n"
)


def study(given, joints, *, scale=1.0, method="event-driven", restitution=0.0):
    text = f'[suspension]\njoints = "{joints}"\n[input]\n{given}'
    text += f'[sweep]\nfriction_law = {LAWS}\nscale = {scale}\n[solver]\nmethod = "{method}"\nrtol = 1e-9\n'
    text += "case_timeout_s = 600.0\n"  # only to end a hang, also on a busy machine
    if restitution:
        text = text.replace("[input]", f"restitution = {restitution}\n[input]")
    return text


def solved(*args, **options):
    ds = Sweep(config.parse(study(*args, **options)), None).run_here()
    assert (ds["status"] == 0).all()
    return ds


@pytest.mark.acceptance
def test_both_solvers_agree():
    one, other = (solved(SWEPT, "unilateral", method=method) for method in ("event-driven", "radau"))
    size = float(np.abs(one["displacement"]).max())
    assert one["column_open_fraction"].max() > 0.1
    assert np.array_equal(one["impacts"], other["impacts"])
    assert np.abs(one["displacement"] - other["displacement"]).max() < 1e-6 * size
    for name in ("dissipated_energy", "impact_energy", "lift_off_fraction", "largest_impulse"):
        assert one[name].values == pytest.approx(other[name].values, rel=1e-5)


@pytest.mark.acceptance
@pytest.mark.parametrize("restitution", [0.0, 0.4])
def test_friction_and_impacts_lose_what_a_release_stores(restitution):
    """The bolster is let go from 10 mm and ends at rest: the springs' energy has gone into both."""
    given = RELEASE.replace("duration_s = 0.6", "duration_s = 1.5")
    ds = solved(given, "unilateral", restitution=restitution).sel(friction_law="coulomb").squeeze()
    still = float(np.abs(ds["velocity"][-1]))
    assert still < 1e-9
    (case,) = config.parse(study(given, "unilateral")).records(np.array([0]))
    geometry, suspension = case["geometry"], case["suspension"]
    rise = geometry["column_ratio"] * geometry["cos_column"]  # of both wedges over that of the bolster
    stiffness = suspension["bolster_spring"] + 2.0 * suspension["wedge_spring"] * rise**2
    start, end = (float(ds["displacement"][place]) for place in (0, -1))
    stored = 0.5 * stiffness * (start**2 - end**2)
    assert float(ds["impact_energy"]) > 0.05 * stored
    assert float(ds["dissipated_energy"] + ds["impact_energy"]) == pytest.approx(stored, rel=1e-6)


@pytest.mark.acceptance
def test_faces_push_or_carry_nothing_and_motions_that_keep_contact_are_those_of_bilateral_joints():
    ds = solved(RELEASE, "unilateral")
    for name in ("normal_force_column", "normal_force_bolster"):
        assert float(ds[name].min()) >= 0.0
        assert (ds[name] == 0.0).any()
    held, open_ = (solved(RELEASE, joints, scale=0.02) for joints in ("bilateral", "unilateral"))
    assert not (held["lift_off_fraction"] > 0.0).any()
    assert np.abs(held["displacement"] - open_["displacement"]).max() < 1e-12
    for name in ("column_open_fraction", "bolster_open_fraction", "impacts"):
        assert (open_[name] == 0.0).all()


def test_an_unfinished_sweep_tells_what_lies_outside_of_the_model(tmp_path):
    sweep = Sweep(config.parse(study(RELEASE, "bilateral")), tmp_path / "part.nc")
    with Journal(sweep.journal_path, sweep.dtype, sweep.journal_header) as journal:
        journal.append(sweep.solve(np.arange(3)))
    assert int(lifted(unfinished.dataset_of(tmp_path / "part.nc")).sum()) == 3


@pytest.mark.acceptance
def test_the_open_phases_are_told(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "open.toml").write_text(study(RELEASE, "unilateral"))
    (tmp_path / "held.toml").write_text(study(RELEASE, "bilateral"))
    for name, outside in (("open", False), ("held", True)):
        for told in (invoke("run", f"{name}.toml", "--n-jobs", 1), invoke("status", f"{name}.nc")):
            assert ("outside of the model's validity" in told) is outside
    # Wedges that lift off do not move with the bolster: nothing tells their forces from inertia.
    told = invoke("plot", "all", "open.nc", "-o", "drawn")
    assert "skipped loop: the dataset has no force" in told
    svg = tmp_path / "ring-down.svg"
    invoke("plot", "ring-down", "open.nc", "-o", str(svg))
    assert "a contact is open" in svg.read_text()
    invoke("plot", "ring-down", "held.nc", "-o", str(svg))
    assert "coulomb (lifts off)" in svg.read_text()
    assert "a contact is open" not in svg.read_text()
