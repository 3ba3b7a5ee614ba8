"""Every figure draws the fixture, has a title and units, and fails with a clear message."""

import re

import numpy as np
import pytest
from matplotlib.figure import Figure
from matplotlib.text import Text

from tests import fixture_dataset
from wedgesweep import config, figures
from wedgesweep.config.physics import physics
from wedgesweep.figures import (
    amplitude_ratio,
    bifurcation,
    cases,
    catalogue,
    friction_laws,
    lines,
    maps,
    style,
    validity,
)
from wedgesweep.friction import LAWS

KINDS = sorted(figures.FIGURES)
FROM_LISTS = ("friction-laws", "phase-portrait")
FEWEST = {"bifurcation": "20 frequencies", "stick-map": "4 amplitudes"}
FROM_WAVEFORMS = ("bifurcation", "phase-portrait", "response")


@pytest.fixture(scope="module")
def dataset():
    return fixture_dataset.build()


def labels(figure):
    """Labels of all axes, also those of second axes and colour bars."""
    axes = [*figure.axes, *(child for ax in figure.axes for child in ax.child_axes)]
    return [text for ax in axes for text in (ax.get_xlabel(), ax.get_ylabel()) if text]


def legend(figure):
    return str([text.get_text() for legend in figure.legends for text in legend.get_texts()])


def everything_failed(ds):
    ds = ds.copy(deep=True)
    for variable in ds.data_vars.values():
        if variable.dtype.kind == "f":
            variable[:] = np.nan
    ds["stuck"][:] = 0
    return ds


@pytest.mark.parametrize("kind", KINDS)
def test_draws_and_says_what_it_shows(kind, dataset):
    """Metrics suffice for all figures but those of waveforms."""
    ds = dataset if kind in FROM_WAVEFORMS else fixture_dataset.without_waveforms(dataset)
    figure = figures.draw(ds, kind)
    figure.draw_without_rendering()
    assert figure.get_suptitle()
    assert len(labels(figure)) >= 2
    assert [text for text in labels(figure) if "[" not in text] == []  # [1] without a dimension


def render(figure):
    """Draw a figure without its layout, which takes longest, and which the test above tries for each kind."""
    figure.set_layout_engine("none")
    figure.draw_without_rendering()


@pytest.mark.few(2)
@pytest.mark.parametrize("kind", KINDS)
def test_units_of_choice_are_in_all_figures_and_move_nothing(kind, dataset):
    shown, usual = figures.draw(dataset, kind, units="us"), figures.draw(dataset, kind)
    render(shown)
    texts = [text.get_text() for text in shown.findobj(Text) if text.get_visible()]
    assert [text for text in texts if re.search(r"\bmm\b|\bN\b", text)] == []
    limits = [[(ax.get_xlim(), ax.get_ylim()) for ax in figure.axes] for figure in (shown, usual)]
    assert limits[0] == limits[1]


def test_a_tick_stands_where_its_number_is(dataset):
    """Linear and logarithmic axes, and those of panels without a label."""
    for kind in ("phase-portrait", "peak-to-peak"):
        figure = figures.draw(dataset, kind, units="us")
        render(figure)
        panels = [ax for ax in figure.axes if ax.get_label() != "<colorbar>"]
        for ax in panels:
            low, high = sorted(ax.get_ylim())
            numbers = {tick.get_loc(): tick.label1.get_text() for tick in ax.yaxis.get_major_ticks()}
            inside = {place: text for place, text in numbers.items() if low <= place <= high}
            assert len(inside) > 1
            for place, text in inside.items():
                assert place == pytest.approx(25.4 * float(text or place / 25.4), rel=1e-5)
                assert len(text) <= 7  # a round number
    # A logarithmic axis without a positive number is drawn.
    axis = Figure().add_subplot().yaxis
    style.power_ticks(axis)
    label = axis.get_major_formatter()
    assert [label(value) for value in (0.0, 1e-3, 1e5)] == ["", "10⁻³", "10⁵"]


GRIDS = {
    "one case": {"laws": ("coulomb",), "betas": (1.0,), "amplitudes": (1e-3,), "failed": None},
    "fine grid": {"betas": np.linspace(0.1, 3.0, 70), "amplitudes": np.linspace(1e-5, 1e-3, 60)},
}


@pytest.fixture(scope="module", params=GRIDS)
def grid(request):
    return fixture_dataset.build(**GRIDS[request.param])


@pytest.mark.few(2)
@pytest.mark.parametrize("kind", KINDS)
def test_draws_small_and_large_grids(kind, grid):
    needs = {**FEWEST, "map": "two axes with several values"}
    if grid["status"].size == 1 and kind in needs:
        with pytest.raises(ValueError, match=f"^{kind}: needs {needs[kind]}"):
            figures.draw(grid, kind)
        return
    render(figures.draw(grid, kind))


@pytest.mark.few(1)
@pytest.mark.parametrize("kind", KINDS)
def test_draws_a_sweep_in_which_every_case_failed(kind, dataset):
    render(figures.draw(everything_failed(dataset), kind))


@pytest.mark.few(3)
@pytest.mark.parametrize("kind", KINDS)
def test_list_of_cases(kind, dataset):
    ds = fixture_dataset.as_cases(dataset)
    if kind in FROM_LISTS:
        render(figures.draw(ds, kind))
        return
    with pytest.raises(ValueError, match=f"^{kind}: needs a grid"):
        figures.draw(ds, kind)


def test_what_cannot_be_drawn_is_told(dataset):
    held = dataset.assign(lift_off_fraction=0.0 * dataset["lift_off_fraction"])
    bare = fixture_dataset.without_waveforms(dataset)
    for ds, kind, picks, words in (
        *(
            (bare, kind, {}, rf"^{kind}: the dataset has no displacement.*waveforms")
            for kind in FROM_WAVEFORMS
        ),
        (dataset, "stickmap", {}, r"no figure 'stickmap'.*stick-map"),
        (
            dataset,
            "response",
            {"laws": "x"},
            "^response: unknown option 'laws'; it takes beta, amplitudes, law",
        ),
        (dataset, "response", {"beta": 99.0}, "^response: no beta near 99; the dataset has"),
        (dataset, "peak-to-peak", {"amplitudes": [0.05]}, "no amplitude near 0.05; the dataset has"),
        (held, "lift-off-map", {}, "lift-off-map: nothing lifts off in these cases"),
    ):
        with pytest.raises(ValueError, match=words):
            figures.draw(ds, kind, **picks)


def test_saves(dataset, tmp_path):
    figure = figures.draw(dataset, "friction-laws")
    for suffix, start in zip(figures.FORMATS, (b"\x89PNG", b"%PDF", b"<?xml"), strict=True):
        figures.save(figure, tmp_path / f"figure{suffix}")
        assert (tmp_path / f"figure{suffix}").read_bytes().startswith(start)
    with pytest.raises(ValueError, match=r"'\.jpeg'.*\.png, \.pdf, \.svg"):
        figures.save(figure, tmp_path / "figure.jpeg")
    assert len(list(tmp_path.iterdir())) == len(figures.FORMATS)


TOY = """
from wedgesweep.figures.panels import panels

NAME = "histogram"
DESCRIPTION = "how often each stick fraction occurs"
NEEDS = ("stick_fraction",)


def draw(target, ds, bins=5):
    made = panels(target, 1)
    made.axes[0].hist(ds["stick_fraction"].values.ravel(), bins)
    made.title("Stick fractions")
    return made
"""


def test_a_new_figure_is_one_file(dataset, tmp_path, monkeypatch):
    (tmp_path / "toy_figure.py").write_text(TOY)
    monkeypatch.setattr(figures, "__path__", [*figures.__path__, str(tmp_path)])
    (toy,) = catalogue.declared(tmp_path, "wedgesweep.figures").values()
    assert (toy.name, toy.needs, toy.picks) == ("histogram", ("stick_fraction",), ("bins",))
    monkeypatch.setitem(figures.FIGURES, toy.name, toy)
    drawn = figures.draw(dataset, "histogram", bins=7)
    assert len(drawn.axes[0].patches) == 7
    # Above it stands the title of the sweep.
    assert drawn.get_suptitle() == "synthetic\nStick fractions"


@pytest.mark.few(1)
@pytest.mark.parametrize("kind", KINDS)
def test_a_single_panel_is_drawn_into_given_axes(kind, dataset):
    one = dataset.sel(friction_law="coulomb")
    one = one if kind in FEWEST or kind == "map" else one.isel(amplitude=[4])
    figure = Figure(layout="constrained")
    left, right = figure.subplots(1, 2)
    assert figures.draw(one, kind, ax=right) is figure
    render(figure)
    assert right.has_data()
    assert right.get_xlabel()
    assert right.get_title()
    assert not left.has_data()
    assert not figure.get_suptitle()
    with pytest.raises(ValueError, match=f"^{kind}: [0-9]+ panels do not fit into one Axes"):
        figures.draw(dataset, kind, ax=left)


def test_nearest_case_is_chosen_and_named(dataset):
    figure = figures.draw(dataset, "response", beta=1.7, amplitudes=[0.9e-3, 1.1e-3])
    assert "1.75" in figure.get_suptitle()
    assert [tick.get_text() for tick in figure.axes[0].get_yticklabels()] == ["1"]
    figure = figures.draw(dataset, "phase-portrait", beta=0.9, law="Exponential")
    assert all("exponential" in ax.get_title() for ax in figure.axes)
    assert "4 mm" in figures.draw(dataset, "bifurcation", amplitude=3.5e-3).get_suptitle()
    one = dataset.sel(friction_law="coulomb", beta=1.0, amplitude=1e-3)
    assert len(figures.draw(one, "phase-portrait").axes) == 1
    line = figures.draw(one, "peak-to-peak").axes[0].lines[0]
    assert line.get_xdata() == pytest.approx(one["frequency"].item())


def test_what_moves_is_shown_by_default(dataset):
    chosen = cases.pick_amplitudes(dataset, None, 3)
    fraction = dataset["stick_fraction"].isel(amplitude=chosen)
    assert len(chosen) == 3
    assert (fraction < cases.SLIPS).any(["friction_law", "beta"]).all()
    still = dataset["stick_fraction"].where(dataset["beta"] > 0.9, 1.0)
    drawn = figures.draw(dataset.assign(stick_fraction=still), "phase-portrait")
    assert "β$ = 1 (" in drawn.axes[0].get_title()


def test_frictionless_ratio(dataset):
    # PHYSICS.md for the paper's Table 1: 2.58 at 20 Hz, 1.20 at beta = 3; nothing at beta = 0.
    beta = np.array([0.0, 20.0 * 2.0 * np.pi / fixture_dataset.OMEGA_N, 3.0])
    ratio = amplitude_ratio.frictionless_ratio(dataset, beta)
    assert ratio == pytest.approx([0.0, 2.58, 1.20], abs=0.005)


def test_poincare_samples_are_one_per_period_at_phase_0(dataset):
    samples = bifurcation.poincare_samples(dataset)
    assert samples.shape == (3, 20, 6, fixture_dataset.PERIODS)
    wave = dataset["displacement"].isel(friction_law=0, beta=5, amplitude=4)
    whole_turns = np.isclose(np.mod(dataset["phase"] / (2.0 * np.pi) + 1e-9, 1.0), 0.0, atol=1e-6)
    assert samples[0, 5, 4].tolist() == wave.values[whole_turns].tolist()


def test_friction_curves(dataset):
    settings = config.parse(dataset.attrs["config"])
    parameters = {law: settings.record(config.Case(law, 1.0, 1e-3))[0] for law in LAWS}
    for law in LAWS:
        velocity, coefficient = friction_laws.curve(law, parameters[law], 4e-3)
        assert (np.diff(velocity) >= 0.0).all()
        assert coefficient == pytest.approx(-coefficient[::-1])
        peak = 0.29 if law == "coulomb" else 0.32
        assert coefficient.max() == pytest.approx(peak)
    jump = friction_laws.curve("coulomb", parameters["coulomb"], 4e-3)
    assert sorted(jump[1][jump[0] == 0.0]) == [-0.29, 0.29]


CROSSING = """
[sweep]
friction_law = ["coulomb", "static-dynamic"]
beta = [0.5, 1.0]
amplitude_mm = [0.1, 1.0]
[effects.cross_slip]
velocity_mm_per_s = 5.0
[effects.bolster_mass]
scale = 2.0
"""


def test_each_law_is_drawn_with_its_own_numbers(dataset):
    """With slip across coulomb is regularised, and nothing else is."""
    crossing = dataset.sel(friction_law=["coulomb", "static-dynamic"]).assign_attrs(config=CROSSING)
    coulomb, static_dynamic = figures.draw(crossing, "friction-laws").axes
    assert max(np.max(line.get_ydata()) for line in static_dynamic.lines) == pytest.approx(0.32)
    told = [[text.get_text() for text in ax.texts][-1] for ax in (coulomb, static_dynamic)]
    assert told == ["ramp up to $v_t$ = 0.001 mm/s", "ramp up to $v_t$ = 1 mm/s"]


@pytest.mark.parametrize("held", ["", "[effects.bolster_stiffness]\nscale = 1.1\n"])
def test_small_motions_do_not_depend_on_whether_joints_may_open(held):
    grid = '[sweep]\nfriction_law = "coulomb"\nbeta = [1.0, 2.0]\namplitude_mm = 1.0\n'
    unilateral = '[suspension]\njoints = "unilateral"\nrestitution = 0.3\n[solver]\nmethod = "event-driven"\n'
    bilateral, opens = (physics(config.parse(grid + held + joints)) for joints in ("", unilateral))
    assert opens == bilateral
    assert np.isfinite(list(opens.values())).all()


@pytest.mark.acceptance
def test_what_the_base_model_knows_is_not_said_of_effects_with_mechanics_of_their_own(tmp_path, dataset):
    (tmp_path / "crossing.toml").write_text(CROSSING)
    numbers = physics(config.load(tmp_path / "crossing.toml"))
    assert np.isnan([numbers["frictionless_resonance"], numbers["breakaway_acceleration"]]).all()
    unknown = dataset.assign_attrs(numbers)
    assert np.isnan(amplitude_ratio.frictionless_ratio(unknown, np.array([1.0, 2.0]))).all()
    ratio, sticking = (figures.draw(unknown, kind) for kind in ("amplitude-ratio", "stick-map"))
    for figure in (ratio, sticking):
        render(figure)
    assert not ratio.axes[0].get_legend_handles_labels()[1]
    assert "breakaway" not in legend(sticking)
    heavy = dataset.assign_attrs(
        config=CROSSING.replace("[effects.cross_slip]\nvelocity_mm_per_s = 5.0\n", "")
    )
    ratio = amplitude_ratio.frictionless_ratio(heavy, np.array([20.0]))
    assert ratio < amplitude_ratio.frictionless_ratio(dataset, np.array([20.0]))


def test_stick_map_cells_enclose_their_centres():
    for centres in (np.array([0.1, 0.3, 0.4, 1.75]), np.array([0.005, 0.015, 0.1, 4.75])):
        for logarithmic in (False, True):
            edges = maps.cell_edges(centres, logarithmic)
            assert ((edges[:-1] < centres) & (centres < edges[1:])).all()
    # An axis such as the column angle may be negative.
    assert maps.cell_edges(np.array([-8.0, -4.0, 0.0, 4.0]), False).tolist() == [-10.0, -6.0, -2.0, 2.0, 6.0]
    assert maps.cell_edges(np.array([0.0, 1.0, 2.0]), False).tolist() == [0.0, 0.5, 1.5, 2.5]


def test_cases_that_failed_lifted_off_or_did_not_settle_are_marked(dataset):
    lifted = 0.0 * dataset["lift_off_fraction"]
    plain = dataset.assign(lift_off_fraction=lifted, period=1 + dataset["status"])
    for kind in ("amplitude-ratio", "stick-map"):
        for words in ("lift-off: outside of validity", "not settled"):
            assert words in legend(figures.draw(dataset, kind))
            assert words not in legend(figures.draw(plain, kind))
        if kind != "stick-map":
            figure = figures.draw(dataset.isel(amplitude=[4]), kind)
            assert "no result" in figure.get_suptitle()
    clean = fixture_dataset.build(failed=None)
    assert "no result" not in figures.draw(clean, "amplitude-ratio").get_suptitle()


def test_marked_points_are_those_of_the_variables(dataset):
    case = dataset.isel(friction_law=0, amplitude=5)
    ax = Figure().subplots()
    validity.mark(ax, case["beta"].values, case["amplitude_ratio"].values, case, "black")
    *hollow, both = ax.lines  # hollow ones, and a grey ring where nothing settled either
    marked = sorted(x for line in ax.lines for x in line.get_xdata())
    lifted = case["beta"].values[case["lift_off_fraction"] > 0.0].tolist()
    assert marked == lifted
    assert both.get_xdata().tolist() == [0.6]
    assert (both.get_markerfacecolor(), both.get_color()) == ("white", "0.6")
    assert [line.get_color() for line in hollow] == ["black"]
    assert "24 of" not in validity.shares(case)
    assert f"{len(lifted)} of 20 cases with lift-off" in validity.shares(case)
    plain = case.assign(lift_off_fraction=0.0 * case["lift_off_fraction"])
    ax = Figure().subplots()
    validity.mark(ax, case["beta"].values, case["amplitude_ratio"].values, plain, "black")
    (grey,) = ax.lines
    assert (grey.get_xdata().tolist(), grey.get_color()) == ([0.6], "0.6")


@pytest.mark.few(2)
@pytest.mark.parametrize("kind", KINDS)
def test_every_figure_takes_a_law(kind, dataset):
    law = "Coulomb"
    figure = figures.draw(dataset, kind, law=law)
    told = str([figure.get_suptitle(), *(ax.get_title() for ax in figure.axes)])
    assert kind == "peak-to-peak" or law.lower() in told
    assert "static-dynamic" not in told


def test_many_cases_are_a_density(dataset, monkeypatch):
    monkeypatch.setattr(amplitude_ratio, "MOST_CASES", 50)
    ax = figures.draw(dataset, "amplitude-ratio").axes[0]
    assert [line.get_label() for line in ax.lines] == ["no friction"]
    (mesh,) = ax.collections
    shares = mesh.get_array()
    assert 0.0 < shares.min() <= shares.max() <= 1.0
    assert "not settled" in legend(figures.draw(dataset, "lines"))
    monkeypatch.setattr(lines, "MOST_MARKED", 50)
    assert "not settled" not in legend(figures.draw(dataset, "lines"))
