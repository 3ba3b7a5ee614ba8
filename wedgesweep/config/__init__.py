"""Config of a sweep: TOML with the unit in every key, checked, and SI from here on."""

import logging
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from functools import cached_property
from hashlib import sha256
from math import isnan, pi, prod, sqrt
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from wedgesweep import __version__
from wedgesweep.config import toml
from wedgesweep.config.contradictions import contradictions
from wedgesweep.config.input_contradictions import is_force
from wedgesweep.errors import InputError
from wedgesweep.files import read_text
from wedgesweep.kinds import CONFIG, confusion
from wedgesweep.natural_units import natural_units

log = logging.getLogger(__name__)

# With this effect a suspension may have no equilibrium.
SOFTENING = "cubic_stiffness"
OSCILLATOR = "oscillator"
# The effect that is the same as unilateral joints.
LIFT_OFF = "lift_off"
# What beta refers to where there is no spring: 1 Hz, in rad/s.
UNIT_FREQUENCY = 2.0 * pi

# Imports that load numba or scipy come late, so that `wedgesweep --help` does not wait for them.
if TYPE_CHECKING:
    from wedgesweep.inputs.sampled import Input
    from wedgesweep.natural_units import NaturalUnits
    from wedgesweep.quantity import Quantity
    from wedgesweep.simulate import Settings, Transient


class ConfigError(InputError):
    """A config cannot run; ``problems`` lists all its faults."""


class Case(NamedTuple):
    """One case of a sweep; amplitude in m, under a force in N."""

    law: str
    beta: float
    amplitude: float


@dataclass(frozen=True)
class Cases:
    """The cases: a grid, or a list in ``cases`` (the grid is then empty).

    ``beta`` and ``amplitude`` (m; under a force N) have shapes (n,) and (m,); beta refers to ``omega_n``
    (rad/s). Under an [input] beta is 1, and ``amplitude`` is the scale.
    """

    friction_law: tuple[str, ...]
    beta: np.ndarray
    amplitude: np.ndarray
    omega_n: float
    cases: tuple[Case, ...] | None

    @property
    def shape(self) -> tuple[int, ...]:
        """Sizes of the case dimensions: of laws, frequencies and amplitudes, or of the list."""
        if self.cases is not None:
            return (len(self.cases),)
        return len(self.friction_law), self.beta.size, self.amplitude.size

    @property
    def count(self) -> int:
        """Number of cases."""
        return prod(self.shape)

    @cached_property
    def laws(self) -> tuple[str, ...]:
        """The laws of the cases, each once."""
        if self.cases is None:
            return self.friction_law
        return tuple(dict.fromkeys(case.law for case in self.cases))

    def at(self, indices: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Place in ``laws``, beta and amplitude of some cases, each of the shape of ``indices``.

        A grid counts law, beta, amplitude (the last varies fastest). No other case is made.
        """
        if self.cases is None:
            law, beta, amplitude = np.unravel_index(indices, self.shape)
            return law, self.beta[beta], self.amplitude[amplitude]
        laws, betas, amplitudes = self._columns
        return laws[indices], betas[indices], amplitudes[indices]

    @cached_property
    def _columns(self) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """All cases of a list, as ``at`` returns some."""
        place = {law: number for number, law in enumerate(self.laws)}
        laws, betas, amplitudes = zip(*self.cases or (), strict=True)
        return np.array([place[law] for law in laws]), np.array(betas), np.array(amplitudes)

    def case(self, index: int) -> Case:
        """One of the cases."""
        law, beta, amplitude = self.at(np.array(index))
        return Case(self.laws[int(law)], float(beta), float(amplitude))


class AmplitudeUnit(NamedTuple):
    """How input amplitudes are written: unit, and what turns a number into SI."""

    unit: str
    factor: float

    @property
    def key(self) -> str:
        return f"amplitude_{self.unit}"


@dataclass(frozen=True)
class Config:
    """A checked config. ``document`` holds every key in its own unit; the properties are SI."""

    document: dict[str, Any]

    @property
    def title(self) -> str:
        return self.document["title"]

    @cached_property
    def suspension(self) -> dict[str, Any]:
        """SI numbers of the suspension; ``joints`` and ``restitution`` where they are unilateral."""
        from wedgesweep.systems.suspension.parameters import RESTITUTION, SUSPENSION, UNILATERAL

        given = self.document["suspension"]
        if given.get("joints") != UNILATERAL:
            return _si(SUSPENSION, given)
        restitution = given.get(RESTITUTION.key, RESTITUTION.default)
        return {**_si(SUSPENSION, given), "joints": given["joints"], "restitution": restitution}

    @property
    def opens(self) -> bool:
        """Whether the joints of a suspension are unilateral, so that wedges may lift off."""
        unilateral = self.document.get("suspension", {}).get("joints") == "unilateral"
        return unilateral or LIFT_OFF in self.document["effects"]

    def natural_units(self, travel: float | None = None, omega: float | None = None) -> "NaturalUnits":
        """Natural units of the model, whose measured motion has some travel (m) and angular frequency."""
        if self.system == OSCILLATOR:
            own = self.oscillator
            return natural_units(own["mass"], own["spring"], travel=travel, omega=omega)
        from wedgesweep.systems.suspension.parameters import natural_units_of

        return natural_units_of(self.suspension, travel)

    @property
    def system(self) -> str:
        """Name of the mechanical system: suspension or oscillator."""
        return OSCILLATOR if OSCILLATOR in self.document else "suspension"

    @cached_property
    def oscillator(self) -> dict[str, Any]:
        """SI numbers of the oscillator, and its contact."""
        from wedgesweep.systems.oscillator.parameters import BELT_VELOCITY, BRISTLES
        from wedgesweep.systems.oscillator.parameters import OSCILLATOR as QUANTITIES

        given = self.document[OSCILLATOR]
        more = [each for each in (BELT_VELOCITY, *BRISTLES) if each.key in given]
        return {**_si((*QUANTITIES, *more), given), "contact": given["contact"]}

    @property
    def possible_effects(self) -> tuple[str, ...]:
        """Names of the effects that a model may lack.

        Of a suspension these are all but what its joints do not go with. An oscillator has no wedge. If it
        rubs, more friction of its surface is another level of friction; if not, there is nothing that the
        effects on the law of friction could change. Under a force the base is at rest.
        """
        from wedgesweep.effects import EFFECTS
        from wedgesweep.systems.oscillator import parameters

        if self.system != OSCILLATOR:
            return tuple(name for name in EFFECTS if name in self.effects or self._may_have(name))
        rubs = self.oscillator["normal_force"] * max(self.friction["dynamic"], self.friction["static"]) > 0.0
        without = {parameters.LATERAL} if rubs else {*parameters.OF_FRICTION}
        if self.oscillator["spring"] == 0.0:
            without.update(parameters.OF_SPRING)
        if self.forced:
            without.add(parameters.OF_BASE)
        return tuple(name for name in parameters.effect_names() if name not in without)

    def _may_have(self, effect: str) -> bool:
        """Whether the model of a suspension can have a further effect, as far as its joints are concerned."""
        if effect != LIFT_OFF and not self.opens:
            return True
        added = self.document["effects"] | {effect: {}}
        return not any(contradictions(self.document | {"effects": added}))

    @property
    def excitation(self) -> str:
        """What the input is: "base" (its motion) or "force"."""
        if self.transient:
            return "force" if is_force(self.document["input"]) else "base"
        return self.document["sweep"].get("excitation", "base")

    @cached_property
    def friction(self) -> dict[str, float]:
        from wedgesweep.friction.quantities import FRICTION

        return _si(FRICTION, self.document["friction"])

    @cached_property
    def effects(self) -> dict[str, dict[str, float]]:
        from wedgesweep.effects import EFFECTS

        given = self.document["effects"]
        return {name: _si(EFFECTS[name].quantities, values) for name, values in given.items()}

    @cached_property
    def sweep(self) -> Cases:
        given = self.document["sweep"]
        omega_n = given["omega_n_rad_per_s"]
        if self.transient:
            laws, scale = tuple(given["friction_law"]), np.array(given["scale"])
            return Cases(laws, np.ones(1), scale, omega_n, None)
        cases = tuple(
            Case(each["friction_law"], *_betas(each, omega_n), *_amplitudes(each))
            for each in given.get("case", ())
        )
        return Cases(
            tuple(given.get("friction_law", ())),
            np.array(_betas(given, omega_n)),
            np.array(_amplitudes(given)),
            omega_n,
            cases or None,
        )

    @cached_property
    def solver(self) -> "Settings":
        from wedgesweep.simulate import Settings

        given = self.document["solver"]
        return Settings(
            method=given["method"],
            rtol=given["rtol"],
            duration=given.get("duration_s"),
            settle_periods=given.get("settle_periods"),
            kept_periods=given["kept_periods"],
            samples_per_period=given["samples_per_period"],
            case_timeout=given["case_timeout_s"],
            steady="settle" in given,
            steady_tolerance=given["steady_tolerance"],
            max_periods=given["max_periods"],
            keep_waveforms=given["keep_waveforms"],
            continuation=given["continuation"],
            transient=self._transient() if self.transient else None,
        )

    @property
    def transient(self) -> bool:
        """Whether the config has an [input], which does not repeat."""
        return "input" in self.document

    @cached_property
    def input(self) -> "Input":
        """The input at scale 1; raises ConfigError if a recording cannot be read."""
        from wedgesweep.inputs.sampled import made

        return made(self.document["input"], self.sweep.omega_n)

    def _transient(self) -> "Transient":
        """How the input is run."""
        from wedgesweep.inputs.transient import transient

        absolute = self.system == OSCILLATOR and self.oscillator["contact"] != "base"
        rate = self.document["input"].get("sampling_hz")
        return transient(self.input, self.sweep.omega_n, rate, absolute, self.system == OSCILLATOR)

    def with_method(self, method: str) -> "Config":
        """The same config with another solver; raises ConfigError if its settings do not allow it."""
        document = self.document | {"solver": self.document["solver"] | {"method": method}}
        if problems := list(contradictions(document)):
            raise ConfigError([f'solver "{method}": {problem}' for problem in problems])
        return Config(document)

    def single_case(
        self,
        amplitude_mm: float | None,
        beta: float | None,
        frequency_hz: float | None,
        law: str | None,
        amplitude_N: float | None = None,
    ) -> "Config":
        """The same config with a grid of one case, whose waveforms are kept; raises ConfigError.

        Either ``beta`` or ``frequency_hz`` is given, and one of the amplitudes; ``law`` is by default the
        config's first.
        """
        given = {
            "friction_law": law.lower() if law else self.sweep.laws[0],
            "beta": beta,
            "frequency_hz": frequency_hz,
            "excitation": self.document["sweep"].get("excitation"),
            "amplitude_mm": amplitude_mm,
            "amplitude_N": amplitude_N,
            "omega_n_rad_per_s": None if self.has_no_spring else self.sweep.omega_n,
        }
        grid = {key: value for key, value in given.items() if value is not None}
        if self.transient:
            problem = "input: a single case is of a sine; remove [input], or use 'wedgesweep run'"
            raise ConfigError([problem])
        solver = self.document["solver"] | {"keep_waveforms": True, "continuation": False}
        return from_document(self.document | {"sweep": grid, "solver": solver}, "case")

    def case_list(self) -> list[Case]:
        """All cases, which may be many: ``sweep.case`` makes one of them."""
        laws, *numbers = (each.tolist() for each in self.sweep.at(np.arange(self.sweep.count)))
        return [Case(self.sweep.laws[law], *pair) for law, *pair in zip(laws, *numbers, strict=True)]

    def case_coordinates(
        self,
    ) -> tuple[tuple[int, ...], dict[str, tuple[str, Any, dict[str, str]]]]:
        """Shape of the cases; dimension, values and attributes of their coordinates."""
        sweep = self.sweep
        if self.transient:
            about = "what multiplies the input, or the start of a release"
            return (len(sweep.friction_law), sweep.amplitude.size), {
                "friction_law": ("friction_law", list(sweep.friction_law), {"long_name": "friction law"}),
                "scale": ("scale", sweep.amplitude, {"units": "1", "long_name": about}),
            }
        if sweep.cases is None:
            dims = ["friction_law", "beta", "amplitude"]
            laws, betas, amplitudes = list(sweep.friction_law), sweep.beta, sweep.amplitude
        else:
            dims = ["case"] * 3
            laws = [case.law for case in sweep.cases]
            _, betas, amplitudes = sweep.at(np.arange(sweep.count))
        frequencies = betas * sweep.omega_n / (2.0 * pi)
        unit, amplitude = ("N", "amplitude of the force") if self.forced else ("m", "input amplitude a")
        beta = "input frequency over 1 Hz" if self.has_no_spring else "input frequency over omega_n"
        return sweep.shape, {
            "friction_law": (dims[0], laws, {"long_name": "friction law"}),
            "beta": (dims[1], betas, {"units": "1", "long_name": beta}),
            "amplitude": (dims[2], amplitudes, {"units": unit, "long_name": amplitude}),
            "frequency": (dims[1], frequencies, {"units": "Hz", "long_name": "input frequency"}),
        }

    def record(self, case: Case) -> np.ndarray:
        """Parameter record of a case, shape (1,)."""
        return self.record_with(self.effects, case.law, case.amplitude, case.beta * self.sweep.omega_n)

    def record_with(
        self, effects: Mapping[str, Mapping[str, float]], law: str, amplitude: float = 1.0, omega: float = 1.0
    ) -> np.ndarray:
        """Parameter record, shape (1,), with other effects (SI); amplitude in m or N, omega in rad/s."""
        from wedgesweep.systems import oscillator, suspension

        if self.system == OSCILLATOR:
            own = self.oscillator
            return oscillator.record(law, amplitude, omega, own, self.friction, effects, self.excitation)
        return suspension.record(law, amplitude, omega, self.suspension, self.friction, effects)

    @property
    def forced(self) -> bool:
        """Whether the input is a force, and amplitudes are in N."""
        return self.excitation == "force"

    @property
    def has_no_spring(self) -> bool:
        """Whether there is no natural frequency that frequencies could be compared with."""
        own, omega_n = self.document.get(OSCILLATOR, {}), self.document["sweep"]["omega_n_rad_per_s"]
        return own.get("spring_N_per_mm") == 0.0 and omega_n == UNIT_FREQUENCY

    @property
    def amplitude_unit(self) -> AmplitudeUnit:
        """Unit of the input's amplitude in files: N of a force, mm of the base."""
        return AmplitudeUnit("N", 1.0) if self.forced else AmplitudeUnit("mm", 1e-3)

    @property
    def simulated_motion(self) -> tuple[str, ...]:
        """Whether simulated displacements are "relative" to the base, "absolute", or both."""
        if self.forced:
            return "relative", "absolute"
        moves_with_base = self.system != OSCILLATOR or self.oscillator["contact"] == "base"
        return ("relative",) if moves_with_base else ("absolute",)

    def deflection(self, omega: float | np.ndarray) -> float | np.ndarray:
        """Length (m) that motions are compared with, over the input amplitude, at omega (rad/s).

        1 on a moving base; under a force the deflection at rest, without a spring the free mass's motion.
        """
        if not self.forced:
            return 1.0
        own = self.oscillator
        return 1.0 / (own["spring"] or own["mass"] * omega**2)

    def records(self, indices: np.ndarray | None = None) -> np.ndarray:
        """Parameter records of the cases of these indices, shape (n,); by default of all."""
        sweep = self.sweep
        laws, betas, amplitudes = sweep.at(np.arange(sweep.count) if indices is None else indices)
        records = self.records_of_laws[laws]
        # Only amplitude and frequency differ between the cases of a law.
        records["input"]["amplitude"] = amplitudes
        records["input"]["omega"] = betas * sweep.omega_n
        return records

    @cached_property
    def records_of_laws(self) -> np.ndarray:
        """Parameter records of one case of each of ``sweep.laws``."""
        return np.concatenate([self.record(Case(law, 1.0, 1.0)) for law in self.sweep.laws])

    def to_toml(self) -> str:
        """The resolved config with every key, ranges expanded; ``parse`` of it gives the same config."""
        return toml.dumps(self.document)

    @property
    def remark(self) -> str | None:
        """What readers of the results should know of the friction: effects change it, or it is unusual."""
        return "; ".join(filter(None, (self._regularised(), self._strengthening()))) or None

    def _strengthening(self) -> str | None:
        """Static friction that is below dynamic friction."""
        static, dynamic = (self.friction[name] for name in ("static", "dynamic"))
        if static >= dynamic:
            return None
        return (
            f"friction.static = {static:g} is below friction.dynamic = {dynamic:g}: friction rises once the "
            "faces slip, so that nothing makes them break away and stick again; dry friction has it the "
            "other way round (coulomb knows dynamic friction only)"
        )

    def _regularised(self) -> str | None:
        """Set-valued friction that effects make smooth."""
        from wedgesweep.systems.suspension import parameters

        law = "coulomb"
        if self.system == OSCILLATOR or law not in self.sweep.laws:
            return None
        if not parameters.is_regularised(self.record(Case(law, 1.0, 1.0))[0]):
            return None
        width = parameters.regularised_velocity(self.suspension) * 1e3
        return (
            f"{law}: with cross_slip or column_compliance the faces may stick one at a time; "
            f"friction is regularised, a ramp up to mu_d over {width:g} mm/s"
        )

    @property
    def sha256(self) -> str:
        return sha256(self.to_toml().encode()).hexdigest()


def load(path: str | Path) -> Config:
    """Read a config file; raises ConfigError."""
    if problem := confusion(Path(path), CONFIG):
        raise ConfigError([problem])
    try:
        text = read_text(Path(path))
    except UnicodeDecodeError as error:
        problem = f"{path}: not UTF-8 text (byte {error.start}); save it as UTF-8"
        raise ConfigError([problem]) from error
    except OSError as error:
        problem = f"{path}: {error.strerror}; give the path of a TOML file"
        raise ConfigError([problem]) from error
    found = parse(text, str(path), Path(path).parent)
    log.debug("%s: %d cases, %s", path, found.sweep.count, found.document["solver"]["method"])
    return found


def parse(text: str, source: str = "<config>", directory: Path = Path()) -> Config:
    """Read a config from TOML text; raises ConfigError with everything that is wrong with it.

    ``directory``: where the path of a recorded input begins.
    """
    try:
        given = toml.loads(text)
    except ValueError as error:
        raise ConfigError([f"{source}: not valid TOML: {error}"]) from error
    return from_document(given, source, directory)


def from_document(given: Mapping[str, Any], source: str = "<config>", directory: Path = Path()) -> Config:
    """Check the tables and keys of a config; raises ConfigError with everything that is wrong with it."""
    from wedgesweep.config.declarations import root

    problems: list[str] = []
    document = root("input" in given).read(given, "", problems)
    problems += contradictions(document)
    recorded = document.get("input", {})
    if not problems and recorded.get("kind") == "record" and "sha256" not in recorded:
        problems += _located(recorded, directory)
    if problems:
        raise ConfigError([f"{source}: {problem}" for problem in problems])
    document["sweep"].setdefault("omega_n_rad_per_s", _natural_frequency(document))
    if OSCILLATOR in document and "title" not in given:
        document["title"] = "friction oscillator"
    found = Config(document)
    if SOFTENING in found.effects and found.system != OSCILLATOR:
        _require_rest(found, source)
    return found


def _located(recorded: dict[str, Any], directory: Path) -> list[str]:
    """Fill in the full path and the digest of a recorded input; what is wrong with its file."""
    from wedgesweep.inputs import record

    recorded["file"] = str((directory / recorded["file"]).resolve())
    try:
        recorded["sha256"] = record.digest(Path(recorded["file"]))
        record.columns(recorded)
    except ConfigError as error:
        return error.problems
    return []


def _natural_frequency(document: Mapping[str, Any]) -> float:
    """The omega_n (rad/s) that beta refers to; 1 Hz where there is no spring."""
    own = document.get(OSCILLATOR)
    if own is None:
        own = document["suspension"]
        return sqrt(own["bolster_spring_N_per_mm"] * 1e3 / own["bolster_mass_kg"])
    return sqrt(own["spring_N_per_mm"] * 1e3 / own["mass_kg"]) or UNIT_FREQUENCY


def _require_rest(found: Config, source: str) -> None:
    """Refuse springs that soften so much that they have no equilibrium under the weight."""
    if isnan(found.record(Case("static-dynamic", 1.0, 1e-3))["geometry"]["rest"][0]):
        problem = "leaves the springs no equilibrium under the weight; it must be larger"
        raise ConfigError([f"{source}: effects.{SOFTENING}.coefficient_N_per_mm3: {problem}"])


def schema() -> dict[str, Any]:
    """JSON schema of a config (draft 2020-12), for editors."""
    from wedgesweep.config.declarations import root

    return {
        "$schema": "https://json-schema.org/draft/2020-12/schema",
        "$id": f"urn:wedgesweep:config:{__version__}",
        "version": __version__,
        **root().schema(),
    }


def template() -> str:
    """A config with every key, commented."""
    from wedgesweep.config import commented
    from wedgesweep.config.declarations import root

    return commented.template(root())


def _si(quantities: Iterable["Quantity"], given: Mapping[str, float]) -> dict[str, float]:
    return {each.name: given[each.key] * each.factor for each in quantities}


def _betas(given: Mapping[str, Any], omega_n: float) -> list[float]:
    if "frequency_hz" in given:
        return [2.0 * pi * f / omega_n for f in _listed(given["frequency_hz"])]
    return _listed(given.get("beta", []))


def _amplitudes(given: Mapping[str, Any]) -> list[float]:
    """Amplitudes of the input in m, or of a force in N."""
    if "amplitude_N" in given:
        return _listed(given["amplitude_N"])
    return _metres(_listed(given.get("amplitude_mm", [])))


def _metres(amplitudes: list[float]) -> list[float]:
    """Convert from mm, rounded so that 0.3 mm is the float 0.0003, by which users select."""
    return [float(f"{amplitude * 1e-3:.15g}") for amplitude in amplitudes]


def _listed(value: Any) -> list[float]:
    return value if isinstance(value, list) else [value]
