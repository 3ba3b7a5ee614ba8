"""Declaration of every config key with its default, range and meaning."""

from collections.abc import Collection, Mapping
from math import nan, sqrt

from wedgesweep.config import force_table
from wedgesweep.config.axes import NO_NUMBER, TOGETHER, Axes, Varied, WithNumbers, numbers_of
from wedgesweep.config.inputs import INPUT, SCALE
from wedgesweep.config.keys import Choice, Flag, Number, Text, Whole
from wedgesweep.config.sample import KEYS as SAMPLE_KEYS
from wedgesweep.config.sample import Sample
from wedgesweep.config.series import Series, Several
from wedgesweep.config.tables import GridOrList, Table, TableList, table
from wedgesweep.effects import EFFECTS, empirical_force
from wedgesweep.effects.base import Effect
from wedgesweep.friction import LAWS
from wedgesweep.friction.names import LAW_NAMES
from wedgesweep.friction.quantities import FRICTION
from wedgesweep.quantity import Quantity
from wedgesweep.rotation import MOTIONS, ROTATION
from wedgesweep.solvers.names import SOLVERS
from wedgesweep.systems.oscillator import parameters as oscillator
from wedgesweep.systems.suspension import parameters as suspension

BETA = Quantity("beta", nan, "input frequency over omega_n", above=0.0)
FREQUENCY = Quantity("frequency_hz", nan, "input frequency", above=0.0)
AMPLITUDE = Quantity("amplitude_mm", nan, "input amplitude a of the side frame", above=0.0)
FORCE_AMPLITUDE = Quantity(
    "amplitude_N", nan, 'amplitude of the force on the mass, for excitation = "force"', minimum=0.0
)
# The laws are looked up when a config is read: one may be registered until then.
LAW = Choice("friction_law", "friction law", choices=LAWS.keys(), example=LAW_NAMES[0])


def _series(quantity: Quantity, example: object) -> Series:
    return Series(
        quantity.key,
        f"{quantity.meaning}: a number, an increasing list or a range",
        item=Number.of(quantity),
        example=example,
    )


def _optional(key: str, meaning: str, choices: Collection[str], example: str) -> Choice:
    return Choice(key, meaning, choices=choices, optional=True, example=example)


def _off(quantity: Quantity, meaning: str) -> Number:
    """A number that an absent key switches off, whatever the default of its effect is."""
    return Number.of(quantity, meaning=meaning, default=None, optional=True, example=quantity.default)


EXCITATION = _optional(
    "excitation",
    'motion of the base, or (oscillator only) a force on the mass; default: "base"',
    oscillator.EXCITATIONS,
    oscillator.BASE,
)


def _effect(effect: Effect) -> Table:
    if effect.name == empirical_force.NAME:
        return force_table.KEYS
    keys = (Number.of(each, example=_typical(each)) for each in effect.quantities)
    return table(effect.name, effect.described(), *keys, optional=True)


def _typical(quantity: Quantity) -> float | None:
    """The middle of what a fit searches, to one digit."""
    if quantity.search is None:
        return None
    low, high = quantity.search
    return float(f"{sqrt(low * high) if quantity.logarithmic else 0.5 * (low + high):.0e}")


OMEGA_N = Number.new(
    "omega_n_rad_per_s",
    "omega_n that beta refers to; default: sqrt(k_b/M_b), or sqrt(k/m)",
    above=0.0,
    optional=True,
    example=85.3565,
)

LAWS_KEY = Several("friction_law", "friction laws", item=LAW, example=list(LAW_NAMES))

INPUT_KEYS = (
    (
        _series(BETA, {"start": 0.1, "stop": 3.0, "num": 30}),
        _series(FREQUENCY, [20.0, 30.0]),
    ),
    EXCITATION,
    (
        _series(AMPLITUDE, [0.005, 0.015, 0.1, 0.3, 1.0]),
        _series(FORCE_AMPLITUDE, [1.0, 2.0]),
    ),
)


def _grid(numbers: Mapping[str, Varied], transient: bool) -> Table:
    """[sweep] as a grid, under a sine or beside an [input]; ``numbers`` may vary."""
    where = (
        "under [input]: every law at every scale"
        if transient
        else "every law at every frequency and amplitude"
    )
    return table(
        "sweep",
        f"the cases {where}" if transient else f"the cases: {where}",
        LAWS_KEY,
        *((SCALE,) if transient else INPUT_KEYS),
        OMEGA_N,
        (
            table(
                "axes",
                "other axes of the grid: values of numbers of the model",
                TOGETHER,
                kind=Axes,
                numbers=numbers,
                optional=True,
                unknown=NO_NUMBER,
                example=("suspension.wedge_angle_deg", {"start": 28, "stop": 45, "num": 18}),
            ),
            table(
                "sample",
                "instead of axes: samples of numbers of the model",
                *SAMPLE_KEYS,
                kind=Sample,
                numbers=numbers,
                optional=True,
                unknown=NO_NUMBER,
                example=("friction.dynamic", "0.29 +- 5 %"),
            ),
        ),
        unknown="no key of a [sweep] beside an [input]" if transient else Table.unknown,
    )


def _listed(numbers: Mapping[str, Varied]) -> Table:
    """[sweep] as a list of cases."""
    return table(
        "sweep",
        "a list of cases",
        OMEGA_N,
        EXCITATION,
        TableList(
            "case",
            "one case each",
            item=table(
                "case",
                "one case",
                LAW,
                (Number.of(BETA, example=0.4), Number.of(FREQUENCY, example=20.0)),
                (Number.of(AMPLITUDE, example=1.0), Number.of(FORCE_AMPLITUDE, example=1.0)),
                kind=WithNumbers,
                numbers=numbers,
                example=("suspension.wedge_angle_deg", 30.0),
            ),
        ),
    )


SOLVER = table(
    "solver",
    "how each case is solved",
    Choice("method", "integrator", choices=SOLVERS, default=SOLVERS[0]),
    Number.new("rtol", "relative tolerance", 1e-6, minimum=1e-13, maximum=1e-2),
    (
        Number.new(
            "duration_s",
            "simulated time, in whole periods and at least kept_periods + 1 of them",
            1.5,
            above=0.0,
        ),
        Whole.new(
            "settle_periods",
            "periods simulated before those that are kept",
            minimum=1,
            maximum=100_000,
            example=60,
        ),
        _optional("settle", "run until the response repeats (event-driven only)", ("steady",), "steady"),
    ),
    Number.new(
        "steady_tolerance",
        "largest change per repetition of a steady response, over input amplitude and velocity",
        1e-7,
        minimum=1e-13,
        maximum=1e-2,
    ),
    Flag(
        "continuation",
        "sweep up and down in beta, from one steady state to the next, to find coexisting responses",
        default=False,
    ),
    Whole.new(
        "max_periods",
        "periods after which a response that has not repeated counts as not periodic",
        5000,
        minimum=10,
        maximum=10**7,
    ),
    Whole.new(
        "kept_periods",
        "periods at the end of a run that are evaluated and stored",
        3,
        minimum=2,
        maximum=1000,
    ),
    Whole.of(
        Quantity("samples_per_period", 256, "samples per period of the stored waveforms", 32, maximum=65_536),
        step=2,
    ),
    Flag("keep_waveforms", "store waveforms, not only numbers", default=True),
    Number.new(
        "case_timeout_s",
        "wall-clock limit of a case (radau; event-driven limits its steps and events instead)",
        60.0,
        above=0.0,
    ),
    default={},
)


OSCILLATOR_TABLE = table(
    "oscillator",
    "instead of a suspension: a mass that rubs on a surface, m x'' + c (x' - u') + k (x - u) + mu(v) N = F",
    *(
        Number.of(quantity, example=example)
        for quantity, example in zip(oscillator.OSCILLATOR, (3.0, 1.2, 0.0, 2.5), strict=True)
    ),
    Choice(
        "contact",
        "what the rubbing surface moves with: base (v = x' - u'), ground (v = x') or belt",
        choices=oscillator.CONTACTS,
        default=oscillator.BASE,
    ),
    Number.of(oscillator.BELT_VELOCITY, optional=True, example=200.0),
    _optional(
        "motion",
        "rotation: angles for lengths, torques for forces, and keys in rad, N m and kg m^2",
        MOTIONS,
        ROTATION,
    ),
    _optional(
        "restoring_force",
        "of the spring; pendulum: of a rotation, k sin(x), where the spring is m g l",
        oscillator.RESTORING,
        oscillator.LINEAR,
    ),
    Number.of(oscillator.COUPLING, optional=True, example=0.5),
    *(
        Number.of(quantity, optional=True, example=example)
        for quantity, example in zip(oscillator.BRISTLES, (100.0, 300.0, 0.4), strict=True)
    ),
)


def root(transient: bool = False) -> Table:
    """The whole config, with the effects that are registered by now; ``transient``: it has an [input]."""
    model = _model()
    varying = numbers_of(model)
    scaled = _grid(varying, transient=True)
    grid, listed = _grid(varying, transient=False), _listed(varying)
    cases = GridOrList("sweep", "the cases", grid=grid, listed=listed, scaled=scaled)
    title = Text("title", "title of the sweep", default="wedge suspension")
    return table("", "Config of wedgesweep", title, *model.groups, scaled if transient else cases, SOLVER)


def numbers() -> dict[str, Varied]:
    """The numbers of models that a sweep may vary, by dotted key."""
    return numbers_of(_model())


def _model() -> Table:
    """The tables of what is simulated."""
    return table(
        "",
        "the model and its input",
        (
            table(
                "suspension",
                "the suspension; defaults: Table 1 of the paper",
                *map(Number.of, suspension.SUSPENSION),
                _optional(
                    "damping",
                    "whether the springs of the wedges stand on the side frame, or on the bolster",
                    suspension.DAMPING,
                    suspension.CONSTANT,
                ),
                _optional(
                    "joints",
                    "whether both faces of a wedge are held, or may lift off, fall back and hit",
                    suspension.JOINTS,
                    suspension.UNILATERAL,
                ),
                _off(
                    suspension.RESTITUTION,
                    'coefficient of restitution of impacts, for joints = "unilateral" (0 if absent)',
                ),
                _off(
                    suspension.LOCKED_IN,
                    "share of the band of rest that set-valued friction holds (0 if absent)",
                ),
                default={},
            ),
            OSCILLATOR_TABLE,
        ),
        table("friction", "friction on both faces of each wedge", *map(Number.of, FRICTION), default={}),
        table(
            "effects",
            "effects that the base model leaves out; off unless their table is present",
            *map(_effect, EFFECTS.values()),
            default={},
        ),
        INPUT,
    )
