"""Makes measured data with something hidden in them, and diagnoses data, through the command line."""

import json
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from tests.command import invoke
from wedgesweep.config import toml

Numbers = dict[str, dict[str, float]]
# Below and above resonance; all wedges stay pressed, none stands still. (Hz, mm)
BENCH = (
    *((5.1, 0.98), (5.1, 2.2), (8.2, 0.60), (11.3, 0.22)),
    *((19.6, 0.060), (19.6, 0.115), (24.3, 0.085), (28.4, 0.040), (31.5, 0.024), (31.5, 0.060)),
)
PAPER = ((20.0, 0.075), (30.0, 0.045))


@dataclass(frozen=True)
class Hidden:
    """A system and how it was measured; effects in key units. ``spread`` None: amplitudes are not told."""

    name: str
    law: str
    effects: Numbers
    noise: str = "white"
    tests: tuple[tuple[float, float], ...] = BENCH
    spread: float | None = 0.005
    uncertain: dict[str, float] | None = None
    withheld: tuple[str, ...] = ()
    seed: int = 1


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


def make(hidden: Hidden, here: Path) -> tuple[Path, dict[str, Any]]:
    """measured.toml of fresh data, and their truth, which is not left beside them."""
    system = {
        "title": "true",
        "effects": hidden.effects,
        "sweep": {"friction_law": hidden.law, "beta": 1.0, "amplitude_mm": 0.1},
    }
    told = {"known": False} if hidden.spread is None else {"amplitude_std": hidden.spread}
    tests = [{"frequency_hz": f, "amplitude_mm": a, **told} for f, a in hidden.tests]
    (here / "true.toml").write_text(toml.dumps(system))
    (here / "tests.toml").write_text(toml.dumps({"uncertain": hidden.uncertain or {}, "test": tests}))
    files = (here / "true.toml", "--tests", here / "tests.toml", "-o", here / "data")
    invoke("synthesize", *files, "--noise", hidden.noise, "--seed", hidden.seed, "--n-jobs", 2)
    truth = here / "data" / "truth.json"
    document = json.loads(truth.read_text())
    truth.unlink()
    return here / "data" / "measured.toml", document


def diagnose(measured: Path, output: Path, candidates: list[str] | None = None, *options: str) -> Found:
    chosen = [] if candidates is None else ["--effects", ",".join(candidates)]
    invoke("diagnose", measured, "-o", output, "--n-jobs", 2, *chosen, *options)
    return Found(json.loads((output / "diagnosis.json").read_text()), output)
