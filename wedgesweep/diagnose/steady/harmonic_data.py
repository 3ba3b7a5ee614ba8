"""Steady harmonics as data of a fit.

Each test has a start phase, eliminated in closed form, and an input amplitude, fitted as its logarithm over
the stated one.
"""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any, NamedTuple, Self

import numpy as np

from wedgesweep.diagnose.evaluation import Comparison, Evaluation, NuisanceParameter, Point, Scenario
from wedgesweep.diagnose.fit_data import Arrays, FitData, Motion
from wedgesweep.diagnose.model import Fit, Model
from wedgesweep.diagnose.next_test.sensors import Sensors
from wedgesweep.diagnose.noise_spectrum import NoiseSpectrum
from wedgesweep.diagnose.steady import amplitude_grid, arrays, simulation, stated_input, tone, waveforms
from wedgesweep.diagnose.steady.column_load import CHANNEL
from wedgesweep.diagnose.steady.spectra import SIMULATED, Spectrum
from wedgesweep.diagnose.steady.tone import SAME, TONE, TONE_FREQUENCY
from wedgesweep.diagnose.steady.whitened import WhitenedHarmonics, real
from wedgesweep.diagnose.work import SLIGHT
from wedgesweep.effects import acting
from wedgesweep.effects.states import TIME, kinds
from wedgesweep.measured.declarations import STEADY
from wedgesweep.natural_units import NaturalUnits
from wedgesweep.solvers.period_detection import LONGEST_PERIOD
from wedgesweep.solvers.periodic import Warm, at_rest, joined
from wedgesweep.systems import compact
from wedgesweep.systems.records import stacked

# The nuisance parameter: logarithm of the amplitude over its reference.
AMPLITUDE = NuisanceParameter(step=2e-3, max_step=0.1)
# Effects that only a recorded input, or a recorded force, shows.
OF_RECORDED = ("input_gain", "force_gain", "channel_delay")
# A stated amplitude that a fit changes by more than this (relative) makes up for a wrong model.
IMPLAUSIBLE = 0.3
# Relative standard deviation of an amplitude that is held as stated.
HELD = 1e-4
# A covariance is replaced if the variance of some combination of residuals changes by more than this factor.
CHANGED = 1.1


class SteadyResponse(NamedTuple):
    """Simulated harmonics of all tests.

    ``harmonics`` (T, C, H): those that are compared, from phase 0 of the input (m, m/s); ``whitened``: over
    the noise. ``phase`` (T,): start phase (rad) of each record. ``aliases`` (T, C, H): what sampling adds, 0
    in a record that looks as if it had been low-passed before it was sampled.
    """

    harmonics: np.ndarray
    whitened: np.ndarray
    phase: np.ndarray
    aliases: np.ndarray

    @property
    def aliased(self) -> np.ndarray:
        """Whether (T, 1, 1) aliases are part of what is compared."""
        return (self.aliases != 0.0).any(axis=(-2, -1), keepdims=True)


class Simulated(NamedTuple):
    """Harmonics (n, T, C, K) of n scenarios, whether they exist (n, T), and final states of all n T tests."""

    harmonics: np.ndarray
    found: np.ndarray
    warm: Warm


@dataclass(frozen=True)
class HarmonicData(WhitenedHarmonics, FitData):
    """Harmonics of steady tests; see WhitenedHarmonics for the attributes.

    ``harmonics_std``: of each harmonic of a stated input, over its amplitude; 0 for exact sines.
    """

    harmonics_std: float = 0.0

    kind = STEADY
    offers = (STEADY,)
    eliminated = 1

    @cached_property
    def reference(self) -> np.ndarray:
        """Input amplitudes (T,) about which a fit looks: stated, or as large as the fundamental."""
        fundamental = np.abs(self.measured[:, 0, 0]) / self.model.deflection(self.omega)
        return np.where(np.isinf(self.amplitude_std), fundamental, self.amplitude)

    def amplitudes(self, point: Point) -> np.ndarray:
        """Input amplitudes (T,) in m, or N of a force, at a point."""
        return self.reference * np.exp(point.nuisance[:, 0])

    def inputs_of(self, scenario: Scenario) -> np.ndarray:
        """Input amplitudes (T,) in m, or N of a force, that are simulated in a scenario."""
        return self.amplitudes(scenario.point)

    @property
    def nuisance_std(self) -> np.ndarray:
        return self.amplitude_std[:, None]

    @property
    def known(self) -> dict[str, tuple[float, float]]:
        return {} if self.tone is None else {TONE_FREQUENCY: (self.tone, self.tone_std)}

    @cached_property
    def units(self) -> NaturalUnits:
        """Natural units of the model; without gravity of the largest fundamental that was measured."""
        travel = max(float(np.abs(s.mean[0, 0])) for s in self.spectra)
        return self.model.natural_units(travel)

    def has_tone(self, effects: Iterable[str]) -> bool:
        """Whether responses under these effects contain the tone."""
        return self.tone is not None and TONE in {*acting(self.model.effects), *effects}

    def nuisances(self, effects: Iterable[str]) -> tuple[NuisanceParameter, ...]:
        return (AMPLITUDE,)

    def start(self) -> tuple[np.ndarray, Warm]:
        return np.zeros((self.tests, 1)), at_rest(self.tests)

    def records(self, scenario: Scenario) -> np.ndarray:
        """Parameter records (T,) of the tests in a scenario."""
        amplitudes = self.inputs_of(scenario)
        if self.models is None:
            return simulation.records(self.model, self.law, scenario.values, self.omega, amplitudes)
        each = [
            simulation.records(model, self.law, scenario.values, self.omega[t : t + 1], amplitudes[t : t + 1])
            for t, model in enumerate(self.models)
        ]
        return stacked(each)

    def power_of(self, response: SteadyResponse) -> np.ndarray:
        return self.squared(self.of_motion(response.whitened))

    def _simulate(self, scenarios: Sequence[Scenario], tolerance: float) -> Simulated:
        rows = [self.records(each) for each in scenarios]
        warm = joined([each.point.warm for each in scenarios])
        done = self._respond(stacked(rows), self.has_tone(scenarios[0].values), warm, tolerance)
        shape = (len(scenarios), self.tests)
        harmonics = done.harmonics.reshape(*shape, *done.harmonics.shape[1:])[:, :, : self.shape[0]]
        return Simulated(harmonics, done.found.reshape(shape), done.warm)

    def _respond(self, rows: np.ndarray, toned: bool, warm: Warm, tolerance: float) -> simulation.Responses:
        """Responses to parameter records, with the tone or without it."""
        if toned and self.tone is not None:
            timings = self.tone_timings * (len(rows) // self.tests)
            return simulation.respond_with_tone(rows, warm, self.shape[1], self.tone, timings, tolerance)
        done = simulation.respond(rows, warm, SIMULATED, tolerance, load=bool(self.loads))
        if self.tone is None:
            return done
        silent = np.zeros((len(rows), 2, 1))  # a periodic response has no tone
        return done._replace(harmonics=np.concatenate([done.harmonics, silent], axis=-1))

    def compare(self, scenarios: Sequence[Scenario], tolerance: float) -> list[Comparison]:
        simulated, found, warm = self._simulate(scenarios, tolerance)
        simulated = np.where(found[:, :, None, None], simulated, 0.0)
        harmonics = self.compared(simulated)
        whitened = self.whiten(harmonics)
        phase, aliases = self._aligned(simulated, whitened)
        residual = real(self.whitened - self.whiten(aliases) - self.rotated(whitened, phase))
        residual = self.decorrelated(residual)
        return [
            Comparison(
                SteadyResponse(harmonics[i], whitened[i], phase[i], aliases[i]),
                residual[i],
                found[i],
                warm.of(slice(i * self.tests, (i + 1) * self.tests)),
            )
            for i in range(len(scenarios))
        ]

    def _aligned(self, simulated: np.ndarray, whitened: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Start phases (n, T), and aliases (n, T, C, H) in each record unless something kept them out."""
        phase = self.start_phase(whitened)
        aliases = self.aliases(simulated, phase)
        if not aliases.any():
            return phase, aliases
        left = self.whitened - self.rotated(whitened, phase)
        # A record was low-passed before it was sampled if it fits better without aliases.
        both = np.stack([left - self.whiten(aliases), left])
        with_aliases, without = self.squared(both)
        aliases[with_aliases > without + SLIGHT] = 0.0
        phase = self.start_phase(whitened, self.whiten(aliases))
        return phase, np.where(aliases != 0.0, self.aliases(simulated, phase), 0.0)

    def with_model_error(self, size: float) -> Self:
        return replace(self, model_error=size)

    def compared_again(self, here: Evaluation) -> Evaluation:
        response: SteadyResponse = here.response
        whitened, aliases = self.whiten(response.harmonics), self.whiten(response.aliases)
        phase = self.start_phase(whitened, aliases)
        residual = self.decorrelated(real(self.whitened - aliases - self.rotated(whitened, phase)))
        return replace(here, response=response._replace(whitened=whitened, phase=phase), residual=residual)

    def changes(
        self, here: Evaluation, scenarios: Sequence[Scenario], tolerance: float
    ) -> tuple[np.ndarray, np.ndarray]:
        simulated, found, _ = self._simulate(scenarios, tolerance)
        response: SteadyResponse = here.response
        phase = np.repeat(response.phase[None], len(scenarios), axis=0)
        there = self.rotated(self.whiten(self.compared(simulated)), phase)
        aliases = np.where(response.aliased, self.aliases(simulated, phase), 0.0) - response.aliases
        change = self.rotated(response.whitened, response.phase) - there - self.whiten(aliases)
        return self.decorrelated(real(change)), found

    def eliminated_derivatives(self, here: Evaluation) -> np.ndarray:
        """Derivative of the residual by the start phase, (T, m, 1)."""
        rotated = self.rotated(here.response.whitened, here.response.phase)
        return self.decorrelated(real(-1j * self.turning_orders * rotated))[..., None]

    def response_change(self, here: Evaluation, there: Evaluation) -> np.ndarray:
        both = np.stack([there.response.whitened, here.response.whitened])
        both = self.rotated(both, np.stack([here.response.phase] * 2))
        return self.decorrelated(real(both[0] - both[1]))

    def candidates(self, effects: Sequence[str]) -> tuple[str, ...]:
        hidden = {*OF_RECORDED, *(() if self.tone is not None else (TONE,))}
        return tuple(name for name in effects if name not in hidden)

    def with_undetected(self, effect: str) -> Self:
        """The data as if a tone had been looked for, between the harmonics, and only noise been found."""
        if self.loads:  # there is no tone beside them
            return replace(self, loads=(), by_input=None).with_undetected(effect)
        frequency = tone.between(self.spectra)
        spectra = tuple(s.with_undetected_tone(frequency) for s in self.spectra)
        wider = replace(self, spectra=spectra, tone=frequency, by_input=None)
        if self.by_input is None:
            return wider
        # Errors of an input do not matter at a tone between its harmonics.
        harmonic = np.zeros((2, self.shape[0], wider.columns), bool)
        harmonic[..., : self.shape[1]] = True
        place, by_input = np.flatnonzero(harmonic), np.zeros((self.tests, harmonic.size, harmonic.size))
        by_input[:, place[:, None], place] = self.by_input
        return replace(wider, by_input=by_input)

    def covariance(self, scenario: Scenario) -> np.ndarray | None:
        """Of residuals over the noise of the responses (T, m, m) in a scenario; None for exact inputs."""
        return stated_input.covariance(self, scenario) if self.harmonics_std else None

    def bare(self) -> Self:
        """The data as if inputs were exactly known."""
        return replace(self, by_input=None)

    def with_covariance(self, scenario: Scenario) -> Self:
        """The data with the covariance of their residuals in a scenario."""
        covariance = self.covariance(scenario)
        if covariance is None:
            return self
        back = self.matrices(self.unwhiten)
        by_input = back @ (covariance - np.eye(covariance.shape[-1])) @ np.swapaxes(back, 1, 2)
        return replace(self, by_input=by_input)

    def renewed(self, scenario: Scenario) -> Self:
        there = self.with_covariance(scenario)
        if self.whitening is None or there.whitening is None:
            return self
        both = self.whitening @ np.linalg.inv(there.whitening)
        ratio = np.linalg.eigvalsh(both @ np.swapaxes(both, 1, 2))
        return there if np.abs(np.log(ratio)).max() > np.log(CHANGED) else self

    def extra_nuisances(self, effects: Iterable[str]) -> np.ndarray:
        """One in each test with a tone that these effects explain: its phase."""
        return np.array([self.has_tone(effects) and s.has_tone for s in self.spectra])

    def aligned_to(self, evaluation: Evaluation) -> Self:
        return replace(self, input_phase=evaluation.response.phase)

    def needs_alignment(self, effects: Iterable[str]) -> bool:
        """Responses under a tone do not repeat: they depend on the input's phase where a record starts."""
        return self.has_tone(effects)

    def never_steady(self, scenario: Scenario) -> np.ndarray:
        """Whether (T,) a time that is a state (an age) exceeds that which any response takes to repeat."""
        clocks = [kind == TIME for _, kind in kinds(compact(self.records(scenario)).dtype.fields or {})]
        elapsed = scenario.point.warm.state[:, : len(clocks)][:, clocks]
        return (elapsed * self.omega[:, None] / (2.0 * np.pi) > LONGEST_PERIOD).any(axis=1)

    def search_nuisances(self, model: Model, points: Sequence[Point]) -> list[Evaluation]:
        return amplitude_grid.best_amplitudes(model, points)

    def held_as_stated(self) -> Self:
        std = self.amplitude_std
        return replace(self, amplitude_std=np.where(np.isinf(std), std, np.minimum(std, HELD)))

    def implausible(self, point: Point) -> bool:
        stated = np.isfinite(self.amplitude_std)
        return bool((np.abs(point.nuisance[stated, 0]) > IMPLAUSIBLE).any())

    def predicted_nuisances(self, evaluation: Evaluation, step: np.ndarray) -> np.ndarray:
        """A stated amplitude moves within its prior; an unknown one is matched to the fundamental alone."""
        measured = np.abs(self.measured[:, 0, 0])
        simulated = np.abs(evaluation.response.harmonics[:, 0, 0])
        match = np.log(measured / np.where(simulated > 0.0, simulated, measured))
        unknown = np.isinf(self.amplitude_std)
        return np.where(unknown, match, step[:, 0])[:, None]

    def held_out_groups(self) -> list[tuple[str, np.ndarray]]:
        """All tests of one frequency, and of one amplitude if all amplitudes are known."""
        found = [("frequency", rows) for rows in groups_of_equal(self.omega)]
        if not np.isinf(self.amplitude_std).any():
            found += [("amplitude", rows) for rows in groups_of_equal(self.amplitude)]
        return found

    def bootstrap_sample(self, truth: Evaluation, rng: np.random.Generator) -> Self:
        response: SteadyResponse = truth.response
        exact = self.rotated(response.harmonics, response.phase) + response.aliases
        noise = self.correlated(rng.normal(size=truth.residual.shape))
        real_part, imaginary = np.split(noise, 2, axis=-1)
        sample = exact + self.unwhiten((real_part + 1j * imaginary).reshape(exact.shape))
        spectra = (self._with_mean(s, mean) for s, mean in zip(self.spectra, sample, strict=True))
        loads = [
            each
            and each._replace(mean=np.append(mean[CHANNEL, : each.mean.size - 1], mean[CHANNEL, -1].real))
            for each, mean in zip(self.loads, sample, strict=False)
        ]
        return replace(self, spectra=tuple(spectra), loads=tuple(loads))

    def _with_mean(self, spectrum: Spectrum, padded: np.ndarray) -> Spectrum:
        """A spectrum with other harmonics (C, H), a tone last, than the measured ones."""
        channels = len(spectrum.mean)
        mean = padded[:channels, : spectrum.harmonics]
        if spectrum.tone is not None:
            mean = np.concatenate([mean, padded[:channels, -1:]], axis=1)
        return replace(spectrum, mean=mean)

    def rows(self, base: Fit, extended: Fit) -> list[dict[str, Any]]:
        unit, size = self.model.amplitude_unit
        fitted = self.inputs_of(extended.model.scenario(extended.point)) / size
        loads = self._load_rows(extended)
        return [
            {
                "frequency_hz": spectrum.frequency,
                f"amplitude_{unit}": stated,
                f"amplitude_fitted_{unit}": amplitude,
                "periods": spectrum.periods,
                "noise_displacement_mm": 1e3 * spectrum.sample_noise[0],
                "noise_velocity_mm_per_s": 1e3 * spectrum.sample_noise[1] if len(spectrum.mean) > 1 else None,
                **load,
            }
            for spectrum, stated, amplitude, load in zip(
                self.spectra, self.amplitude / size, fitted, loads, strict=True
            )
        ]

    def _load_rows(self, extended: Fit) -> list[dict[str, Any]]:
        """What each test shows of the load of its column (N), None where it is not compared."""
        if not self.loads:
            return [{}] * self.tests
        simulated = extended.evaluation.response.harmonics[:, CHANNEL, -1].real
        return [
            {
                "noise_normal_force_N": each and each.noise,
                "mean_normal_force_N": each and float(each.mean[-1].real),
                "mean_normal_force_fitted_N": each and float(mean),
            }
            for each, mean in zip(self.loads, simulated, strict=True)
        ]

    def arrays(self, base: Fit, extended: Fit) -> Arrays:
        return arrays.arrays(self, base, extended)

    def motion(self, fit: Fit) -> Motion:
        harmonics = waveforms.measured_from_phase_zero(self, fit)
        both = harmonics[:, 0], waveforms.velocity(self, harmonics)
        return Motion(*(waveforms.waveform(each).ravel() for each in both))

    @property
    def method(self) -> dict[str, Any]:
        return {"harmonics": self.shape[1]}

    def cases(self, fit: Fit) -> list[dict[str, float]]:
        unit, inputs = self.model.amplitude_unit, self.inputs_of(fit.model.scenario(fit.point))
        return [
            {"frequency_hz": spectrum.frequency, unit.key: float(f"{amplitude / unit.factor:.7g}")}
            for spectrum, amplitude in zip(self.spectra, inputs, strict=True)
        ]

    def sensors(self) -> Sensors:
        share = [float(each.sample_noise[0] / each.rms[0]) for each in self.spectra]
        own = self.spectra[int(np.argsort(share)[len(share) // 2])]
        noise = tuple(NoiseSpectrum(0.0, 0.0, float(std) ** 2) for std in own.sample_noise[:2])
        travel = max(float(np.abs(each.mean[0]).sum()) for each in self.spectra)
        rms, orders = own.rms[:2], tuple(range(len(noise)))
        return Sensors(self.model, self.law, 1.0 / own.interval, noise, rms, travel, orders)


def stated(data: HarmonicData) -> Scenario:
    """The scenario of the base model as stated, each test starting at rest."""
    return Scenario({}, Point(np.zeros(0), *data.start()))


def groups_of_equal(values: np.ndarray) -> list[np.ndarray]:
    """Indices of values that are the same to within SAME, group by group."""
    order = np.argsort(values)
    found = [[order[0]]]
    for place in order[1:]:
        # Compared with the first of the group: in a fine sweep each is close to its neighbour.
        if np.log(values[place] / values[found[-1][0]]) > SAME:
            found.append([])
        found[-1].append(place)
    return [np.array(group) for group in found]
