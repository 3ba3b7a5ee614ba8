"""Makes measured data of planted effects, and diagnoses data, through the command line."""

import json
import os
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from tests.command import invoke
from wedgesweep import toml

Numbers = dict[str, dict[str, float]]
# ``make acceptance`` runs two tests at a time already, ``make validate`` one.
JOBS = 1 if "PYTEST_XDIST_WORKER" in os.environ else 2
# Below and above resonance; all wedges stay pressed, none stands still. (Hz, mm)
BENCH = (
    *((5.1, 0.98), (5.1, 2.2), (8.2, 0.60), (11.3, 0.22)),
    *((19.6, 0.060), (19.6, 0.115), (24.3, 0.085), (28.4, 0.040), (31.5, 0.024), (31.5, 0.060)),
)
PAPER = ((20.0, 0.075), (30.0, 0.045))


@dataclass(frozen=True)
class Specimen:
    """A system and how it is measured; effects in key units. ``spread`` None: amplitudes are unknown."""

    name: str
    law: str
    effects: Numbers
    noise: str = "white"
    tests: tuple[tuple[float, float], ...] = BENCH
    spread: float | None = 0.005
    uncertain: dict[str, float] | None = None
    seed: int = 1


GUIDE_FRICTION = Specimen("guide", "static-dynamic", {"guide_friction": {"force_N": 0.25}}, "ar1")
CLEAN = Specimen("clean", "static-dynamic", {}, "ar1", uncertain={"friction_level": 0.07}, spread=0.02)
PAPER_TESTS = replace(GUIDE_FRICTION, name="paper", noise="white", tests=PAPER, spread=None)


@dataclass(frozen=True)
class Found:
    """What a diagnosis wrote."""

    document: dict[str, Any]
    directory: Path

    @property
    def verdict(self) -> str:
        return self.document["verdict"]

    @property
    def causes(self) -> set[str]:
        return {cause["effect"] for cause in self.document["causes"]}

    @property
    def parameters(self) -> dict[str, dict[str, Any]]:
        """Numbers of the causes as "effect.key"."""
        return {
            f"{cause['effect']}.{key}": number
            for cause in self.document["causes"]
            for key, number in cause["parameters"].items()
        }

    @property
    def explanations(self) -> list[set[str]]:
        """The cause and its rivals."""
        return [self.causes, *(set(rival["effects"]) for rival in self.document["rivals"])]


def make(specimen: Specimen, here: Path) -> tuple[Path, dict[str, Any]]:
    """Path of measured.toml of new data, and their truth, whose file is removed."""
    system = {
        "title": "true",
        "effects": specimen.effects,
        "sweep": {"friction_law": specimen.law, "beta": 1.0, "amplitude_mm": 0.1},
    }
    told = {"known": False} if specimen.spread is None else {"amplitude_std": specimen.spread}
    tests = [{"frequency_hz": f, "amplitude_mm": a, **told} for f, a in specimen.tests]
    (here / "true.toml").write_text(toml.dumps(system))
    (here / "tests.toml").write_text(toml.dumps({"uncertain": specimen.uncertain or {}, "test": tests}))
    files = (here / "true.toml", "--tests", here / "tests.toml", "-o", here / "data")
    invoke("synthesize", *files, "--noise", specimen.noise, "--seed", specimen.seed, "--n-jobs", JOBS)
    truth = here / "data" / "truth.json"
    document = json.loads(truth.read_text())
    truth.unlink()
    return here / "data" / "measured.toml", document


def diagnose(measured: Path, output: Path, candidates: list[str] | None = None, *options: str) -> Found:
    chosen = [] if candidates is None else ["--effects", ",".join(candidates)]
    invoke("diagnose", measured, "-o", output, "--n-jobs", JOBS, *chosen, *options)
    return Found(json.loads((output / "diagnosis.json").read_text()), output)
