"""A checked config: every key in its own unit, and SI numbers of all that is simulated."""

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, replace
from functools import cached_property
from hashlib import sha256
from math import pi
from typing import Any

import numpy as np

from wedgesweep import formatting, rotation, toml
from wedgesweep.config.axes import INPUT, dimension, named, with_numbers
from wedgesweep.config.cases import UNIT_FREQUENCY, AmplitudeUnit, Case, Cases, natural_frequency, of_document
from wedgesweep.config.contradictions import contradictions
from wedgesweep.config.declarations import numbers
from wedgesweep.config.input_contradictions import is_force
from wedgesweep.config.keys import Number
from wedgesweep.config.turned import numbers_back, turned_numbers
from wedgesweep.effects import EFFECTS, empirical_force, go_together, jamming, lift_off, of_system
from wedgesweep.effects.base import OSCILLATOR
from wedgesweep.friction import LAWS
from wedgesweep.friction.quantities import FRICTION
from wedgesweep.inputs.kinds import made as input_of
from wedgesweep.inputs.sampled import Input, transient_of
from wedgesweep.natural_units import NaturalUnits, natural_units
from wedgesweep.quantity import Quantity
from wedgesweep.simulate import Settings, Transient
from wedgesweep.systems.oscillator import parameters as oscillator
from wedgesweep.systems.records import stacked
from wedgesweep.systems.suspension import parameters as suspension

# Records of models that are kept (900 bytes each).
MOST_KEPT = 4096
# Why an effect is no candidate, which a report tells where friction is what is missing.
NO_FRICTION = "changes friction, and the model has none"


@dataclass(frozen=True)
class Config:
    """A checked config. ``document`` holds every key in its own unit; the properties are SI.

    That of a rotation has the keys of a translation, with angles as lengths; ``written`` has its own keys.
    ``nominal_load``: normal force (N) of the oscillator of which this one has the numbers of a test.
    """

    document: dict[str, Any]
    nominal_load: float | None = None

    @property
    def turns(self) -> bool:
        """Whether it is an oscillator that turns."""
        return rotation.turns(self.document)

    @property
    def written(self) -> dict[str, Any]:
        """The document with the keys that a file has."""
        return rotation.written(self.document) if self.turns else self.document

    @property
    def title(self) -> str:
        return self.document["title"]

    @cached_property
    def suspension(self) -> dict[str, Any]:
        """SI numbers of the suspension; damping, jamming and unilateral joints where they are given."""
        given = self.document["suspension"]
        numbers: dict[str, Any] = _si(suspension.SUSPENSION, given)
        if "damping" in given:
            numbers["damping"] = given["damping"]
        if suspension.LOCKED_IN.key in given:
            numbers |= _si([suspension.LOCKED_IN], given)
        if given.get("joints") != suspension.UNILATERAL:
            return numbers
        restitution = given.get(suspension.RESTITUTION.key, suspension.RESTITUTION.default)
        return {**numbers, "joints": given["joints"], "restitution": restitution}

    @property
    def opens(self) -> bool:
        """Whether the joints of a suspension are unilateral, so that wedges may lift off."""
        unilateral = self.document.get("suspension", {}).get("joints") == suspension.UNILATERAL
        return unilateral or lift_off.NAME in self.document["effects"]

    @cached_property
    def at_rest(self) -> "Config":
        """The config of a suspension with joints that hold, as they do at rest, and nothing locked in."""
        without = ("joints", suspension.RESTITUTION.key, suspension.LOCKED_IN.key)
        held = {key: value for key, value in self.document["suspension"].items() if key not in without}
        effects = dict(self.document["effects"])
        for name in (lift_off.NAME, jamming.NAME):
            effects.pop(name, None)
        return Config(self.document | {"suspension": held, "effects": effects})

    def natural_units(self, travel: float | None = None, omega: float | None = None) -> NaturalUnits:
        """Natural units of the model, whose measured motion has some travel (m) and angular frequency."""
        if self.system == OSCILLATOR:
            own = self.oscillator
            return natural_units(own["mass"], own["spring"], travel=travel, omega=omega)
        return suspension.natural_units_of(self.suspension, travel)

    @property
    def system(self) -> str:
        """Name of the mechanical system: suspension or oscillator."""
        return OSCILLATOR if OSCILLATOR in self.document else "suspension"

    @cached_property
    def oscillator(self) -> dict[str, Any]:
        """SI numbers of the oscillator, and its contact."""
        given = self.document[OSCILLATOR]
        optional = (oscillator.BELT_VELOCITY, *oscillator.BRISTLES, oscillator.COUPLING)
        more = [each for each in optional if each.key in given]
        words = {name: given[name] for name in ("contact", "restoring_force") if name in given}
        numbers = _si((*oscillator.OSCILLATOR, *more), given)
        nominal = {} if self.nominal_load is None else {"nominal_load": self.nominal_load}
        return {**numbers, **words, **nominal}

    @property
    def possible_effects(self) -> tuple[str, ...]:
        """Names of the effects that a model may lack, whatever its tests are."""
        excluded = self.excluded_effects()
        return tuple(name for name in EFFECTS if name not in excluded)

    def excluded_effects(self, loads_differ: bool = False, loops: bool = False) -> dict[str, str]:
        """Effects that a model cannot lack, and why.

        ``loads_differ``: whether the normal force of an oscillator differs from test to test; ``loops``:
        whether all tests are loops.
        """
        known = of_system(self.system)
        excluded = dict.fromkeys((name for name in EFFECTS if name not in known), "acts on no part of it")
        if self.system != OSCILLATOR:
            why = "does not go with its joints or its law of friction"
            return excluded | {
                name: why for name in known if not (name in self.effects or self._may_have(name))
            }
        for names, why in self._excluded_of_oscillator(loads_differ, loops):
            excluded |= dict.fromkeys(names, why)
        others = {name: go_together((*self.effects, name)) for name in known}
        return excluded | {
            name: "does not go with an effect of the model" for name, fine in others.items() if not fine
        }

    def _excluded_of_oscillator(self, loads_differ: bool, loops: bool) -> Iterator[tuple[Iterable[str], str]]:
        """Effects that an oscillator cannot lack, and why."""
        rubs = self.oscillator["normal_force"] * max(self.friction["dynamic"], self.friction["static"]) > 0.0
        if rubs and not loads_differ:
            yield (oscillator.LATERAL,), "is friction_level where the normal force is the same in all tests"
        if not rubs:
            # Some show beside friction that may be missing. In runs their simulation would take too long.
            beside = [name for name in oscillator.OF_FRICTION if loops and EFFECTS[name].acts_on]
            alone = [name for name in oscillator.OF_FRICTION if name not in beside]
            yield alone, NO_FRICTION
        if not (rubs and loads_differ):
            yield (oscillator.OF_LOAD,), "shows only where the normal force differs from test to test"
        if self.oscillator["spring"] == 0.0:
            yield oscillator.OF_SPRING, "acts on a spring, and the model has none"
        if self.forced:
            yield (oscillator.OF_BASE,), "moves the base, which is at rest under a force"
        belt = self.oscillator["contact"] == oscillator.BELT
        if belt or not (rubs or self.oscillator["damping"]):
            rods = [name for name in oscillator.OF_ROD if belt or name != oscillator.OF_MANY_STATES]
            yield rods, "needs a rod to a damper, and the model has none"
        if self.oscillator["contact"] == oscillator.GROUND and not self.forced:
            yield oscillator.WITH_DAMPING, "needs friction and damping that follow the same body"
        for law in self.sweep.laws:
            yield oscillator.OF_LAW.get(law, ()), f"has no place in the law {law}"

    def _may_have(self, effect: str) -> bool:
        """Whether the model of a suspension can have a further effect: joints and law of friction decide."""
        if effect == jamming.NAME and not any(LAWS[law].SET_VALUED for law in self.sweep.laws):
            return False
        if effect not in (lift_off.NAME, jamming.NAME) and not self.opens:
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
        return _si(FRICTION, self.document["friction"])

    @cached_property
    def effects(self) -> dict[str, dict[str, float]]:
        given = self.document["effects"]
        found: dict[str, dict[str, Any]] = {
            name: _si(EFFECTS[name].quantities, values) for name, values in given.items()
        }
        if empirical_force.NAME in given:
            found[empirical_force.NAME] |= empirical_force.table(given[empirical_force.NAME])
        return found

    @cached_property
    def sweep(self) -> Cases:
        return of_document(self.document)

    @cached_property
    def solver(self) -> Settings:
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
            transient=self._nominal_run if self.transient else None,
        )

    @property
    def transient(self) -> bool:
        """Whether the config has an [input], which does not repeat."""
        return INPUT in self.document

    @cached_property
    def input(self) -> Input:
        """The input at scale 1; raises ConfigError if a recording cannot be read."""
        return input_of(self.document[INPUT], self.sweep.omega_n)

    def inputs(self, tables: Iterable[Mapping[str, Any]]) -> list[Input]:
        """The input at scale 1 of each table [input]; a recording is read once."""
        own = self.document[INPUT]
        return [self.input if table == own else input_of(table, self.sweep.omega_n) for table in tables]

    def tables_of_input(self, indices: np.ndarray) -> list[dict[str, Any]]:
        """The table [input] of some cases, shape (n,)."""
        columns = [self.sweep.values(key, indices).tolist() for key in self.sweep.keys_of_input]
        names = [key.removeprefix(f"{INPUT}.") for key in self.sweep.keys_of_input]
        rows = zip(*columns, strict=True) if columns else [()] * len(indices)
        return [self.document[INPUT] | dict(zip(names, row, strict=True)) for row in rows]

    def transients(self, indices: np.ndarray) -> tuple[Transient, ...]:
        """How some cases are run under inputs of their own; none where all have the same."""
        if not self.sweep.keys_of_input:
            return ()
        tables = self.tables_of_input(indices)
        # Equal inputs are one object.
        different = {repr(table): table for table in tables}
        samples = self._nominal_run.samples
        made = {text: replace(self._transient(table), samples=samples) for text, table in different.items()}
        return tuple(made[repr(table)] for table in tables)

    @cached_property
    def _nominal_run(self) -> Transient:
        """How the input is run; all cases have the samples that the highest frequencies need."""
        highest = {
            key.removeprefix(f"{INPUT}."): self.sweep.column(key).max().item()
            for key in self.sweep.keys_of_input
        }
        run = self._transient(self.document[INPUT])
        return (
            replace(run, samples=self._transient(self.document[INPUT] | highest).samples) if highest else run
        )

    def _transient(self, table: Mapping[str, Any]) -> Transient:
        """How an input is run."""
        absolute = self.system == OSCILLATOR and self.oscillator["contact"] != "base"
        belt = self.oscillator.get("belt_velocity", 0.0) if absolute else 0.0
        natural, rate = self.sweep.omega_n, table.get("sampling_hz")
        (given,) = self.inputs([table])
        return transient_of(given, natural, rate, absolute, self.system == OSCILLATOR, belt)

    def case_list(self) -> list[Case]:
        """All cases, which may be many: ``sweep.case`` makes one of them."""
        return [self.sweep.case(index) for index in range(self.sweep.count)]

    def case_coordinates(self) -> dict[str, tuple[tuple[str, ...], Any, dict[str, str]]]:
        """Coordinates of the cases: dimensions, values and attributes of each, by name."""
        sweep = self.sweep
        names = {name: (axis.dim,) for axis in sweep.axes for name in axis.columns}
        columns: dict[str, Any] = {name: (dims, sweep.column(name)) for name, dims in names.items()}
        if not self.transient:
            columns |= self._frequencies(columns)
        found = dict(self._coordinate(name, *column) for name, column in columns.items())
        found["friction_law"] = (found["friction_law"][0], list(sweep.friction_law), found["friction_law"][2])
        return found

    def _frequencies(self, columns: Mapping[str, Any]) -> dict[str, Any]:
        """Dimensions and values of beta or frequency, which is no column, and of omega_n if it varies."""
        sweep = self.sweep
        natural = [key for key, _ in sweep.natural if key in sweep.places]
        dims, indices = sweep.along(("beta", "frequency", *natural))
        found: dict[str, Any] = {}
        if "beta" not in columns:
            found["beta"] = dims, sweep.betas(indices)
        if "frequency" not in columns:
            found["frequency"] = dims, sweep.betas(indices) * sweep.omega_ns(indices) / (2.0 * pi)
        if natural:
            dims, indices = sweep.along(natural)
            found["omega_n"] = dims, sweep.omega_ns(indices)
        return found

    def _coordinate(self, name: str, dims: tuple[str, ...], values: np.ndarray) -> tuple[str, Any]:
        """Name of a coordinate, and its dimensions, values and attributes, as the file has its key."""
        if name not in self.sweep.keys:
            return name, (dims, values, self._about(name))
        key, factor = rotation.turned_path(name) if self.turns else (name, 1.0)
        number = (turned_numbers() if self.turns else numbers())[key]
        about = {"long_name": number.meaning, "key": key}
        if isinstance(number, Number):
            about["units"] = number.quantity.unit
        shown = [named(name, rotation.scaled(value, factor)) for value in values.tolist()]
        return dimension(key), (dims, np.array(shown), about)

    def _about(self, name: str) -> dict[str, str]:
        """Attributes of a coordinate that is no number of the model."""
        force = self.forced and not self.transient
        return {
            "friction_law": {"long_name": "friction law"},
            "scale": {"units": "1", "long_name": "what multiplies the input, or the start of a release"},
            "beta": {
                "units": "1",
                "long_name": f"input frequency over {'1 Hz' if self.has_no_spring else 'omega_n'}",
            },
            "frequency": {"units": "Hz", "long_name": "input frequency"},
            "amplitude": {
                "units": "N" if force else "m",
                "long_name": "amplitude of the force" if force else "input amplitude a",
            },
            "omega_n": {"units": "rad s-1", "long_name": "omega_n that beta refers to"},
        }[name]

    def record(self, case: Case) -> np.ndarray:
        """Parameter record of a case, shape (1,)."""
        model = self.at(dict(case.numbers))
        return model.record_with(model.effects, case.law, case.amplitude, case.beta * model.omega_n)

    def given(self, numbers: Mapping[str, Any]) -> dict[str, Any]:
        """Numbers with the keys of the file as those of the document, as ``at`` takes them."""
        return numbers_back(numbers) if self.turns else dict(numbers)

    def at(self, numbers: Mapping[str, float | str]) -> "Config":
        """The config of a model with other numbers, by dotted key; its sweep stays what it is."""
        return Config(with_numbers(self.document, numbers)) if numbers else self

    def alone(self, numbers: Mapping[str, float | str]) -> "Config":
        """The config of a model with these numbers whose sweep varies nothing else."""
        changed = self.at(numbers)
        rest = {key: each for key, each in self.document["sweep"].items() if key not in ("axes", "sample")}
        return Config(changed.document | {"sweep": {**rest, "omega_n_rad_per_s": changed.omega_n}})

    @property
    def omega_n(self) -> float:
        """What beta refers to (rad/s) for the nominal model."""
        return self.document["sweep"].get("omega_n_rad_per_s") or natural_frequency(self.document)

    def record_with(
        self, effects: Mapping[str, Mapping[str, float]], law: str, amplitude: float = 1.0, omega: float = 1.0
    ) -> np.ndarray:
        """Parameter record, shape (1,), with other effects (SI); amplitude in m or N, omega in rad/s."""
        if self.system == OSCILLATOR:
            own = self.oscillator
            return oscillator.record(law, amplitude, omega, own, self.friction, effects, self.excitation)
        return suspension.record(law, amplitude, omega, self.suspension, self.friction, effects)

    @property
    def forced(self) -> bool:
        """Whether the input is a force, and amplitudes are in N."""
        return self.excitation == "force"

    def case_in_words(self, index: int) -> str:
        """A case as messages name it."""
        law, beta, amplitude, numbers = self.sweep.case(index)
        unit = "" if self.transient else "N" if self.forced else "m"
        if not self.turns:
            return formatting.case(law, beta, amplitude, numbers, unit)
        shown = rotation.written(dict(numbers)).items()
        return formatting.case(law, beta, amplitude, shown, rotation.UNITS.get(unit, ""))

    @property
    def has_no_spring(self) -> bool:
        """Whether there is no natural frequency that frequencies could be compared with."""
        own = self.document.get(OSCILLATOR, {})
        return own.get("spring_N_per_mm") == 0.0 and self.omega_n == UNIT_FREQUENCY

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
        indices = np.arange(sweep.count) if indices is None else indices
        laws, omegas, amplitudes = sweep.at(indices)
        # Only amplitude and frequency differ between the cases of a law and a model.
        models, places = np.unique(
            np.column_stack([laws, sweep.varying(indices)]), axis=0, return_inverse=True
        )
        records = stacked([self._of_model(int(law), *rest) for law, *rest in models.tolist()])
        records = records[places.ravel()]
        records["input"]["amplitude"] = amplitudes
        records["input"]["omega"] = omegas
        return records

    def _of_model(self, law: int, *numbers: float) -> np.ndarray:
        """Parameter record, shape (1,), of a law and a model, whose numbers are those of ``sweep.keys``."""
        kept = self._records_of_models
        if (law, *numbers) not in kept:
            if len(kept) >= MOST_KEPT:
                kept.clear()
            case = Case(self.sweep.laws[law], 1.0, 1.0, self.sweep.named(numbers))
            kept[law, *numbers] = self.record(case)
        return kept[law, *numbers]

    @cached_property
    def _records_of_models(self) -> dict[tuple[float, ...], np.ndarray]:
        return {}

    @cached_property
    def records_of_laws(self) -> np.ndarray:
        """Parameter records of each law, of the nominal model and of the ends of what varies."""
        columns = [self.sweep.column(key) for key in self.sweep.keys]
        ends = [self.sweep.named(end(each).item() for each in columns) for end in (np.min, np.max)]
        models = dict.fromkeys([(), *ends])
        cases = [Case(law, 1.0, 1.0, numbers) for law in self.sweep.laws for numbers in models]
        return stacked([self.record(case) for case in cases])

    def to_toml(self) -> str:
        """The resolved config with every key, ranges expanded; ``parse`` of it gives the same config."""
        return toml.dumps(self.written)

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
        law = "coulomb"
        if self.system == OSCILLATOR or law not in self.sweep.laws:
            return None
        if not suspension.is_regularised(self.record(Case(law, 1.0, 1.0))[0]):
            return None
        width = suspension.regularised_velocity(self.suspension) * 1e3
        return (
            f"{law}: with cross_slip or column_compliance the faces may stick one at a time; "
            f"friction is regularised, a ramp up to mu_d over {width:g} mm/s"
        )

    @property
    def sha256(self) -> str:
        """Digest of all but the title, on which no result depends."""
        rest = {key: value for key, value in self.document.items() if key != "title"}
        return sha256(toml.dumps(rest).encode()).hexdigest()


def _si(quantities: Iterable[Quantity], given: Mapping[str, float]) -> dict[str, float]:
    return {each.name: given[each.key] * each.factor for each in quantities}
